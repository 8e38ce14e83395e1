"""The test that tasks can be done: an agent that sees everything does each of them alone."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Job, Known, played
from hearth.challenges.tasks import Task
from hearth.storage.parallel import Seen, spread, unseen


@dataclass(frozen=True, slots=True)
class Solved:
    """The result of a task.

    Attributes:
        task: its id.
        success: whether the goal was reached.
        ticks: that it took; 0 of a task that was done before it began.
    """

    task: str
    success: bool
    ticks: int

    @property
    def fault(self) -> str:
        """Return why the task is none; "" where it can be done."""
        if not self.ticks:
            return f"{self.task}: its goal is reached at the start"
        return "" if self.success else f"{self.task}: not done in {self.ticks} ticks by an agent that sees everything"


def solved(tasks: Sequence[Task], known: Known, workers: int = 1, seen: Seen = unseen) -> Iterator[Solved]:
    """Yield the oracle's episodes, in the order of the tasks.

    Args:
        tasks: which.
        known: gives the knowledge.
        workers: processes.
        seen: called with the number of tasks done.
    """
    alone = Lineup("oracle").checked()
    jobs = [Job(task, 0, alone, False, None, known) for task in tasks]
    for record in spread(played, jobs, workers, seen):
        yield Solved(record.task, bool(record.metrics["success"]), int(record.metrics["ticks"]))
