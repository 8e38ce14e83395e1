"""The agents by name. To add one: a file with its settings, a row here, a test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

from hearth.agents.communication import Answering
from hearth.agents.goal_space import GoalsIn
from hearth.agents.hierarchical_helper import HELPING, Hierarchical, Partner
from hearth.agents.human_like import Habits, HumanLike
from hearth.agents.human_population import PEOPLE
from hearth.agents.learned_helpers import Hybrid, Learned
from hearth.agents.protocol import Agent
from hearth.agents.random_agents import AdmissibleRandom, Random
from hearth.agents.random_helper import RandomHelper
from hearth.agents.veto_helpers import VetoHierarchical, VetoRandom


class MainAgent(Agent, Partner, Protocol):
    """A main agent, which a helper helps: its current subgoal is known (`subgoal`)."""


@dataclass(frozen=True, slots=True)
class Helper:
    """A way to help.

    Attributes:
        make: makes the helper of a main agent.
        goal: which it is given: `true`, `inferred` (from the task's demonstration), `random` (that of another task,
            which the runner gives), or `none`.
        main: name of the main agent that it is made for; '' for any.
        about: a description, for tables.
        network: the policy that it asks, which needs the extra `models`; "" for none.
    """

    make: Callable[[Partner], Agent]
    goal: str
    about: str
    main: str = ""
    network: str = ""


SEES_ALL = replace(HELPING, sees_all=True)

MAIN: dict[str, Callable[[GoalsIn], MainAgent]] = {
    "human_like": lambda goals: HumanLike(),
    "oracle": lambda goals: HumanLike(Habits(sees_all=True)),
    "answering": lambda goals: Answering(),
    "random": lambda goals: Random(),
    "admissible_random": lambda goals: AdmissibleRandom(),
    **PEOPLE,
}
"""The main agents, which a helper helps; each is made from the possible goals."""

HELPERS: dict[str, Helper] = {
    "random": Helper(lambda partner: RandomHelper(), "none", "anything that can be done"),
    "random_veto": Helper(lambda partner: VetoRandom(), "none", "anything that can be done and does no harm"),
    "hp_true": Helper(Hierarchical, "true", "planner, true goal, leaves the partner's subgoal"),
    "hp_timed": Helper(
        lambda partner: Hierarchical(partner, timed=True),
        "true",
        "planner, true goal, leaves what the partner reaches first",
    ),
    "hp_true_veto": Helper(VetoHierarchical, "true", "as hp_true, and asks the engine before it acts: no harm"),
    "hp": Helper(lambda partner: Hierarchical(), "inferred", "planner, inferred goal"),
    "hp_random": Helper(lambda partner: Hierarchical(), "random", "planner, goal of another task"),
    "hybrid": Helper(
        lambda partner: Hybrid(),
        "inferred",
        "learned choice of subgoals, regression; inferred goal",
        network="helping-subgoals",
    ),
    "hrl": Helper(
        lambda partner: Learned(),
        "inferred",
        "learned choice of subgoals and of actions; inferred goal",
        network="helping-actions",
    ),
    "oracle_b": Helper(
        lambda partner: Hierarchical(partner, SEES_ALL, timed=True), "true", "planner that sees everything"
    ),
    "oracle_ab": Helper(
        lambda partner: Hierarchical(partner, SEES_ALL, timed=True), "true", "planner; both see everything", "oracle"
    ),
}
"""The helpers, by name."""
