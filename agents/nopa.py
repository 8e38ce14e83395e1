"""NOPA: goals proposed, weighed by inverse planning, helped with under uncertainty (thesis 7.3, algorithms 1 to 3)."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import Literal as Choice

from hearth.agents.goal_posterior import USUAL_MODEL, ActionModel
from hearth.agents.goal_space import Counts, Edge, GoalsIn
from hearth.agents.helping_plans import USUAL_WEIGHTS, HelpingPlans, Weights
from hearth.agents.network_proposals import NetworkProposals
from hearth.agents.online_helper import OnlineHelper
from hearth.agents.partner_plans import Planner, Prospect
from hearth.schemas.goals import Goal
from hearth.simulation.observation.views import View

Source = Choice["exact", "uniform", "likeliest", "gpn"]
"""The source of particles.

The exact posterior, all goals with equal probability, the likeliest goal alone, or the goal proposal network, which
needs the extra `models`.
"""


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings of NOPA.

    Attributes:
        proposals: of goals.
        model: the network that proposes them, if one does: a checkpoint's folder, or a name of `model list`.
        particles: K, how many goals are proposed at once.
        horizon: T_prop, ticks for which a plan is predicted and after which goals are proposed anew.
        weights: of equation 7.1.
        inverse_planning: particles are rejected when an action is not of their plan.
        keeps: V that a new subgoal must be better than the present one.
    """

    proposals: Source = "exact"
    model: str = "goal-proposals"
    particles: int = 20
    horizon: float = 5.0
    weights: Weights = USUAL_WEIGHTS
    inverse_planning: bool = True
    keeps: float = 0.0


PUBLISHED = Settings()


class Nopa(OnlineHelper):
    """Helps with the edge of the highest expected value over its particles (eq. 7.1)."""

    def __init__(self, goals: GoalsIn, settings: Settings = PUBLISHED, model: ActionModel = USUAL_MODEL) -> None:
        super().__init__(goals, model)
        self.settings = settings

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode (see `agents.protocol`)."""
        super().reset(observation, goal, seed)
        self._particles: list[tuple[Counts, frozenset[int]]] = []
        self._network = None
        if self.settings.proposals == "gpn":
            self._network = NetworkProposals(self.space, self.settings.model, self.partner, self.places(observation))
        self._age = 0.0

    def choose(self, view: View) -> Edge | None:
        """Return the first edge of the best plan; None where none is worth more than waiting."""
        planner = self.planner()
        self._reject(view)
        if not self._particles or self._age >= self.settings.horizon:
            self._propose(planner)
        self._age += 1
        values = HelpingPlans(self, view, self._weighed(planner), self.settings.weights).values
        if not values:
            return None
        best = max(values, key=lambda edge: (values[edge], edge))
        now = self.subgoal
        if now in values and values[best] <= values[now] + self.settings.keeps:
            best = now
        return best if values[best] > 0 else None

    def _reject(self, view: View) -> None:
        """Drop the particles whose plan the last action is not of (algorithm 2, lines 5 to 9)."""
        last = view.others[0].last
        if not self.settings.inverse_planning or last is None or not last.instruction.objects:
            return
        index = view.world.home.index
        nodes = {index[ref.node] for ref in last.instruction.objects if ref.node in index}
        if view.world.home.knowledge.state_of(last.instruction.action) != "CLOSED":
            self._particles = [each for each in self._particles if nodes <= each[1]]

    def _propose(self, planner: Planner) -> None:
        goals = self._drawn()
        found = {goal: planner.prospect(goal, self.settings.horizon).nodes for goal in set(goals)}
        self._particles = [(goal, found[goal]) for goal in goals]
        self._age = 0.0

    def _drawn(self) -> list[Counts]:
        """Goals drawn from the proposals (algorithm 2, line 13)."""
        number, wanted = self.settings.particles, self.space.wanted
        if self._network is not None:
            return self._network.drawn(self.posterior.places, number, self.chooser)
        if self.settings.proposals == "likeliest":
            return [wanted[goal] for goal in self.posterior.likeliest(1).tolist()]
        if self.settings.proposals == "exact":
            return self.chooser.choices(wanted, self.posterior.weights.tolist(), k=number)
        return [self.chooser.choice(wanted) for _ in range(number)]

    @property
    def proposed(self) -> dict[Counts, float]:
        """Return the goals of its particles, with their shares."""
        shares: defaultdict[Counts, float] = defaultdict(float)
        for goal, _ in self._particles:
            shares[goal] += 1 / len(self._particles)
        return dict(shares)

    def _weighed(self, planner: Planner) -> list[tuple[float, Counts, Prospect]]:
        """Return the goals of the particles, with their shares and the prediction under each from now on."""
        horizon = self.settings.horizon
        return [(share, goal, planner.prospect(goal, horizon)) for goal, share in self.proposed.items()]
