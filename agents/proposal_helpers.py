"""Planners for goals that the network proposes: HP_GPN for the most probable, AF_GPN for many (thesis 7.5.1)."""

from __future__ import annotations

from collections import Counter

from hearth.agents.goal_space import Counts, Edge, GoalsIn
from hearth.agents.hierarchical_helper import Hierarchical
from hearth.agents.network_proposals import NetworkProposals
from hearth.agents.online_helper import OnlineHelper
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.schemas.rng import derive
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View


class ProposedPlans(OnlineHelper):
    """A helper that takes the most frequent first action of the hierarchical planner over the proposed goals."""

    def __init__(self, goals: GoalsIn, model: str = "goal-proposals", particles: int = 1) -> None:
        """Choose how.

        Args:
            goals: that there may be.
            model: the network: a checkpoint's folder, or a name of `model list`.
            particles: how many goals are drawn; of one, the most probable is taken (HP_GPN).
        """
        super().__init__(goals)
        self._network_name, self._particles = model, particles

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, None, seed)
        self._network = NetworkProposals(self.space, self._network_name, self.partner, self.places(observation))
        self._planners: dict[Counts, Hierarchical] = {}
        self._seed = seed
        self._shares: dict[Counts, float] = {}

    def act(self, observation: View, legal: Legal) -> Step | None:
        """Return the instruction of most plans; of equally many, the first in order."""
        places = self.places(observation)
        goals = [self._network.likeliest(places)]
        if self._particles > 1:
            goals = self._network.drawn(places, self._particles, self.chooser)
        shares = Counter(goals)
        self._shares = {goal: number / len(goals) for goal, number in shares.items()}
        steps: Counter[Step] = Counter()
        for goal, number in shares.items():
            step = self._planner(goal, observation).act(observation, legal)
            if step is not None:
                steps[step] += number
        return max(steps, key=lambda step: (steps[step], str(step)), default=None)

    def _planner(self, goal: Counts, view: View) -> Hierarchical:
        if goal not in self._planners:
            self._planners[goal] = Hierarchical()
            self._planners[goal].reset(view, self.space.goal(goal), derive(self._seed, *map(str, goal)))
        return self._planners[goal]

    @property
    def proposed(self) -> dict[Counts, float]:
        """Return the goals that were proposed, with their shares."""
        return self._shares

    def choose(self, view: View) -> Edge | None:
        """Not asked: `act` chooses."""
        return None
