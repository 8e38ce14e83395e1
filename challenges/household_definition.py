"""The challenge `household` as its YAML file defines it: splits, homes, families, and the shares of goals."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache, lru_cache
from hashlib import blake2b
from typing import Any, NamedTuple

from hearth.homes.library import load_graph
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import AGENT, Name
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.schemas.yaml_limits import packaged
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.home import Home

NAME = "household"

RULES: Rules = DEFAULT._replace(one_grip=True, made_bed=False, near_hands=False)
"""Rules of actions, as in the other challenges."""


class HouseholdSplit(NamedTuple):
    """A set of tasks.

    Attributes:
        name: its identifier.
        tasks: how many.
        homes: names of the homes.
        goals: the share of goals and activities that are its own: `train`, `valid` or `test`.
        words: the pool of wordings.
    """

    name: str
    tasks: int
    homes: tuple[str, ...]
    goals: str
    words: str


@cache
def settings() -> dict[str, Any]:
    """Return the content of `household.yaml`."""
    found: dict[str, Any] = packaged("hearth.challenges", "household.yaml")
    return found


def split_named(name: str) -> HouseholdSplit:
    """Return a split by name.

    Raises:
        HearthError: BAD_ARGUMENT: there is none of that name.
    """
    splits = settings()["splits"]
    if name not in splits:
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no split `{name[:40]}`", suggestion=", ".join(splits))
    given = splits[name]
    return HouseholdSplit(name, given["tasks"], _homes(given["homes"]), given["goals"], given["words"])


def _homes(name: str) -> tuple[str, ...]:
    """Return the names of homes: ours as often as there are generated ones, so that half the tasks are in ours."""
    given = settings()["homes"][name]
    made = given["generated"]
    generated = [f"home_{rooms}_{seed}" for rooms in made["rooms"] for seed in range(*made["seeds"])]
    ours = given["ours"]
    return (*(ours * (len(generated) // max(1, len(ours)))), *generated)


@cache
def every_home() -> frozenset[str]:
    """Return the names of the homes of all splits."""
    return frozenset(home for name in settings()["splits"] for home in split_named(name).homes)


def need_two_agents(name: str) -> None:
    """Refuse the challenge whose tasks are for one agent.

    Raises:
        HearthError: BAD_ARGUMENT: the challenge is `household`.
    """
    if name == NAME:
        message = f"tasks of `{NAME}` are for one agent, and nobody helps"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="wah or owah")


@lru_cache(maxsize=24)
def home_named(name: str, knowledge: Knowledge) -> Home:
    """Return a home of ours, or the generated one of a name such as `home_4_17`; built once.

    Raises:
        HearthError: UNKNOWN_HOME.
    """
    numbers = numbers_of(name)
    if numbers is not None:
        layout = generate(*numbers, knowledge)
        return Home.from_graph(scene(layout, knowledge), name, knowledge)
    return Home.from_graph(load_graph(name, knowledge), name, knowledge)


def numbers_of(name: str) -> tuple[int, int] | None:
    """Return the rooms and the seed of a generated home; None for other homes."""
    head, *numbers = name.split("_")
    if head != "home" or len(numbers) != 2 or not all(each.isdecimal() for each in numbers):
        return None
    return int(numbers[0]), int(numbers[1])


def share_of(text: str) -> str:
    """Return whose a goal or an activity is: `train`, `valid` or `test`; by its text alone."""
    number = int.from_bytes(blake2b(text.encode(), digest_size=8).digest(), "little") % 100
    for name, share in settings()["shares"].items():
        if number < share:
            return str(name)
        number -= share
    return "train"


def share_of_goal(goal: Goal) -> str:
    """Return whose a goal is; the classes that it names decide, without what it forbids."""
    return _share_of_names(term for literal, _ in goal for term in literal.terms if term != AGENT)


def share_of_program(steps: Iterable[Step]) -> str:
    """Return whose a program is; the classes that it handles decide.

    Steps on the way (`ways` of the file) do not matter. A program that does what its goal names, and no more, is of the
    same share as the goal.
    """
    handled = (step for step in steps if step.action not in settings()["ways"])
    return _share_of_names(each.name for step in handled for each in step.objects if each.name != CHARACTER_CLASS)


def _share_of_names(names: Iterable[Name]) -> str:
    return share_of(" ".join(sorted({str(name) for name in names})))
