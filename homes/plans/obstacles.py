"""Free places of a room: clear of other things, of the fronts of things in use, and of doors and windows."""

from collections.abc import Sequence

import numpy as np

from hearth.homes.geometry import Rect, bottom, facing_from, footprint, top
from hearth.homes.object_shapes import Form
from hearth.homes.plans.home_shell import Opening, Thing, before, interior, strip
from hearth.homes.plans.plan import Room
from hearth.homes.plans.walkable_floor import HEAD

Stand = tuple[Rect, float, float]
"""A possible place of a thing: the floor under it, its yaw, its underside."""
TOUCH = 0.005
"""Things that meet by less than this do not."""
LOW = 1.0
"""Things lower than this obstruct the use of the thing behind them."""
SILL = 0.3
"""Metres above a window's sill that furniture before it may reach."""


class Obstacles:
    """The things that stand in a room.

    Args:
        room: the room.
        solids: the standing things; nothing else may stand in them, nor at the front of those used from the front.
        kept: floor that doors need.
        openings: of the room's walls.
    """

    def __init__(self, room: Room, solids: Sequence[Thing], kept: Sequence[Rect], openings: Sequence[Opening]) -> None:
        self._inner = interior(room)
        self._solids = [(footprint(t.box), bottom(t.box), top(t.box)) for t in solids]
        self._fronts = [before(rect, t.yaw or 0.0, t.front) for t, (rect, *_) in zip(solids, self._solids, strict=True)
                        if t.front]  # fmt: skip
        self._kept = kept
        self._openings = openings
        self._taken: dict[tuple[float, float], np.ndarray] = {}

    def free(self, spots: Sequence[Stand], shaped: Form, front: float) -> np.ndarray:
        """Bool (spots): whether a thing of that shape, with `front` metres before it, may stand there."""
        rects = np.array([spot[0] for spot in spots], float).reshape(-1, 4)
        found = _within(rects, self._inner, TOUCH)
        if shaped.mount == "flat" or not spots:
            return found
        # All spots of a shape are at one height.
        low = spots[0][2]
        if found.any():
            found &= ~_meets(rects, self._in_the_way(low, low + shaped.size[1])).any(axis=1)
        if front and found.any():
            zones = np.array([before(rect, yaw, front) for rect, yaw, _ in spots])
            found &= _within(zones, self._inner, 0.05)
            low_ones = [rect for rect, lower, _ in self._solids if lower < LOW]
            found &= ~_meets(zones, np.array(low_ones, float).reshape(-1, 4)).any(axis=1)
        holes = [hole for hole in self._openings if low < hole.y1 and low + shaped.size[1] > hole.y0]
        if holes and found.any():
            high = [hole.window is not None and low + shaped.size[1] > hole.y0 + SILL for hole in holes]
            there = _meets(rects, np.array([self._deep(hole) for hole in holes]))
            if shaped.mount == "wall":
                yaws = np.array([yaw for _, yaw, _ in spots])
                found &= ~(there & (high | (yaws[:, None] == [facing_from(hole.wall) for hole in holes]))).any(axis=1)
            else:
                found &= ~there[:, high].any(axis=1)
        return found

    def _in_the_way(self, low: float, high: float) -> np.ndarray:
        """Return the floor that is taken for something of that height."""
        if (low, high) in self._taken:
            return self._taken[low, high]
        taken = [rect for rect, lower, upper in self._solids if lower < high and low < upper]
        fronts, kept = self._fronts if low < LOW else (), self._kept if low < HEAD else ()
        found = np.array([*taken, *fronts, *kept], float).reshape(-1, 4)
        self._taken[low, high] = found
        return found

    def _deep(self, hole: Opening) -> Rect:
        """Return the floor in front of an opening in a wall."""
        return strip(self._inner, hole.wall, hole.start - 0.03, hole.end + 0.03, 0.25)


def _within(rects: np.ndarray, room: Rect, slack: float) -> np.ndarray:
    u0, v0, u1, v1 = rects.T
    inside = (u0 >= room[0] - slack) & (v0 >= room[1] - slack) & (u1 <= room[2] + slack) & (v1 <= room[3] + slack)
    return np.asarray(inside)


def _meets(rects: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Bool (rects, others): which of them meet."""
    u0, v0, u1, v1 = rects.T[:, :, None]
    a0, b0, a1, b1 = others.T[:, None]
    return np.asarray((u0 < a1 - TOUCH) & (v0 < b1 - TOUCH) & (a0 < u1 - TOUCH) & (b0 < v1 - TOUCH))
