"""The value of helping with one edge of the graph, or with two, one in each hand (thesis 7.3.4, equation 7.1).

The thesis weighs edges one by one. Here an edge is followed by the next best one. The helper may take the second thing
along before it puts the first: the same equation then decides if both hands are worth the detour. A goal needs an edge
if it lacks one more than the partner and the helper already bring.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations
from typing import NamedTuple, Protocol

from hearth.agents.belief import Place
from hearth.agents.goal_space import Counts, Edge, GoalSpace, Scene
from hearth.agents.partner_plans import Prospect
from hearth.schemas.literals import HOLDS
from hearth.simulation.observation.views import View

HANDS = 2

OPENING = 6
"""Ticks that it takes more to open something with both hands full."""


@dataclass(frozen=True, slots=True)
class Weights:
    """Weights of equation 7.1.

    Attributes:
        reward, cost, moves: w_r, w_c and w_m.
        ahead: L_max, ticks after which an edge is expected that no predicted plan brings about.
        returns: whether unwanted things are brought back; if not, w_m is 0.
        hands: how many things it carries at once.
        looked: edges of the highest value that are combined with each other.
    """

    reward: float = 1.0
    cost: float = 1.0
    moves: float = 20.0
    ahead: float = 100.0
    returns: bool = True
    hands: int = HANDS
    looked: int = 6


USUAL_WEIGHTS = Weights()


class Helper(Protocol):
    """A helper's knowledge of its own ways."""

    space: GoalSpace
    me: int
    first_places: dict[int, Place]
    scene: Scene

    @property
    def theirs(self) -> int:
        """Return the set of things that the partner holds."""

    def arrivals(self, view: View, stops: Iterable[tuple[int, int]]) -> list[float]:
        """Ticks until each of some stops is done (see `online_helper.OnlineHelper`)."""

    def taking(self, place: Place) -> tuple[int, int]:
        """Return the stop at which something is taken."""

    def putting(self, relation: str, target: int) -> tuple[int, int]:
        """Return the stop at which something is put."""


class _Leg(NamedTuple):
    """A stop: node, ticks there, and the edge that comes about; None where a thing is taken."""

    node: int
    ticks: int
    edge: Edge | None = None


class HelpingPlans:
    """The values of a helper's possible next plans, in one view.

    Attributes:
        values: by first edge, the value of the best plan that begins with it; `("", thing, -1)` is to take it along.
    """

    def __init__(
        self,
        helper: Helper,
        view: View,
        prospects: Sequence[tuple[float, Counts, Prospect]],
        weights: Weights,
    ) -> None:
        """Weigh plans.

        Args:
            helper: the helper whose plans are weighed.
            view: its view.
            prospects: goals with their shares, and the prediction under each.
            weights: of equation 7.1.
        """
        self._helper, self._view, self._weights = helper, view, weights
        self._places = dict(zip(helper.space.things, helper.scene.places, strict=True))
        self._held = [thing for thing, place in self._places.items() if place == (HOLDS, helper.me)]
        self._theirs = helper.theirs
        self._predicted(prospects)
        self._lacking(prospects)
        self.values: dict[Edge, float] = {}
        for first, legs in self._plans():
            value = self._value(legs)
            self.values[first] = max(value, self.values.get(first, value))
        if weights.returns:
            for edge in (Edge(*self._first(thing)) for thing in self._held):
                self.values[edge] = weights.moves - weights.cost * self._times([self._put(edge)])[-1]

    def _first(self, thing: int) -> tuple[str, int, int]:
        place = self._helper.first_places[thing]
        return place.relation, thing, place.node

    def _predicted(self, prospects: Sequence[tuple[float, Counts, Prospect]]) -> None:
        """Compute L_M of each edge, and the probability of each edge that is in no final goal (algorithm 3)."""
        ahead = self._weights.ahead
        self._expected: dict[Edge, float] = {}
        self._passing: defaultdict[Edge, float] = defaultdict(float)
        for share, _, prospect in prospects:
            for edge, ticks in (*prospect.edges.items(), *((edge, ahead) for edge in prospect.later)):
                self._expected[edge] = min(self._expected.get(edge, ahead), ticks)
                self._passing[edge] += share

    def _lacking(self, prospects: Sequence[tuple[float, Counts, Prospect]]) -> None:
        """Compute the probability that a goal lacks one, two, .

        Of each predicate, after the things the partner carries.
        """
        space = self._helper.space
        there = space.counted(self._helper.scene.places).sum(axis=1).tolist()
        carried = [rows for thing, rows in zip(space.things, space.rows_of, strict=True) if self._theirs >> thing & 1]
        self._needs: defaultdict[tuple[int, int], float] = defaultdict(float)
        for share, goal, _ in prospects:
            lacking = [wanted - found for wanted, found in zip(goal, there, strict=True)]
            for rows in carried:
                row = next((row for row in rows if lacking[row] > 0), -1)
                lacking[row] -= row >= 0
            for row, number in enumerate(lacking):
                for nth in range(number):
                    self._needs[row, nth] += share

    def _plans(self) -> Iterator[tuple[Edge, list[_Leg]]]:
        """Yield first edges, each with the stops of its plan in order."""
        edges = [edge for edge in self._expected if not self._theirs >> edge.thing & 1]
        if self._theirs:
            edges = [edge for edge in edges if edge.relation != HOLDS]
        mine = [edge for edge in edges if edge.thing in self._held]
        yield from ((edge, [self._put(edge)]) for edge in mine)
        for one, other in permutations(mine, 2):
            if one.thing != other.thing:
                yield one, [self._put(one, full=True), self._put(other)]
        if len(self._held) >= self._weights.hands:
            return
        others = self._best([edge for edge in edges if edge.thing not in self._held])
        for edge in others:
            if not self._held:
                yield edge, [self._take(edge), self._put(edge)]
        for one in mine or others:
            for other in others:
                if one.thing != other.thing:
                    yield from self._both(one, other)

    def _best(self, edges: Sequence[Edge]) -> list[Edge]:
        """Return the edges that are worth most by themselves."""
        values = {edge: self._value([self._take(edge), self._put(edge)]) for edge in edges}
        return sorted(values, key=lambda edge: (-values[edge], edge))[: self._weights.looked]

    def _both(self, one: Edge, other: Edge) -> Iterator[tuple[Edge, list[_Leg]]]:
        """Two edges one after the other, or with both hands."""
        has = one.thing in self._held
        takes = [] if has else [self._take(one)]
        yield one, [*takes, self._put(one), self._take(other), self._put(other)]
        if self._weights.hands < HANDS:
            return
        first = Edge("", other.thing if has else one.thing)
        takes = [*takes, self._take(other)]
        yield first, [*takes, self._put(one, full=True), self._put(other)]
        if has and one[::2] != other[::2]:
            yield first, [*takes, self._put(other, full=True), self._put(one)]

    def _take(self, edge: Edge) -> _Leg:
        return _Leg(*self._helper.taking(self._places[edge.thing]))

    def _put(self, edge: Edge, full: bool = False) -> _Leg:
        node, ticks = self._helper.putting(edge.relation, edge.target)
        return _Leg(node, ticks + OPENING * (full and ticks > 1), edge)

    def _times(self, legs: Sequence[_Leg]) -> list[float]:
        return self._helper.arrivals(self._view, ((leg.node, leg.ticks) for leg in legs))

    def _value(self, legs: Sequence[_Leg]) -> float:
        """Return V(s, e) of equation 7.1, summed over the edges of a plan; a thing in hand counts as away already."""
        weights, times = self._weights, self._times(legs)
        value, brought = -weights.cost * times[-1], set()
        for leg, time in zip(legs, times, strict=True):
            if leg.edge is not None:
                brought.add(leg.edge.thing)
                saved = max(self._expected[leg.edge] - time, 0.0)
                value += weights.reward * self._probability(leg.edge, brought) * saved
                value -= weights.moves * (weights.returns and leg.edge.thing not in self._held)
        return value

    def _probability(self, edge: Edge, brought: set[int]) -> float:
        """Return p(e): the probability that an edge is needed, given the earlier edges and the things in hand."""
        space = self._helper.space
        row = space.row_at.get(edge)
        if row is None:
            return self._passing[edge]
        others = brought - {edge.thing} if edge.thing in self._held else brought.union(self._held) - {edge.thing}
        return self._needs[row, sum(row in space.rows_of[space.number[thing]] for thing in others)]
