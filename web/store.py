"""The store of all data: one database, embedded (SQLite) or of many machines (PostgreSQL), one schema.

A write is one transaction, isolated from all others and on the disk when it returns: accepted data survives a kill.
"""

from __future__ import annotations

import contextlib
import random
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import sqlalchemy as sql
from sqlalchemy.exc import DBAPIError

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import SERVED
from hearth.web.web_tables import METADATA

T = TypeVar("T")

Row = dict[str, Any]
"""A row by the names of its columns."""

TRIES = 40
"""Attempts of a transaction that conflicts with another, about ten seconds in all."""

SETTING_UP = 7_264_311
"""The number of PostgreSQL's lock that one process holds while it makes the tables."""


class Store:
    """The database that the server's processes share.

    Args:
        url: `sqlite:///FILE`, `postgresql://USER@HOST/NAME`, or another form of these two that SQLAlchemy knows.

    Raises:
        HearthError: MISSING_FILE, if the database can't be reached; UNSUPPORTED_FILE, if it is of another kind;
            DAMAGED_FILE, if statements of its own would run with ours.
    """

    def __init__(self, url: str) -> None:
        self.engine = _engine(url)
        # SQLite lets one thread write. A thread that waits here is woken at once; SQLite itself would only retry later.
        self._turn: contextlib.AbstractContextManager[Any] = contextlib.nullcontext()
        if self.engine.dialect.name == "sqlite":
            self._turn = threading.Lock()
        with usable(_shown(url), "the store can't be opened"):
            self.read(_check_schema)
            self.write(_make_tables)

    def read(self, work: Callable[[sql.Connection], T]) -> T:
        """Return the result of a function that reads one state of the store and changes nothing."""
        with self.engine.connect() as connection, connection.begin():
            return work(connection)

    def rows(self, query: sql.Select[Any]) -> list[Row]:
        """The rows of a query by the names of its columns."""
        return self.read(lambda connection: [dict(row) for row in connection.execute(query).mappings()])

    def row(self, query: sql.Select[Any]) -> Row | None:
        """The first row of a query, or None."""
        return next(iter(self.rows(query)), None)

    def scalar(self, query: sql.Select[Any]) -> Any:
        """The first value of the first row of a query, or None."""
        return self.read(lambda connection: connection.execute(query).scalar())

    def write(self, work: Callable[[sql.Connection], T]) -> T:
        """Run a function as one transaction, and return its result once the transaction is on the disk.

        It may run several times, until it conflicts with no other: it changes nothing but the store.
        """
        for attempt in range(TRIES):
            try:
                with (
                    self._turn,
                    self.engine.connect().execution_options(hearth_writes=True) as connection,
                    connection.begin(),
                ):
                    return work(connection)
            except DBAPIError as error:
                if attempt == TRIES - 1 or not _is_conflict(error):
                    raise
                time.sleep(random.uniform(0, 0.02 * min(attempt + 1, 25)))
        raise AssertionError

    def close(self) -> None:
        """Close the connections."""
        self.engine.dispose()


@contextlib.contextmanager
def usable(place: str, message: str) -> Iterator[None]:
    """Give the reason why the database refuses a store that a user gave.

    Raises:
        HearthError: MISSING_FILE.
    """
    try:
        yield
    except DBAPIError as error:
        what = str(error.orig).strip().partition("\n")[0]
        raise HearthError.of(Code.MISSING_FILE, f"{message}: {what}", file=place) from error


def default_url(out: Path) -> str:
    """The address of the embedded store of a folder, which is made."""
    private(out)
    return f"sqlite:///{embedded(out).resolve()}"


def embedded(out: Path) -> Path:
    """The file of a folder's embedded store, which may not be there."""
    return out / SERVED / "store.sqlite"


def private(out: Path) -> Path:
    """The folder within a server's own for its own files; `build` reads no hidden folder.

    Raises:
        HearthError: BAD_ARGUMENT: it is a link, which would lead the server's files elsewhere.
    """
    folder = out / SERVED
    if folder.is_symlink():
        remedy = "remove the link, or name another folder with --out"
        raise HearthError.of(Code.BAD_ARGUMENT, "`.server` is a link", file=str(folder), suggestion=remedy)
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    return folder


def _engine(given: str) -> sql.Engine:
    try:
        url = sql.make_url(given)
    except sql.exc.ArgumentError as error:
        raise HearthError.of(Code.BAD_ARGUMENT, "not the address of a store", suggestion=_FORMS) from error
    if url.drivername in ("postgresql", "postgres"):
        url = url.set(drivername="postgresql+psycopg")
    if url.get_backend_name() == "postgresql":
        return _postgres(url)
    if url.get_backend_name() != "sqlite":
        kind = url.get_backend_name()
        raise HearthError.of(Code.UNSUPPORTED_FILE, f"a store can't be {kind}", suggestion=_FORMS)
    engine = sql.create_engine(url, connect_args={"timeout": 20, "check_same_thread": False}, pool_size=20)
    sql.event.listen(engine, "connect", _set_up_sqlite)
    sql.event.listen(engine, "begin", _begin_sqlite)
    return engine


_FORMS = "give sqlite:///FILE or postgresql://USER@HOST/NAME"


def _postgres(url: sql.URL) -> sql.Engine:
    try:
        return sql.create_engine(url, isolation_level="SERIALIZABLE", pool_pre_ping=True, pool_size=10)
    except ModuleNotFoundError as error:
        remedy = "pip install 'psycopg[binary]'"
        raise HearthError.of(Code.MISSING_FILE, "PostgreSQL needs psycopg", suggestion=remedy) from error


def _shown(url: str) -> str:
    return sql.make_url(url).render_as_string(hide_password=True)


def _set_up_sqlite(connection: Any, record: object) -> None:
    """Readers do not wait for the writer; a commit is on the disk; rows of a session go with it."""
    connection.isolation_level = None  # SQLAlchemy begins transactions, not the driver
    # A file may be a stranger's: with `trusted_schema` off its schema calls no function that does anything.
    for pragma in ("trusted_schema = OFF", "journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON"):
        connection.execute(f"PRAGMA {pragma}")


def _begin_sqlite(connection: sql.Connection) -> None:
    """Let a writer take the lock at once, so that the data it has read still holds when it writes."""
    writes = connection.get_execution_options().get("hearth_writes")
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def _is_conflict(error: DBAPIError) -> bool:
    state = getattr(error.orig, "sqlstate", None)
    return state in ("40001", "40P01") or "database is locked" in str(error.orig)


def _check_schema(connection: sql.Connection) -> None:
    """Refuse views, which could stand for our tables and never end, and triggers, which follow our changes."""
    if connection.dialect.name == "sqlite":
        query = "SELECT type, name FROM sqlite_master WHERE type IN ('view', 'trigger')"
        for kind, name in connection.exec_driver_sql(query):
            message = f"it has a {kind} `{str(name)[:60]}`, and stores of ours have none"
            raise HearthError.of(Code.DAMAGED_FILE, message, suggestion="name a folder that `serve` keeps its store in")


def _make_tables(connection: sql.Connection) -> None:
    """Make the tables that lack; several processes may start at once."""
    if connection.dialect.name == "postgresql":
        connection.execute(sql.select(sql.func.pg_advisory_xact_lock(SETTING_UP)))
    METADATA.create_all(connection)
