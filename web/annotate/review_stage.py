"""Review: a second person accepts a program, corrects it, or returns it to its author (thesis 3.3)."""

import secrets
import time
from typing import Any

import sqlalchemy as sql
from starlette.responses import Response

from hearth.schemas.failures import Code
from hearth.web.annotate import annotated_programs, program_stage, trial_run
from hearth.web.annotate.annotate_tables import ACCEPTED, PROGRAMS, RETURNED, REVIEWS, SUBMITTED
from hearth.web.annotate.collected_files import write_collected
from hearth.web.annotate.program_draft import Draft, stored
from hearth.web.annotate.qualification import is_qualified
from hearth.web.annotate.reviewers import is_invited
from hearth.web.messages import int_field
from hearth.web.room_request import Visit
from hearth.web.store import Row
from hearth.web.web_errors import WebError


def review_list(visit: Visit) -> Response:
    """Return the programs that wait for a second person; others get the way to an invitation and the test."""
    store, person = visit.web.store, visit.person
    invited, qualified = is_invited(store, person), is_qualified(store, person)
    waiting = annotated_programs.submitted(store, person) if invited and qualified else []
    return visit.page("annotate/reviews.html", invited=invited, qualified=qualified, waiting=waiting)


def review_page(visit: Visit) -> Response:
    """Return a program next to its description."""
    program, text = _waiting(visit)
    draft = stored(program["draft"])
    words = program_stage.words_of(visit, text, draft)
    return visit.page("annotate/review.html", program=program, text=text, draft=draft, words=words)


def judge(visit: Visit) -> Response:
    """Accept a program as it is, or return it with a note."""
    program, _ = _waiting(visit)
    verdict, note = visit.field("verdict", 10), visit.field("note", 1_000).strip()
    if verdict not in ("accept", "return"):
        raise WebError(Code.BAD_ARGUMENT, "verdict", "accept or return", verdict)
    if verdict == "return" and not note:
        raise WebError(Code.BAD_ARGUMENT, "note", "what the author should change", "nothing")
    _store(visit, program, verdict, note, program["version"], stored(program["draft"]))
    return visit.go("/annotate/review")


def mend_page(visit: Visit) -> Response:
    """Return the program with its blocks, for correction."""
    program, text = _waiting(visit)
    values: dict[str, Any] = {"base": f"/annotate/review/{program['id']}", "mode": "mend", "homes": trial_run.homes()}
    return visit.page("annotate/compose.html", text=text, closed=False, program=program, **values)


def work(visit: Visit) -> Response:
    """Return the program, the blocks and the things, for the page's scripts."""
    program, _ = _waiting(visit)
    return visit.answer(program_stage.work_of(visit, program, stored(program["draft"])))


def check(visit: Visit) -> Response:
    """Check the corrected steps; nothing is kept before they are accepted."""
    _, text, draft, message = _mended(visit)
    found = program_stage.check_of(visit, text, draft)
    return visit.answer({"version": int_field(message, "version", 1, 10**9), "found": found})


def try_out(visit: Visit) -> Response:
    """Run the corrected steps in a home."""
    _, text, draft, message = _mended(visit)
    return program_stage.ran(visit, text, message, draft)


def replay(visit: Visit) -> Response:
    """Return the same run in 3D."""
    _, text, draft, message = _mended(visit)
    return program_stage.ran(visit, text, message, draft, trial_run.replay_draft)


def mend(visit: Visit) -> Response:
    """Accept the corrected steps instead of the submitted ones."""
    program, text, draft, message = _mended(visit)
    if refused := program_stage.refusal(program_stage.check_of(visit, text, draft)):
        return visit.answer(refused, 400)
    _store(visit, program, "mend", "", int_field(message, "version", 1, 10**9), draft)
    return visit.answer({"go": "/annotate/review"})


def _mended(visit: Visit) -> tuple[Row, Row, Draft, dict[str, Any]]:
    program, text = _waiting(visit)
    message = visit.json()
    return program, text, program_stage.sent(visit, message, stored(program["draft"])), message


def _waiting(visit: Visit) -> tuple[Row, Row]:
    """Return another person's submitted program, and its description, for a person with invitation and test.

    Raises:
        WebError: NOT_ALLOWED or UNKNOWN_ID.
    """
    store = visit.web.store
    if not is_invited(store, visit.person):
        raise WebError(Code.NOT_ALLOWED, "review", "somebody whom the desk invited", "somebody whom it did not")
    if not is_qualified(store, visit.person):
        raise WebError(Code.NOT_ALLOWED, "review", "somebody who passed the test", "somebody who did not")
    query = sql.select(PROGRAMS).where(
        PROGRAMS.c.id == visit.part("program"), PROGRAMS.c.state == SUBMITTED, PROGRAMS.c.session != visit.person
    )
    program = store.row(query)
    if program is None:
        raise WebError(Code.UNKNOWN_ID, "program", "a submitted program of somebody else", visit.part("program")[:40])
    return program, annotated_programs.text_of(store, program["text"])


def _store(visit: Visit, program: Row, verdict: str, note: str, version: int, draft: Draft) -> None:
    """Store a verdict, unless another reviewer was faster; then write the accepted programs.

    Raises:
        WebError: LOCKED.
    """
    state = RETURNED if verdict == "return" else ACCEPTED
    row = {
        "id": secrets.token_hex(8),
        "session": visit.person,
        "program": program["id"],
        "verdict": verdict,
        "note": note,
        "before": program["draft"],
        "created": time.time(),
    }
    same = (PROGRAMS.c.id == program["id"], PROGRAMS.c.state == SUBMITTED, PROGRAMS.c.version == version)
    values = {"state": state, "note": note, "draft": draft.dumped(), "version": version + 1}

    def write(connection: sql.Connection) -> bool:
        if not connection.execute(sql.update(PROGRAMS).where(*same).values(values)).rowcount:
            return False
        connection.execute(sql.insert(REVIEWS).values(row))
        return True

    if not visit.web.store.write(write):
        raise WebError(Code.LOCKED, "program", "a program that waits", "another person reviewed it first")
    if state == ACCEPTED:
        write_collected(visit.web)
