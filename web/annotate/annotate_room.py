"""The room where people annotate: its addresses."""

from __future__ import annotations

import sqlalchemy as sql
from starlette.responses import Response

from hearth.schemas.yaml_extent import packaged
from hearth.web.annotate import (
    annotate_desk,
    annotated_programs,
    composing,
    descriptions,
    marking,
    reviewers,
    reviewing,
    withdrawal,
)
from hearth.web.annotate.annotate_tables import TEXTS
from hearth.web.annotate.collected_files import write_collected
from hearth.web.annotate.qualification import is_qualified, take_test, test_page
from hearth.web.room import Room, get, post
from hearth.web.visit import Visit


def _home(visit: Visit) -> Response:
    """Return the start page: the person's possible tasks, and how many contributions wait for each."""
    store, person = visit.web.store, visit.person
    query = sql.select(sql.func.count()).select_from(TEXTS)
    waiting = {
        "texts": store.scalar(query),
        "reviews": len(annotated_programs.submitted(store, person)),
        "accepted": len(annotated_programs.accepted(store, person)),
        "films": visit.web.films is not None,
    }
    return visit.page("annotate/home.html", waiting=waiting, qualified=is_qualified(store, person))


def _tutorial(visit: Visit) -> Response:
    return visit.page("annotate/tutorial.html", taught=packaged("hearth.web.annotate", "tutorial.yaml"))


ROOM = Room(
    "annotate",
    "Annotate",
    "Describe an activity, and write it down step by step, from blocks.",
    addresses=(
        get("/", _home),
        get("/tutorial", _tutorial),
        get("/describe", descriptions.describe),
        post("/describe", descriptions.submit_description),
        get("/tasks", composing.task_list),
        get("/task/{text}", composing.read_task),
        get("/task/{text}/scene", composing.scene_page),
        post("/task/{text}/scene", composing.set_scene),
        get("/task/{text}/compose", composing.compose),
        get("/task/{text}/work", composing.work),
        post("/task/{text}/save", composing.save),
        post("/task/{text}/run", composing.try_out),
        post("/task/{text}/replay", composing.replay),
        post("/task/{text}/submit", composing.submit),
        get("/plan/{home}", composing.plan),
        get("/shapes/{home}", composing.shapes),
        get("/replay.js", composing.replay_script),
        get("/test", test_page),
        post("/test", take_test),
        get("/review", reviewing.review_list),
        get("/review/{program}", reviewing.review_page),
        post("/review/{program}", reviewing.judge),
        get("/review/{program}/mend", reviewing.mend_page),
        get("/review/{program}/work", reviewing.work),
        post("/review/{program}/save", reviewing.check),
        post("/review/{program}/run", reviewing.try_out),
        post("/review/{program}/replay", reviewing.replay),
        post("/review/{program}/submit", reviewing.mend),
        get("/reviewer/{code}", reviewers.invited_page),
        post("/reviewer/{code}", reviewers.accept_invitation),
        get("/sketch", marking.sketch_page),
        post("/sketch/{program}", marking.keep_sketch),
        get("/rate", marking.rating_page),
        post("/rate/{program}", marking.keep_rating),
        get("/film", marking.film_page),
        post("/film/{film:path}", marking.keep_film),
        get("/film-of/{film:path}", marking.film_file),
    ),
    desk=(
        get("/", annotate_desk.overview),
        post("/invite", reviewers.invite),
        post("/erase", annotate_desk.erase),
        get("/{file}", annotate_desk.download),
    ),
    needs=("blockly",),
    opens=write_collected,
    keeps=withdrawal.keep,
)
