"""Helpers that are not given the goal, by name. To add one: a file, a row here, a test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hearth.agents.empowerment import Empowerment
from hearth.agents.expected_time import ExpectedTime
from hearth.agents.goal_space import GoalsIn
from hearth.agents.nopa import Nopa, Settings
from hearth.agents.protocol import Agent


@dataclass(frozen=True, slots=True)
class OnlineKind:
    """A way to help without being given the goal.

    Attributes:
        make: makes the helper of the goals that there may be.
        about: what it is, for tables.
    """

    make: Callable[[GoalsIn], Agent]
    about: str


def _nopa(about: str, settings: Settings) -> OnlineKind:
    return OnlineKind(lambda goals: Nopa(goals, settings), about)


ONLINE: dict[str, OnlineKind] = {
    "expected_time": OnlineKind(ExpectedTime, "saves the most expected ticks, over the exact posterior"),
    "nopa": _nopa("NOPA, proposals from the exact posterior", Settings()),
    "nopa_uniform": _nopa("NOPA, uniform proposals (RG)", Settings(proposals="uniform")),
    "nopa_no_inverse": _nopa(
        "NOPA, uniform proposals, no inverse planning", Settings(proposals="uniform", inverse_planning=False)
    ),
    "nopa_no_return": _nopa("NOPA, nothing is brought back", Settings(returns=False)),
    "likeliest": _nopa("planner for the likeliest goal", Settings(proposals="likeliest", horizon=1.0)),
    "empowerment": OnlineKind(Empowerment, "what most goals have in their plans"),
}
"""How to help somebody whose goal one does not know."""
