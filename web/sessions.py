"""Sessions: each person's own, found by an unguessable token of which the store has a digest alone.

A session has no end of its own: it stays until its person deletes it. Connections have one (see `connections`).
"""

import hashlib
import secrets
import time
from collections.abc import Iterable
from typing import Any, NamedTuple, Protocol

import sqlalchemy as sql

from hearth.schemas.failures import Code
from hearth.web.store import Store
from hearth.web.web_errors import WebError
from hearth.web.web_tables import SESSIONS

COOKIE = "hearth"
"""The cookie with the token, which scripts can't read."""


class Session(NamedTuple):
    """A person at work.

    Attributes:
        id: names the session in the store and to researchers.
        token: the secret that came with the request.
    """

    id: str
    token: str


def digest(token: str) -> str:
    """Return the store's record of a token."""
    return hashlib.sha256(token.encode("utf-8", "surrogatepass")).hexdigest()


def start(store: Store) -> Session:
    """Return a new session, stored."""
    made = Session(secrets.token_hex(8), secrets.token_urlsafe(32))
    row = {"id": made.id, "token": digest(made.token), "created": time.time()}
    store.write(lambda connection: connection.execute(sql.insert(SESSIONS).values(row)))
    return made


def find(store: Store, token: str) -> Session | None:
    """Return the session of a token, or None."""
    if not token or len(token) > 100:
        return None
    query = sql.select(SESSIONS.c.id).where(SESSIONS.c.token == digest(token))
    found = store.scalar(query)
    return Session(found, token) if found else None


class Keeps(Protocol):
    """A room's function that gives rows on which others built to another owner, and says how many."""

    def __call__(self, connection: sql.Connection, person: str, nobody: str) -> int:
        """Give rows of a person to `nobody`."""


def forget(store: Store, session: str) -> None:
    """Delete a session and, with it, all rows of all rooms that belong to it, whoever built on them."""
    query = sql.delete(SESSIONS).where(SESSIONS.c.id == session)
    store.write(lambda connection: connection.execute(query))
    store.erase_traces()


def nobody() -> dict[str, Any]:
    """Return the row of a new session that no token opens, for rows on which others built."""
    return {"id": secrets.token_hex(8), "token": digest(secrets.token_urlsafe(32)), "created": 0.0}


def withdraw(store: Store, session: str, keeps: Iterable[Keeps]) -> None:
    """Delete a session with all that belongs to it, but for that on which other people built.

    What is kept belongs to a session of nobody from then on: a random id that no token opens, another for each
    withdrawal, and without a time.
    """
    row = nobody()

    def work(connection: sql.Connection) -> None:
        connection.execute(sql.insert(SESSIONS).values(row))
        kept = sum([keep(connection, session, row["id"]) for keep in keeps])
        gone = [session] if kept else [session, row["id"]]
        connection.execute(sql.delete(SESSIONS).where(SESSIONS.c.id.in_(gone)))

    store.write(work)
    store.erase_traces()


def take_tab(store: Store, session: str, tab: str) -> None:
    """Make a tab the only one of a session that may act; an older tab is refused from then on."""
    query = sql.update(SESSIONS).where(SESSIONS.c.id == session).values(tab=tab)
    store.write(lambda connection: connection.execute(query))


def check_tab(connection: sql.Connection, session: str, tab: str) -> None:
    """Refuse a tab that is not the one that may act; called within the transaction of its action.

    Raises:
        WebError: LOCKED.
    """
    found = connection.execute(sql.select(SESSIONS.c.tab).where(SESSIONS.c.id == session)).scalar()
    if found != tab:
        raise WebError(Code.LOCKED, "tab", "the tab of this session that was opened last", "an older tab")
