"""Household tasks as tasks of a challenge, which `challenge run`, `score`, `verify`, `build` and `export` take."""

from __future__ import annotations

from dataclasses import dataclass

from hearth.challenges.household import HouseholdTask, household_task
from hearth.challenges.household_definition import NAME, split_named
from hearth.challenges.instruction_reader import read_instruction
from hearth.challenges.instruction_writer import instruction
from hearth.challenges.tasks import Task
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.rng import derive
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

SEVERAL = "several"
"""Stands for the split of tasks of several splits."""


@dataclass(frozen=True)
class OpenTask(Task):
    """A household task as a task of a challenge: its family is its goal set, and it was demonstrated nowhere.

    Attributes:
        origin: the household task.
    """

    origin: HouseholdTask

    @property
    def instruction(self) -> str:
        """Return the task's own instruction."""
        return self.origin.instruction

    def worded(self, knowledge: Knowledge, number: int = 0, terse: bool | None = None) -> str:
        """Return the goal in English, in another wording of the split's pool."""
        pool, seed = split_named(self.split).words, derive(self.seed, "instruction", number)
        return instruction(self.goal, knowledge, seed, pool=pool, family=self.origin.family, terse=terse)

    def start(self, knowledge: Knowledge, agents: int | None = None) -> World:
        """Return the world in which it starts; equal every time, and with one agent."""
        return self.origin.start(knowledge)

    def read(self, text: str, knowledge: Knowledge) -> Goal:
        """Return the goal of an instruction; errors as of `read_instruction`."""
        return read_instruction(text, knowledge)

    def demonstration_start(self, knowledge: Knowledge) -> World:
        """Raise BAD_ARGUMENT: a household task has no other home in which it was demonstrated."""
        remedy = "`expert` of the task has instructions that reach the goal"
        raise HearthError.of(Code.BAD_ARGUMENT, f"{self.id} has no demonstration", suggestion=remedy)

    def goal_in(self, home: Home) -> Goal:
        """Return the goal, which names classes alone."""
        return self.goal

    @property
    def published(self) -> bool:
        """Return whether the task is the one that is made from its id; making it takes a second or two."""
        try:
            return household_task(self.id, knowledge=default()) == self.origin
        except HearthError:
            return False


def as_task(origin: HouseholdTask) -> OpenTask:
    """Return a household task as a task of a challenge."""
    return OpenTask(origin.id, NAME, origin.split, origin.home, "", (origin.family,), origin.goal, origin.seed, origin)


def split_of(tasks: tuple[Task, ...]) -> str:
    """Return the split of tasks, or `several`."""
    splits = {task.split for task in tasks}
    return splits.pop() if len(splits) == 1 else SEVERAL
