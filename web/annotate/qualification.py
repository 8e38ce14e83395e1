"""The test that one passes before one reviews the programs of others (thesis 3.3)."""

import secrets
import time
from collections.abc import Sequence
from functools import cache
from typing import Any

import sqlalchemy as sql
from starlette.responses import Response

from hearth.schemas.rng import rng
from hearth.schemas.yaml_limits import packaged
from hearth.web.annotate.annotate_tables import QUALIFIED
from hearth.web.room_request import Visit
from hearth.web.store import Store

YES, NO = "yes", "no"
"""The answers."""

MOST_TRIES = 3
"""Tests that one session may take."""


@cache
def _test() -> dict[str, Any]:
    found: dict[str, Any] = packaged("hearth.web.annotate", "qualification.yaml")
    return found


def is_qualified(store: Store, person: str) -> bool:
    """Return whether a person has passed."""
    query = sql.select(QUALIFIED.c.id).where(QUALIFIED.c.session == person, QUALIFIED.c.passed)
    return store.scalar(query) is not None


def test_page(visit: Visit) -> Response:
    """Return the questions in an order of this try; once the test is passed, the right answers with reasons.

    To load the page again costs no attempt.
    """
    taken = _taken(visit)
    questions = list(enumerate(_test()["questions"]))
    rng(0, "qualification", visit.person, taken).shuffle(questions)
    values: dict[str, Any] = {"questions": questions, "taken": taken, "left": MOST_TRIES - taken}
    given = visit.field("given", len(questions)) if taken else ""
    answers = [YES if letter == YES[0] else NO for letter in given]
    if len(answers) != len(questions):
        return visit.page("annotate/test.html", answers=None, passed=False, **values)
    passed = is_qualified(visit.web.store, visit.person)
    return visit.page("annotate/test.html", answers=answers, right=_right(answers), passed=passed, **values)


def _right(answers: Sequence[str]) -> int:
    return sum((answer == YES) is each["right"] for answer, each in zip(answers, _test()["questions"], strict=True))


def take_test(visit: Visit) -> Response:
    """Count the right answers, store the result, and lead to the reasons. A form that is sent again counts once."""
    questions, taken = _test()["questions"], _taken(visit)
    again = visit.field("taken", 10) not in ("", str(taken))
    if taken >= MOST_TRIES or again:
        return visit.go("/annotate/test")
    answers = [visit.field(f"answer {number}", 10) for number in range(len(questions))]
    if not all(answer in (YES, NO) for answer in answers):
        return visit.go("/annotate/test")
    right = _right(answers)
    row = {"id": secrets.token_hex(8), "session": visit.person, "right": right, "passed": right >= _test()["passing"]}
    query = sql.insert(QUALIFIED).values(**row, created=time.time())
    visit.web.store.write(lambda connection: connection.execute(query))
    return visit.go(f"/annotate/test?given={''.join(answer[0] for answer in answers)}")


def _taken(visit: Visit) -> int:
    query = sql.select(sql.func.count()).select_from(QUALIFIED).where(QUALIFIED.c.session == visit.person)
    return int(visit.web.store.scalar(query))
