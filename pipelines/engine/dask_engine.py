"""The dask engine: partitions as tasks of a cluster, started on this machine or already running.

The partitions of a lost worker are run again by another. All workers must see the same files: one machine, a shared
folder, or a dataset in a store (see `storage.remote_build_folders`).
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any

from hearth.pipelines.engine.stage import Done, Job, Partition, RecordsSeen
from hearth.pipelines.engine.workers import AHEAD, run_here
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.storage.partitions import Counts

LOSSES = 3
"""Workers that may die over one partition before the stage stops."""

_CONNECT_SECONDS = 10


class DaskEngine:
    """Partitions on a dask cluster."""

    def __init__(self, count: int = 1, scheduler: str = "") -> None:
        self.count = max(1, count)
        self._scheduler = scheduler
        self._cluster: Any = None
        self._client: Any = None

    def __enter__(self) -> DaskEngine:
        return self

    def __exit__(self, *error: object) -> None:
        for started in (self._client, self._cluster):
            if started is not None:
                started.close()
        self._client = self._cluster = None

    @property
    def client(self) -> Any:
        """Return the cluster's client; starts a cluster if none is running.

        Raises:
            HearthError: MISSING_FILE, dask is not installed; UNWRITABLE, the scheduler does not answer.
        """
        if self._client is None:
            self._client = self._connected()
        return self._client

    def _connected(self) -> Any:
        distributed = library("distributed")
        library("dask").config.set({"distributed.scheduler.allowed-failures": LOSSES})
        if self._scheduler:
            try:
                client = distributed.Client(self._scheduler, timeout=_CONNECT_SECONDS)
            except (OSError, ValueError) as error:
                message = f"no scheduler answers at {self._scheduler}: {error}"
                suggestion = "start one with `dask scheduler`, or leave --scheduler out for a cluster on this machine"
                raise HearthError.of(Code.MISSING_FILE, message, suggestion=suggestion) from None
            self.count = max(1, sum(client.nthreads().values()))
            return client
        self._cluster = distributed.LocalCluster(
            n_workers=self.count, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs="CRITICAL"
        )
        return distributed.Client(self._cluster)

    def run(self, job: Job, partitions: Iterator[Partition], seen: RecordsSeen) -> Iterator[Done]:
        """Run partitions and yield each with its counts, in the order of completion.

        Raises:
            HearthError: a partition killed several workers, or the cluster is gone; complete parts are kept.
        """
        client = self.client  # it says so where dask is not installed
        from distributed import as_completed
        from distributed.scheduler import KilledWorker

        running: dict[Any, Partition] = {}
        done = as_completed(loop=client.loop)
        try:
            for partition in itertools.islice(partitions, self.count * AHEAD):
                done.add(_submitted(client, job, partition, running))
            for future in done:
                partition = running.pop(future.key)
                counts: Counts = future.result()
                seen(counts.records_in, counts.rejected)
                yield partition, counts
                for following in itertools.islice(partitions, 1):
                    done.add(_submitted(client, job, following, running))
        except KilledWorker as error:
            raise HearthError.of(
                Code.CONFLICT,
                f"{LOSSES + 1} workers of stage `{job.stage.name}` died over one partition, perhaps for want of memory",
                file=str(job.folder),
                suggestion="run the same command again with more memory for each worker: complete parts are kept",
            ) from error


def _submitted(client: Any, job: Job, partition: Partition, running: dict[Any, Partition]) -> Any:
    future = client.submit(run_here, job, partition, pure=False)
    running[future.key] = partition
    return future
