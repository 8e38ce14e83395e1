"""Where in a room a thing may stand: free of others, of what is used from its front, of doors and windows."""

from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np

from hearth.homes.forms import Form
from hearth.homes.geometry import Rect, bottom, facing_from, footprint, top
from hearth.homes.plans.floor import HEAD
from hearth.homes.plans.plan import Room
from hearth.homes.plans.shell import Opening, Thing, before, interior, strip

Stand = tuple[Rect, float, float]
"""Where a thing may stand: the floor under it, its yaw, its underside."""
TOUCH = 0.005
"""Things that meet by less than this do not."""
LOW = 1.0
"""What is lower stands in the way of using something."""
SILL = 0.3
"""Metres above a window's sill that furniture before it may reach."""


class Obstacles:
    """What stands in a room.

    Args:
        room: the room.
        solids: what stands there; nothing else may stand in it, nor before what is used from its front.
        kept: floor that doors need.
        openings: of the room's walls.
    """

    def __init__(self, room: Room, solids: Sequence[Thing], kept: Sequence[Rect], openings: Sequence[Opening]) -> None:
        self._inner = interior(room)
        self._solids = solids
        self._kept = kept
        self._openings = openings
        self._taken = cache(self._in_the_way)

    def free(self, spots: Sequence[Stand], shaped: Form, front: float) -> np.ndarray:
        """Bool (spots): whether a thing of that shape, with `front` metres before it, may stand there."""
        rects = np.array([spot[0] for spot in spots], float).reshape(-1, 4)
        found = _within(rects, self._inner, TOUCH)
        if shaped.mount == "flat" or not spots:
            return found
        # All spots of a shape are at one height.
        low = spots[0][2]
        if found.any():
            found &= ~_meets(rects, self._taken(low, low + shaped.size[1]))
        if front and found.any():
            zones = np.array([before(rect, yaw, front) for rect, yaw, _ in spots])
            found &= _within(zones, self._inner, 0.05)
            found &= ~_meets(zones, [footprint(t.box) for t in self._solids if bottom(t.box) < LOW])
        yaws = np.array([yaw for _, yaw, _ in spots])
        for hole, deep in self._holes(low, low + shaped.size[1]):
            if not found.any():
                break
            high = hole.window is not None and low + shaped.size[1] > hole.y0 + SILL
            there = _meets(rects, [deep])
            found &= ~(there & (high | ((shaped.mount == "wall") & (yaws == facing_from(hole.wall)))))
        return found

    def _in_the_way(self, low: float, high: float) -> np.ndarray:
        """The floor that is taken for something of that height."""
        taken = [footprint(t.box) for t in self._solids if bottom(t.box) < high and low < top(t.box)]
        if low < LOW:
            taken += [before(footprint(t.box), t.yaw or 0.0, t.front) for t in self._solids if t.front]
        return np.array([*taken, *(self._kept if low < HEAD else ())], float).reshape(-1, 4)

    def _holes(self, low: float, high: float) -> Iterator[tuple[Opening, Rect]]:
        """What opens in the walls at that height, with the floor before it."""
        for hole in self._openings:
            if low < hole.y1 and high > hole.y0:
                yield hole, strip(self._inner, hole.wall, hole.start - 0.03, hole.end + 0.03, 0.25)


def _within(rects: np.ndarray, room: Rect, slack: float) -> np.ndarray:
    low, high = np.array(room[:2]) - slack, np.array(room[2:]) + slack
    return np.asarray((rects[:, :2] >= low).all(axis=1) & (rects[:, 2:] <= high).all(axis=1))


def _meets(rects: np.ndarray, others: Sequence[Rect] | np.ndarray) -> np.ndarray:
    """Bool (rects): whether each meets any of the others."""
    taken = np.asarray(others, float).reshape(-1, 4)
    lows, highs = rects[:, None, :2], rects[:, None, 2:]
    apart = np.any((lows >= taken[None, :, 2:] - TOUCH) | (taken[None, :, :2] >= highs - TOUCH), axis=2)
    return np.asarray(np.any(~apart, axis=1))
