"""An agent: it is shown where an episode begins, then asked for one instruction a tick."""

from __future__ import annotations

from typing import Protocol

from hearth.schemas.agent_messages import Message
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View

Choice = Step | Message | None
"""What an agent chooses in a tick."""


class Resigned(Exception):  # noqa: N818 - nothing is wrong
    """Raised by an agent that ends the episode, such as a person who leaves; the ticks up to then stand."""


class Agent(Protocol):
    """Whoever acts in an episode. It keeps its own generator, and learns of the world by observations alone.

    An observation holds the whole world, for speed; an agent reads of it what its mask shows, and what never changes:
    rooms, furniture, doors, what things afford. `tests/agents/` scrambles what is unseen and expects the same choices.
    """

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode.

        Args:
            observation: what it sees before the first tick.
            goal: what it is to reach; None for a helper that is not told.
            seed: of all that it does at random.
        """

    def act(self, observation: View, legal: Legal) -> Choice:
        """The instruction that it tries in this tick, or what it says instead; None to wait.

        Args:
            observation: what it sees now, with what it and those it sees last tried.
            legal: what it could do now, of the actions of the challenge.
        """
