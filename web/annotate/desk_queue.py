"""The desk's queue of programs: each with its state and signs of little care, and a page on which one is read."""

import time
from collections import Counter
from collections.abc import Iterator
from typing import Any

import sqlalchemy as sql
from starlette.responses import Response

from hearth.schemas.failures import Code
from hearth.studies.participant_flags import is_gibberish
from hearth.web.annotate import annotated_programs, program_stage
from hearth.web.annotate.annotate_tables import PROGRAMS, REVIEWS, SUBMITTED, TEXTS
from hearth.web.annotate.descriptions import folded
from hearth.web.annotate.program_draft import stored
from hearth.web.room_request import Visit
from hearth.web.store import Row, Store
from hearth.web.web_errors import WebError

FEWEST_STEPS = 3
"""Steps below which a program is hardly an activity."""

SIGNS = {
    "gibberish": "the title or the description has no words",
    "again": "another description has the same words",
    "short": "the program has fewer than three steps",
}
"""The signs of little care, with their meanings; nothing is decided by them."""

MOST_LISTED = 500
"""Programs that the desk lists: those that wait for review first, the oldest before the others."""


def queue(store: Store) -> list[dict[str, Any]]:
    """Return the programs that were handed in, those that wait for review first."""
    texts = {each["id"]: each for each in store.rows(sql.select(TEXTS))}
    same = Counter(folded(each["description"]) for each in texts.values())
    programs = store.rows(sql.select(PROGRAMS).where(PROGRAMS.c.state != "draft").order_by(PROGRAMS.c.created))
    rows = [_listed(each, texts[each["text"]], same) for each in programs]
    return sorted(rows, key=lambda each: each["state"] != SUBMITTED)[:MOST_LISTED]


def _listed(program: Row, text: Row, same: Counter[str]) -> dict[str, Any]:
    steps = len(stored(program["draft"]).blocks)
    hours = (time.time() - program["created"]) / 3600
    signs = [each for each in SIGNS if each in set(_signs(text, steps, same))]
    return {**program, "title": text["title"], "steps": steps, "hours": round(hours, 1), "signs": signs}


def _signs(text: Row, steps: int, same: Counter[str]) -> Iterator[str]:
    if is_gibberish(text["title"]) or is_gibberish(text["description"]):
        yield "gibberish"
    if same[folded(text["description"])] > 1:
        yield "again"
    if steps < FEWEST_STEPS:
        yield "short"


def item(visit: Visit) -> Response:
    """Return a program next to its description, with the notes of its reviewers.

    Raises:
        WebError: UNKNOWN_ID.
    """
    store = visit.web.store
    program = store.row(sql.select(PROGRAMS).where(PROGRAMS.c.id == visit.part("program")))
    if program is None:
        raise WebError(Code.UNKNOWN_ID, "program", "a program of somebody", visit.part("program")[:40])
    text = annotated_programs.text_of(store, program["text"])
    words = program_stage.words_of(visit, text, stored(program["draft"]))
    reviews = store.rows(sql.select(REVIEWS).where(REVIEWS.c.program == program["id"]).order_by(REVIEWS.c.created))
    return visit.page("annotate/item.html", program=program, text=text, words=words, reviews=reviews)
