"""Threads for handlers: apart from those that serve files, with a short queue and a time limit."""

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import copy_context
from typing import Any, TypeVar

from hearth.web import deadlines

T = TypeVar("T")

THREADS = 10
"""Handlers that run at once in a process."""

MOST_WAITING = 200
"""Requests and messages that wait for a thread; more are refused at once."""

WITHIN = 30.0
"""Seconds that a handler may take for a person."""

DESK_WITHIN = 300.0
"""Seconds that a handler may take for a researcher: reports and tables."""


class Threads:
    """A pool of threads.

    Args:
        threads: that run at once.
        waiting: calls that may wait for one.
    """

    def __init__(self, threads: int = THREADS, waiting: int = MOST_WAITING) -> None:
        self._pool = ThreadPoolExecutor(threads, "hearth-web")
        self._most, self._asked, self._lock = threads + waiting, 0, threading.Lock()

    async def run(self, work: Callable[..., T], *given: Any, within: float = WITHIN) -> T:
        """Return what a function returns that runs in a thread; it goes on there if it takes too long.

        Raises:
            HearthError: TIMED_OUT: no thread was free in time, or the function took too long; what it raises.
        """
        with self._lock:
            if self._asked >= self._most:
                raise deadlines.busy("the server")
            self._asked += 1
        future: Future[T] = self._pool.submit(copy_context().run, work, *given)
        future.add_done_callback(self._done)
        waited: asyncio.Future[T] = asyncio.wrap_future(future)
        for seconds in (deadlines.left(), within):
            done, _ = await asyncio.wait((waited,), timeout=seconds)
            if done:
                return waited.result()
            if future.cancel():  # it has not begun
                break
        raise deadlines.busy("the server")

    def _done(self, future: Future[Any]) -> None:
        with self._lock:
            self._asked -= 1


POOL = Threads()
"""The threads of this process."""

in_thread = POOL.run
"""Run a function in one of them."""
