"""Partitions over processes: a bounded number in flight, progress by record, the same bytes for any number."""

from __future__ import annotations

import gc
import itertools
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

from hearth.pipelines.engine.stage import Done, Job, Partition, RecordsSeen, run_partition
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.manifest import read_manifest
from hearth.storage.parallel import begin, context, end, uninterrupted
from hearth.storage.partitions import Counts, part_path, rejects_path
from hearth.storage.remote_build_folders import store

AHEAD = 2
"""Partitions assigned to each process, so that the next is ready when the first is complete."""

_POLL_SECONDS = 0.2


class Workers:
    """Processes that stages share, started when a stage first has two partitions.

    Use it as a context manager, so that the processes end with the build.
    """

    def __init__(self, count: int = 1) -> None:
        self.count = max(1, count)
        self._pool: ProcessPoolExecutor | None = None
        self._seen: Any = None
        self._thresholds = gc.get_threshold()

    def __enter__(self) -> Workers:
        self._thresholds = gc.get_threshold()
        _collect_seldom()
        return self

    def __exit__(self, *error: object) -> None:
        if self._pool is not None and isinstance(error[1], KeyboardInterrupt):
            end(self._pool)
        self._stop()
        gc.set_threshold(*self._thresholds)
        gc.unfreeze()

    def run(self, job: Job, partitions: Iterator[Partition], seen: RecordsSeen) -> Iterator[Done]:
        """Run partitions and yield each with its counts, in the order of completion.

        Raises:
            HearthError: a worker died; complete parts are kept.
        """
        first = list(itertools.islice(partitions, 2))
        rest = itertools.chain(first, partitions)
        if self.count == 1 or len(first) < 2:
            yield from ((partition, _run(job, partition, seen)) for partition in rest)
        else:
            yield from self._pooled(job, rest, seen)

    def _pooled(self, job: Job, partitions: Iterator[Partition], seen: RecordsSeen) -> Iterator[Done]:
        try:
            yield from self._drive(job, partitions, seen)
        except BrokenProcessPool as error:
            self._stop()
            raise HearthError.of(
                Code.CONFLICT,
                f"a worker of stage `{job.stage.name}` was killed, perhaps for want of memory",
                file=str(job.folder),
                suggestion="run the same command again: complete parts are kept; fewer --workers need less memory",
            ) from error

    def _drive(self, job: Job, partitions: Iterator[Partition], seen: RecordsSeen) -> Iterator[Done]:
        pool = self._start()
        before = self._counted()
        running: dict[Future[Counts], Partition] = {}
        while True:
            for partition in itertools.islice(partitions, self.count * AHEAD - len(running)):
                with uninterrupted():
                    running[pool.submit(run_here, job, partition)] = partition
            if not running:
                return
            done, _ = wait(running, timeout=_POLL_SECONDS, return_when=FIRST_COMPLETED)
            now = self._counted()
            if now > before:
                seen(now[0] - before[0], now[1] - before[1])
                before = now
            for future in done:
                yield running.pop(future), future.result()

    def _start(self) -> ProcessPoolExecutor:
        if self._pool is None:
            here = context()
            self._seen = here.Array("q", 2)
            self._pool = ProcessPoolExecutor(self.count, here, _begin, (self._seen,))
        return self._pool

    def _stop(self) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)
            self._pool = None

    def _counted(self) -> tuple[int, int]:
        with self._seen.get_lock():
            return self._seen[0], self._seen[1]


_counters: Any = None
_job: Job | None = None


def _begin(counters: Any) -> None:
    global _counters  # noqa: PLW0603 - a worker's own state
    _counters = counters
    begin()


def _collect_seldom() -> None:
    """Rows and worlds hold few cycles; collecting them took a fifth of the time."""
    gc.freeze()
    gc.set_threshold(50_000, 20, 100)


def run_here(job: Job, partition: Partition) -> Counts:
    """Run a partition in a worker; partitions of one job share its context."""
    global _job  # noqa: PLW0603 - a worker's own state
    if _job is None:
        _collect_seldom()
    if _job is None or (_job.key, _job.settings) != (job.key, job.settings):
        _job = job
    return _run(_job, partition, _count)


def _run(job: Job, partition: Partition, seen: RecordsSeen) -> Counts:
    """Run a partition; if the build is in a store, fetch its input from there and push its parts."""
    if not job.settings.store:
        return run_partition(job, partition, seen)
    remote = store(job.settings.store)
    remote.attend(job.settings.revision)
    for path in _needed(job, partition):
        remote.fetch(path)
    counts = run_partition(job, partition, seen)
    rejects = rejects_path(job.folder, partition.number)
    parts = [part_path(job.folder, table, partition.number) for table in job.stage.tables]
    remote.push([*([rejects] if rejects.exists() else []), *parts])
    return counts


def _needed(job: Job, partition: Partition) -> list[Path]:
    """Return the parts that a partition reads: those of its payload, or all if the stage defines its own partitions."""
    if job.stage.partitions is None:
        return [Path(path) for path in partition.payload]
    manifests = [read_manifest(job.settings.folder(name)) for name in job.stage.reads]
    return [found.folder / file for found in manifests if found for part in found.parts for file in part["files"]]


def _count(records: int, rejects: int) -> None:
    if _counters is not None:
        with _counters.get_lock():
            _counters[0] += records
            _counters[1] += rejects
