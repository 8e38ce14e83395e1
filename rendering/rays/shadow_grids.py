"""Light buffers of moving things (Haines and Greenberg 1986): a grid of directions from a light, and the triangles
that each cell may contain. Shadow rays to the light test the triangles of one cell.

For shadows of one picture they are made and used several times as fast as a tree of boxes.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from math import isqrt
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays import light_grid_loops as loops
from hearth.rendering.rays.reused_arrays import scratch
from hearth.rendering.rays.threads import each

LEAST_SIZE, GREATEST_SIZE = 8, 128
"""Cells along a side: about as many cells as triangles, within these limits."""

LEAST_DEPTH = 0.02
"""Metres in front of a lamp within which no grid is made: its directions would be all around."""

WIDEST = 4.0
"""Greatest tangent of an angle between a lamp's grid's axis and a triangle."""

CROWDED = 40
"""Cells a triangle, on average, from which on a grid is not made."""


@dataclass(frozen=True, eq=False)
class LightGrid:
    """The triangles that lie in some direction from a light.

    Attributes:
        edges: (T, 9) a corner of each triangle, and the ways from there to the two others.
        light: position, or direction to the sun.
        frame: position, or zeros for the sun; axes right, up, forward; least place across and up, cells per unit.
        size: cells along a side.
        starts: (size * size + 1,) each cell's first place in the list.
        triangles, depths: the list: triangles, and their least depths along the axis.
    """

    edges: Floats
    light: Floats
    is_sun: bool
    frame: Floats
    size: int
    starts: Ints
    triangles: Ints
    depths: Floats

    @classmethod
    def of(cls, corners: Floats, edges: Floats, chosen: Ints, light: Floats, *, is_sun: bool) -> LightGrid | None:
        """Return a light's grid.

        None if the triangles lie all around the lamp, or are so large that a grid is not worth it.

        Args:
            corners, edges: of all triangles.
            chosen: indices of those that cast shadows.
            light: position, or direction to the sun.
            is_sun: whether it is the sun.
        """
        size = min(max(isqrt(len(chosen)), LEAST_SIZE), GREATEST_SIZE)
        frame = _axes(corners, chosen, light, is_sun)
        places = scratch("light grid places", len(chosen), 3, 2)
        nearest, bounds = scratch("light grid depths", len(chosen)), np.empty(5)
        loops.project(corners, chosen, frame, is_sun, places, nearest, bounds)
        west, east, low, high, least = bounds.tolist()
        if not is_sun and (least < LEAST_DEPTH or max(-west, east, -low, high) > WIDEST):
            return None
        scale = (size - 2 * loops.EDGE) / max(east - west, high - low, 1e-6)
        frame[12:] = west - loops.EDGE / scale, low - loops.EDGE / scale, scale
        starts = np.zeros(size * size + 1, np.int32)
        number = int(loops.count(places, frame, size, starts))
        if number > CROWDED * max(len(chosen), GREATEST_SIZE * GREATEST_SIZE // CROWDED):
            return None
        triangles, depths = np.empty(number, np.int32), np.empty(number, np.float32)
        loops.distribute(places, nearest, chosen, frame, size, starts, triangles, depths)
        return cls(edges, np.asarray(light, np.float32), is_sun, frame, size, starts, triangles, depths)

    def shaded(self, lit: Ints, skipped: NDArray[np.bool_], points: Floats, far: float) -> Ints:
        """Those of some points whose rays to the light meet a triangle; valid until the thread's next call.

        Args:
            lit: (K,) indices of the points.
            skipped: (M,) whether a point is excluded.
            points: (M, 3).
            far: share of the way to the light up to which triangles count.
        """
        dark = scratch("dark", len(lit), dtype=np.int32)
        where = (self.frame, self.size, self.starts, self.triangles, self.depths, self.edges)
        return dark[: loops.shaded(lit, skipped, points, self.light, self.is_sun, np.float32(far), *where, dark)]


def _axes(corners: Floats, chosen: Ints, light: Floats, is_sun: bool) -> Floats:
    """Return the frame of a grid, without its place and scale."""
    place = np.zeros(3) if is_sun else np.asarray(light, np.float64)
    forward = -np.asarray(light, np.float64) if is_sun else loops.middle(corners, chosen) - place
    forward = forward / max(float(np.linalg.norm(forward)), 1e-9)
    aside = (1.0, 0.0, 0.0) if abs(forward[1]) > 0.7 else (0.0, 1.0, 0.0)
    right = np.cross(aside, forward)
    right /= max(float(np.linalg.norm(right)), 1e-9)
    return np.concatenate((place, right, np.cross(forward, right), forward, (0.0, 0.0, 0.0)))


@dataclass(eq=False)
class LightGrids:
    """The grids of some things' lights, made at their first use.

    Attributes:
        corners: (T, 3, 3) of the things' triangles.
        owner: (T,) index of each triangle's thing.
        lamps: (things,) whether each is a lamp that is on, which casts no shadow by lamps.
    """

    corners: Floats
    owner: NDArray[np.int32]
    lamps: NDArray[np.bool_]
    made: dict[tuple[Any, ...], LightGrid | None] = field(default_factory=dict)
    lock: Any = field(default_factory=Lock)

    @cached_property
    def edges(self) -> Floats:
        """See `LightGrid`."""
        edges = np.empty((len(self.corners), 9), np.float32)
        loops.edges_of(self.corners, edges)
        return edges

    def of(self, light: Floats, *, is_sun: bool) -> LightGrid | None:
        """Return a light's grid; see `LightGrid.of`."""
        key = (is_sun, *light.tolist())
        if key not in self.made:
            with self.lock:
                if key not in self.made:
                    self.made[key] = self._made(light, is_sun)
        return self.made[key]

    def make(self, lights: Iterable[tuple[Floats, bool]]) -> None:
        """Make the grids of some lights, each a position, or a direction and whether it is the sun."""
        due = {(is_sun, *light.tolist()): (light, is_sun) for light, is_sun in lights}
        due = {key: light for key, light in due.items() if key not in self.made}
        _ = self.edges
        self.made.update(zip(due, each(lambda light: self._made(*light), due.values()), strict=True))

    def _made(self, light: Floats, is_sun: bool) -> LightGrid | None:
        chosen = np.flatnonzero(~self.lamps[self.owner] | is_sun).astype(np.int32)
        return LightGrid.of(self.corners, self.edges, chosen, light, is_sun=is_sun) if len(chosen) else None
