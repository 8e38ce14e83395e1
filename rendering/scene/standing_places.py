"""The floor people can stand on, and where one stands to use a thing."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import cos, radians, sin
from random import Random

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.schemas.graph import Box, Node, Spot

CELL = 0.1
BODY = 2
"""Cells that a standing person needs on each side of the middle one."""
HEADROOM = 1.7
STEP_OVER = 0.06
IGNORED = frozenset({"floor", "ceiling", "mat", "carpet", "doorjamb", "window", "curtain", "blinds", "doormat"})
"""Classes one walks on, through or past."""

NEAR, FAR = 0.32, 1.1
"""Metres from a thing at which one likes to stand, and at which one can hardly use it."""

SIDE = 0.26
"""Metres from a person's middle within which a door touches it."""


def nothing(node: int) -> Floats:
    """What passes over the floor while a thing without doors opens."""
    return np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class Ground:
    """Cells of a home's floor.

    Attributes:
        origin: (x, z) of the first cell's corner.
        centers: (n, 2) x and z of the cells one can stand on, row by row.
        rooms: (n,) id of the room each lies in.
        level: height of the floor.
        sweeps: gives, for a node's id, (n, 2) x and z of what its doors or drawers pass over.
    """

    origin: Spot
    centers: NDArray[np.float64]
    rooms: NDArray[np.int64]
    level: float
    sweeps: Callable[[int], Floats] = nothing

    @classmethod
    def of(cls, rooms: Iterable[Node], nodes: Iterable[Node], sweeps: Callable[[int], Floats] = nothing) -> Ground:
        """The free floor of rooms with boxes, between things with boxes."""
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
        return cls((low[0], low[2]), centers, inside[i, j], low[1], sweeps)

    def spot_in(self, room: int, taken: Iterable[Spot] = ()) -> Spot | None:
        """Where one stands in a room: the free place nearest to the middle of its free floor."""
        mine = self.centers[self.rooms == room]
        if not len(mine):
            return None
        cost = np.linalg.norm(mine - mine.mean(axis=0), axis=1) + _crowding(mine, taken)
        x, z = mine[int(cost.argmin())]
        return float(x), float(z)

    def any_in(self, room: int, numbers: Random, taken: Iterable[Spot] = ()) -> Spot | None:
        """A free place of a room by chance, not where others are."""
        mine = self.centers[self.rooms == room]
        mine = mine[_crowding(mine, taken) == 0]
        if not len(mine):
            return None
        x, z = mine[numbers.randrange(len(mine))]
        return float(x), float(z)

    def spot_for(
        self, box: Box, yaw: float | None, room: int, now: Spot | None, taken: Iterable[Spot] = (), opens: int = 0
    ) -> Spot | None:
        """Where one stands to use a thing: near it, before its front if it has one, not far from where one is.

        Args:
            box: the thing's.
            yaw: the way it faces; None for things without a front.
            room: only there.
            now: where one is.
            taken: where others are.
            opens: the node whose doors pass beside one: the thing's, or that of what it is in.
        """
        mine = self.centers[self.rooms == room]
        if not len(mine):
            return None
        middle, half = np.array((box.center[0], box.center[2])), np.array((box.size[0], box.size[2])) / 2
        offset = mine - middle
        gap = np.linalg.norm(np.maximum(np.abs(offset) - half, 0), axis=1)
        cost = np.where(gap < NEAR, (NEAR - gap) * 1.5, (gap - NEAR) * 2.0) + np.where(gap > FAR, 4.0, 0.0)
        if yaw is not None:
            front = np.array((sin(radians(yaw)), cos(radians(yaw))))
            way = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-6)
            cost += (1 - way @ front) * 0.9
            # Straight before it rather than aslant.
            cost += np.maximum(np.abs(offset @ np.array((front[1], -front[0]))) - 0.2, 0) * 0.6
        if now is not None:
            cost += np.linalg.norm(mine - np.array(now), axis=1) * 0.08
        x, z = mine[int((cost + _crowding(mine, taken) + self._hit(mine, opens)).argmin())]
        return float(x), float(z)

    def _hit(self, centers: NDArray[np.float64], opens: int) -> NDArray[np.float64]:
        """A cost for standing where a door would hit one."""
        passed = self.sweeps(opens)
        if not len(passed):
            return np.zeros(len(centers))
        near = np.linalg.norm(centers[:, None] - passed, axis=2).min(axis=1) < SIDE
        return np.where(near, 2.0, 0.0)


def is_in_the_way(node: Node, floor: float) -> bool:
    """Whether a thing with a box keeps people from where it stands, on a floor of that height."""
    assert node.box is not None
    low, high = node.box.center[1] - node.box.size[1] / 2 - floor, node.box.center[1] + node.box.size[1] / 2 - floor
    return node.class_name not in IGNORED and low < HEADROOM and high > STEP_OVER and node.category not in (
        "Rooms", "Characters", "BodyParts"
    )  # fmt: skip


def cells_of(box: Box, origin: Spot) -> tuple[slice, slice]:
    """Cells whose middle lies in a box."""

    def part(center: float, size: float, start: float) -> slice:
        first = int(np.ceil((center - size / 2 - start) / CELL - 0.5))
        last = int(np.floor((center + size / 2 - start) / CELL - 0.5)) + 1
        return slice(max(first, 0), max(last, 0))

    return part(box.center[0], box.size[0], origin[0]), part(box.center[2], box.size[2], origin[1])


def eroded(free: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells with `BODY` free cells on every side."""
    padded = np.pad(free, BODY)
    kept = free.copy()
    for i in range(-BODY, BODY + 1):
        for j in range(-BODY, BODY + 1):
            if i * i + j * j <= BODY * BODY + 1:
                kept &= padded[BODY + i : BODY + i + free.shape[0], BODY + j : BODY + j + free.shape[1]]
    return kept


def _crowding(centers: NDArray[np.float64], taken: Iterable[Spot]) -> NDArray[np.float64]:
    """A cost for standing where others are."""
    cost = np.zeros(len(centers))
    for spot in taken:
        cost += np.where(np.linalg.norm(centers - np.array(spot), axis=1) < 0.55, 5.0, 0.0)
    return cost
