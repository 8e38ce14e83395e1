"""A time limit on the statements of a DuckDB connection."""

from __future__ import annotations

import math
import threading
from types import TracebackType
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

LONGEST = 31_536_000
"""Seconds of the longest limit: a year. Clocks of the system do not take every number."""

AGAIN = 0.05
"""Seconds between interrupts once the time is up: one that comes between two statements is lost."""


def checked_seconds(seconds: float | None) -> float | None:
    """Return a time limit that is one, or None.

    Raises:
        HearthError: BAD_ARGUMENT: it is not a number from 0 to `LONGEST`.
    """
    if seconds is None or (math.isfinite(seconds) and 0 <= seconds <= LONGEST):
        return seconds
    remedy = f"give seconds from 0 to {LONGEST:,} (a year); 0: no limit"
    raise HearthError.of(Code.BAD_ARGUMENT, f"`{seconds:g}` is not a time limit", suggestion=remedy)


class TimeLimit:
    """An interrupt of a connection that works longer than allowed; a context manager.

    Args:
        connection: a DuckDB connection.
        seconds: it may work so long; None or 0 for no limit.

    Raises:
        HearthError: BAD_ARGUMENT: as of `checked_seconds`.

    Attributes:
        over: whether the time is up.
    """

    def __init__(self, connection: Any, seconds: float | None) -> None:
        self.connection, self.seconds, self.over = connection, checked_seconds(seconds), False
        self._done = threading.Event()
        self._thread: threading.Thread | None = None

    def _interrupt(self) -> None:
        self.over = not self._done.wait(self.seconds)
        while not self._done.is_set():
            self.connection.interrupt()
            self._done.wait(AGAIN)

    def __enter__(self) -> TimeLimit:
        if self.seconds:
            self._thread = threading.Thread(target=self._interrupt, daemon=True)
            self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._done.set()
        if self._thread is not None:
            self._thread.join()
