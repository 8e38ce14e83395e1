"""Errands: actions of an agent for a while that have nothing to do with its goal."""

from __future__ import annotations

from hearth.agents.human_like import Habits, HumanLike
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal, Name
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.goals import Progress
from hearth.simulation.observation.views import View


class Errand:
    """One literal that a human-like agent brings about, with a belief of its own, until some tick."""

    def __init__(self, wanted: Literal[Name], view: View, ticks: int, seed: int, habits: Habits) -> None:
        """Begin.

        Args:
            wanted: about ids of nodes.
            view: the current view.
            ticks: after which it is given up.
            seed: of all that it does at random.
            habits: of planning.
        """
        self._agent = HumanLike(habits)
        self._agent.reset(view, Goal.of(wanted), seed)
        self._until = view.tick + ticks

    def act(self, view: View, legal: Legal) -> Step | None:
        """Return the next instruction; None once it is done, given up, or can't go on."""
        if view.tick >= self._until or Progress.at(self._agent.goal, view.world).satisfied:
            return None
        return self._agent.act(view, legal)
