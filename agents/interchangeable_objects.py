"""A home as two agents that fetch things find it: heaps of equal things, and the ticks of ways between them."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

from hearth.agents.goal_space import GoalSpace, Scene
from hearth.agents.walk_distances import Distances
from hearth.schemas.literals import HOLDS
from hearth.simulation.observation.views import Pose

SHORT = 1.2
"""Meters before the end of a way from which an agent can already reach the node there, as measured in episodes."""

FAR = 1_000
"""Ticks to a place that can't be reached."""

MAIN, HELPER = 0, 1


@dataclass(frozen=True, slots=True)
class Heap:
    """Things of one class at one place, of which each is as good as another.

    Attributes:
        rows: the predicates for which they would count elsewhere.
        node: index of the node that they are on or in; -1 in the hands of a character.
        inside: whether they are in it.
        things: their numbers in the goal space.
        holder: `MAIN` or `HELPER` who holds them; -1 if nobody does.
    """

    rows: tuple[int, ...]
    node: int
    inside: bool
    things: tuple[int, ...]
    holder: int = -1


class Situation:
    """A scene as two people find it who fetch things.

    Attributes:
        space: the goals.
        heaps: all things that goals could want elsewhere.
        starts: the cells in which both stand.
        shut: the set of closed nodes.
        giving: ticks until the helper has handed over the things in its hands.
    """

    def __init__(
        self,
        space: GoalSpace,
        scene: Scene,
        hands: tuple[int, int],
        poses: tuple[Pose, Pose],
        ways: tuple[Distances, Distances],
        giving: float = FAR,
    ) -> None:
        """Look at a scene.

        Args:
            space: the goals.
            scene: where things are.
            hands: indices of the nodes of the one who is helped, and of the helper.
            poses: of the one who is helped, and of the helper.
            ways: of both.
            giving: ticks until the helper has handed over the things in its hands.
        """
        self.space, self.giving = space, giving
        self._ways = ways
        self.starts = ways[MAIN].cell(poses[MAIN].place), ways[HELPER].cell(poses[HELPER].place)
        self.shut = scene.closed
        found: defaultdict[tuple[str, int, tuple[int, ...]], list[int]] = defaultdict(list)
        for number, (relation, node) in enumerate(scene.places):
            rows = tuple(row for row in space.rows_of[number] if not space.counts_at(row, relation, node))
            if rows and (relation != HOLDS or node in hands):
                found[relation, node, rows].append(number)
        self.heaps = tuple(
            Heap(rows, node, relation == "INSIDE", tuple(things))
            if relation != HOLDS
            else Heap(rows, -1, False, tuple(things), hands.index(node))
            for (relation, node, rows), things in found.items()
        )
        self._legs: dict[tuple[int, int, int], tuple[int, int]] = {}
        self._trips: dict[tuple[int, int], int] = {}

    def leg(self, who: int, cell: int, node: int) -> tuple[int, int]:
        """Ticks of a walk, and the cell at which it ends."""
        key = who, cell, node
        if key not in self._legs:
            metres, end = self._ways[who].leg(cell, node)
            near = max(0.0, metres - SHORT) / self._ways[who].stride
            self._legs[key] = math.ceil(near) if math.isfinite(near) else FAR, end
        return self._legs[key]

    def after(self, who: int, cell: int, node: int, ticks: float) -> int:
        """Return the cell of an agent some ticks after setting out for a node."""
        return self._ways[who].after(cell, node, ticks * self._ways[who].stride)

    @cached_property
    def targets(self) -> tuple[tuple[int, bool], ...]:
        """Return the furniture of each row, and whether things go inside it."""
        pairs = zip(self.space.targets.tolist(), self.space.relations, strict=True)
        return tuple((node, name == "INSIDE") for node, name in pairs)

    def round_trip(self, number: int, row: int) -> int:
        """Ticks in which the one who is helped fetches something of a heap from where it is put for a row."""
        key = number, row
        if key not in self._trips:
            heap, node = self.heaps[number], self.targets[row][0]
            there, cell = self.leg(MAIN, self._ways[MAIN].end(node), heap.node)
            shut = heap.inside and self.shut >> heap.node & 1
            self._trips[key] = there + self.leg(MAIN, cell, node)[0] + 2 + 2 * shut
        return self._trips[key]
