"""Routes of walks: the walkable floor of a graph with boxes, and straightened paths over it."""

from collections.abc import Iterable, Sequence

import numpy as np

from hearth.homes.plans.floor import Floor
from hearth.rendering.scene.standing_places import CELL, IGNORED, cells_of, eroded, is_in_the_way
from hearth.schemas.graph import Box, Node, Spot
from hearth.simulation.motion.navigation import Ways

DOORS = frozenset({"door", "maindoor", "balcony_door"})
"""Classes of doors."""


def ways_of(rooms: Iterable[Node], nodes: Sequence[Node]) -> Ways | None:
    """The free floor of rooms and doorways; None for rooms without boxes."""
    boxes = [room.box for room in rooms if room.box]
    if not boxes:
        return None
    low = [min(box.center[axis] - box.size[axis] / 2 for box in boxes) - 2 * CELL for axis in range(3)]
    high = [max(box.center[axis] + box.size[axis] / 2 for box in boxes) + 2 * CELL for axis in range(3)]
    origin = (low[0], low[2])
    free = np.zeros((int((high[0] - low[0]) / CELL) + 1, int((high[2] - low[2]) / CELL) + 1), np.bool_)
    for box in [*boxes, *(_deeper(node.box) for node in nodes if node.class_name == "doorjamb" and node.box)]:
        free[cells_of(box, origin)] = True
    floor = low[1] + 2 * CELL
    for node in nodes:
        if node.box and node.class_name not in DOORS and node.class_name not in IGNORED and is_in_the_way(node, floor):
            free[cells_of(node.box, origin)] = False
    walkable = eroded(free)
    return Ways(Floor(origin, CELL, free, walkable, np.where(free, 0, -1).astype(np.int16)))


def _deeper(jamb: Box) -> Box:
    """A doorway extended into both rooms."""
    (w, h, d), more = jamb.size, 2 * CELL
    return Box(jamb.center, (w + more, h, d) if w < d else (w, h, d + more))


def path(ways: Ways | None, start: Spot, goal: Spot, others: Sequence[Spot] = ()) -> tuple[Spot, ...]:
    """A path with few corners from start to goal; a straight line without a walkable path."""
    found = ways.path(start, goal, others) if ways else None
    if not found or ways is None:
        return start, goal
    points = [start, *found[1:-1], goal]
    kept = [points[0]]
    k = 0
    while k < len(points) - 1:
        ahead = len(points) - 1
        while ahead > k + 1 and not _clear(ways, points[k], points[ahead]):
            ahead -= 1
        kept.append(points[ahead])
        k = ahead
    return tuple(kept)


def _clear(ways: Ways, a: Spot, b: Spot) -> bool:
    """Whether the straight line is walkable; ends close to furniture are ignored."""
    floor = ways.floor
    distance = float(np.hypot(b[0] - a[0], b[1] - a[1]))
    for step in np.arange(0.25, max(distance - 0.25, 0.26), CELL / 2):
        share = min(step / max(distance, 1e-9), 1.0)
        i, j = floor.index(a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share)
        if not (0 <= i < floor.walkable.shape[0] and 0 <= j < floor.walkable.shape[1] and floor.walkable[i, j]):
            return False
    return True
