"""Longest waits of a request: for a thread, for a lock of this process, for the store. A busy server says so soon."""

import math
import threading
import time
from contextvars import ContextVar
from types import TracebackType

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

WAITS = 1.5
"""Seconds that a request or message waits for locks of others, in all."""

ACTS = 4.0
"""Seconds that a decision in a game waits: a person would rather wait than decide again."""

OPENS = 8.0
"""Seconds that a socket waits while it opens: a class of people opens its games, which takes work, at one moment."""

LEAST = 0.3
"""Seconds that it waits at each place, however long it has worked before."""

PATIENCE = 20.0
"""Seconds that programs wait, which nobody watches: the start of a server, exports."""

_UNTIL: ContextVar[float] = ContextVar("until", default=math.inf)


def begin(seconds: float = WAITS) -> None:
    """Let the time of a request or message begin, in its task and in the threads that work for it."""
    _UNTIL.set(time.monotonic() + seconds)


def wait_until() -> float:
    """Return the time, of `time.monotonic`, until which whoever runs here may wait."""
    now, until = time.monotonic(), _UNTIL.get()
    return now + PATIENCE if until == math.inf else max(until, now + LEAST)


def left() -> float:
    """Return the seconds that whoever runs here may wait."""
    return wait_until() - time.monotonic()


def busy(what: str) -> HearthError:
    """Return the refusal of a request that others keep from its turn."""
    return HearthError.of(Code.TIMED_OUT, f"{what} is busy", suggestion="try again in a moment")


class BoundedLock:
    """A lock that its holder may take again, and for which nobody waits longer than a request may.

    Args:
        what: names it in the refusal.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._lock = threading.RLock()

    def __enter__(self) -> None:
        if not self._lock.acquire(timeout=left()):
            raise busy(self._what)

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._lock.release()
