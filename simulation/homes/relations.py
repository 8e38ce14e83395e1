"""Geometry -> edges: ON, INSIDE and BETWEEN from the plan, CLOSE from free distance, FACING from fronts and sight."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from math import cos, radians
from typing import TYPE_CHECKING

from hearth.schemas.graph import Edge
from hearth.schemas.vocabulary import RELATION_ID, RELATIONS
from hearth.simulation.homes.shell import Thing

if TYPE_CHECKING:
    import numpy as np

CLOSE_WITHIN = 0.8
"""Metres of free space between two things that are CLOSE; chosen so that homes are as dense as the release's."""
VIEW = 60.0
"""A thing faces what lies at most this many degrees off the way its front points."""
SHOWN = 80.0
"""And what it faces must show its own front: at most this many degrees off."""
FAR = 7.0
"""Metres beyond which nothing is looked at."""
EYES = (1.1, 1.6)
"""Sight starts between these heights: those of someone sitting and standing."""


def edges(things: Sequence[Thing], ids: Mapping[str, int], lookable: frozenset[str]) -> tuple[Edge, ...]:
    """All edges between things, sorted by source, relation and target.

    Args:
        things: rooms, everything in them, and the character.
        ids: node ids by the things' names.
        lookable: classes that one can look at: what things are FACING.
    """
    own = [ids[thing.name] for thing in things]
    found = [(e.source, RELATION_ID[e.relation], e.target) for e in _given(things, ids)]
    for relation, pairs in (("CLOSE", close(things)), ("FACING", facing(things, lookable))):
        number = RELATION_ID[relation]
        found.extend((own[i], number, own[j]) for i, j in pairs)
    found.sort()
    return tuple(Edge(source, RELATIONS[number], target) for source, number, target in found)


def _given(things: Sequence[Thing], ids: Mapping[str, int]) -> Iterator[Edge]:
    """What the plan says outright; everything is INSIDE its room as well."""
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


def close(things: Sequence[Thing]) -> Iterator[tuple[int, int]]:
    """Pairs with at most `CLOSE_WITHIN` of free space between their boxes, both ways round.

    Walls part things of different rooms; doors and their jambs are near things of both. A container's sides part
    nothing: as in the release, what is in a dresser is near what stands beside it.
    """
    import numpy as np

    centers, halves = _arrays(things)
    gaps = np.maximum(np.abs(centers[:, None] - centers[None]) - (halves[:, None] + halves[None]), 0.0)
    near = (gaps**2).sum(axis=2) <= CLOSE_WITHIN**2 + 1e-9
    near &= _together(things)
    np.fill_diagonal(near, False)
    rows, columns = np.nonzero(near)
    yield from zip(rows.tolist(), columns.tolist(), strict=True)


def _arrays(things: Sequence[Thing]) -> tuple[np.ndarray, np.ndarray]:
    """Centres and half sizes, both of shape (things, 3)."""
    import numpy as np

    centers = np.array([thing.box.center for thing in things], float).reshape(-1, 3)
    halves = np.array([thing.box.size for thing in things], float).reshape(-1, 3) / 2
    return centers, halves


def _together(things: Sequence[Thing]) -> np.ndarray:
    """Bool (things, things): no wall stands between them; rooms themselves are near nothing."""
    import numpy as np

    names = list(dict.fromkeys(thing.room for thing in things))
    member = np.zeros((len(things), len(names)), bool)
    for i, thing in enumerate(things):
        if thing.mount != "room":
            for room in {thing.room, *(thing.between or ())}:
                member[i, names.index(room)] = True
    shared: np.ndarray = (member.astype(np.int32) @ member.T.astype(np.int32)) > 0
    return shared


def facing(things: Sequence[Thing], lookable: frozenset[str]) -> Iterator[tuple[int, int]]:
    """Pairs where the first turns its front to the second, which shows its own front, with nothing tall between."""
    rooms: dict[str, list[int]] = {}
    for i, thing in enumerate(things):
        if thing.mount not in ("room", "shell"):
            rooms.setdefault(thing.room, []).append(i)
    for members in rooms.values():
        blockers = [i for i in members if things[i].mount in ("floor", "wall", "door")]
        for j in members:
            target = things[j]
            if target.class_name in lookable and not target.inside:
                for i in members:
                    if i != j and not things[i].inside and _faces(things[i], target):
                        between = [things[k] for k in blockers if k not in (i, j)]
                        if _sees(things[i], target, between):
                            yield i, j


def _faces(source: Thing, target: Thing) -> bool:
    if source.yaw is None or source.mount in ("ceiling", "flat", "door", "window"):
        return False
    dx = target.box.center[0] - source.box.center[0]
    dz = target.box.center[2] - source.box.center[2]
    distance = (dx * dx + dz * dz) ** 0.5
    if not 0.05 < distance <= FAR:
        return False
    ahead = _along(source.yaw, dx, dz) / distance
    shown = 1.0 if target.yaw is None else -_along(target.yaw, dx, dz) / distance
    return ahead >= cos(radians(VIEW)) and shown >= cos(radians(SHOWN))


@lru_cache(maxsize=16)
def _direction(yaw: float) -> tuple[float, float]:
    """A yaw as a unit vector (x, z); exact for the four winds."""
    exact = {0.0: (0.0, 1.0), 90.0: (1.0, 0.0), 180.0: (0.0, -1.0), 270.0: (-1.0, 0.0)}
    if yaw % 360 in exact:
        return exact[yaw % 360]
    from math import sin

    return sin(radians(yaw)), cos(radians(yaw))


def _along(yaw: float, dx: float, dz: float) -> float:
    x, z = _direction(yaw)
    return x * dx + z * dz


def _sees(source: Thing, target: Thing, between: Sequence[Thing]) -> bool:
    """Whether the straight line between them misses every other thing of size."""
    eye = min(max(source.box.center[1], EYES[0]), EYES[1])
    a = (source.box.center[0], eye, source.box.center[2])
    b = target.box.center
    spared = {target.on, target.name, source.on, source.name}
    return not any(_cuts(thing, a, b) for thing in between if thing.name not in spared)


def _cuts(thing: Thing, a: tuple[float, float, float], b: tuple[float, float, float]) -> bool:
    """Whether the segment from a to b passes through a box (slab test)."""
    first, last = 0.0, 1.0
    for start, end, center, size in zip(a, b, thing.box.center, thing.box.size, strict=True):
        low, high, step = center - size / 2, center + size / 2, end - start
        if abs(step) < 1e-9:
            if not low <= start <= high:
                return False
            continue
        near, far = sorted(((low - start) / step, (high - start) / step))
        first, last = max(first, near), min(last, far)
        if first >= last:
            return False
    return True
