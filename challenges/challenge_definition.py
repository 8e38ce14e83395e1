"""A challenge as its YAML file defines it: goals, starts, episodes, splits."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

from hearth.challenges import household_definition
from hearth.challenges.goal_grammar import GoalSet, Grammar, instance
from hearth.kb.action_sets import LATEST
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal, Name
from hearth.schemas.yaml_limits import packaged
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.home import Home

NAMES = ("wah", "owah")
"""The challenges; each is a file of this package."""

VARIANTS = ("owah_partial", "owah_messages", "owah_consequences", "owah_bodies")
"""Challenges beyond the thesis: each is one of `NAMES` with the changes in its file."""


@dataclass(frozen=True)
class Split:
    """A set of tasks.

    Attributes:
        tasks: how many.
        sets: how many goal sets a goal is made of.
        homes: where the agents are.
        goals: `seen`, `held_out` or `all` (see `published_tasks.tasks`).
    """

    tasks: int
    sets: int
    homes: tuple[str, ...]
    goals: str


@dataclass(frozen=True)
class Challenge:
    """A kind of task for agents.

    Attributes:
        name: its identifier.
        title: its name.
        grammar: its goals.
        never_at: classes of furniture that no thing of a goal is put at.
        ticks: after which an episode ends.
        partial: whether agents see only the area around them.
        messages: whether agents may say something instead of doing something (see `schemas.agent_messages`).
        bodies: whether agents stand in each other's way.
        strides: metres that each agent walks in a tick.
        actions: the group of actions that agents may try.
        train, test: homes of training and of testing.
        held_out: how many goals of each set are for testing only.
        splits: by name.
        demonstrations: how many there are in addition to the tasks.
        habits: probabilities of the habits that make demonstrations hard to read (see `demonstrator`).
        consequences: whether acts have the consequences of action set 3, so that episodes have counts of harm.
    """

    name: str
    title: str
    grammar: Grammar
    never_at: frozenset[str]
    ticks: int
    partial: bool
    messages: bool
    bodies: bool
    strides: tuple[float, ...]
    actions: str
    train: tuple[str, ...]
    test: tuple[str, ...]
    held_out: int
    splits: Mapping[str, Split]
    demonstrations: int
    habits: Mapping[str, float]
    consequences: bool = False

    @property
    def agents(self) -> int:
        """Return how many characters there are; the first is the one that is helped."""
        return len(self.strides)

    @property
    def rules(self) -> Rules:
        """Return how actions are read; published tasks count the bedding on a bed, and hands reach into other rooms."""
        usual = DEFAULT._replace(bodies=self.bodies, one_grip=True, made_bed=False, near_hands=False)
        return usual._replace(consequences=True) if self.consequences else usual

    def knowledge(self, known: Knowledge) -> Knowledge:
        """Return the knowledge with the actions of the challenge's action set."""
        return known.of_set(LATEST) if self.consequences else known

    def goals_in(self, home: Home) -> Mapping[Goal, float]:
        """Return the goals of single sets that there may be in a home, with their probabilities."""
        places = tuple(instance(name, home) for name in sorted(self.grammar.furniture))
        if places not in self._goals:  # homes with equal furniture have equal goals
            bound = {self.grammar.in_home(goal, home): share for goal, share in self.grammar.goals.items()}
            self._goals[places] = bound
        return self._goals[places]

    @cached_property
    def _goals(self) -> dict[tuple[int, ...], Mapping[Goal, float]]:
        return {}

    def allowed(self, knowledge: Knowledge) -> frozenset[str]:
        """Return the actions that agents may try."""
        return knowledge.group(self.actions)


@cache
def challenge(name: str) -> Challenge:
    """Return a challenge by name; read once.

    Raises:
        HearthError: BAD_ARGUMENT: there is none of that name.
    """
    if name == household_definition.NAME:
        return _household()
    if name not in (*NAMES, *VARIANTS):
        remedy = ", ".join((*NAMES, *VARIANTS, household_definition.NAME))
        raise HearthError.of(Code.BAD_ARGUMENT, f"there is no challenge `{name[:40]}`", suggestion=remedy)
    data = packaged("hearth.challenges", f"{name}.yaml")
    if "like" in data:
        data = {**packaged("hearth.challenges", f"{data['like']}.yaml"), **data}
    homes = {part: tuple(names) for part, names in data["homes"].items()}
    splits = {
        part: Split(given["tasks"], given["sets"], homes[given["homes"]], given["goals"])
        for part, given in data["splits"].items()
    }
    sets = {each: _goal_set(each, given) for each, given in data["sets"].items()}
    return Challenge(
        name,
        data["title"],
        Grammar(sets, data["most_predicates"]),
        frozenset(data["never_at"]),
        data["ticks"],
        data["partial"],
        data.get("messages", False),
        data["bodies"],
        tuple(data["strides"]),
        data["actions"],
        homes["train"],
        homes["test"],
        data["held_out"],
        splits,
        data["demonstrations"],
        data["habits"],
        data.get("consequences", False),
    )


def _household() -> Challenge:
    """Return the challenge of household tasks: any goal, one agent, no splits of `published_tasks`."""
    data = household_definition.settings()
    homes = {part: tuple(given["ours"]) for part, given in data["homes"].items()}
    return Challenge(
        household_definition.NAME,
        data["title"],
        Grammar({}, 0),
        frozenset(data["never_at"]),
        data["ticks"],
        partial=True,
        messages=False,
        bodies=household_definition.RULES.bodies,
        strides=(data["stride"],),
        actions=data["actions"],
        train=homes["train"],
        test=homes["test"],
        held_out=0,
        splits={},
        demonstrations=0,
        habits={},
    )


def _goal_set(name: str, given: Mapping[str, Any]) -> GoalSet:
    return GoalSet(
        name,
        given["title"],
        given.get("asked", given["title"]),
        given["relation"],
        tuple(given["targets"]),
        given.get("most", {}),
        tuple((choice,) if isinstance(choice, str) else tuple(choice) for choice in given.get("each", ())),
        tuple(given.get("pool", ())),
        tuple(given.get("total", (0, 0))),
        tuple(given.get("people", (0, 0))),
        tuple(map(_literal, given.get("always", ()))),
        tuple(map(_literal, given.get("free", ()))),
    )


def _literal(text: str) -> Literal[Name]:
    name, *terms = re.findall(r"[\w:]+", text)
    return Literal(name, tuple(terms))
