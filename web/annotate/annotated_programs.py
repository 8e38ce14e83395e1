"""Programs in the store: read by sessions that may see them, changed by a session that has read the last version."""

import secrets
import time

import sqlalchemy as sql

from hearth.schemas.failures import Code
from hearth.web.annotate.annotate_tables import ACCEPTED, DRAFT, PROGRAMS, RETURNED, SUBMITTED, TEXTS
from hearth.web.annotate.program_draft import Draft
from hearth.web.store import Row, Store
from hearth.web.web_errors import WebError

EMPTY = Draft({}, {}).dumped()
"""A draft in which nothing was set yet."""

CHANGED = (DRAFT, RETURNED)
"""States in which its author may change a program."""


def text_of(store: Store, text: str) -> Row:
    """Return a description by its id.

    Raises:
        WebError: UNKNOWN_ID.
    """
    query = sql.select(TEXTS).where(TEXTS.c.id == text)
    found = store.row(query)
    if found is None:
        raise WebError(Code.UNKNOWN_ID, "task", "a description of this server", text[:40])
    return found


def latest_text(store: Store, person: str) -> Row | None:
    """Return the description that a person handed in last; None if there is none."""
    query = sql.select(TEXTS).where(TEXTS.c.session == person).order_by(TEXTS.c.created.desc()).limit(1)
    return store.row(query)


def own_program(store: Store, person: str, text: str) -> Row | None:
    """Return the program that a person has begun for a description."""
    query = sql.select(PROGRAMS).where(PROGRAMS.c.session == person, PROGRAMS.c.text == text)
    return store.row(query)


def seen(store: Store, person: str, text: str) -> Row:
    """Return a person's program, or the empty one that it would begin with; nothing is stored for a look at it."""
    return own_program(store, person, text) or _empty(person, text)


def _empty(person: str, text: str) -> Row:
    """Return the program that a person begins with: an empty scene."""
    return {
        "id": f"P{secrets.token_hex(5).upper()}",
        "session": person,
        "text": text,
        "draft": EMPTY,
        "version": 1,
        "state": DRAFT,
        "note": "",
        "created": time.time(),
    }


def begin(store: Store, person: str, text: str) -> Row:
    """Return a person's program, stored with an empty scene if there is none: the person is about to change it."""
    found = own_program(store, person, text)
    if found is not None:
        return found
    row = _empty(person, text)
    try:
        store.write(lambda connection: connection.execute(sql.insert(PROGRAMS).values(row)))
    except sql.exc.IntegrityError:  # begun in another tab at this moment
        found = own_program(store, person, text)
        if found is None:
            text_of(store, text)  # it says so if the description was withdrawn at this moment
            raise
        return found
    return row


begun = begin
"""Its name in 0.2."""


def save(store: Store, person: str, text: str, version: int, draft: Draft, state: str | None = None) -> int:
    """Replace the last version of a person's own program, which the first change begins; the number of the new one.

    Raises:
        WebError: LOCKED, if another tab has saved since, or the program is with a reviewer.
    """
    if version == 1:
        begin(store, person, text)
    own = (PROGRAMS.c.session == person, PROGRAMS.c.text == text)
    values = {"draft": draft.dumped(), "version": version + 1, **({"state": state} if state else {})}
    query = sql.update(PROGRAMS).where(*own, PROGRAMS.c.version == version, PROGRAMS.c.state.in_(CHANGED))
    if not store.write(lambda connection: connection.execute(query.values(values)).rowcount):
        row = own_program(store, person, text)
        actual = f"version {version}, after {row['version']} ({row['state']})" if row else "no program"
        raise WebError(Code.LOCKED, "version", "the version that was saved last, in your hands", actual)
    return version + 1


def tasks(store: Store, person: str, most: int = 100) -> list[Row]:
    """Descriptions that a person may write a program for, with the state of the person's own and the number of others'.

    Those without any program come first, then the oldest.
    """
    mine = sql.and_(PROGRAMS.c.text == TEXTS.c.id, PROGRAMS.c.session == person)
    given = PROGRAMS.alias("given")
    of_others = (given.c.text == TEXTS.c.id, given.c.session != person, given.c.state != DRAFT)
    others = sql.select(sql.func.count()).select_from(given).where(*of_others).correlate(TEXTS).scalar_subquery()
    own_text = (TEXTS.c.session == person).label("mine")
    columns = (TEXTS.c.id, TEXTS.c.scene, TEXTS.c.title, PROGRAMS.c.state, PROGRAMS.c.note, own_text)
    query = (
        sql.select(*columns, others.label("others"))
        .select_from(TEXTS.outerjoin(PROGRAMS, mine))
        .order_by(PROGRAMS.c.state.is_(None), others, TEXTS.c.created)
        .limit(most)
    )
    return store.rows(query)


def submitted(store: Store, person: str, most: int = 100) -> list[Row]:
    """Programs of others that wait for a second person."""
    joined = PROGRAMS.join(TEXTS, PROGRAMS.c.text == TEXTS.c.id)
    query = (
        sql.select(PROGRAMS.c.id, TEXTS.c.title, TEXTS.c.scene)
        .select_from(joined)
        .where(PROGRAMS.c.state == SUBMITTED, PROGRAMS.c.session != person)
        .order_by(PROGRAMS.c.created)
        .limit(most)
    )
    return store.rows(query)


def accepted(store: Store, person: str = "") -> list[Row]:
    """Return accepted programs with their descriptions, oldest first; of all but one person."""
    joined = PROGRAMS.join(TEXTS, PROGRAMS.c.text == TEXTS.c.id)
    columns = (TEXTS.c.title, TEXTS.c.description, TEXTS.c.scene, TEXTS.c.session.label("writer"))
    query = (
        sql.select(PROGRAMS, *columns)
        .select_from(joined)
        .where(PROGRAMS.c.state == ACCEPTED, PROGRAMS.c.session != person)
        .order_by(PROGRAMS.c.created, PROGRAMS.c.id)
    )
    return store.rows(query)
