"""A trial: a task that a person does, alone or with a helper, by one of the interfaces. It is stored as JSON."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hearth.agents.agent_registry import HELPERS
from hearth.agents.online_helper_registry import ONLINE
from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.episode_agents import GOALS, NOBODY, Lineup
from hearth.challenges.household import household_task
from hearth.challenges.household_as_challenge import OpenTask, as_task
from hearth.challenges.household_definition import NAME as HOUSEHOLD
from hearth.challenges.household_definition import settings
from hearth.challenges.published_tasks import tasks
from hearth.challenges.suite_runs import INFERRED
from hearth.challenges.task_files import Suite, read_suite, suite_data
from hearth.challenges.tasks import Task
from hearth.challenges.watch_stage import inferred
from hearth.envs.compact_text import IN_SHORT
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.optional_libraries import lacking, remedy
from hearth.schemas.rng import derive, rng

PERSON, PROGRAM = "person", "program"
"""Helpers that are no agents of ours: a second person, and a program over the agent protocol."""

OTHERS = (NOBODY, PERSON, PROGRAM)
"""Helpers for which the server makes no agent."""

INTERFACES = ("symbolic", "visual", "stream")
"""Buttons and a floor plan; first person in 3D by the browser; pictures of our renderer."""

SIZE = (640, 480)
"""Pixels of a picture in first person, width and height."""


@dataclass(frozen=True)
class Trial:
    """A task that a person does.

    Attributes:
        task: the task to do.
        helper: `none`, `person`, `program`, or an agent by name (see `helpers`).
        goal: the helper's goal, one of `challenges.episode_agents.GOALS`.
        helper_goal: the same in the words of the grammar; None if nothing.
        interface: one of `INTERFACES`.
        seed: number of the episode among those of its task.
        partial: whether the person sees only the area around it.
        seconds: after which it ends, counted from when it was begun; 0 for never.
    """

    task: Task
    helper: str = NOBODY
    goal: str = "none"
    helper_goal: Goal | None = None
    interface: str = INTERFACES[0]
    seed: int = 0
    partial: bool = True
    seconds: float = 0.0

    @property
    def challenge(self) -> Challenge:
        """Return the challenge of the task."""
        return challenge(self.task.challenge)

    @property
    def title(self) -> str:
        """Return what its task is about, for people."""
        if isinstance(self.task, OpenTask):
            return str(settings()["titles"][self.task.family])
        return ", ".join(self.challenge.grammar.sets[name].asked for name in self.task.sets)

    @property
    def instruction(self) -> str:
        """Return what the person is asked to do in words; empty where the goal's title says it.

        Of an activity, the words of the person that wrote it down are left out: they tell of more than its goal has.
        """
        return self.task.instruction.rpartition(IN_SHORT)[2] if isinstance(self.task, OpenTask) else ""

    @property
    def helped(self) -> bool:
        """Return whether there is a second character."""
        return self.helper != NOBODY

    @property
    def people(self) -> tuple[int, ...]:
        """Return the characters that people decide for."""
        return (0, 1) if self.helper == PERSON else (0,)

    @property
    def episode_seed(self) -> int:
        """Return the seed of all random choices in it, as of episodes of agents (see `challenges.episodes.played`)."""
        return derive(self.task.seed, "episode", self.seed)

    def as_json(self) -> dict[str, Any]:
        """Return the trial as the store has it; `read_trial` reads it."""
        grammar = self.challenge.grammar
        alone = Suite(self.task.challenge, self.task.split, 0, (self.task,))
        return {
            "tasks": suite_data(alone),
            "helper": self.helper,
            "goal": self.goal,
            "helper_goal": None if self.helper_goal is None else grammar.written(self.helper_goal),
            "interface": self.interface,
            "seed": self.seed,
            "partial": self.partial,
            "seconds": self.seconds,
        }


def helpers() -> dict[str, str]:
    """Return the helpers that a person may have, with descriptions; none that needs a main agent of ours."""
    ours = {name: each.about for name, each in HELPERS.items() if not each.main}
    online = {name: each.about for name, each in ONLINE.items()}
    others = {NOBODY: "nobody", PERSON: "another person", PROGRAM: "a program over the agent protocol"}
    return {**others, **ours, **online}


def offered(which: Challenge) -> dict[str, str]:
    """Return the helpers that can help in a challenge, here: some use networks, which need the extra `models`."""
    return {name: about for name, about in helpers().items() if _can_help(name, which)}


def drawable() -> tuple[str, ...]:
    """Return the interfaces that can be here: buttons alone where the extra `pictures` is not installed."""
    return INTERFACES[:1] if lacking("pictures") else INTERFACES


def _can_help(helper: str, which: Challenge) -> bool:
    try:
        Lineup(helper=helper).installed().fits(which)
    except HearthError:
        return False
    return True


def published(name: str, split: str, number: int) -> Task:
    """Return a published task by its place in its split, from 0; one of `household` is made, which takes a moment.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such challenge, split or number.
    """
    if name == HOUSEHOLD:
        return as_task(household_task(f"{HOUSEHOLD}-{split}-{number:05d}"))
    found = tasks(name, split, limit=max(number + 1, 1))
    if not 0 <= number < len(found):
        message = f"there is no task {number} of {name} {split}"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"0 to {len(found) - 1}")
    return found[number]


def trial(
    task: Task,
    knowledge: Knowledge,
    helper: str = NOBODY,
    interface: str = INTERFACES[0],
    seed: int = 0,
    partial: bool | None = None,
    goal: str = "",
) -> Trial:
    """Return a trial, checked, with its helper's goal.

    Args:
        task: the task to do.
        knowledge: with which its homes are read.
        helper: one of `helpers`.
        interface: one of `INTERFACES`.
        seed: number of the episode among those of its task.
        partial: whether the person sees only the area around it; as the challenge has it where None.
        goal: the helper's goal; as its row in the registry says where empty.

    Raises:
        HearthError: BAD_ARGUMENT: there is no such helper, goal or interface, or the helper can't help there;
            MISSING_FILE: it asks a network, and the extra `models` is not installed; or the interface draws, and the
            extra `pictures` is not.
    """
    _check("helper", helper, helpers())
    _check("interface", interface, INTERFACES)
    if interface not in drawable():
        message = f"`{interface}` draws, and {lacking('pictures')[0]} is not installed"
        raise HearthError.of(Code.MISSING_FILE, message, suggestion=remedy("pictures"))
    usual = {PERSON: "true", PROGRAM: "true"} | {name: each.goal for name, each in HELPERS.items()}
    kind = goal or usual.get(helper, "none")
    _check("goal", kind, GOALS)
    Lineup(helper=helper, goal=kind).installed().fits(challenge(task.challenge))
    seen = challenge(task.challenge).partial if partial is None else partial
    return Trial(task, helper, kind, _asked(task, kind, seed, knowledge), interface, seed, seen)


def _check(what: str, given: str, known: Any) -> None:
    if given not in known:
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no {what} `{given[:60]}`", suggestion=", ".join(known))


def _asked(task: Task, kind: str, seed: int, knowledge: Knowledge) -> Goal | None:
    """Return a helper's goal; a random goal is another that the task's sets could have had."""
    if kind == "true":
        return task.goal
    if kind in INFERRED:
        return next(inferred([task], INFERRED[kind], lambda: knowledge))
    if kind == "random":
        chooser = rng(task.seed, "random goal of a trial", seed)
        grammar = challenge(task.challenge).grammar
        return next(goal for _ in range(100) if (goal := grammar.sample(chooser)[0]) != task.goal)
    return None


def read_trial(given: Mapping[str, Any]) -> Trial:
    """Return a trial as the store has it.

    Raises:
        HearthError: BAD_JSON, DAMAGED_FILE, BAD_ARGUMENT: it is not as it was written.
    """
    (task,) = read_suite(given.get("tasks"), "trial").tasks
    fields = {name: given.get(name) for name in ("helper", "goal", "interface", "seed", "partial")}
    kinds = {"helper": str, "goal": str, "interface": str, "seed": int, "partial": bool}
    if wrong := [name for name, kind in kinds.items() if not isinstance(fields[name], kind)]:
        raise HearthError.of(Code.BAD_JSON, f"`{wrong[0]}` of a trial is {str(fields[wrong[0]])[:60]}")
    for name, known in (("helper", helpers()), ("interface", INTERFACES), ("goal", GOALS)):
        _check(name, str(fields[name]), known)
    asked = given.get("helper_goal")
    goal = None if asked is None else challenge(task.challenge).grammar.read(asked)
    seconds = given.get("seconds", 0.0)  # trials of earlier versions have none
    if isinstance(seconds, bool) or not isinstance(seconds, int | float):
        raise HearthError.of(Code.BAD_JSON, f"`seconds` of a trial is {str(seconds)[:60]}")
    return Trial(task, helper_goal=goal, seconds=float(seconds), **fields)  # type: ignore[arg-type]
