"""The store of all data: one database, embedded (SQLite) or of many machines (PostgreSQL), one schema.

A write is one transaction, isolated from all others and on the disk when it returns: accepted data survives a kill.
"""

import contextlib
import random
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import sqlalchemy as sql
from sqlalchemy.exc import DBAPIError

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.files import SERVED
from hearth.web import deadlines
from hearth.web.store_faults import is_conflict, said
from hearth.web.web_tables import METADATA

T = TypeVar("T")

Row = dict[str, Any]
"""A row by the names of its columns."""

ERASURES = 100
"""Attempts, of `PATIENCE` each, to empty a log that readers need."""

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
            self._turn = deadlines.BoundedLock("the store")
        with usable(_shown(url), "the store can't be opened"):
            self.read(_check_schema)
            self.write(_make_tables)
            self.read(partial(_check_columns, _shown(url)))

    def read(self, work: Callable[[sql.Connection], T]) -> T:
        """Return the result of a function that reads one state of the store and changes nothing.

        Raises:
            HearthError: TIMED_OUT, UNWRITABLE or DAMAGED_FILE, as of `store_faults.said`.
        """
        with said(), self._begun(hearth_until=deadlines.wait_until()) as connection:
            return work(connection)

    def _begun(self, **options: Any) -> contextlib.AbstractContextManager[sql.Connection]:
        return _transaction(self.engine, options)

    def rows(self, query: sql.Select[Any]) -> list[Row]:
        """Return the rows of a query by the names of its columns."""
        return self.read(lambda connection: [dict(row) for row in connection.execute(query).mappings()])

    def row(self, query: sql.Select[Any]) -> Row | None:
        """Return the first row of a query, or None."""
        return next(iter(self.rows(query)), None)

    def scalar(self, query: sql.Select[Any]) -> Any:
        """Return the first value of the first row of a query, or None."""
        return self.read(lambda connection: connection.execute(query).scalar())

    def write(self, work: Callable[[sql.Connection], T]) -> T:
        """Run a function as one transaction, and return its result once the transaction is on the disk.

        It may run several times, until it conflicts with no other: it changes nothing but the store.

        Raises:
            HearthError: as of `read`.
        """
        until, attempt = deadlines.wait_until(), 0
        with said():
            while True:
                try:
                    with self._turn, self._begun(hearth_writes=True, hearth_until=until) as connection:
                        return work(connection)
                except DBAPIError as error:
                    attempt += 1
                    pause = random.uniform(0, 0.02 * min(attempt, 25))
                    if not is_conflict(error) or time.monotonic() + pause > until:
                        raise
                time.sleep(pause)

    def erase_traces(self) -> None:
        """Leave nothing of deleted rows in the store's files: now, or as soon as no reader needs them any more."""
        if not self._erased():
            threading.Thread(target=self._erase_later, daemon=True).start()

    def _erase_later(self) -> None:
        with contextlib.suppress(HearthError, DBAPIError):
            for _ in range(ERASURES):
                if self._erased():
                    return

    def _erased(self) -> bool:
        """Empty the write-ahead log of an embedded store; whether that is done.

        What is deleted is overwritten in the database itself (`secure_delete`); the write-ahead log still has it until
        it is emptied, which readers can delay.
        """
        if self.engine.dialect.name != "sqlite":
            return True
        until = deadlines.wait_until()
        while True:
            with said(), self._turn, self.engine.connect() as connection:
                held = connection.exec_driver_sql("PRAGMA wal_checkpoint(TRUNCATE)").scalar()
            if not held or time.monotonic() > until:
                return not held
            time.sleep(0.02)

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
    """Return the address of the embedded store of a folder, which is made."""
    private(out)
    return f"sqlite:///{embedded(out).resolve()}"


def embedded(out: Path) -> Path:
    """Return the file of a folder's embedded store, which may not be there."""
    return out / SERVED / "store.sqlite"


def private(out: Path) -> Path:
    """Return the folder within a server's own for its own files; `build` reads no hidden folder.

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
    engine = sql.create_engine(
        url, connect_args={"timeout": 1, "check_same_thread": False}, pool_size=30, pool_timeout=1.5,
        hide_parameters=True,
    )  # fmt: skip
    sql.event.listen(engine, "connect", _set_up_sqlite)
    sql.event.listen(engine, "begin", _begin_sqlite)
    return engine


_FORMS = "give sqlite:///FILE or postgresql://USER@HOST/NAME"


def _postgres(url: sql.URL) -> sql.Engine:
    try:
        engine = sql.create_engine(
            url, isolation_level="SERIALIZABLE", pool_pre_ping=True, pool_size=10, max_overflow=10, pool_timeout=1.5,
            connect_args=_POSTGRES, hide_parameters=True,
        )  # fmt: skip
    except ModuleNotFoundError as error:
        remedy = "pip install 'psycopg[binary]'"
        raise HearthError.of(Code.MISSING_FILE, "PostgreSQL needs psycopg", suggestion=remedy) from error
    sql.event.listen(engine, "begin", _begin_postgres)
    return engine


_POSTGRES = {
    "connect_timeout": 2,
    "tcp_user_timeout": 3_000,
    "options": "-c statement_timeout=30s -c idle_in_transaction_session_timeout=30s",
}
"""Time limits of PostgreSQL: its silence, a statement, and an idle transaction."""


def _shown(url: str) -> str:
    return sql.make_url(url).render_as_string(hide_password=True)


def _set_up_sqlite(connection: Any, record: object) -> None:
    """Readers do not wait for the writer; a commit is on the disk; rows of a session go with it."""
    connection.isolation_level = None  # SQLAlchemy begins transactions, not the driver
    # A file may be a stranger's: with `trusted_schema` off its schema calls no function that does anything.
    for pragma in ("trusted_schema = OFF", "journal_mode = WAL", "synchronous = FULL", "foreign_keys = ON",
                   "secure_delete = ON"):  # fmt: skip
        connection.execute(f"PRAGMA {pragma}")


def _wait(connection: sql.Connection) -> int:
    """Return the milliseconds that a transaction may wait for a lock."""
    until: float = connection.get_execution_options().get("hearth_until", 0.0)
    return max(50, round(1000 * (until - time.monotonic())))


def _begin_sqlite(connection: sql.Connection) -> None:
    """Let a writer take the lock at once, so that the data it has read still holds when it writes."""
    writes = connection.get_execution_options().get("hearth_writes")
    connection.exec_driver_sql(f"PRAGMA busy_timeout = {_wait(connection)}")
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def _begin_postgres(connection: sql.Connection) -> None:
    connection.exec_driver_sql(f"SET LOCAL lock_timeout = {_wait(connection)}")


@contextlib.contextmanager
def _transaction(engine: sql.Engine, options: dict[str, Any]) -> Iterator[sql.Connection]:
    with engine.connect().execution_options(**options) as connection, connection.begin():
        yield connection


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


def _check_columns(place: str, connection: sql.Connection) -> None:
    """Refuse a store whose tables lack columns, as those of another version or of somebody else do.

    Raises:
        HearthError: DAMAGED_FILE.
    """
    there = sql.inspect(connection)
    for table in METADATA.sorted_tables:
        lacking = {column.name for column in table.columns} - {each["name"] for each in there.get_columns(table.name)}
        if lacking:
            message = f"its table `{table.name}` lacks `{min(lacking)}`, which this version of Hearth keeps there"
            remedy = "name a store of this version, or another folder with --out"
            raise HearthError.of(Code.DAMAGED_FILE, message, file=place, suggestion=remedy)
