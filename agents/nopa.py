"""NOPA: goals proposed, weighed by inverse planning, helped with under uncertainty (thesis 7.3, algorithms 1 to 3)."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import Literal as Choice

from hearth.agents.goal_space import Counts, Edge, GoalsIn
from hearth.agents.network_proposals import NetworkProposals
from hearth.agents.online import OnlineHelper
from hearth.agents.posterior import USUAL_MODEL, ActionModel
from hearth.agents.prospects import Planner, Prospect
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HOLDS
from hearth.simulation.observation.views import View

Source = Choice["exact", "uniform", "likeliest", "gpn"]
"""Where particles come from: the exact posterior, all goals with equal probability, the likeliest goal alone, or the
goal proposal network, which needs the extra `models`.
"""


@dataclass(frozen=True, slots=True)
class Settings:
    """How NOPA helps.

    Attributes:
        proposals: of goals.
        model: the network that proposes them, where one does: a checkpoint's folder, or a name of `model list`.
        particles: K, how many goals are proposed at once.
        horizon: T_prop, ticks for which a plan is predicted and after which goals are proposed anew.
        ahead: L_max, ticks after which an edge is expected that no predicted plan brings about.
        reward, cost, moves: w_r, w_c and w_m of equation 7.1.
        inverse_planning: particles are rejected when an action is not of their plan.
        returns: what turns out not to be wanted is brought back.
        keeps: V that a new subgoal must be better than the present one.
    """

    proposals: Source = "exact"
    model: str = "goal-proposals"
    particles: int = 20
    horizon: float = 5.0
    ahead: float = 100.0
    reward: float = 1.0
    cost: float = 1.0
    moves: float = 5.0
    inverse_planning: bool = True
    returns: bool = True
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
            self._network = NetworkProposals(self.space, self.settings.model, self.partner, observation.world)
        self._age = 0.0

    def choose(self, view: View) -> Edge | None:
        """The best edge; None where none is worth more than waiting."""
        places = self.posterior.places
        planner = Planner(self.space, places, view.world, view.others[0], self.posterior.distances)
        self._reject(view)
        if not self._particles or self._age >= self.settings.horizon:
            self._propose(planner)
        self._age += 1
        values = self._values(view, self._weighed(planner))
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
        """The goals of its particles, with their shares."""
        shares: defaultdict[Counts, float] = defaultdict(float)
        for goal, _ in self._particles:
            shares[goal] += 1 / len(self._particles)
        return dict(shares)

    def _weighed(self, planner: Planner) -> list[tuple[float, Prospect]]:
        """The goals of the particles with their shares and what is predicted under each from now on."""
        return [(share, planner.prospect(goal, self.settings.horizon)) for goal, share in self.proposed.items()]

    def _values(self, view: View, prospects: list[tuple[float, Prospect]]) -> dict[Edge, float]:
        """The value of each edge that could be helped with (algorithm 3)."""
        expected: dict[Edge, float] = {}
        probable: defaultdict[Edge, float] = defaultdict(float)
        for share, prospect in prospects:
            for edge, ticks in (*prospect.edges.items(), *((edge, self.settings.ahead) for edge in prospect.later)):
                expected[edge] = min(expected.get(edge, self.settings.ahead), ticks)
                probable[edge] += share
        held = self.held(view)
        theirs = view.world.agents[view.others[0].agent]
        found = {}
        for edge, share in probable.items():
            relation, thing, _ = edge
            if theirs.held >> thing & 1 or (held and thing not in held) or (relation == HOLDS and theirs.held):
                continue
            found[edge] = self._value(view, edge, share, expected[edge], thing in held)
        if self.settings.returns:
            for edge in map(self._back, held):
                found[edge] = self.settings.moves - self.settings.cost * self._own(view, edge)
        return found

    def _value(self, view: View, edge: Edge, share: float, expected: float, moved: bool) -> float:
        """V(s, e) of equation 7.1; what it holds already is away from its first place as it is."""
        settings, own = self.settings, self._own(view, edge)
        saved = max(expected - own, 0.0)
        changes = 0.0 if moved or not settings.returns else 1.0
        return settings.reward * share * saved - settings.cost * own - settings.moves * changes

    def _own(self, view: View, edge: Edge) -> float:
        """L_H(e): ticks in which the helper brings an edge about."""
        relation, thing, target = edge
        place = self.belief.where[thing]
        stops = [] if place.node == self.me else [self.taking(place, view.world)]
        return self.ticks(view, [*stops, self.putting(relation, target, view.world)])

    def _back(self, thing: int) -> Edge:
        relation, node = self.first_places[thing]
        return Edge(relation, thing, node)
