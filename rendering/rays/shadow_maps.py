"""Shadow maps of static things: which points a light reaches, where that is certain; the others get rays.

A map is made when a light has been asked for so often that it will be worth it. What it says is what rays say, so that
pictures do not depend on when that was.
"""

from dataclasses import dataclass, field
from threading import Lock
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays import shadow_loops as loops
from hearth.rendering.rays.convex_triangle_groups import unshaded_groups
from hearth.rendering.rays.ray_casting import Caster
from hearth.rendering.rays.reused_arrays import scratch
from hearth.rendering.rays.threads import each

WORTH = 600_000
"""Number of rays to a light from which on its map is made: about the cost of making it."""

CUBE, PLANE = 256, 1024
"""Width in texels of a face of a lamp's map, and of the sun's."""

WIDEST = 50.0
"""Metres of a home up to which the sun's rays, which have an end, leave it."""

DIRECTION = 3
"""Numbers that describe the sun; a lamp has more."""

LampArea = tuple[float, ...]


class ShadowMap(NamedTuple):
    """The bounds of each texel; see `shadow_loops.draw`. For the sun, also where they lie."""

    first: Floats
    other: Floats
    covered: Floats
    groups: Ints
    frame: Floats | None = None
    scale: float = 0.0

    def certain(self, rays: Floats, index: Ints, own: Ints, blocked: Any, rest: Floats, places: Ints) -> int:
        """Fill in the rays that are certain; return the number of the others; see `shadow_loops.look_up_cube`."""
        bounds = self.first, self.other, self.covered, self.groups
        if self.frame is None:
            return int(loops.look_up_cube(rays, index, own, *bounds, blocked, rest, places))
        where = self.frame, np.float32(self.scale)
        return int(loops.look_up_plane(rays, index, own, *where, *bounds, blocked, rest, places))


@dataclass(eq=False)
class ShadowMaps:
    """The maps of some things' lights, and how often each light was asked for.

    Attributes:
        corners: (T, 3, 3) of the things' triangles.
        owner: (T,) index of each triangle's thing.
        lamps: (things,) whether each is a lamp that is on, which casts no shadow by lamps.
        asked: rays so far, by light: a lamp's place and the area that it lights, or the direction to the sun.
        made: the maps by light.
    """

    corners: Floats
    owner: NDArray[np.int32]
    lamps: NDArray[np.bool_]
    asked: dict[LampArea, int] = field(default_factory=dict)
    made: dict[LampArea, ShadowMap] = field(default_factory=dict)
    lock: Any = field(default_factory=Lock)
    _groups: Ints | None = None

    def groups(self) -> Ints:
        """(T,) of the triangles that do not shade each other, see `convex_triangle_groups`; made at their first use."""
        if self._groups is None:
            self._groups = unshaded_groups(self.corners, self.owner)
        return self._groups

    def of(self, light: Floats, rays: int) -> ShadowMap | None:
        """Return the map of a light that is asked for some rays more; None if there is none yet.

        Args:
            light: a lamp's place and the area that it lights, or the direction to the sun.
            rays: their number.
        """
        key = tuple(light.tolist())
        self.asked[key] = self.asked.get(key, 0) + rays
        return self.made.get(key)

    def make(self) -> None:
        """Make the maps that are worth it by now."""
        with self.lock:
            due = [key for key, rays in self.asked.items() if rays >= WORTH and key not in self.made]
            if due:
                self.groups()
                self.made.update(zip(due, each(self._map, due), strict=True))

    def _map(self, key: LampArea) -> ShadowMap:
        light = np.array(key, np.float32)
        return self._lamp(light) if len(light) > DIRECTION else self._sun(light)

    def _lamp(self, light: Floats) -> ShadowMap:
        place, (west, east, south, north) = light[:3].astype(np.float64), light[3:7]
        low, high = self.corners.min(axis=1), self.corners.max(axis=1)
        near = (low[:, 0] <= max(east, place[0])) & (high[:, 0] >= min(west, place[0]))
        near &= (low[:, 2] <= max(north, place[2])) & (high[:, 2] >= min(south, place[2]))
        drawn = np.flatnonzero(near & ~self.lamps[self.owner])
        bounds = _empty(6, CUBE, CUBE)
        for face in range(6):
            own = [values[face] for values in bounds]
            loops.draw_cube(self.corners, drawn, self.groups(), place, face, *own)
        return ShadowMap(*bounds)

    def _sun(self, way: Floats) -> ShadowMap:
        corners, sun = self.corners, way.astype(np.float64)
        right = np.cross((0.0, 1.0, 0.0), sun)
        right /= max(float(np.linalg.norm(right)), 1e-9)
        up = np.cross(sun, right)
        across, down = corners @ right, corners @ up
        least = float(across.min()) - 0.1, float(down.min()) - 0.1
        size = max(float(across.max()) - least[0], float(down.max()) - least[1]) + 0.1
        bounds, scale = _empty(PLANE, PLANE), PLANE / size
        frame = np.array((*least, *right, *up, *sun))
        if float(np.ptp(corners @ sun)) > WIDEST:
            scale = 0.0
            bounds[0][:] = np.inf
        else:
            loops.draw_plane(corners, self.groups(), frame, scale, *bounds)
        return ShadowMap(*bounds, frame.astype(np.float32), scale)


def _empty(*shape: int) -> tuple[Floats, Floats, Floats, Ints]:
    far = np.float32(-1e9)
    return np.full(shape, far), np.full(shape, far), np.full(shape, far), np.full(shape, -1, np.int32)


def occluded(
    caster: Caster, maps: ShadowMaps, rays: Floats, far: float, index: Ints, own: Ints, light: Floats
) -> NDArray[np.bool_]:
    """(N,) whether static things block rays to a light; like `Caster.occluded`, but most are looked up.

    Args:
        caster, maps: of the things.
        rays: (N, 6), with the share `far` at which they end.
        index: (N,) the points that they begin at.
        own: (M,) groups that cannot shade the points; (0,) to cast all rays.
        light: see `ShadowMaps.of`.
    """
    known = maps.of(light, len(rays)) if caster.count else None
    if known is None or not len(own):
        return caster.occluded(rays, far)
    blocked: NDArray[np.bool_] = np.empty(len(rays), np.bool_)
    rest, places = scratch("unsure", len(rays), 6), scratch("unsure places", len(rays), dtype=np.int32)
    left = known.certain(rays, index, own, blocked, rest, places)
    if left:
        blocked[places[:left]] = caster.occluded(rest[:left], far)
    return blocked
