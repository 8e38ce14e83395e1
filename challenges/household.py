"""`household`: open tasks for one agent, from the corpus and from families of goals; a task is made from its id.

The same id gives the same task: what is drawn depends on the seed, the split and the number alone. A draw whose goal or
program is another split's, or that an agent that sees everything does not solve, is rejected, counted, and replaced.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from hashlib import blake2b
from random import Random

from hearth.agents.human_like import Habits, HumanLike
from hearth.challenges.episode_loop import Played, Player, play
from hearth.challenges.episodes import written
from hearth.challenges.household_activities import activities, drawn_activity, start_of_activity
from hearth.challenges.household_definition import (
    NAME,
    RULES,
    HouseholdSplit,
    home_named,
    settings,
    share_of_goal,
    share_of_program,
    split_named,
)
from hearth.challenges.household_families import FAMILIES
from hearth.challenges.household_starts import overlaps, start_for_goal
from hearth.challenges.instruction_reader import read_instruction
from hearth.challenges.instruction_writer import instruction
from hearth.envs.compact_text import IN_SHORT
from hearth.grounding.environments.default_state import prepared
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.rng import derive, rng
from hearth.simulation.rules import Rules
from hearth.simulation.world.world import World

ACTIVITY = "activity"
"""The family of the corpus."""

TRIES = 200
"""Draws for one task before it is given up."""


@dataclass(frozen=True)
class HouseholdTask:
    """Something to do in a home.

    Attributes:
        id: unique; the task can be made from it (`household_task`).
        family: one of the families of `household.yaml`.
        home: its name; a generated home's has its rooms and seed.
        seed: of the start.
        instruction: in English; of an activity, a person's words and then, after `In short:`, the same as below.
        goal: counted literals over classes; of `without`, also what is never done.
        expert: instructions that reach the goal, one a tick.
        min_ticks: ticks that an agent that sees everything takes.
        split: one of the splits of `household.yaml`.
        activity: id of the program of the corpus; "" of other families.
    """

    id: str
    family: str
    home: str
    seed: int
    instruction: str
    goal: Goal
    expert: tuple[str, ...]
    min_ticks: int
    split: str
    activity: str = ""

    @property
    def rules(self) -> Rules:
        """Return how actions are read, as in the other challenges."""
        return RULES

    def start(self, knowledge: Knowledge | None = None) -> World:
        """Return the world in which it starts; equal every time."""
        world = _start(self.family, self.goal, self.home, self.seed, self.activity, knowledge or default())[0]
        assert world is not None
        return world


def household_tasks(
    split: str,
    limit: int | None = None,
    seed: int = 0,
    rejected: Counter[str] | None = None,
    knowledge: Knowledge | None = None,
) -> Iterator[HouseholdTask]:
    """Yield the tasks of a split, made one by one.

    Args:
        split: see `household.yaml`.
        limit: the first of them only.
        seed: draws other tasks; those of 0 are the published ones.
        rejected: counts the draws that gave no task, by reason.
        knowledge: ours where None.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such split.
    """
    for task_id in household_ids(split, limit, seed):
        yield household_task(task_id, rejected, knowledge)


def household_ids(split: str, limit: int | None = None, seed: int = 0) -> Iterator[str]:
    """Yield the ids of a split's tasks; errors as of `household_tasks`."""
    number = split_named(split).tasks
    label = split if seed == 0 else f"{split}-{seed}"
    yield from (f"{NAME}-{label}-{n:05d}" for n in range(number if limit is None else min(limit, number)))


_ID = re.compile(rf"{NAME}-([a-z_]{{1,20}})(?:-(\d{{1,18}}))?-(\d{{5}})", re.ASCII)


def household_task(
    task_id: str, rejected: Counter[str] | None = None, knowledge: Knowledge | None = None
) -> HouseholdTask:
    """Return a task by its id.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such task; NO_PLACE: none was found in `TRIES` draws.
    """
    match = _ID.fullmatch(task_id)
    if match is None or int(match[3]) >= split_named(match[1]).tasks:
        remedy = "as in household-train-00017; see `challenge tasks household`"
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no task `{task_id[:60]}`", suggestion=remedy)
    split, number, known = split_named(match[1]), int(match[3]), knowledge or default()
    counted = Counter[str]() if rejected is None else rejected
    for attempt in range(TRIES):
        chooser = rng(int(match[2] or 0), NAME, split.name, number, attempt)
        family = settings()["families"][number % len(settings()["families"])]
        found = _drawn(task_id, split, family, chooser, known)
        if isinstance(found, HouseholdTask):
            return found
        counted[found] += 1
    raise HearthError.of(Code.NO_PLACE, f"no task was found for `{task_id}`")


def _drawn(task_id: str, split: HouseholdSplit, family: str, chooser: Random, known: Knowledge) -> HouseholdTask | str:
    """Return a task, or why the draw gives none."""
    home, seed = chooser.choice(split.homes), chooser.getrandbits(63)
    goal, activity = _goal(family, split, home, seed, chooser, known)
    if goal is None:
        return "no goal"
    if share_of_goal(goal) != split.goals:
        return "goal of another split"
    world, _ = _start(family, goal, home, seed, activity, known)
    if world is None:
        return "no start"
    if overlaps(goal, world):
        return "one thing counts twice"
    text = _text(goal, split, family, activity, seed, known)
    if not _same(text, goal, known):
        return "instruction not read back"
    done = solve(world, goal, seed, known, sees_all=True)
    if not done.success:
        return "not solved by an agent that sees everything"
    if share_of_program(step for tick in done.env.ticks for step in tick.instructions.values()) != split.goals:
        return "program of another split"
    expert = tuple(written(tick.instructions.get(0)) or "" for tick in done.env.ticks)
    return HouseholdTask(task_id, family, home, seed, text, goal, expert, done.ticks, split.name, activity)


def _goal(
    family: str, split: HouseholdSplit, home: str, seed: int, chooser: Random, known: Knowledge
) -> tuple[Goal | None, str]:
    """Return a goal of a family, and the activity that it is of."""
    if family != ACTIVITY:
        return FAMILIES[family](prepared(home_named(home, known)), chooser), ""
    activity = drawn_activity(split.goals, chooser)
    found = start_of_activity(activity, home, seed, known)
    return (found[1] if found else None), activity.id


def _start(family: str, goal: Goal, home: str, seed: int, activity: str, known: Knowledge) -> tuple[World | None, Goal]:
    if family != ACTIVITY:
        return start_for_goal(goal, home, seed, known), goal
    found = start_of_activity(activities()[activity], home, seed, known)
    return found or (None, goal)


def _text(goal: Goal, split: HouseholdSplit, family: str, activity: str, seed: int, known: Knowledge) -> str:
    text = instruction(goal, known, seed, pool=split.words, family=family)
    if not activity:
        return text
    said = activities()[activity]
    return f"{said.title}. {said.description}{IN_SHORT}{text}"


def _same(text: str, goal: Goal, known: Knowledge) -> bool:
    try:
        return read_instruction(text, known) == goal
    except HearthError:
        return False


def solve(world: World, goal: Goal, seed: int, knowledge: Knowledge, *, sees_all: bool = False) -> Played:
    """Return the episode of the human-like agent, which sees everything, or only the room it is in."""
    agent = HumanLike(Habits(sees_all=sees_all))
    return play(
        world,
        goal,
        [Player(agent, goal)],
        derive(seed, "household episode"),
        actions=knowledge.group(settings()["actions"]),
        partial=True,
        limit=settings()["ticks"],
        rules=RULES,
    )


def digest_of(tasks: Iterable[HouseholdTask]) -> str:
    """Return 32 hexadecimal digits of all that tasks are; equal for equal tasks in the same order."""
    whole = blake2b(digest_size=16)
    for task in tasks:
        made = (task.family, task.split, task.activity, task.min_ticks)
        parts = (task.id, *made, task.home, task.seed, task.instruction, task.goal, *task.expert)
        whole.update("\x1f".join(map(str, parts)).encode() + b"\x1e")
    return whole.hexdigest()
