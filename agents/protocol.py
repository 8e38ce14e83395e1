"""An agent: it is shown where an episode begins, then asked for one instruction a tick."""

from __future__ import annotations

from typing import Protocol

from hearth.schemas.agent_messages import Message
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

Choice = Step | Message | None
"""An agent's choice in a tick."""


class Resigned(Exception):  # noqa: N818 - nothing is wrong
    """Raised by an agent that ends the episode, such as a person who leaves; the ticks up to then stand."""


class Agent(Protocol):
    """An agent in an episode. It keeps its own generator, and learns of the world by observations alone.

    An observation holds the whole world, for speed. An agent reads only the part in its mask, and the part that never
    changes: rooms, furniture, doors, affordances. `tests/agents/` scrambles the unobserved part and expects the same
    choices.
    """

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode.

        Args:
            observation: its observation before the first tick.
            goal: the goal to reach; None for a helper that does not know it.
            seed: of all that it does at random.
        """

    def act(self, observation: View, legal: Legal) -> Choice:
        """Return the instruction that it tries in this tick, or its message instead; None to wait.

        Args:
            observation: its current observation, with its own last attempt and those of the agents in view.
            legal: its possible instructions now, of the actions of the challenge.
        """
