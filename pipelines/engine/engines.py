"""Engines spread a stage's partitions over processes or machines. Every engine gives the same bytes."""

from collections.abc import Callable, Iterator
from typing import Protocol, Self

from hearth.pipelines.engine.stage import Done, Job, Partition, RecordsSeen
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


class Engine(Protocol):
    """Runs partitions. A context manager: its processes end with it.

    Attributes:
        count: the number of partitions it runs at once.
    """

    count: int

    def __enter__(self) -> Self:
        """Get ready."""

    def __exit__(self, *error: object) -> None:
        """Stop the running partitions."""

    def run(self, job: Job, partitions: Iterator[Partition], seen: RecordsSeen) -> Iterator[Done]:
        """Run partitions, taking few more than run at once, and yield each with its counts when it is complete.

        Raises:
            HearthError: a partition could not be completed; complete parts are kept.
        """


def _local(count: int, scheduler: str) -> Engine:
    from hearth.pipelines.engine.workers import Workers

    return Workers(count)


def _dask(count: int, scheduler: str) -> Engine:
    from hearth.pipelines.engine.dask_engine import DaskEngine

    return DaskEngine(count, scheduler)


ENGINES: dict[str, Callable[[int, str], Engine]] = {"local": _local, "dask": _dask}
"""A function for each engine, of the number of processes and the scheduler's address, or ""."""


def engine(name: str, count: int = 1, scheduler: str = "") -> Engine:
    """Return the engine of that name.

    Args:
        name: one of `ENGINES`.
        count: processes, where the engine starts them.
        scheduler: address of a running cluster's scheduler; "" for a cluster of our own.

    Raises:
        HearthError: UNKNOWN_ID, the engine is unknown; CONTRADICTION, the local engine has no scheduler.
    """
    if name not in ENGINES:
        known = " and ".join(ENGINES)
        raise HearthError.of(Code.UNKNOWN_ID, f"unknown engine `{name}`", suggestion=f"there are {known}")
    if scheduler and name == "local":
        message = "the local engine has no scheduler"
        raise HearthError.of(Code.CONTRADICTION, message, suggestion="add --engine dask")
    return ENGINES[name](count, scheduler)
