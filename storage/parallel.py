"""A function over many jobs in several processes, where nothing is written and no order of completion matters."""

import multiprocessing
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sized
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from itertools import chain, islice
from multiprocessing import connection, forkserver, resource_tracker
from multiprocessing.context import BaseContext
from typing import Any, TypeVar

Job = TypeVar("Job")
Result = TypeVar("Result")


def context() -> BaseContext:
    """Return how processes are started: never by forking a process that may hold threads or locks.

    An interrupt at the keyboard waits until a worker has started (`begin`): before, it would print where it was.
    """
    if sys.platform != "linux":
        return multiprocessing.get_context("spawn")
    resource_tracker.ensure_running()  # it unblocks signals itself
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        forkserver.ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return multiprocessing.get_context("forkserver")


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Hold signals to stop until workers are started: nobody knows yet of one that is half started."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[int] = []
    before = {
        number: signal.signal(number, lambda number, frame: waiting.append(number))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler or signal.SIG_DFL)
        for stopped in waiting:  # an error, too: the same interrupt may have ended the workers
            signal.raise_signal(stopped)


def end(pool: ProcessPoolExecutor) -> None:
    """Stop the workers: their build was stopped, and they need not have had the signal."""
    for process in list((pool._processes or {}).values()):
        process.terminate()


def begin() -> None:
    """Let a worker end with its build.

    When the build is stopped at the keyboard, the worker ends without a word, since the build itself prints the remedy.
    When the build is killed, the worker ends at once. Where a shell has started the build with `&`, both ignore the
    keyboard.
    """
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    if sys.platform != "win32":
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    threading.Thread(target=_end_with_parent, daemon=True).start()


def begin_apart() -> None:
    """Let a worker that runs code of others end with its run, in a session of its own.

    Signals that such code sends to its group reach nobody else.
    """
    begin()
    if sys.platform != "win32":
        os.setsid()


def _end_with_parent() -> None:
    """Workers wait for work on a pipe that each of them holds open: without this they would wait for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


Seen = Callable[[int, int | None], None]
"""Reports progress: items done and, if known, the total."""


def unseen(done: int, total: int | None) -> None:
    """Reports nothing."""


AHEAD = 8
"""Jobs of each worker that are given out before their results are asked for."""


def spread(
    function: Callable[[Job], Result], jobs: Iterable[Job], workers: int, seen: Seen = unseen, apart: bool = False
) -> Iterator[Result]:
    """Yield the results in the order of the jobs, for any number of workers.

    Args:
        function: of a module, so that other processes find it.
        jobs: its arguments, one after the other; only a few more are taken than results are asked for.
        workers: processes; below 2, or for a single job, all is done in this one.
        seen: called with the number of jobs done.
        apart: whether nothing is done in this process, not even a single job: a job may end its process.

    Raises:
        BrokenProcessPool: a job ended its process.
    """
    total = len(jobs) if isinstance(jobs, Sized) else None
    for done, result in enumerate(_results(function, jobs, workers, apart), 1):
        seen(done, total)
        yield result


def _results(function: Callable[[Job], Result], jobs: Iterable[Job], workers: int, apart: bool) -> Iterator[Result]:
    waiting, workers = iter(jobs), max(workers, 1)
    first = list(islice(waiting, max(workers, 2)))
    if not first or (not apart and (workers < 2 or len(first) < 2)):
        yield from map(function, chain(first, waiting))
        return
    with ProcessPoolExecutor(min(workers, len(first)), context(), begin_apart if apart else begin) as pool:
        given: deque[Future[Result]] = deque()
        try:
            for job in chain(first, waiting):
                with uninterrupted():  # it may start a worker
                    given.append(pool.submit(function, job))
                if len(given) >= AHEAD * workers:
                    yield given.popleft().result()
            while given:
                yield given.popleft().result()
        except KeyboardInterrupt:
            end(pool)
            raise
        finally:
            for each in given:
                each.cancel()
            if apart:
                _leave(pool)


LEAVES = 3.0
"""Seconds that workers which run code of others have to end once there is no more to do."""


def _leave(pool: ProcessPoolExecutor) -> None:
    """End the workers, those too that threads, programs or finalizers of others keep from ending."""
    workers = list((pool._processes or {}).values())
    manager: Any = pool._executor_manager_thread
    pool.shutdown(wait=False)
    left: dict[Any, Any] = {each.sentinel: each for each in workers}
    until = time.monotonic() + LEAVES
    while left and (ended := connection.wait(list(left), max(0.0, until - time.monotonic()))):
        for each in ended:
            del left[each]
    for worker in left.values():
        worker.kill()
    if manager is not None:  # at the end of the process, Python wakes it through a pipe that it may just be closing
        manager.join(LEAVES)
