"""Help by empowerment: the actions that most goals need, whatever the goal is (thesis 7.4, a baseline)."""

from __future__ import annotations

from collections import Counter

from hearth.agents.goal_space import Edge, GoalsIn
from hearth.agents.online_helper import OnlineHelper
from hearth.simulation.observation.views import View


class Empowerment(OnlineHelper):
    """Brings about the edge that most of some goals, drawn uniformly in each tick, have in their plans."""

    def __init__(self, goals: GoalsIn, particles: int = 20, horizon: float = 15.0) -> None:
        super().__init__(goals)
        self._particles, self._horizon = particles, horizon

    def choose(self, view: View) -> Edge | None:
        """Return the commonest edge that can still be helped with."""
        planner, theirs = self.planner(), self.theirs
        held = self.held(view)
        found: Counter[Edge] = Counter()
        for goal in (self.chooser.choice(self.space.wanted) for _ in range(self._particles)):
            found.update(planner.prospect(goal, self._horizon).edges.keys())
        able = [each for each in found if not theirs >> each.thing & 1 and (not held or each.thing in held)]
        return max(able, key=lambda each: (found[each], each), default=None)
