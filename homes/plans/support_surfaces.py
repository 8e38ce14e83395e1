"""Surfaces of furniture: the levels of tops, shelves and hollows, and the free places on them."""

from dataclasses import dataclass, field

import numpy as np

from hearth.homes.geometry import OPPOSITE_WALL, Rect, bottom, box_over, footprint, top, wall_of
from hearth.homes.object_shapes import Form
from hearth.homes.plans.furniture import NoPlaceError
from hearth.homes.plans.home_shell import Thing, band, span
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import Box

MARGIN = 0.015
"""Free rim of a top, and half the least distance between two things on it."""
SHELL = 0.03
"""Thickness of a container's sides."""
STEP = 0.02
"""Metres between the places that are tried, where they are not more than `MOST_STEPS` along a side."""
MOST_STEPS = 40
"""Places along a side, at most."""
FAR = 0.12
"""On a top, things need not stand further apart than this."""

Local = tuple[float, float, float, float]
"""A rectangle in a support's own axes: along its back from the west or south end, and outwards from its back."""


@dataclass(slots=True)
class Level:
    """A height of a support on which things stand.

    Attributes:
        y: the height above the floor.
        clear: the free height above it.
        taken: what stands there, with the name it is called by.
        piles: how high things are piled where they are, by the place of the pile.
    """

    y: float
    clear: float
    taken: list[tuple[str, Local]]
    piles: dict[Local, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Support:
    """A thing with its levels, in axes of its own.

    Attributes:
        thing: what it is.
        width, depth: of a level.
        rim: the distance from the thing's edges.
        levels: from the lowest.
        apart: how far things should stand apart; 0: in rows from the back, as in containers and on shelves.
    """

    thing: Thing
    width: float
    depth: float
    rim: float
    levels: tuple[Level, ...]
    apart: float

    @property
    def tidy(self) -> bool:
        """Return whether things stand in rows from the back."""
        return self.apart == 0


def support_of(thing: Thing, shaped: Form, relation: str, knowledge: Knowledge, apart: float) -> Support:
    """Return a thing with the levels on (or in) it, still empty."""
    width, _, depth = thing.box.size if _along_x(thing) else thing.box.size[::-1]
    low, high = bottom(thing.box), top(thing.box)
    if relation == "on":
        heights = [low + level for level in shaped.levels] or [high]
        ceilings = [*heights[1:], heights[-1] + 10.0]
        if len(heights) > 1:
            ceilings[-1] = high
        levels = tuple(Level(y, above - y - 0.02, []) for y, above in zip(heights, ceilings, strict=True))
        apart = 0.0 if len(levels) > 1 else apart
        return Support(thing, width - 2 * MARGIN, depth - 2 * MARGIN, MARGIN, levels, apart)
    rim = min(SHELL, 0.1 * min(width, depth))
    base = min(SHELL, 0.1 * (high - low))
    pitch = (high - low - 2 * base) / shaped.shelves
    closed = "CAN_OPEN" in knowledge.objects[thing.class_name].properties or shaped.shelves > 1
    levels = tuple(Level(low + base + k * pitch, pitch - 0.01 if closed else 10.0, []) for k in range(shaped.shelves))
    return Support(thing, width - 2 * rim, depth - 2 * rim, rim, levels, apart=0.0)


def _along_x(thing: Thing) -> bool:
    return (thing.yaw or 0.0) % 180 == 0


def check_free(support: Support, level: Level, local: Local) -> None:
    """Check that a rectangle is on the support, and that nothing stands there.

    Raises:
        NoPlaceError: a side of it would stand over the edge, or in another thing.
    """
    u0, v0, u1, v1 = local
    slack = support.rim + 1e-6
    if u0 < -slack or v0 < -slack or u1 > support.width + slack or v1 > support.depth + slack:
        raise NoPlaceError("it would stand over the edge")
    for name, (a0, b0, a1, b1) in level.taken:
        if min(a1 - u0, u1 - a0, b1 - v0, v1 - b0) > 1e-6:
            raise NoPlaceError(f"it would stand in `{name}`")


def best_place(support: Support, level: Level, width: float, depth: float) -> Local | None:
    """Return where a thing of that size stands best.

    The first free place from the back on tidy supports, else well apart.
    """
    across, out = support.width - width, support.depth - depth
    if across < -1e-9 or out < -1e-9:
        return None
    u, v = _steps(across), _steps(out)
    free = _free(level, u, v, width, depth)
    allowed = free >= MARGIN - 1e-9
    if not support.tidy:
        edge_u, edge_v = np.minimum(u, across - u), np.minimum(v, out - v)
        edges = np.minimum(edge_v[:, None], edge_u[None])
        score = np.minimum(free, support.apart) + 0.5 * np.minimum(edges, support.apart)
        # Rounded, so that the last digit of a distance does not choose between equal places.
        free = np.where(allowed, np.round(score, 4), -1.0)
    index = int(np.argmax(allowed if support.tidy else free))
    row, column = divmod(index, len(u))
    if not allowed[row, column]:
        return None
    u0, v0 = float(u[column]), float(v[row])
    return u0, v0, u0 + width, v0 + depth


def _steps(length: float) -> np.ndarray:
    """Places along a length, both ends among them."""
    count = min(MOST_STEPS, max(1, round(length / STEP)))
    return np.arange(count + 1) * (max(length, 0.0) / count)


def _free(level: Level, u: np.ndarray, v: np.ndarray, width: float, depth: float) -> np.ndarray:
    """Return, for a thing with its corner at each (v, u), the least distance to the things that stand there.

    Negative where they meet.
    """
    taken = np.array([local for _, local in level.taken], float).reshape(-1, 4)
    gap_u = np.maximum(taken[:, 0, None] - (u + width), u - taken[:, 2, None])
    gap_v = np.maximum(taken[:, 1, None] - (v + depth), v - taken[:, 3, None])
    least: np.ndarray = np.maximum(gap_v[:, :, None], gap_u[:, None, :]).min(axis=0, initial=FAR)
    return least


def box_of(support: Support, level: Level, local: Local, under: float, height: float) -> Box:
    """Return the box of a thing in the room, from its rectangle on a level and the height of the things under it."""
    u0, v0, u1, v1 = (value + support.rim for value in local)
    rect = footprint(support.thing.box)
    wall = wall_of(support.thing.yaw or 0.0)
    low = span(rect, wall)[0]
    return box_over(band(rect, wall, low + u0, low + u1, v0, v1), level.y + under, level.y + under + height)


def local_of(support: Support, rect: Rect) -> Local:
    """Return a rectangle of the room in the support's own axes: the inverse of `_box`."""
    over = footprint(support.thing.box)
    wall = wall_of(support.thing.yaw or 0.0)
    low = span(over, wall)[0]
    u0, u1 = (along - low for along in span(rect, wall))
    v0, v1 = over.reach(wall) - rect.reach(wall), over.reach(wall) + rect.reach(OPPOSITE_WALL[wall])
    return u0 - support.rim, v0 - support.rim, u1 - support.rim, v1 - support.rim
