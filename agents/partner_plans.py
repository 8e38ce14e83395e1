"""The future actions of an agent with a certain goal: a plan, and the time at which each edge of the graph comes about.

The intermediate states of NOPA's particles (thesis 7.3.1): the plan is the nearest thing first, to a horizon.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from hearth.agents.goal_space import Counts, Edge, Flags, GoalSpace, Scene
from hearth.agents.walk_distances import Distances
from hearth.schemas.literals import HOLDS
from hearth.simulation.observation.views import Pose


@dataclass(frozen=True, slots=True)
class Prospect:
    """A predicted plan.

    Attributes:
        nodes: the nodes of its walks, openings, grabs and puts until the horizon.
        edges: edge -> ticks until it comes about, of those until the horizon.
        later: edges of the goal that come about after it.
    """

    nodes: frozenset[int]
    edges: dict[Edge, float]
    later: tuple[Edge, ...]


@dataclass(slots=True)
class _Plan:
    """A plan as it grows.

    Attributes:
        lacking: row of a predicate -> how many it still lacks.
        things: numbers of the things that are left.
        cell: where the one who acts is then.
        opened: the containers that the agent has opened.
    """

    lacking: dict[int, int]
    things: list[int]
    cell: int
    now: float = 0.0
    opened: set[int] = field(default_factory=set)
    nodes: set[int] = field(default_factory=set)
    edges: dict[Edge, float] = field(default_factory=dict)


class Planner:
    """Predicts plans in one scene.

    Attributes:
        space: the goals.
    """

    def __init__(self, space: GoalSpace, scene: Scene, me: int, other: Pose, distances: Distances) -> None:
        """Make a planner for an agent.

        Args:
            space: the goals.
            scene: where things are.
            me: index of the agent's node.
            other: how that one stands.
            other: the agent's pose.
        """
        self.space = space
        self._closed, self._distances, self._me = scene.closed, distances, me
        self._start = distances.cell(other.place)
        self._places = scene.places
        counted = space.counted(scene.places)
        self._found = counted.sum(axis=1).tolist()
        self._away: Flags = space.fits & ~counted
        self._taken = {t for t, (relation, node) in enumerate(self._places) if relation == HOLDS and node != self._me}
        self._known: dict[tuple[int, int], tuple[float, int]] = {}

    def prospect(self, goal: Counts, horizon: float) -> Prospect:
        """Return the plan for a goal until a number of ticks."""
        pairs = enumerate(zip(goal, self._found, strict=True))
        lacking = {row: wanted - found for row, (wanted, found) in pairs if wanted > found}
        things = np.flatnonzero(self._away[list(lacking)].any(axis=0)).tolist()
        plan = _Plan(lacking, things, self._start)
        while plan.now < horizon and (ways := list(self._ways(plan))):
            held = [way for way in ways if self._places[way[1]][0] == HOLDS] if not plan.nodes else []
            _, thing, row = min(held or ways)
            self._fetch(plan, thing, horizon)
            self._bring(plan, thing, row, horizon)
        return Prospect(frozenset(plan.nodes), plan.edges, tuple(self._later(plan)))

    def _ways(self, plan: _Plan) -> Iterator[tuple[float, int, int]]:
        """Yield the things that could be fetched next: ticks, number of the thing, row of the predicate."""
        for row, number in plan.lacking.items():
            for thing in plan.things if number else ():
                if self._away[row, thing] and thing not in self._taken:
                    yield self._cost(plan.cell, thing)[0], thing, row

    def _fetch(self, plan: _Plan, number: int, horizon: float) -> None:
        (relation, place), thing = self._places[number], self.space.things[number]
        ticks, plan.cell = self._cost(plan.cell, number)
        plan.now += ticks
        plan.nodes |= {thing, place}
        if relation != HOLDS and plan.now <= horizon:
            plan.edges[Edge(HOLDS, thing, self._me)] = plan.now

    def _bring(self, plan: _Plan, number: int, row: int, horizon: float) -> None:
        relation, target = self.space.relations[row], int(self.space.targets[row])
        if plan.now <= horizon:
            plan.nodes.add(target)
        metres, plan.cell = self._distances.leg(plan.cell, target)
        shut = relation == "INSIDE" and self._closed >> target & 1 and target not in plan.opened
        plan.now += self._distances.ticks(metres) + 1.0 + bool(shut)
        plan.opened.add(target)
        if plan.now <= horizon:
            plan.edges[Edge(relation, self.space.things[number], target)] = plan.now
            plan.lacking[row] -= 1
            plan.things.remove(number)

    def _later(self, plan: _Plan) -> Iterator[Edge]:
        for row, number in plan.lacking.items():
            for thing in plan.things if number else ():
                if self._away[row, thing]:
                    yield Edge(self.space.relations[row], self.space.things[thing], int(self.space.targets[row]))

    def _cost(self, cell: int, number: int) -> tuple[float, int]:
        """Ticks until a thing is taken, and the cell then."""
        key = cell, number
        if key not in self._known:
            relation, node = self._places[number]
            if relation == HOLDS:
                self._known[key] = 0.0, cell
            else:
                metres, end = self._distances.leg(cell, node)
                shut = relation == "INSIDE" and self._closed >> node & 1
                self._known[key] = self._distances.ticks(metres) + 1.0 + bool(shut), end
        return self._known[key]
