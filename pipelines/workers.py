"""Partitions over processes: a bounded window in flight, progress as records go by, the same bytes for any number."""

from __future__ import annotations

import itertools
import multiprocessing
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from hearth.pipelines.parts import Counts
from hearth.pipelines.stage import Job, Partition, run_partition
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

Seen = Callable[[int, int], None]
Done = tuple[Partition, Counts]

_AHEAD = 2
_POLL_SECONDS = 0.2

_job: Job | None = None
_seen: Any = None


def run_all(job: Job, partitions: Iterator[Partition], workers: int, seen: Seen) -> Iterator[Done]:
    """Run partitions and yield each with its counts, in the order of completion.

    Raises:
        HearthError: a worker died; what was complete is kept.
    """
    first = list(itertools.islice(partitions, 2))
    rest = itertools.chain(first, partitions)
    if workers <= 1 or len(first) < 2:
        yield from ((partition, run_partition(job, partition, seen)) for partition in rest)
    else:
        yield from _pooled(job, rest, workers, seen)


def _pooled(job: Job, partitions: Iterator[Partition], workers: int, seen: Seen) -> Iterator[Done]:
    method = "forkserver" if sys.platform == "linux" else "spawn"
    context = multiprocessing.get_context(method)
    told = _Told(context.Array("q", 2), seen)
    pool = ProcessPoolExecutor(workers, context, _start, (job, told.array))
    try:
        yield from _drive(pool, partitions, workers * _AHEAD, told)
    except BrokenProcessPool as error:
        raise HearthError.of(
            Code.CONFLICT,
            f"a worker of stage `{job.stage.name}` was killed, perhaps for want of memory",
            file=str(job.folder),
            suggestion="run the same command again: complete partitions are kept; fewer --workers need less memory",
        ) from error
    finally:
        pool.shutdown(cancel_futures=True)


def _drive(pool: ProcessPoolExecutor, partitions: Iterator[Partition], window: int, told: _Told) -> Iterator[Done]:
    running: dict[Future[Counts], Partition] = {}
    while True:
        for partition in itertools.islice(partitions, window - len(running)):
            running[pool.submit(_run, partition)] = partition
        if not running:
            return
        done, _ = wait(running, timeout=_POLL_SECONDS, return_when=FIRST_COMPLETED)
        told.tell()
        for future in done:
            yield running.pop(future), future.result()


class _Told:
    """Two counters shared with the workers, and how much of them was passed on."""

    def __init__(self, array: Any, seen: Seen) -> None:
        self.array, self._seen = array, seen
        self._records = self._rejects = 0

    def tell(self) -> None:
        with self.array.get_lock():
            records, rejects = self.array[0], self.array[1]
        if records > self._records:
            self._seen(records - self._records, rejects - self._rejects)
            self._records, self._rejects = records, rejects


def _start(job: Job, array: Any) -> None:
    global _job, _seen
    _job, _seen = job, array


def _run(partition: Partition) -> Counts:
    assert _job is not None
    return run_partition(_job, partition, _count)


def _count(records: int, rejects: int) -> None:
    with _seen.get_lock():
        _seen[0] += records
        _seen[1] += rejects
