"""Geometry -> edges: ON, INSIDE and BETWEEN from the plan, CLOSE from free distance, FACING from fronts and sight."""

from collections.abc import Iterator, Mapping, Sequence
from math import cos, radians, sin

import numpy as np

from hearth.homes.plans.home_shell import Thing
from hearth.schemas.graph import Box, Edge
from hearth.schemas.vocabulary import RELATION_ID, RELATIONS

CLOSE_WITHIN = 0.8
"""Metres of free space between two things that are CLOSE; chosen so that homes are as dense as the release's."""
VIEW = 60.0
"""A thing faces what lies at most this many degrees off the way its front points."""
SHOWN = 80.0
"""Largest angle between the front of a faced thing and the direction to the one that faces it, degrees."""
FAR = 7.0
"""Metres beyond which nothing is looked at."""
EYES = (1.1, 1.6)
"""Sight starts between these heights: those of someone sitting and standing."""
BLIND = ("ceiling", "flat", "door", "window")
"""Mounts of things that face nothing."""
TALL = ("floor", "wall", "door")
"""And how those are that may stand in the way of sight."""


def edges(things: Sequence[Thing], ids: Mapping[str, int], lookable: frozenset[str]) -> tuple[Edge, ...]:
    """All edges between things, sorted by source, relation and target.

    Args:
        things: rooms, everything in them, and the character.
        ids: node ids by the things' names.
        lookable: classes that one can look at: what things are FACING.
    """
    own = np.array([ids[thing.name] for thing in things], np.int64)
    tables = [np.array([(e.source, RELATION_ID[e.relation], e.target) for e in _given(things, ids)]).reshape(-1, 3)]
    for relation, pairs in (("CLOSE", close(things)), ("FACING", np.array([*facing(things, lookable)], int))):
        i, j = pairs.reshape(-1, 2).T
        tables.append(np.column_stack((own[i], np.full(len(i), RELATION_ID[relation]), own[j])))
    table = np.concatenate(tables).astype(np.int64)
    sources, numbers, targets = table[np.lexsort((table[:, 2], table[:, 1], table[:, 0]))].T.tolist()
    return tuple(map(Edge, sources, map(RELATIONS.__getitem__, numbers), targets))


def _given(things: Sequence[Thing], ids: Mapping[str, int]) -> Iterator[Edge]:
    """Yield the plan's own relations; everything is INSIDE its room as well."""
    for thing in things:
        me = ids[thing.name]
        if thing.on:
            yield Edge(me, "ON", ids[thing.on])
        if thing.inside:
            yield Edge(me, "INSIDE", ids[thing.inside])
        if thing.mount != "room":
            yield Edge(me, "INSIDE", ids[thing.room])
        # Where a door hangs it is the door that is between the rooms, as in the release, not its jamb.
        has_door = thing.class_name == "doorjamb" and thing.name.removesuffix("jamb") in ids
        for room in () if has_door else thing.between:
            yield Edge(me, "BETWEEN", ids[room])


def close(things: Sequence[Thing]) -> np.ndarray:
    """Pairs (pairs, 2) with at most `CLOSE_WITHIN` of free space between their boxes, both ways round.

    Walls part things of different rooms; doors and their jambs are near things of both. A container's sides part
    nothing: as in the release, the things in a dresser are near its neighbors.
    """
    found = [np.zeros((0, 2), np.int64)]
    doorway = np.array([bool(thing.between) for thing in things])
    for members in _rooms(things).values():
        boxes = [things[i].box for i in members]
        found.append(np.array(members)[_near(boxes) if len(boxes) <= MATRIX else np.array([*_swept(boxes)], int)])
    pairs = np.concatenate(found)
    # A door and its jamb meet in both rooms.
    both = doorway[pairs].all(axis=1)
    return np.concatenate((pairs[~both], np.unique(pairs[both], axis=0)))


MATRIX = 500
"""Boxes up to which all pairs are compared at once; with more, only those that are side by side from west to east."""


def _near(boxes: Sequence[Box]) -> np.ndarray:
    """Return the pairs (pairs, 2) of boxes that are close."""
    near = gaps(boxes, boxes) <= CLOSE_WITHIN + 1e-9
    np.fill_diagonal(near, False)
    return np.argwhere(near)


def _swept(boxes: Sequence[Box]) -> Iterator[tuple[int, int]]:
    """Yield the same pairs, by work in proportion to the boxes that overlap from west to east."""
    for one, others in _beside(boxes):
        for other in others:
            yield from ((one, other), (other, one))


def _beside(boxes: Sequence[Box]) -> Iterator[tuple[int, list[int]]]:
    """Yield boxes, each with those that are close and begin further east."""
    centers, halves = arrays(boxes)
    west = centers[:, 0] - halves[:, 0]
    order = np.argsort(west, kind="stable")
    ends = np.searchsorted(west[order], (centers + halves)[order, 0] + CLOSE_WITHIN + 1e-6, side="right")
    for place, (one, end) in enumerate(zip(order.tolist(), ends.tolist(), strict=True)):
        later = order[place + 1 : end]
        apart = np.abs(centers[later] - centers[one]) - (halves[later] + halves[one])
        near = np.sqrt((np.maximum(apart, 0.0) ** 2).sum(axis=1)) <= CLOSE_WITHIN + 1e-9
        yield one, later[near].tolist()


def many_close(things: Sequence[Thing], most: int) -> int:
    """Return how many CLOSE edges things have; the count ends soon after `most`."""
    count = 0
    for members in _rooms(things).values():
        for _, others in _beside([things[i].box for i in members]):
            count += 2 * len(others)
            if count > most:
                return count
    return count


def _rooms(things: Sequence[Thing]) -> dict[str, list[int]]:
    """Return the things of each room, doorways in both of theirs; rooms themselves are near nothing."""
    found: dict[str, list[int]] = {}
    for i, thing in enumerate(things):
        if thing.mount != "room":
            for room in dict.fromkeys((thing.room, *thing.between)):
                found.setdefault(room, []).append(i)
    return found


def gaps(ones: Sequence[Box], others: Sequence[Box]) -> np.ndarray:
    """Metres of free space (ones, others) between each of some boxes and each of others."""
    (centers, halves), (aims, sizes) = arrays(ones), arrays(others)
    apart = np.abs(centers[:, None] - aims[None]) - (halves[:, None] + sizes[None])
    found: np.ndarray = np.sqrt((np.maximum(apart, 0.0) ** 2).sum(axis=2))
    return found


def arrays(boxes: Sequence[Box]) -> tuple[np.ndarray, np.ndarray]:
    """Centres and half sizes, both of shape (boxes, 3)."""
    centers = np.array([box.center for box in boxes], float).reshape(-1, 3)
    return centers, np.array([box.size for box in boxes], float).reshape(-1, 3) / 2


def facing(things: Sequence[Thing], lookable: frozenset[str]) -> Iterator[tuple[int, int]]:
    """Pairs where the first turns its front to the second, which shows its own front, with nothing tall between.

    What is in a container neither looks nor is looked at.
    """
    rooms: dict[str, list[int]] = {}
    for i, thing in enumerate(things):
        if thing.mount not in ("room", "shell") and not thing.inside:
            rooms.setdefault(thing.room, []).append(i)
    for members in rooms.values():
        own = [things[i] for i in members]
        targets = [k for k, thing in enumerate(own) if thing.class_name in lookable]
        if targets:
            yield from ((members[i], members[j]) for i, j in _seen(own, targets))


def _seen(things: Sequence[Thing], targets: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Return which things of one room face which of its targets."""
    centers, _ = arrays([thing.box for thing in things])
    towards = centers[targets][None] - centers[:, None]
    distance = np.maximum(np.hypot(towards[..., 0], towards[..., 2]), 1e-9)
    fronts = np.array([direction(thing.yaw or 0.0) for thing in things])
    ahead = (towards[..., 0] * fronts[:, None, 0] + towards[..., 2] * fronts[:, None, 1]) / distance
    shows = fronts[targets]
    shown = -(towards[..., 0] * shows[None, :, 0] + towards[..., 2] * shows[None, :, 1]) / distance
    shown[:, [things[j].yaw is None for j in targets]] = 1.0
    looks = np.array([t.yaw is not None and t.mount not in BLIND for t in things])
    near = (distance > 0.05) & (distance <= FAR) & looks[:, None]
    pairs = np.argwhere(near & (ahead >= cos(radians(VIEW)) - 1e-9) & (shown >= cos(radians(SHOWN)) - 1e-9))
    if len(pairs):
        sources, aims = pairs[:, 0], np.array(targets)[pairs[:, 1]]
        free = ~_blocked(things, sources, aims)
        yield from zip(sources[free].tolist(), aims[free].tolist(), strict=True)


def direction(yaw: float) -> tuple[float, float]:
    """Return a yaw as a unit vector (x, z); exact for the four winds."""
    exact = {0.0: (0.0, 1.0), 90.0: (1.0, 0.0), 180.0: (0.0, -1.0), 270.0: (-1.0, 0.0)}
    return exact.get(yaw % 360) or (sin(radians(yaw)), cos(radians(yaw)))


def _blocked(things: Sequence[Thing], sources: np.ndarray, aims: np.ndarray) -> np.ndarray:
    """Return bool (pairs): a thing of size, other than the two and their supports, cuts the line of sight."""
    centers, halves = arrays([thing.box for thing in things])
    walls = np.array([k for k, thing in enumerate(things) if thing.mount in TALL], int)
    start = centers[sources].copy()
    start[:, 1] = np.clip(start[:, 1], *EYES)
    cut = _cuts(start, centers[aims], centers[walls] - halves[walls], centers[walls] + halves[walls])
    index = {thing.name: k for k, thing in enumerate(things)}
    under = np.array([index.get(thing.on, -1) for thing in things])
    for spared in (sources, aims, under[sources], under[aims]):
        cut &= spared[:, None] != walls[None]
    return np.asarray(cut.any(axis=1))


def _cuts(start: np.ndarray, end: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Bool (segments, boxes): whether a segment passes through a box (slab test).

    Args:
        start, end: of shape (segments, 3).
        low, high: corners, of shape (boxes, 3).
    """
    step = (end - start)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (low[None] - start[:, None]) / step, (high[None] - start[:, None]) / step
    still = np.abs(step) < 1e-9
    within = (low[None] <= start[:, None]) & (start[:, None] <= high[None])
    near = np.where(still, np.where(within, -np.inf, np.inf), np.minimum(one, other))
    far = np.where(still, np.where(within, np.inf, -np.inf), np.maximum(one, other))
    return np.asarray(np.maximum(near.max(axis=2), 0.0) < np.minimum(far.min(axis=2), 1.0))
