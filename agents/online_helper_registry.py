"""Helpers that are not given the goal, by name. To add one: a file, a row here, a test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hearth.agents.communication import Asking
from hearth.agents.empowerment_helper import Empowerment
from hearth.agents.expected_time_helper import ExpectedTime
from hearth.agents.goal_space import GoalsIn
from hearth.agents.helping_plans import Weights
from hearth.agents.nopa import Nopa, Settings
from hearth.agents.partial_view_helper import Watchful, Watching
from hearth.agents.proposal_helpers import ProposedPlans
from hearth.agents.protocol import Agent
from hearth.agents.veto_helpers import VetoExpectedTime, VetoNopa


@dataclass(frozen=True, slots=True)
class OnlineKind:
    """A way to help without being given the goal.

    Attributes:
        make: makes the helper of the goals that there may be.
        about: a description, for tables.
        network: the goal proposal network that it asks, which needs the extra `models`; "" for none.
        talks: whether it says something, which challenges allow by `messages`.
    """

    make: Callable[[GoalsIn], Agent]
    about: str
    network: str = ""
    talks: bool = False


LARGE, SMALL = "goal-proposals", "goal-proposals-small"
"""The networks that were trained on 6,000 and on 300 episodes."""

PROPOSED = "owah"
"""The challenge for whose goals these networks were trained."""


def _nopa(about: str, settings: Settings) -> OnlineKind:
    return OnlineKind(lambda goals: Nopa(goals, settings), about, settings.model if settings.proposals == "gpn" else "")


ONLINE: dict[str, OnlineKind] = {
    "expected_time": OnlineKind(ExpectedTime, "saves the most expected ticks, over the exact posterior"),
    "expected_time_veto": OnlineKind(VetoExpectedTime, "as above, and asks the engine before it acts: no harm"),
    "watchful": OnlineKind(
        Watchful, "as expected_time, but it sees its own room only, and goes to watch where that saves time"
    ),
    "watchful_stays": OnlineKind(
        lambda goals: Watchful(goals, Watching(seeks=False)), "the same, watches who is in view anyway"
    ),
    "asking": OnlineKind(Asking, "the same, and asks where an answer is worth two ticks", talks=True),
    "nopa": _nopa("NOPA, proposals from the exact posterior", Settings()),
    "nopa_veto": OnlineKind(VetoNopa, "as nopa, and asks the engine before it acts: no harm"),
    "nopa_gpn": _nopa("NOPA, proposals from the network", Settings(proposals="gpn")),
    "nopa_gpn_s": _nopa("NOPA, proposals from the network of 300 episodes", Settings(proposals="gpn", model=SMALL)),
    "hp_gpn": OnlineKind(ProposedPlans, "planner for the network's most probable goal", network=LARGE),
    "hp_gpn_s": OnlineKind(lambda goals: ProposedPlans(goals, SMALL), "the same, 300 episodes", network=SMALL),
    "af_gpn": OnlineKind(
        lambda goals: ProposedPlans(goals, particles=20), "the commonest first action of 20 plans", network=LARGE
    ),
    **{f"nopa_k{k}": _nopa(f"NOPA with {k} particle{'s' * (k > 1)}", Settings(particles=k)) for k in (1, 2, 5, 10, 40)},
    "nopa_uniform": _nopa("NOPA, uniform proposals (RG)", Settings(proposals="uniform")),
    "nopa_no_inverse": _nopa(
        "NOPA, uniform proposals, no inverse planning", Settings(proposals="uniform", inverse_planning=False)
    ),
    "nopa_no_return": _nopa("NOPA, nothing is brought back", Settings(weights=Weights(returns=False))),
    "likeliest": _nopa("planner for the likeliest goal", Settings(proposals="likeliest", horizon=1.0)),
    "empowerment": OnlineKind(Empowerment, "what most goals have in their plans"),
}
"""The helpers for a partner whose goal is unknown, by name."""
