"""Tasks: the places of the agents, the main agent's goal, and the home of a demonstration of it."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random

from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.instruction_reader import read_instruction
from hearth.challenges.instruction_writer import TEST, TRAIN, instruction
from hearth.challenges.start_worlds import start
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT
from hearth.schemas.rng import derive, rng
from hearth.simulation.rules import Rules
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

MAIN = f"{AGENT}:0"
"""The agent of goals that is asked to do them."""


@dataclass(frozen=True)
class Task:
    """Something to do in a home.

    Attributes:
        id: unique among the tasks of a challenge.
        challenge: its name.
        split: which tasks it is one of.
        home: where it is done.
        demonstration_home: where it was seen done; another home.
        sets: names of the goal sets that the goal is of.
        goal: in the words of the grammar; `goal_in` names the furniture of a home.
        seed: of the start, and of all that is derived from it.
    """

    id: str
    challenge: str
    split: str
    home: str
    demonstration_home: str
    sets: tuple[str, ...]
    goal: Goal
    seed: int

    @property
    def family(self) -> str:
        """Return the names of its goal sets, joined."""
        return "+".join(self.sets)

    @property
    def rules(self) -> Rules:
        """Return how actions are read in its challenge."""
        return challenge(self.challenge).rules

    @property
    def instruction(self) -> str:
        """Return the goal in English, by our knowledge; equal every time."""
        return self.worded(default())

    def worded(self, knowledge: Knowledge, number: int = 0, terse: bool | None = None) -> str:
        """Return the goal in English, in the task's own wording or another; tests have wordings of their own.

        Args:
            knowledge: has the nouns of classes.
            number: which wording.
            terse: whether the wording is terse; drawn where None.
        """
        pool = TRAIN if self.split.startswith(TRAIN) else TEST
        seed = derive(self.seed, "instruction", number)
        return instruction(self.goal, knowledge, seed, pool=pool, doer=MAIN, terse=terse)

    def start(self, knowledge: Knowledge, agents: int | None = None) -> World:
        """Return the world in which it starts, with the first of its characters or all; equal every time."""
        return start(challenge(self.challenge), self.goal, self.home, self.seed, knowledge, agents)

    def read(self, text: str, knowledge: Knowledge) -> Goal:
        """Return the goal of an instruction in the words of the grammar; errors as of `read_instruction`."""
        return read_instruction(text, knowledge, MAIN, challenge(self.challenge).grammar.names)

    def demonstration_start(self, knowledge: Knowledge) -> World:
        """Return the world in which its demonstration starts: one character is there."""
        seed = derive(self.seed, "demonstration")
        return start(challenge(self.challenge), self.goal, self.demonstration_home, seed, knowledge, 1)

    def goal_in(self, home: Home) -> Goal:
        """Return the goal with the instances of furniture of a home."""
        return challenge(self.challenge).grammar.in_home(self.goal, home)


def task(name: str = "wah", split: str = "train", number: int = 0, seed: int = 0, goal: str = "") -> Task:
    """Return a task of a kind, drawn for itself: to try agents with. The published tasks are those of
    `published_tasks`.

    Args:
        name: of the challenge.
        split: whose homes it is in.
        number, seed: which of all such tasks.
        goal: as text; drawn where empty.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such challenge or split; every fault of the goal.
    """
    which = challenge(name)
    chooser = rng(seed, "task", name, split, number)
    if split not in which.splits:
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no split `{split[:40]}`", suggestion=", ".join(which.splits))
    wanted, sets = which.grammar.sample(chooser, which.splits[split].sets)
    if goal:
        wanted = which.grammar.read(goal)
        sets = tuple(each for each, one in which.grammar.sets.items() if {x for x, _ in wanted} & {*one.predicates})
    return drawn(which, split, f"{name}-{split}-tried-{seed}-{number}", wanted, sets, chooser)


def drawn(which: Challenge, split: str, task_id: str, goal: Goal, sets: tuple[str, ...], chooser: Random) -> Task:
    """Return a task with a goal: its home is one of the split's, its demonstration's another of the homes of training.

    A split that the challenge does not name has the homes of training.
    """
    home = chooser.choice(which.splits[split].homes if split in which.splits else which.train)
    other = chooser.choice([each for each in which.train if each != home])
    return Task(task_id, which.name, split, home, other, sets, goal, chooser.getrandbits(63))
