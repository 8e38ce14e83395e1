"""Likely positions of the things of a graph's room, from CLOSE edges alone: a first guess for furnishing.

Steps along CLOSE are distances, and distances are a map (classical multidimensional scaling), which is then turned and
stretched so that it fills the room's floor, doors to where the doors are.
"""

from collections.abc import Iterator, Mapping
from math import cos, radians, sin

import numpy as np

from hearth.homes.from_graph.rooms_and_supports import Parts
from hearth.homes.geometry import Rect
from hearth.homes.object_shapes import form
from hearth.homes.plans.home_shell import Thing, interior
from hearth.homes.plans.plan import Plan
from hearth.schemas.graph import Box

TURN = 5
"""Degrees between the ways that a map is turned."""
FEW = 4
"""A room with fewer things has no map."""


def guessed(parts: Parts, plan: Plan, doors: Mapping[int, Thing]) -> dict[int, Thing]:
    """Things and panels of every room about where they may be, by node id; what is CLOSE to nothing is left out.

    Args:
        parts: the graph.
        plan: its rooms.
        doors: rooms, and the doors that have their place.
    """
    found: dict[int, Thing] = {}
    for node, room in zip(parts.rooms, plan.rooms, strict=True):
        members = [n for n, r in parts.room.items() if r == node and n not in parts.rooms and n in parts.near]
        anchors = _anchors(parts, node, members, doors)
        if len(members) < FEW:
            continue
        inner = interior(room)
        guesses = _placements(_map(parts, members), inner)
        places = min(guesses, key=lambda guess: _misfit(guess, members, anchors))
        for member, (x, z) in zip(members, places.tolist(), strict=True):
            if member not in doors:
                found[member] = _guess(parts, member, room.name, x, z)
    return found


def _guess(parts: Parts, node: int, room: str, x: float, z: float) -> Thing:
    name = parts.nodes[node].class_name
    shaped = form(name, parts.knowledge)
    width, height, depth = shaped.size if shaped else (0.5, 0.5, 0.5)
    side = min(width, depth) if name not in ("floor", "ceiling", "wall") else 1.0
    return Thing(str(node), name, room, Box((x, height / 2, z), (side, height, side)), None, "item")


def _anchors(parts: Parts, room: int, members: list[int], doors: Mapping[int, Thing]) -> dict[int, tuple[float, float]]:
    """Return where some of the members should be.

    Doors are at their holes, and things CLOSE to another room are on its side.
    """
    found = {}
    for node in members:
        beyond = [doors[parts.room[n]] for n in parts.near[node] if parts.room.get(n, room) != room]
        places = [doors[node]] if node in doors else beyond
        if places:
            found[node] = (sum(t.box.center[0] for t in places) / len(places),
                           sum(t.box.center[2] for t in places) / len(places))  # fmt: skip
    return found


def _map(parts: Parts, members: list[int]) -> np.ndarray:
    """Coordinates (members, 2) whose distances are about as many steps as CLOSE takes between them."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import shortest_path

    number = {node: k for k, node in enumerate(members)}
    pairs = [(number[a], number[b]) for a in members for b in parts.near[a] if b in number]
    rows, columns = np.array(pairs, int).reshape(-1, 2).T
    steps = shortest_path(csr_array((np.ones(len(rows)), (rows, columns)), (len(members),) * 2), unweighted=True,
                          directed=False)  # fmt: skip
    steps[~np.isfinite(steps)] = steps[np.isfinite(steps)].max() + 1
    squared = steps**2
    centred = squared - squared.mean(axis=0) - squared.mean(axis=1)[:, None] + squared.mean()
    values, vectors = np.linalg.eigh(-centred / 2)
    found = np.asarray(vectors[:, -2:] * np.sqrt(np.maximum(values[-2:], 0.0)))
    signs: np.ndarray = np.where(found[np.abs(found).argmax(axis=0), [0, 1]] < 0, -1.0, 1.0)
    return np.asarray(found * signs)


def _placements(points: np.ndarray, inner: Rect) -> Iterator[np.ndarray]:
    """Yield the map filling the floor, turned so that it does so best, in all eight ways round."""

    def turned(angle: float) -> np.ndarray:
        c, s = cos(radians(angle)), sin(radians(angle))
        return np.asarray(points @ np.array([[c, s], [-s, c]]))

    best = min((turned(angle) for angle in range(0, 90, TURN)), key=lambda p: float(np.prod(np.ptp(p, axis=0))))
    low, extent = best.min(axis=0), np.maximum(np.ptp(best, axis=0), 1e-6)
    unit = (best - low) / extent
    size = np.array([inner.width, inner.depth])
    for swap in (False, True):
        for flip in ((0, 0), (0, 1), (1, 0), (1, 1)):
            along = unit[:, ::-1] if swap else unit
            yield np.array([inner.x0, inner.z0]) + np.abs(np.array(flip) - along) * size


def _misfit(places: np.ndarray, members: list[int], anchors: Mapping[int, tuple[float, float]]) -> float:
    known = [k for k, node in enumerate(members) if node in anchors]
    wanted = np.array([anchors[members[k]] for k in known], float).reshape(-1, 2)
    return round(float(np.hypot(*(places[known] - wanted).T).sum()), 6)
