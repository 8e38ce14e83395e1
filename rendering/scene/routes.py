"""Routes of walks: the walkable floor of a graph with boxes, and straightened paths over it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import dist

import numpy as np
from numpy.typing import NDArray

from hearth.homes.plans import grid_shapes
from hearth.homes.plans.walkable_floor import Floor, check_extent
from hearth.rendering.arrays import Floats
from hearth.rendering.scene.floor_cells import BODY, CELL, cells_of, eroded, is_in_the_way
from hearth.rendering.scene.room_shell import hung_doors
from hearth.schemas.graph import Box, Node, Spot
from hearth.simulation.motion.navigation import Ways

STEPPED_OVER = 0.25
"""Height in metres up to which things that one can carry do not block a walk, such as a pillow on the floor."""

NARROW = 1
"""Cells that a character needs on each side of the middle one where it squeezes through."""

FARTHEST = 1.6
"""Metres within which a walk enters or leaves the walkable floor, such as from a seat at a table."""

AMONG = 60
"""Cells that are tried for that."""

Cells = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class WalkableFloor:
    """The floor on which characters walk.

    Attributes:
        free: bool, (columns, rows): where nothing stands.
        roomy: those with space around for a body and its arms.
        wide: those with space for a body.
        narrow: those with space to squeeze through.
    """

    free: Cells
    roomy: Cells
    wide: Ways
    narrow: Ways

    @cached_property
    def tight(self) -> Ways:
        """All cells where nothing stands, however near something is."""
        return Ways(replace(self.wide.floor, walkable=self.free))

    @cached_property
    def every(self) -> Ways:
        """All cells, whatever stands there."""
        return Ways(replace(self.wide.floor, walkable=np.ones_like(self.free)))

    @cached_property
    def regions(self) -> NDArray[np.int32]:
        """(columns, rows): cells of `narrow` that join share a number from 1; others are 0."""
        return grid_shapes.regions(self.narrow.floor.walkable)

    def region(self, spot: Spot) -> int:
        """Return the number of the region from which one comes to a spot; 0 for none."""
        entry = self.entry(self.narrow, spot)
        return 0 if entry is None else int(self.regions[self.narrow.floor.index(*entry)])

    def regions_at(self, points: NDArray[np.float64]) -> NDArray[np.int32]:
        """(n,) the numbers of the regions of (n, 2) points; 0 for none."""
        index = ((points - self.narrow.floor.origin) // CELL).astype(int).clip(0, np.array(self.regions.shape) - 1)
        found: NDArray[np.int32] = self.regions[tuple(index.T)]
        return found

    def blocked(self, a: Spot, b: Spot) -> Cells:
        """(n,) whether something stands at points, half a cell apart, on the line from a to b."""
        shares = np.linspace(0, 1, max(2, int(np.ceil(dist(a, b) / CELL * 2)) + 1))
        return ~self._at(self.free, np.asarray(a) + shares[:, None] * (np.asarray(b) - np.asarray(a)))

    def clear(self, a: Spot, b: Spot, ways: Ways) -> bool:
        """Return whether the straight line is walkable."""
        shares = np.linspace(0, 1, max(2, int(np.ceil(dist(a, b) / CELL * 2)) + 1))
        points = np.asarray(a) + shares[:, None] * (np.asarray(b) - np.asarray(a))
        return bool(self._at(ways.floor.walkable, points).all())

    def has_room(self, spot: Spot) -> bool:
        """Return whether there is room for a body and its arms."""
        return bool(self._at(self.roomy, np.array([spot]))[0])

    def _at(self, cells: Cells, points: NDArray[np.float64]) -> Cells:
        index = ((points - self.wide.floor.origin) // CELL).astype(int)
        inside = ((index >= 0) & (index < cells.shape)).all(axis=1)
        found = np.zeros(len(points), np.bool_)
        found[inside] = cells[tuple(index[inside].T)]
        return found

    def entry(self, ways: Ways, spot: Spot) -> Spot | None:
        """Return the walkable point from which one comes straight to a spot, which may be in a seat, but through
        nothing else; None if there is none.
        """
        far = np.hypot(*(ways.points - spot).T)
        best: tuple[float, Spot] | None = None
        for number in np.argsort(far, kind="stable")[:AMONG].tolist():
            if far[number] > FARTHEST or (best is not None and far[number] >= best[0]):
                break
            point = (float(ways.points[number, 0]), float(ways.points[number, 1]))
            blocked = self.blocked(spot, point)
            # Once outside what the spot is in, nothing else may be in the way.
            if blocked[: int(blocked.sum())].all():
                cost = float(far[number]) + CELL * float(blocked.sum())
                best = min(best or (cost, point), (cost, point))
        return best[1] if best else None


def ways_of(rooms: Iterable[Node], nodes: Sequence[Node], leaves: Floats | None = None) -> WalkableFloor | None:
    """Return the walkable floor of rooms and doorways; None for rooms without boxes.

    Args:
        rooms: with boxes.
        nodes: everything, as it stands now.
        leaves: (n, 2) x and z of further points in the way, such as open doors of cupboards.
    """
    boxes = [room.box for room in rooms if room.box]
    if not boxes:
        return None
    low = [min(box.center[axis] - box.size[axis] / 2 for box in boxes) - 2 * CELL for axis in range(3)]
    high = [max(box.center[axis] + box.size[axis] / 2 for box in boxes) + 2 * CELL for axis in range(3)]
    check_extent(high[0] - low[0] - 4 * CELL, high[2] - low[2] - 4 * CELL)
    origin = (low[0], low[2])
    free = np.zeros((int((high[0] - low[0]) / CELL) + 1, int((high[2] - low[2]) / CELL) + 1), np.bool_)
    for box in [*boxes, *(_deeper(node.box) for node in nodes if node.class_name == "doorjamb" and node.box)]:
        free[cells_of(box, origin)] = True
    # Open leaves are in the way; closed ones are opened, or passed where the rules ignore doors.
    hung = hung_doors(nodes)
    for node in nodes:
        if node.box and (node.id not in hung or "OPEN" in node.states) and blocks_walks(node, low[1] + 2 * CELL):
            free[cells_of(_thick(node.box), origin)] = False
    for i, j in ((np.zeros((0, 2)) if leaves is None else leaves - origin) // CELL).astype(int):
        if 0 <= i < free.shape[0] and 0 <= j < free.shape[1]:
            free[i, j] = False

    def ways(walkable: Cells) -> Ways:
        return Ways(Floor(origin, CELL, free, walkable, np.where(free, 0, -1).astype(np.int16)))

    return WalkableFloor(free, eroded(free, BODY + 1), ways(eroded(free)), ways(eroded(free, NARROW)))


def blocks_walks(node: Node, floor: float) -> bool:
    """Return whether one walks around a thing."""
    assert node.box is not None
    top = node.box.center[1] + node.box.size[1] / 2 - floor
    return is_in_the_way(node, floor) and not ("GRABBABLE" in node.properties and top < STEPPED_OVER)


def _thick(box: Box) -> Box:
    """Return a box at least a cell wide and deep, so that it takes up cells."""
    (w, h, d) = box.size
    return Box(box.center, (max(w, CELL), h, max(d, CELL)))


def _deeper(jamb: Box) -> Box:
    """Return a doorway extended into both rooms."""
    (w, h, d), more = jamb.size, 2 * CELL
    return Box(jamb.center, (w + more, h, d) if w < d else (w, h, d + more))


def path(floor: WalkableFloor | None, start: Spot, goal: Spot, others: Sequence[Spot] = ()) -> tuple[Spot, ...]:
    """Return a path with few corners from start to goal.

    It keeps a body's width from things where it can, and squeezes through where it must. Where no way leads to the
    goal, it ends at the walkable point nearest to it; without a floor it is the straight line.
    """
    if floor is None or dist(start, goal) < CELL / 2:
        return start, goal
    for ways in (floor.wide, floor.narrow):
        found = _found(floor, ways, start, goal, others)
        if found is not None:
            return found
    return _nearest(floor, start, goal)


def led_on(floor: WalkableFloor | None, route: Sequence[Spot], goal: Spot) -> tuple[Spot, ...]:
    """Return a route that may end before its goal, led on to it.

    Where the world has a character that no drawn way leads to, such as next to an open oven, the way passes between the
    things, however near they are. Where things or walls are all around, the way is the one that leads through them for
    the fewest metres. Only where no floor is known, the rest is the straight line.
    """
    if dist(route[-1], goal) < SAME:
        return tuple(route)
    if floor is None:
        return (*route, goal)
    found = _found(floor, floor.tight, route[-1], goal, ()) or _through_least(floor, route[-1], goal)
    return (*route, *found[1:])


def _through_least(floor: WalkableFloor, start: Spot, goal: Spot) -> tuple[Spot, ...]:
    """Return the path that leads through things for the fewest metres."""
    from scipy.sparse import csr_matrix
    from scipy.sparse.csgraph import dijkstra

    every = floor.every
    ones, others, lengths = every.edges
    taken = ~floor.free[tuple(every.cells.T)]
    costs = lengths * (1 + THROUGH * (taken[ones].astype(float) + taken[others]))
    graph = csr_matrix((costs, (ones, others)), shape=(len(taken),) * 2)
    first, last = (int(np.hypot(*(every.points - spot).T).argmin()) for spot in (start, goal))
    _, before = dijkstra(graph, directed=False, indices=first, return_predecessors=True)
    numbers = [last]
    while numbers[-1] != first:
        numbers.append(int(before[numbers[-1]]))
    points = [(float(x), float(z)) for x, z in every.points[numbers[::-1]]]
    return start, *_straightened(floor, floor.tight, points), goal


THROUGH = 50.0
"""Metres of detour that a metre through something is worth, from each of the two cells between which one steps."""


SAME = 0.01
"""Metres up to which two spots are one."""


def _found(
    floor: WalkableFloor, ways: Ways, start: Spot, goal: Spot, others: Sequence[Spot]
) -> tuple[Spot, ...] | None:
    """Return the path over some cells from where one comes onto the floor to where one leaves it.

    None if there is none.
    """
    if floor.clear(start, goal, ways):
        return start, goal
    first, last = floor.entry(ways, start), floor.entry(ways, goal)
    found = ways.path(first, last, others) if first and last else None
    if not found:
        return None
    corners = _straightened(floor, ways, found)
    for k in range(1, len(corners) - 1):
        corners[k] = _roomier(floor, ways, corners[k - 1], corners[k], corners[k + 1])
    return (start, *corners, goal)


def _roomier(floor: WalkableFloor, ways: Ways, before: Spot, corner: Spot, after: Spot) -> Spot:
    """Return a point next to a corner of a path with room for arms, if the path can lead over it."""
    for x, z in BESIDE:
        point = corner[0] + x, corner[1] + z
        if floor.has_room(point) and floor.clear(before, point, ways) and floor.clear(point, after, ways):
            return point
    return corner


BESIDE = sorted(
    ((x * CELL, z * CELL) for x in range(-2, 3) for z in range(-2, 3)), key=lambda at: (at[0] ** 2 + at[1] ** 2, at)
)
"""From a corner to the points that are tried instead, nearest first."""


def _nearest(floor: WalkableFloor, start: Spot, goal: Spot) -> tuple[Spot, ...]:
    """Return the path to the point nearest to the goal that can be reached; the start alone if it cannot be left."""
    ways = floor.narrow
    region = floor.region(start)
    if not region:
        return start, start
    mine = np.flatnonzero(floor.regions[floor.narrow.floor.walkable] == region)
    x, z = ways.points[mine[np.hypot(*(ways.points[mine] - goal).T).argmin()]]
    return _found(floor, ways, start, (float(x), float(z)), ()) or (start, start)


def _straightened(floor: WalkableFloor, ways: Ways, points: Sequence[Spot]) -> list[Spot]:
    """Return the corners of a path over neighbouring cells."""
    kept, k = [points[0]], 0
    while k < len(points) - 1:
        ahead = len(points) - 1
        while ahead > k + 1 and not floor.clear(points[k], points[ahead], ways):
            ahead -= 1
        kept.append(points[ahead])
        k = ahead
    return kept
