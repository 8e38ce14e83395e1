"""Many household tasks at once: drawn in several processes, and tried by agents."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from hearth.challenges.episodes import Known
from hearth.challenges.household import HouseholdTask, household_ids, household_task, solve
from hearth.storage.parallel import Seen, spread, unseen


class Drawing(NamedTuple):
    """Tasks of a split.

    Attributes:
        tasks: in the order of their ids.
        rejected: the draws that gave no task, by reason.
    """

    tasks: tuple[HouseholdTask, ...]
    rejected: Counter[str]


class Attempt(NamedTuple):
    """An episode of the human-like agent, which sees only the room it is in.

    Attributes:
        task: the task.
        success: whether it reached the goal in time.
        ticks: that it took.
    """

    task: HouseholdTask
    success: bool
    ticks: int


class _Job(NamedTuple):
    task_id: str
    known: Known


class _Try(NamedTuple):
    task: HouseholdTask
    known: Known


def drawn_tasks(
    split: str, limit: int | None, seed: int, known: Known, workers: int = 1, seen: Seen = unseen
) -> Drawing:
    """Return the tasks of a split; the same for any number of processes.

    Args:
        split, limit, seed: see `household_tasks`.
        known: gives the knowledge.
        workers: processes.
        seen: called with the number of tasks done.
    """
    jobs = [_Job(task_id, known) for task_id in household_ids(split, limit, seed)]
    tasks, rejected = [], Counter[str]()
    for task, counts in spread(_draw, jobs, workers, seen):
        tasks.append(task)
        rejected += counts
    return Drawing(tuple(tasks), rejected)


def attempts(tasks: Sequence[HouseholdTask], known: Known, workers: int = 1, seen: Seen = unseen) -> Iterator[Attempt]:
    """Yield the episodes of the human-like agent, in the order of the tasks."""
    yield from spread(_attempt, [_Try(task, known) for task in tasks], workers, seen)


def _draw(job: _Job) -> tuple[HouseholdTask, Counter[str]]:
    rejected = Counter[str]()
    return household_task(job.task_id, rejected, job.known()), rejected


def _attempt(job: _Try) -> Attempt:
    knowledge = job.known()
    done = solve(job.task.start(knowledge), job.task.goal, job.task.seed, knowledge)
    return Attempt(job.task, done.success, done.ticks)
