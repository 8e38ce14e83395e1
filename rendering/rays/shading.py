"""Shading of hits: visibility of lights from each visible point, and the resulting colours.

Pixels are processed in chunks that fit the processor's cache, by one thread per processor. The loops are in
`light_rays` and `surface_lighting`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Bytes, Floats, Ints
from hearth.rendering.models.textures import decode, texels
from hearth.rendering.rays import light_rays
from hearth.rendering.rays import surface_lighting as loops
from hearth.rendering.rays.kernels import COLUMNS, FLAT, gather_rows
from hearth.rendering.rays.light_rays import OPEN
from hearth.rendering.rays.ray_casting import Hits
from hearth.rendering.rays.reused_arrays import scratch
from hearth.rendering.rays.shadow_loops import own_groups
from hearth.rendering.rays.shadow_maps import occluded
from hearth.rendering.rays.threads import each
from hearth.rendering.scene.lights import Daylight, Light
from hearth.rendering.scene.triangles import Geometry, Part

CHUNK = 65536
"""Pixels in one chunk."""

SUN = 0
"""Column of `Exposure.seen` for the sun; lights follow."""

DIM = np.uint8(64)
"""Remaining visibility of a window whose middle is occluded: windows are wide."""


@dataclass(frozen=True, eq=False)
class Setting:
    """The lights of a scene, as rows for the loops.

    Attributes:
        lights: of the scene; their rows and the day's row are (L, L_COLUMNS) and (D_COLUMNS,).
        fine: soft shadows and ambient occlusion.
    """

    lights: tuple[Light, ...]
    rows: Floats
    day: Floats
    fine: bool = False

    @classmethod
    def of(cls, lights: tuple[Light, ...], day: Daylight, *, plain: bool, angle: float, fine: bool = False) -> Setting:
        """Return the rows of a scene's lights.

        Args:
            lights: lamps that are on, and windows.
            day: sun and sky.
            plain: whether the background is plain.
            angle: radians per pixel.
            fine: soft shadows and ambient occlusion.
        """
        rows = np.array([_light_row(light) for light in lights], np.float32).reshape(-1, light_rays.L_COLUMNS)
        return cls(lights, rows, _day_row(day, plain, angle), fine)

    def reaching(self, bounds: Floats) -> Ints:
        """Return the lights that reach (x0, x1, z0, z1)."""
        area = self.rows[:, light_rays.L_AREA : light_rays.L_AREA + 4].T
        x0, x1, z0, z1 = bounds
        return np.flatnonzero((area[0] < x1) & (area[1] > x0) & (area[2] < z1) & (area[3] > z0)).astype(np.int32)

    def shadowed(self, number: int) -> bool:
        """Return whether a light casts shadows: windows are wide and cast only soft ones."""
        return self.fine or self.lights[number].facing is None


def area(source: Light) -> tuple[float, float, float, float]:
    """(x0, x1, z0, z1) that a light reaches."""
    x, _, z = source.position
    reach = float(light_rays.REACH)
    return source.room or (x - reach, x + reach, z - reach, z + reach)


def _light_row(light: Light) -> tuple[float, ...]:
    facing = light.facing or (0.0, 0.0, 0.0)
    return (*light.position, *light.color, float(light.facing is not None), *facing, *area(light), *light.span)


def _day_row(day: Daylight, plain: bool, angle: float) -> Floats:
    up = day.sun is not None
    sun = day.sun or (0.0, 1.0, 0.0)
    row = (*sun, *day.sunlight, float(up), day.ambient, *day.zenith, *day.horizon, day.sky, float(plain), angle)
    return np.array(row, np.float32)


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Surface points of some pixels.

    Attributes:
        pixels: (M,) their indices.
        rows: (M, COLUMNS) of their triangles.
        points: (M, 3) lifted off their surface.
        normals, flats: (M, 3) smooth and flat normals towards the viewer; flat ones are 0 for the background.
        views: (M, 3) unit vectors along the rays.
        bounds: least and greatest x and z of the points.
        triangles: (M,) the triangles that they lie on.
    """

    pixels: Ints
    rows: Floats
    points: Floats
    normals: Floats
    flats: Floats
    views: Floats
    bounds: Floats
    triangles: Ints


def located(pixels: Ints, rays: Floats, hits: Hits, geometry: Geometry, use: str = "spots") -> SurfacePoints:
    """Return the surface points of some pixels, given all rays and hits.

    Valid until this thread's next call with `use`.
    """
    count = len(pixels)
    rows = scratch(f"{use} rows", count, COLUMNS)
    gather_rows(pixels, hits.triangle, geometry.static.rows, geometry.moving.rows, rows)
    points, normals, flats, views = scratch(use, 4, count, 3)
    bounds = np.empty(4, np.float32)
    light_rays.locate(pixels, rays, hits.distance, hits.u, hits.v, rows, points, normals, flats, views, bounds)
    return SurfacePoints(pixels, rows, points, normals, flats, views, bounds, hits.triangle[pixels])


@dataclass(frozen=True, eq=False)
class Exposure:
    """Visibility of lights from some pixels' surface points.

    Attributes:
        pixels: (M,) their indices.
        points: (M, 3) surface points, lifted off their surface.
        near: lights that may reach them.
        seen: (M, lights + 2) visibility of the sun, of each light and of ambient light, 0 to 255.
        lit: for the sun and each light with shadows, the indices (of M) of the points that it reaches.
    """

    pixels: Ints
    points: Floats
    near: Ints
    seen: Bytes
    lit: dict[int, Ints]


def chunks(pixels: Ints) -> list[Ints]:
    """Pixels in chunks."""
    return [pixels[start : start + CHUNK] for start in range(0, len(pixels), CHUNK)]


NO_NOISE: Floats = np.zeros((0, 2), np.float32)
NO_LIGHT: Ints = np.zeros(0, np.int32)


def expose(surface: SurfacePoints, geometry: Geometry, setting: Setting, noise: Floats = NO_NOISE) -> Exposure:
    """Visibility of lights from some surface points, occluded by static things only; `dim` adds moving things.

    Args:
        surface: the points.
        geometry, setting: triangles and lights.
        noise: (M, 2) from 0 to 1 for soft shadows and occlusion, which include moving things.
    """
    count, points = len(surface.pixels), surface.points
    near = setting.reaching(surface.bounds)
    seen = np.full((count, len(setting.lights) + 2), OPEN, np.uint8)
    lit: dict[int, Ints] = {}
    out, index = scratch("rays", count, 6), scratch("index", count, dtype=np.int32)
    # Soft shadow rays are random and can't be repeated: they are cast at static and moving things at once.
    parts = (geometry.static, geometry.moving) if setting.fine else (geometry.static,)
    own = NO_LIGHT if setting.fine else _own_groups(surface, geometry)
    if setting.day[light_rays.D_UP]:
        found = light_rays.aim_at_sun(points, surface.normals, surface.flats, setting.day, noise, out, index)
        known = None if setting.fine else Looked(index[:found], own, setting.day[:3])
        blocked = _blocked(parts, out[:found], 0.999, known)
        lit[SUN] = _marked(seen, SUN, index[:found], blocked, np.uint8(0))
    for number in near.tolist():
        if setting.shadowed(number):
            light = setting.rows[number]
            found = light_rays.aim_at_light(points, surface.normals, surface.flats, light, noise, out, index)
            known = None if setting.fine else Looked(index[:found], own, light[WHERE])
            blocked = _blocked(parts, out[:found], 0.97, known, lamp=True)
            value = np.uint8(0) if setting.lights[number].facing is None else DIM
            lit[number + 1] = _marked(seen, number + 1, index[:found], blocked, value)
    for number in range(AROUND if setting.fine else 0):
        found = light_rays.aim_around(points, surface.flats, noise, number, np.float32(number / AROUND), out, index)
        blocked = _blocked(parts, out[:found], 0.999)
        light_rays.darken(index[:found], blocked, seen, seen.shape[1] - 1, np.uint8(255 // AROUND))
    return Exposure(surface.pixels, points.copy(), near, seen, lit)


AROUND = 1
"""Rays per point over its hemisphere in fine pictures."""


WHERE = [*range(light_rays.L_PLACE, light_rays.L_PLACE + 3), *range(light_rays.L_AREA, light_rays.L_AREA + 4)]
"""Columns of a light's row with its place and the area that it lights."""


def _own_groups(surface: SurfacePoints, geometry: Geometry) -> Ints:
    """(M,) groups that cannot shade some points; (0,) while there are no shadow maps."""
    maps = geometry.static.shadow_maps
    if not maps.made:
        return NO_LIGHT
    own = scratch("own groups", len(surface.pixels), dtype=np.int32)
    own_groups(surface.triangles, maps.groups(), surface.rows, surface.flats, FLAT, own)
    return own


class Looked(NamedTuple):
    """Data by which rays to a light are looked up: see `shadow_maps.occluded`."""

    places: Ints
    own: Ints
    light: Floats


def _blocked(
    parts: Sequence[Part], rays: Floats, far: float, known: Looked | None = None, *, lamp: bool = False
) -> NDArray[np.bool_]:
    """(N,) whether rays are blocked; lamps do not block a lamp's rays."""
    stays = parts[0]
    caster = stays.shadows if lamp else stays.caster
    found = caster.occluded(rays, far) if known is None else occluded(caster, stays.shadow_maps, rays, far, *known)
    for moves in parts[1:]:
        some = scratch("meeting", len(rays), dtype=np.int32)
        some = some[: light_rays.meeting(rays, found, moves.boxes, some)]
        if len(some):
            found[some] = (moves.shadows if lamp else moves.caster).occluded(rays[some], far)
    return found


def _marked(seen: Bytes, column: int, index: Ints, blocked: NDArray[np.bool_], value: np.uint8) -> Ints:
    """Return the points with unblocked rays; the others are marked in `seen`."""
    lit = scratch("lit", len(index), dtype=np.int32)
    return lit[: light_rays.mark(index, blocked, seen, column, value, lit)].copy()


def dim(exposure: Exposure, geometry: Geometry, setting: Setting, skipped: NDArray[np.bool_]) -> tuple[Bytes, Ints]:
    """Visibility of lights after occlusion by moving things.

    Args:
        exposure: visibility with static things only.
        geometry, setting: as in `expose`, without noise.
        skipped: (M,) whether a point is excluded.

    Returns:
        The new `seen`, and the indices of the points where it changed.
    """
    changed: list[Ints] = []
    seen = exposure.seen
    for column, lit in exposure.lit.items():
        dark = _darkened(lit, exposure.points, geometry.moving, setting, column, skipped)
        if len(dark):
            seen = seen.copy() if seen is exposure.seen else seen
            window = column != SUN and setting.lights[column - 1].facing is not None
            seen[dark, column] = DIM if window else 0
            changed.append(dark)
    return seen, np.unique(np.concatenate(changed)) if changed else NO_LIGHT


def _darkened(
    lit: Ints, points: Floats, moving: Part, setting: Setting, column: int, skipped: NDArray[np.bool_]
) -> Ints:
    """Return the points, of those that a light reaches, that moving things shade."""
    is_sun, far = column == SUN, 0.999 if column == SUN else 0.97
    if not len(lit) or not _moves_before(moving, setting, column):
        return NO_LIGHT
    target = _target(setting, column)
    grid = moving.light_grids.of(target, is_sun=is_sun)
    if grid is not None:
        return grid.shaded(lit, skipped, points, far).copy()
    out, index = scratch("rays", len(lit), 6), scratch("index", len(lit), dtype=np.int32)
    found = light_rays.aim_again(lit, skipped, points, target, is_sun, moving.boxes, out, index)
    return index[:found][(moving.caster if is_sun else moving.shadows).occluded(out[:found], far)]


def make_grids(exposures: Sequence[Exposure], moving: Part, setting: Setting) -> None:
    """Make the light grids that `dim` will need, on several threads."""
    columns = sorted({column for one in exposures for column, lit in one.lit.items() if len(lit)})
    due = [column for column in columns if _moves_before(moving, setting, column)]
    moving.light_grids.make((_target(setting, column), column == SUN) for column in due)


def _target(setting: Setting, column: int) -> Floats:
    """Return the direction to the sun, or a light's position."""
    return setting.day[:3] if column == SUN else setting.rows[column - 1, :3]


def _moves_before(moving: Part, setting: Setting, column: int) -> bool:
    """Return whether something that moves may lie between a light and its lit objects."""
    return len(moving.mesh) > 0 and (column == SUN or _between(setting.rows[column - 1], moving.boxes))


def _between(light: Floats, boxes: Floats) -> bool:
    """Return whether one of (B, 6) boxes may lie between a lamp and the area that it lights."""
    (x, _, z), (west, east, south, north) = light[:3], light[light_rays.L_AREA : light_rays.L_AREA + 4]
    across = (boxes[:, 0] <= max(east, x)) & (boxes[:, 3] >= min(west, x))
    return bool((across & (boxes[:, 2] <= max(north, z)) & (boxes[:, 5] >= min(south, z))).any())


def paint(
    surface: SurfacePoints, near: Ints, seen: Bytes, rays: Floats, hits: Hits, setting: Setting, out: Bytes
) -> None:
    """Write the colours of some pixels.

    Args:
        surface: their M surface points.
        near: lights that may reach them.
        seen: (M, lights + 2) as in `Exposure`.
        rays, hits: of all pixels.
        setting: the lights.
        out: (N, 3) sRGB of all pixels, filled.
    """
    count, day = len(surface.pixels), setting.day
    light, gloss = scratch("light", count, 3), scratch("gloss", count, 3)
    places = (surface.points, surface.normals, surface.flats, surface.views, surface.rows)
    loops.lighten(*places, seen, day, setting.rows, near, light, gloss)
    faces = (surface.rows, surface.normals, surface.flats, surface.views)
    atlas = (texels(), decode(), tones(), out)
    where = (surface.pixels, rays, hits.distance, hits.u, hits.v)
    loops.colour(*where, *faces, light, gloss, day[light_rays.D_ANGLE], *atlas)
    loops.outside(surface.pixels, rays, surface.flats, surface.views, day, *atlas)


EXPOSURE = 1.5


@cache
def tones() -> Bytes:
    """(TONE_STEPS + 1,) sRGB bytes of linear light, indexed by TONE_SCALE times its root: neighbours differ by less
    than one grey level. Bright values are compressed rather than clipped.
    """
    light = (np.arange(loops.TONE_STEPS + 1) / float(loops.TONE_SCALE)) ** 2
    tone = 1 - np.exp(-EXPOSURE * light)
    code = np.where(tone <= 0.0031308, 12.92 * tone, 1.055 * np.power(np.maximum(tone, 1e-6), 1 / 2.4) - 0.055)
    return (code * 255 + 0.5).astype(np.uint8)


def whole(
    pixels: Sequence[Ints], rays: Floats, hits: Hits, geometry: Geometry, setting: Setting, out: Bytes
) -> list[Exposure]:
    """Draft colours of pixels, chunk by chunk; returns the exposures with static occlusion."""
    geometry.static.shadow_maps.make()

    def work(chunk: Ints) -> Exposure:
        surface = located(chunk, rays, hits, geometry)
        exposure = expose(surface, geometry, setting)
        seen, _ = dim(exposure, geometry, setting, np.zeros(len(chunk), np.bool_))
        paint(surface, exposure.near, seen, rays, hits, setting, out)
        return exposure

    return each(work, pixels)
