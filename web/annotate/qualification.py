"""The test that one passes before one reviews the programs of others (thesis 3.3)."""

from __future__ import annotations

import secrets
import time
from functools import cache
from typing import Any

import sqlalchemy as sql
from starlette.responses import Response

from hearth.schemas.yaml_extent import packaged
from hearth.web.annotate.annotate_tables import QUALIFIED
from hearth.web.store import Store
from hearth.web.visit import Visit

MOST_TRIES = 3
"""Tests that one session may take, since the answers are shown afterwards."""


@cache
def _test() -> dict[str, Any]:
    found: dict[str, Any] = packaged("hearth.web.annotate", "qualification.yaml")
    return found


def is_qualified(store: Store, person: str) -> bool:
    """Whether a person has passed."""
    query = sql.select(QUALIFIED.c.id).where(QUALIFIED.c.session == person, QUALIFIED.c.passed)
    return store.scalar(query) is not None


def test_page(visit: Visit) -> Response:
    """The questions."""
    left = MOST_TRIES - _taken(visit)
    return visit.page("annotate/test.html", questions=_test()["questions"], left=left, answers=None, passed=False)


def take_test(visit: Visit) -> Response:
    """Count the right answers, store the result and show the reasons."""
    questions, left = _test()["questions"], MOST_TRIES - _taken(visit)
    if left <= 0:
        return visit.go("/annotate/test")
    answers = [visit.field(f"answer {number}", 10) for number in range(len(questions))]
    if not all(answer in ("yes", "no") for answer in answers):
        return visit.go("/annotate/test")
    right = sum((answer == "yes") is each["right"] for answer, each in zip(answers, questions, strict=True))
    row = {"id": secrets.token_hex(8), "session": visit.person, "right": right, "passed": right >= _test()["passing"]}
    query = sql.insert(QUALIFIED).values(**row, created=time.time())
    visit.web.store.write(lambda connection: connection.execute(query))
    values = {"answers": answers, "right": right, "passed": row["passed"], "left": left - 1}
    return visit.page("annotate/test.html", questions=questions, **values)


def _taken(visit: Visit) -> int:
    query = sql.select(sql.func.count()).select_from(QUALIFIED).where(QUALIFIED.c.session == visit.person)
    return int(visit.web.store.scalar(query))
