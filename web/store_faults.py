"""Refusals of the database: in words that name no value of anybody, and as codes that handlers and people know."""

import contextlib
from collections.abc import Iterator

import sqlalchemy as sql
from sqlalchemy.exc import DBAPIError, IntegrityError

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.web.deadlines import busy

CONFLICTS = ("40001", "40P01")
"""PostgreSQL's states of a transaction that is to be tried again."""

WAITED = ("55P03", "57014", "53300", "57P03")
"""Its states of a statement that waited too long, and of a server that takes nobody."""

FULL = ("53100", "53200", "database or disk is full", "disk I/O error", "readonly database")
LACKING = ("42703", "42P01", "no such column", "no such table", "has no column named")
"""States of PostgreSQL and words of SQLite."""


def is_conflict(error: DBAPIError) -> bool:
    """Return whether a transaction failed for another alone, and may be tried again."""
    return _state(error) in CONFLICTS or "database is locked" in str(error.orig)


@contextlib.contextmanager
def said() -> Iterator[None]:
    """Say why the database refuses, where strangers or a full disk can be the reason.

    Raises:
        HearthError: TIMED_OUT: it is busy; UNWRITABLE: its disk is full; DAMAGED_FILE: a table or column is lacking.
        DBAPIError: any other fault; its text has no values.
    """
    try:
        yield
    except sql.exc.TimeoutError:  # no connection was free
        raise busy("the store") from None
    except IntegrityError:
        raise
    except DBAPIError as error:
        found = _in_words(error)
        if found is None:
            raise
        raise found from None


def _state(error: DBAPIError) -> str:
    return getattr(error.orig, "sqlstate", None) or ""


def _in_words(error: DBAPIError) -> HearthError | None:
    words, state = str(error.orig), _state(error)

    def is_one_of(reasons: tuple[str, ...]) -> bool:
        return any(state == each or (not state and each in words) for each in reasons)

    if is_conflict(error) or is_one_of(WAITED):
        return busy("the store")
    if is_one_of(FULL):
        message, remedy = "the store can't be written: its disk is full, or fails", "make room on the server's disk"
        return HearthError.of(Code.UNWRITABLE, message, suggestion=remedy)
    if is_one_of(LACKING):
        message = "the store lacks a table or a column that this version of Hearth keeps"
        return HearthError.of(Code.DAMAGED_FILE, message, suggestion="start the server again, which names it")
    return None
