"""Free floor, and positions from which objects are used."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from math import cos, radians, sin
from random import Random

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.scene.floor_cells import CELL, cells_of, eroded, is_in_the_way
from hearth.rendering.scene.routes import WalkableFloor
from hearth.schemas.graph import Box, Node, Spot

NEAR, FAR = 0.32, 1.1
"""Preferred distance from an object, and distance from which it is hard to use, metres."""

HIGH, NEAR_HIGH = 1.0, 0.46
"""Metres above the floor of things such as switches, which arms reach straight ahead, and the distance from them."""

SIDE = 0.26
"""Metres from a character's middle within which a door touches it."""


AHEAD, CLOSE, TURN = 2.0, 0.9, 30
"""Length of floor that matters ahead of a reader, largest distance that counts as close, metres.

And angle between directions, degrees.
"""

APART = 0.19
"""Metres between spots among which one chooses."""


def nothing(node: int) -> Floats:
    """Return the empty swept area of a thing without doors."""
    return np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class FreeFloor:
    """Cells of a home's free floor.

    Attributes:
        origin: (x, z) of the first cell's corner.
        centers: (n, 2) x and z of the cells where a character can stand, row by row.
        rooms: (n,) id of each cell's room.
        level: height of the floor.
        sweeps: node id -> (n, 2) x and z of the floor that its doors or drawers sweep.
        leaves: node id -> (n, 2) x and z of the floor below its doors or drawers if they stand open.
        walkable: the floor over which one comes to them, if known.
    """

    origin: Spot
    centers: NDArray[np.float64]
    rooms: NDArray[np.int64]
    level: float
    sweeps: Callable[[int], Floats] = nothing
    walkable: WalkableFloor | None = None
    leaves: Callable[[int], Floats] = nothing

    @classmethod
    def of(
        cls,
        rooms: Iterable[Node],
        nodes: Iterable[Node],
        sweeps: Callable[[int], Floats] = nothing,
        walkable: WalkableFloor | None = None,
        leaves: Callable[[int], Floats] = nothing,
    ) -> FreeFloor:
        """Return the free floor of rooms between things; both have boxes."""
        known = [(room.id, room.box) for room in rooms if room.box]
        if not known:
            return cls((0.0, 0.0), np.zeros((0, 2)), np.zeros(0, np.int64), 0.0)
        low = [min(box.center[axis] - box.size[axis] / 2 for _, box in known) for axis in range(3)]
        high = [max(box.center[axis] + box.size[axis] / 2 for _, box in known) for axis in range(3)]
        shape = (int((high[0] - low[0]) / CELL) + 1, int((high[2] - low[2]) / CELL) + 1)
        inside = np.full(shape, -1, np.int64)
        for number, box in known:
            inside[cells_of(box, (low[0], low[2]))] = number
        free = inside >= 0
        for node in nodes:
            if node.box and is_in_the_way(node, low[1]):
                free[cells_of(node.box, (low[0], low[2]))] = False
        free = eroded(free)
        i, j = np.nonzero(free)
        centers = np.column_stack((low[0] + (i + 0.5) * CELL, low[2] + (j + 0.5) * CELL))
        return cls((low[0], low[2]), centers, inside[i, j], low[1], sweeps, walkable, leaves)

    def reachable_from(self, spot: Spot) -> FreeFloor:
        """Return the part to which a way leads from a spot; all of it where that is unknown."""
        region = self.walkable.region(spot) if self.walkable else 0
        if self.walkable is None or not region:
            return self
        same = self.walkable.regions_at(self.centers) == region
        return replace(self, centers=self.centers[same], rooms=self.rooms[same]) if same.any() else self

    def spot_in(self, room: int, taken: Iterable[Spot] = ()) -> Spot | None:
        """Return the free spot nearest to the middle of a room's free floor."""
        mine = self.centers[self.rooms == room]
        if not len(mine):
            return None
        cost = np.linalg.norm(mine - mine.mean(axis=0), axis=1) + _crowding(mine, taken)
        x, z = mine[int(cost.argmin())]
        return float(x), float(z)

    def any_in(self, room: int, numbers: Random, taken: Iterable[Spot] = ()) -> Spot | None:
        """Return a random free spot of a room, away from other characters."""
        mine = self.centers[self.rooms == room]
        mine = mine[_crowding(mine, taken) == 0]
        if not len(mine):
            return None
        x, z = mine[numbers.randrange(len(mine))]
        return float(x), float(z)

    def spots_for(
        self,
        box: Box,
        yaw: float | None,
        room: int,
        now: Spot | None,
        taken: Iterable[Spot] = (),
        opens: int = 0,
        *,
        still: bool = False,
    ) -> Iterator[Spot]:
        """Spots for using an object, `APART` metres from each other, best first: near it, in front of it if it has a
        front, and close to `now`.

        Args:
            box: the object's.
            yaw: its direction; None for objects without a front.
            room: id of the room to stand in.
            now: the character's position.
            taken: positions of other characters.
            opens: the node whose doors may swing there: the object or its outermost container.
            still: whether its doors stay as they are.
        """
        # Where no way leads into the room, one comes as near as one can.
        mine = self.centers[self.rooms == room] if (self.rooms == room).any() else self.centers
        if not len(mine):
            return
        cost = _distances(mine, box, yaw, self.level) + _crowding(mine, taken) + self._hit(mine, opens, still)
        if now is not None:
            cost += np.linalg.norm(mine - np.array(now), axis=1) * 0.08
        while np.isfinite(cost).any():
            x, z = mine[int(cost.argmin())]
            yield float(x), float(z)
            cost[np.linalg.norm(mine - (x, z), axis=1) < APART] = np.inf

    def outlook(self, spot: Spot, yaw: float) -> float:
        """Return the direction in which to look about with something in the hands: `yaw`, unless something stands close
        there; then the nearest with the most floor ahead.
        """
        if self.walkable is None or self._ahead(spot, yaw) > CLOSE:
            return yaw
        turns = (turn * sign for turn in range(0, 181, TURN) for sign in (1, -1))
        return max((yaw + turn for turn in turns), key=lambda to: self._ahead(spot, to))

    def _ahead(self, spot: Spot, yaw: float) -> float:
        """Metres of free floor in a direction, as far as it matters."""
        assert self.walkable is not None
        end = spot[0] + AHEAD * sin(radians(yaw)), spot[1] + AHEAD * cos(radians(yaw))
        blocked = self.walkable.blocked(spot, end)
        return AHEAD * (int(blocked.argmax()) if blocked.any() else len(blocked)) / len(blocked)

    def in_the_way(self, spot: Spot, opens: int) -> bool:
        """Return whether a thing's doors or drawers would hit who stands at a spot."""
        return bool(self._hit(np.array([spot]), opens)[0])

    def _hit(self, centers: NDArray[np.float64], opens: int, still: bool = False) -> NDArray[np.float64]:
        """Return a cost for standing in the swept area of a door, or where it stands if it stays so."""
        passed = self.leaves(opens) if still else self.sweeps(opens)
        if not len(passed):
            return np.zeros(len(centers))
        near = np.linalg.norm(centers[:, None] - passed, axis=2).min(axis=1) < SIDE
        return np.where(near, 2.0, 0.0)


def _distances(centers: NDArray[np.float64], box: Box, yaw: float | None, level: float) -> NDArray[np.float64]:
    """Return a cost for standing far from an object, or not in front of it."""
    near = NEAR_HIGH if box.center[1] - level > HIGH else NEAR
    middle, half = np.array((box.center[0], box.center[2])), np.array((box.size[0], box.size[2])) / 2
    offset = centers - middle
    gap = np.linalg.norm(np.maximum(np.abs(offset) - half, 0), axis=1)
    cost: NDArray[np.float64] = np.where(gap < near, (near - gap) * 1.5, (gap - near) * 2.0)
    cost += np.where(gap > FAR, 4.0, 0.0)
    if yaw is not None:
        front = np.array((sin(radians(yaw)), cos(radians(yaw))))
        way = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-6)
        cost += (1 - way @ front) * 0.9
        # Prefer spots straight in front.
        cost += np.maximum(np.abs(offset @ np.array((front[1], -front[0]))) - 0.2, 0) * 0.6
    return cost


def _crowding(centers: NDArray[np.float64], taken: Iterable[Spot]) -> NDArray[np.float64]:
    """Return a cost for standing near other characters."""
    cost = np.zeros(len(centers))
    for spot in taken:
        cost += np.where(np.linalg.norm(centers - np.array(spot), axis=1) < 0.55, 5.0, 0.0)
    return cost
