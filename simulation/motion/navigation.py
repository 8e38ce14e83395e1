"""Navigation: shortest free paths, base poses for things, and other characters as obstacles (thesis 2.3.1, 2.4.1)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hearth.homes.plans.floor import Floor
from hearth.schemas.graph import Box, Spot

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


BODY_RADIUS = 0.25
"""Metres around a character that others keep out of."""

REACH = 0.9
"""Metres from a thing's edge within which it can be handled."""


class Pose(NamedTuple):
    """Where someone stands and looks: metres, and degrees about y from +z."""

    x: float
    z: float
    yaw: float = 0.0

    @property
    def point(self) -> Spot:
        """The position alone."""
        return (self.x, self.z)

    def towards(self, point: Spot) -> Pose:
        """The same place, looking at a point."""
        if math.dist(self.point, point) < 1e-9:
            return self
        return Pose(self.x, self.z, heading(self.point, point))


class Ways:
    """The walkable cells of a floor as a graph of eight neighbours; made once a floor."""

    def __init__(self, floor: Floor) -> None:
        self.floor = floor
        self.cells = np.argwhere(floor.walkable)
        self.number = np.full(floor.walkable.shape, -1, np.int64)
        self.number[floor.walkable] = np.arange(len(self.cells))
        self.points = np.asarray(floor.origin) + (self.cells + 0.5) * floor.cell

    @cached_property
    def graph(self) -> csr_matrix:
        """Distances between neighbouring cells, metres; a diagonal needs both its sides free."""
        from scipy.sparse import csr_matrix

        sources, targets, lengths = [], [], []
        padded = np.pad(self.number, 1, constant_values=-1)
        inner = padded[1:-1, 1:-1]
        for dx, dz in ((1, 0), (0, 1), (1, 1), (1, -1)):
            other = padded[1 + dx : padded.shape[0] - 1 + dx, 1 + dz : padded.shape[1] - 1 + dz]
            both = (inner >= 0) & (other >= 0)
            if dx and dz:
                both &= padded[1 + dx : padded.shape[0] - 1 + dx, 1:-1] >= 0
                both &= padded[1:-1, 1 + dz : padded.shape[1] - 1 + dz] >= 0
            sources.append(inner[both])
            targets.append(other[both])
            lengths.append(np.full(both.sum(), math.hypot(dx, dz) * self.floor.cell))
        size = len(self.cells)
        data = (np.concatenate(lengths), (np.concatenate(sources), np.concatenate(targets)))
        return csr_matrix(data, shape=(size, size))

    def nearest(self, point: Spot, blocked: np.ndarray | None = None) -> int:
        """Number of the walkable cell nearest to a point, or -1 when there is none."""
        distance = np.hypot(*(self.points - point).T)
        if blocked is not None:
            distance[blocked] = np.inf
        best = int(distance.argmin()) if len(distance) else -1
        return best if best >= 0 and np.isfinite(distance[best]) else -1

    def blocked(self, others: Sequence[Spot]) -> np.ndarray:
        """Bool by cell: where other characters stand in the way."""
        taken = np.zeros(len(self.cells), bool)
        for other in others:
            taken |= np.hypot(*(self.points - other).T) < 2 * BODY_RADIUS
        return taken

    def path(self, start: Spot, goal: Spot, others: Sequence[Spot] = ()) -> tuple[Spot, ...] | None:
        """The shortest free path, as points a cell apart, from the cell of `start` to the one nearest to `goal`.

        Args:
            start, goal: metres; each is taken to the nearest walkable cell.
            others: where other characters stand; their cells are not free.

        Returns:
            The points, or None when no path leads there.
        """
        from scipy.sparse.csgraph import dijkstra

        taken = self.blocked(others)
        first, last = self.nearest(start), self.nearest(goal, taken)
        if first < 0 or last < 0:
            return None
        taken[first] = False
        graph = self._without(taken) if taken.any() else self.graph
        _, before = dijkstra(graph, directed=False, indices=first, return_predecessors=True)
        numbers = [last]
        while numbers[-1] != first:
            previous = int(before[numbers[-1]])
            if previous < 0:
                return None
            numbers.append(previous)
        return tuple((float(x), float(z)) for x, z in self.points[numbers[::-1]])

    def _without(self, taken: np.ndarray) -> csr_matrix:
        from scipy.sparse import diags

        free = diags((~taken).astype(float))
        kept = (free @ self.graph @ free).tocsr()
        kept.eliminate_zeros()
        return kept

    def stand(self, box: Box, yaw: float | None, others: Sequence[Spot] = (), seed: Spot | None = None) -> Pose | None:
        """Where to stand for a thing, looking at it: the free cell nearest to its front, or, where it has no front, to
        who comes.

        Args:
            box: the thing's box.
            yaw: the way it faces, if it has a front.
            others: other characters, who keep their places.
            seed: where the character comes from.

        Returns:
            The pose, or None when no free cell lies within reach.
        """
        middle = (box.center[0], box.center[2])
        goal = _front(box, yaw) if yaw is not None else _edge_towards(box, seed or middle)
        cell = self.nearest(goal, self.blocked(others))
        if cell < 0:
            return None
        pose = Pose(float(self.points[cell][0]), float(self.points[cell][1])).towards(middle)
        return pose if distance_to(box, pose.point) <= REACH else None


def heading(start: Spot, end: Spot) -> float:
    """Degrees about y, from +z towards +x, of the look from one point to another, in [0, 360)."""
    return math.degrees(math.atan2(end[0] - start[0], end[1] - start[1])) % 360


def distance_to(box: Box, point: Spot) -> float:
    """Metres over the floor from a point to a box's edge; 0 within it."""
    dx = max(abs(point[0] - box.center[0]) - box.size[0] / 2, 0.0)
    dz = max(abs(point[1] - box.center[2]) - box.size[2] / 2, 0.0)
    return math.hypot(dx, dz)


def along(path: Sequence[Spot], stride: float) -> Spot:
    """The point `stride` metres along a path, or its end."""
    left = stride
    for here, there in pairwise(path):
        length = math.dist(here, there)
        if length >= left:
            part = left / length
            return (here[0] + (there[0] - here[0]) * part, here[1] + (there[1] - here[1]) * part)
        left -= length
    return path[-1]


def length(path: Sequence[Spot]) -> float:
    """Metres of a path."""
    return sum(math.dist(here, there) for here, there in pairwise(path))


def _front(box: Box, yaw: float) -> Spot:
    angle = math.radians(yaw)
    out = max(box.size[0] * abs(math.sin(angle)), box.size[2] * abs(math.cos(angle))) / 2 + BODY_RADIUS
    return (box.center[0] + math.sin(angle) * out, box.center[2] + math.cos(angle) * out)


def _edge_towards(box: Box, point: Spot) -> Spot:
    """The point of a box's outline nearest to another point."""
    x = min(max(point[0], box.center[0] - box.size[0] / 2), box.center[0] + box.size[0] / 2)
    z = min(max(point[1], box.center[2] - box.size[2] / 2), box.center[2] + box.size[2] / 2)
    return (x, z)
