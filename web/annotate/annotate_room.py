"""The room where people annotate: its addresses."""

import sqlalchemy as sql
from starlette.responses import Response

from hearth.schemas.yaml_limits import packaged
from hearth.web.annotate import (
    annotate_desk,
    annotated_programs,
    annotation_marks,
    descriptions,
    desk_queue,
    own_work,
    program_stage,
    review_stage,
    reviewers,
    withdrawal,
)
from hearth.web.annotate.annotate_tables import TEXTS
from hearth.web.annotate.collected_files import write_collected
from hearth.web.annotate.qualification import is_qualified, take_test, test_page
from hearth.web.room import Room, Who, get, post
from hearth.web.room_request import Visit


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
    qualified, invited = is_qualified(store, person), reviewers.is_invited(store, person)
    return visit.page("annotate/home.html", waiting=waiting, qualified=qualified, invited=invited)


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
        get("/tasks", program_stage.task_list),
        get("/task/{text}", program_stage.read_task),
        get("/task/{text}/scene", program_stage.scene_page),
        post("/task/{text}/scene", program_stage.set_scene),
        get("/task/{text}/compose", program_stage.compose),
        get("/task/{text}/work", program_stage.work),
        post("/task/{text}/save", program_stage.save),
        post("/task/{text}/run", program_stage.try_out),
        post("/task/{text}/replay", program_stage.replay),
        post("/task/{text}/submit", program_stage.submit),
        get("/mine", own_work.own_page),
        post("/mine/back/{text}", own_work.take_back),
        post("/mine/program/{text}", own_work.withdraw_program),
        post("/mine/description/{text}", own_work.withdraw_text),
        get("/plan/{home}", program_stage.plan),
        get("/shapes/{home}", program_stage.shapes),
        get("/replay.js", program_stage.replay_script, Who.ANYONE),
        get("/test", test_page),
        post("/test", take_test),
        get("/review", review_stage.review_list),
        get("/review/{program}", review_stage.review_page),
        post("/review/{program}", review_stage.judge),
        get("/review/{program}/mend", review_stage.mend_page),
        get("/review/{program}/work", review_stage.work),
        post("/review/{program}/save", review_stage.check),
        post("/review/{program}/run", review_stage.try_out),
        post("/review/{program}/replay", review_stage.replay),
        post("/review/{program}/submit", review_stage.mend),
        get("/reviewer/{code}", reviewers.invited_page),
        post("/reviewer/{code}", reviewers.accept_invitation),
        get("/sketch", annotation_marks.sketch_page),
        post("/sketch/{program}", annotation_marks.keep_sketch),
        get("/rate", annotation_marks.rating_page),
        post("/rate/{program}", annotation_marks.keep_rating),
        get("/film", annotation_marks.film_page),
        post("/film/{film:path}", annotation_marks.keep_film),
        get("/film-of/{film:path}", annotation_marks.film_file),
    ),
    desk=(
        get("/", annotate_desk.overview),
        post("/invite", reviewers.invite),
        post("/erase", annotate_desk.erase),
        get("/item/{program}", desk_queue.item),
        get("/{file}", annotate_desk.download),
    ),
    needs=("blockly",),
    own="/annotate/mine",
    opens=write_collected,
    keeps=withdrawal.keep,
)
