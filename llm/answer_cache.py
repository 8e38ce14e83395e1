"""A SQLite file with every reply of a language model: nothing is asked twice, and tests replay without a server.

The file is also the ledger: tokens, seconds and tries of each reply, and failed tries by reason. Prompts and keys are
not in it; a prompt is known by its digest.
"""

from __future__ import annotations

import sqlite3
import threading
import time
from collections import Counter
from dataclasses import astuple, dataclass, fields, replace
from pathlib import Path
from typing import Any

from hearth.llm.replies import Reply
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

IN_MEMORY = ":memory:"
"""The file of a cache that nothing keeps."""

BUSY_SECONDS = 30.0
"""Time that a process waits for another that writes."""

FORMAT = 1
"""The version of the tables."""

_COLUMNS = [each.name for each in fields(Reply) if each.name != "kept"]

_TABLES = (
    f"CREATE TABLE IF NOT EXISTS answers (key TEXT PRIMARY KEY, model TEXT, {', '.join(_COLUMNS)}) WITHOUT ROWID",
    "CREATE TABLE IF NOT EXISTS failed_tries (model TEXT, reason TEXT, tries INTEGER, PRIMARY KEY (model, reason))",
    "CREATE TABLE IF NOT EXISTS obeyed (model TEXT, url TEXT, facts TEXT, PRIMARY KEY (model, url))",
    f"PRAGMA user_version = {FORMAT}",
)


@dataclass(frozen=True, slots=True)
class Spent:
    """The sums of a ledger.

    Attributes:
        replies: how many.
        tokens_in, tokens_out: of prompts and of replies.
        seconds: from requests to replies.
        tries: requests, failed ones included.
        failed: failed tries by reason.
    """

    replies: int = 0
    tokens_in: int = 0
    tokens_out: int = 0
    seconds: float = 0.0
    tries: int = 0
    failed: tuple[tuple[str, int], ...] = ()


class AnswerCache:
    """Replies by the digest of their requests.

    Args:
        file: the SQLite file; in memory where None.

    Raises:
        HearthError: DAMAGED_FILE: the file is something else; UNWRITABLE.
    """

    def __init__(self, file: Path | None = None) -> None:
        self.file = file
        self._lock = threading.Lock()
        try:
            if file is not None:
                file.parent.mkdir(parents=True, exist_ok=True)
            self._connection = sqlite3.connect(
                str(file or IN_MEMORY), BUSY_SECONDS, isolation_level=None, check_same_thread=False
            )
            if file is not None:
                self._share()
            self._make_tables()
        except sqlite3.DatabaseError as error:
            raise self._fault(error) from error

    def _share(self) -> None:
        """Let several processes write; SQLite does not wait by itself for another that is about to do the same."""
        until = time.monotonic() + BUSY_SECONDS
        while True:
            try:
                self._connection.execute("PRAGMA journal_mode = WAL")
                return
            except sqlite3.OperationalError:
                if time.monotonic() > until:
                    raise
                time.sleep(0.05)

    def _make_tables(self) -> None:
        """Make the tables, or find them; one process at a time, so that none sees half of them."""
        self._connection.execute("BEGIN IMMEDIATE")
        try:
            self._need_ours()
            for statement in _TABLES:
                self._connection.execute(statement)
        except sqlite3.DatabaseError:
            self._connection.execute("ROLLBACK")
            raise
        self._connection.execute("COMMIT")

    def _need_ours(self) -> None:
        (version,) = self._connection.execute("PRAGMA user_version").fetchone()
        (tables,) = self._connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if version != (FORMAT if tables else 0):
            raise sqlite3.DatabaseError("it is a database of something else")

    def _fault(self, error: sqlite3.Error) -> HearthError:
        code = Code.UNWRITABLE if isinstance(error, sqlite3.OperationalError) else Code.DAMAGED_FILE
        return HearthError.of(code, f"the cache of answers: {error}", file=str(self.file), suggestion="--cache FILE")

    def _run(self, statement: str, values: tuple[Any, ...] = ()) -> list[Any]:
        with self._lock:
            try:
                return self._connection.execute(statement, values).fetchall()
            except sqlite3.DatabaseError as error:
                raise self._fault(error) from error

    def get(self, key: str) -> Reply | None:
        """Return the reply that is kept; None where there is none."""
        rows = self._run(f"SELECT {', '.join(_COLUMNS)} FROM answers WHERE key = ?", (key,))
        if not rows:
            return None
        found = Reply(**dict(zip(_COLUMNS, rows[0], strict=True)))
        return replace(found, counted=bool(found.counted), cut=bool(found.cut), kept=True)

    def put(self, key: str, model: str, reply: Reply) -> None:
        """Keep a reply, for good once this returns."""
        values = (key, model, *astuple(replace(reply, kept=False))[: len(_COLUMNS)])
        self._run(f"INSERT OR IGNORE INTO answers VALUES ({', '.join('?' * len(values))})", values)

    def failed(self, model: str, reason: str) -> None:
        """Count a try that brought no reply."""
        add = "INSERT INTO failed_tries VALUES (?, ?, 1) ON CONFLICT DO UPDATE SET tries = tries + 1"
        self._run(add, (model, reason))

    def spent(self, model: str) -> Spent:
        """Return the sums of a model."""
        sums = "count(*), coalesce(sum(tokens_in), 0), coalesce(sum(tokens_out), 0), coalesce(sum(seconds), 0.0)"
        row = self._run(f"SELECT {sums} FROM answers WHERE model = ?", (model,))[0]
        failed = Counter(dict(self._run("SELECT reason, tries FROM failed_tries WHERE model = ?", (model,))))
        replies, tokens_in, tokens_out, seconds = row
        return Spent(replies, tokens_in, tokens_out, seconds, replies + failed.total(), tuple(sorted(failed.items())))

    def facts(self, model: str, url: str) -> str | None:
        """Return what a probe found about a server, as JSON; None where none was made."""
        rows = self._run("SELECT facts FROM obeyed WHERE model = ? AND url = ?", (model, url))
        return rows[0][0] if rows else None

    def put_facts(self, model: str, url: str, facts: str) -> None:
        """Keep what a probe found."""
        self._run("INSERT OR REPLACE INTO obeyed VALUES (?, ?, ?)", (model, url, facts))

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            self._connection.close()
