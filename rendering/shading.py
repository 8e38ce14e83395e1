"""From hits to light: textures, sun, windows, lamps, ambient light with occlusion, gloss, and a picture's tone.

Points and vectors are rows of x, y and z, (3, N): numpy is several times as fast on them as on columns.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering import geometry as g
from hearth.rendering import textures
from hearth.rendering.geometry import Geometry
from hearth.rendering.lights import Daylight, Light
from hearth.rendering.rays import Hits

Floats = NDArray[np.floating[Any]]
Ids = NDArray[np.int64]

LIFT = 2e-3
"""Metres by which points are lifted off their surface before rays are cast from them."""

REACH = 7.0
"""Metres beyond which lamps are not looked at."""

NEAR = 0.7
"""Metres within which something darkens the ambient light of a corner."""

FAINT = 6e-3
"""Light below which nobody looks for its shadow."""

SECTION = (0.05, 0.055, 0.065)
"""Where a view from above cuts through a wall."""

CHUNK = 16384
"""Rays that are shaded together: their numbers fit the processor's cache."""


@dataclass(frozen=True, eq=False)
class View:
    """N rays, what they hit, and how they are to be shaded.

    Attributes:
        rays: (6, N).
        hits: what they hit.
        noise: (2, N) for soft shadows and occlusion; empty unless fine.
        angle: radians a pixel spans.
        fine: soft shadows and ambient occlusion.
    """

    rays: Floats
    hits: Hits
    noise: Floats
    angle: float
    fine: bool

    def part(self, found: Ids) -> View:
        """Only those rays."""
        noise = self.noise.take(found, axis=1) if self.fine else self.noise
        return View(self.rays.take(found, axis=1), self.hits.part(found), noise, self.angle, self.fine)


@dataclass(frozen=True, eq=False)
class Surface:
    """M visible points: what shading needs to know of them.

    Attributes:
        points, normals: (3, M), normals towards the viewer; `flat` are those of the triangles.
        view: (3, M) unit vectors along the ray.
        albedo: (3, M) linear. glow, shine: (M,).
        noise: (2, M) numbers from 0 to 1 that differ among neighbouring pixels and passes.
        inner: (M,) whether it is the inside of a wall that was cut through.
        light, gloss: (3, M) light that arrives, and mirror images of lights: filled while shading.
    """

    points: Floats
    normals: Floats
    flat: Floats
    view: Floats
    albedo: Floats
    glow: Floats
    shine: Floats
    noise: Floats
    inner: NDArray[np.bool_]
    light: Floats
    gloss: Floats


def radiance(lights: tuple[Light, ...], geometry: Geometry, view: View, day: Daylight) -> Floats:
    """(3, N) linear light along N rays; zero where nothing was hit."""
    image = np.zeros((3, view.rays.shape[1]), np.float32)
    found = np.flatnonzero(view.hits.triangle >= 0)
    for start in range(0, len(found), CHUNK):
        chunk = found[start : start + CHUNK]
        image[:, chunk] = _shaded(lights, geometry, view.part(chunk), day)
    return image


def _shaded(lights: tuple[Light, ...], geometry: Geometry, view: View, day: Daylight) -> Floats:
    surface = surface_at(geometry, view)
    surface.light[:] = _ambient(day, surface, geometry, view.fine)
    _add_sun(day, surface, geometry, view.fine)
    for source in _in_reach(lights, surface.points):
        _add_light(source, surface, geometry, view.fine)
    color = surface.albedo * (surface.light + surface.glow) + surface.gloss + _reflection(surface)
    color[:, surface.inner] = np.array(SECTION, np.float32)[:, None]
    return color


def _in_reach(lights: tuple[Light, ...], points: Floats) -> list[Light]:
    """The lights that reach some of the points' neighbourhood."""
    (west, east), (south, north) = ((axis.min(), axis.max()) for axis in (points[0], points[2]))
    areas = [(light, area(light)) for light in lights]
    return [light for light, (x0, x1, z0, z1) in areas if x0 < east and x1 > west and z0 < north and z1 > south]


def area(source: Light) -> tuple[float, float, float, float]:
    """(x0, x1, z0, z1) beyond which a light is not looked at."""
    x, _, z = source.position
    return source.room or (x - REACH, x + REACH, z - REACH, z + REACH)


def dot(a: Floats, b: Floats) -> Floats:
    """(N,) scalar products of (3, N) vectors, or of one (3,) with many."""
    result: Floats = a[0] * b[0]
    result += a[1] * b[1]
    result += a[2] * b[2]
    return result


def visible_points(geometry: Geometry, view: View) -> tuple[Floats, Floats]:
    """(3, M) points of rays that all hit something, lifted off their surface, and (3, M) flat normals there."""
    flat = geometry.rows(view.hits.triangle, g.FLAT)
    direction = view.rays[3:]
    flat *= np.where(dot(flat, direction) > 0, np.float32(-1), np.float32(1))
    return view.rays[:3] + direction * view.hits.distance + flat * np.float32(LIFT), flat


def surface_at(geometry: Geometry, view: View) -> Surface:
    """The visible points of rays that all hit something."""
    hits = view.hits
    rows = geometry.rows(hits.triangle)
    direction = view.rays[3:]
    length = np.sqrt(dot(direction, direction))
    toward = direction / length
    normals = rows[g.NORMAL] + rows[g.NORMAL_U] * hits.u + rows[g.NORMAL_V] * hits.v
    uvs = rows[g.UV] + rows[g.UV_U] * hits.u + rows[g.UV_V] * hits.v
    flat = rows[g.FLAT]
    behind = dot(flat, toward) > 0
    flat *= np.where(behind, np.float32(-1), np.float32(1))
    normals *= np.where(dot(normals, flat) < 0, np.float32(-1), np.float32(1))
    points = view.rays[:3] + direction * hits.distance + flat * np.float32(LIFT)
    footprint = hits.distance * length * np.float32(view.angle) * rows[g.DENSITY]
    albedo = rows[g.COLOR] * textures.sample(rows[g.TEXTURE].astype(np.int64), uvs, footprint)
    inner = behind & (rows[g.SOLID] > 0)
    light, gloss = np.zeros_like(points), np.zeros_like(points)
    return Surface(points, normals, flat, toward, albedo, rows[g.GLOW], rows[g.SHINE], view.noise, inner, light, gloss)


def _ambient(day: Daylight, surface: Surface, geometry: Geometry, fine: bool) -> Floats:
    """Light from everywhere: more from above, less in corners."""
    level = day.ambient * (1.0 + 0.22 * surface.normals[1] + 0.06 * surface.normals[0])
    if fine:
        level = level * (1 - 0.85 * _occlusion(surface, geometry, 2))
    return np.outer(np.array((1.0, 0.985, 0.96), np.float32), level).astype(np.float32)


def _occlusion(surface: Surface, geometry: Geometry, count: int) -> Floats:
    """(M,) share of `count` rays over the hemisphere that hit something near."""
    blocked = np.zeros(surface.points.shape[1], np.float32)
    for k in range(count):
        u = (surface.noise[0] + k / count) % 1.0
        phi = 2 * np.pi * ((surface.noise[1] + k * 0.618) % 1.0)
        z = 1 - 2 * u
        ring = np.sqrt(np.maximum(1 - z * z, 0))
        # A point of the unit ball set on the normal's tip is a direction of cosine density.
        direction = surface.flat * 1.02 + np.stack((ring * np.cos(phi), z, ring * np.sin(phi)))
        direction *= NEAR / np.maximum(np.sqrt(dot(direction, direction)), 1e-3)
        blocked += geometry.occluded(surface.points, direction.astype(np.float32))
    return blocked / count


def _add_sun(day: Daylight, surface: Surface, geometry: Geometry, fine: bool) -> None:
    """Add direct sunlight, with soft edges when fine."""
    if day.sun is None:
        return
    facing = dot(np.array(day.sun, np.float32), surface.normals)
    lit = facing_sun(day, facing, surface.flat)
    direction = np.repeat(np.array(day.sun, np.float32)[:, None], len(lit), axis=1)
    if fine:
        direction += (surface.noise[[0, 1, 0]][:, lit] - 0.5) * np.array(((0.05,), (0.02,), (-0.05,)), np.float32)
    free = lit[~geometry.occluded(surface.points.take(lit, axis=1), direction * np.float32(FAR))]
    surface.light[:, free] += facing[free] * np.array(day.sunlight, np.float32)[:, None]


FAR = 60.0
"""Metres beyond which nothing keeps the sun away."""


def facing_sun(day: Daylight, facing: Floats, flat: Floats) -> Ids:
    """Which points the sun could light; `facing` is the cosine at their shading normals."""
    return np.flatnonzero((facing > 0) & (dot(np.array(day.sun, np.float32), flat) > 0))


def _add_light(source: Light, surface: Surface, geometry: Geometry, fine: bool) -> None:
    """Add what a lamp or window gives to the surface's light, and its highlights to its gloss."""
    near = within(source, surface.points)
    if not len(near):
        return
    whole = len(near) == surface.points.shape[1]
    points, normals = (a if whole else a.take(near, axis=1) for a in (surface.points, surface.normals))
    way = _targets(source, surface.noise[:, near] if fine else surface.noise, fine) - points
    square = dot(way, way)
    toward = way / np.sqrt(square)
    strength = _strength(source, toward, normals, square)
    seen = strength > FAINT
    if fine or source.facing is None:
        cast = np.flatnonzero(seen & (dot(surface.flat.take(near, axis=1), toward) > 0))
        blocked = geometry.occluded(points.take(cast, axis=1), way.take(cast, axis=1), 0.97, shadows=True)
        strength[cast[blocked]] *= 0.0 if source.facing is None else 0.25
    color = np.array(source.color, np.float32)[:, None]
    surface.light[:, near] += strength * color
    glossy = np.flatnonzero(seen & (surface.shine[near] > 0.05))
    if len(glossy):
        spots = near[glossy]
        surface.gloss[:, spots] += _highlight(surface, spots, toward[:, glossy], strength[glossy]) * color


def within(source: Light, points: Floats) -> Ids:
    """Which points a light may reach: those in its room; a lamp's also a little beyond, through doors."""
    x0, x1, z0, z1 = area(source)
    x, z = points[0], points[2]
    return np.flatnonzero((x > x0) & (x < x1) & (z > z0) & (z < z1))


def _targets(source: Light, noise: Floats, fine: bool) -> Floats:
    """(3, 1) the light's middle, or (3, K) points all over it."""
    middle = np.array(source.position, np.float32)[:, None]
    if not fine:
        return middle
    third = (noise[0] + noise[1]) % 1.0
    order = (third, noise[1], noise[0]) if source.span[0] < source.span[2] else (noise[0], noise[1], third)
    targets: Floats = middle + (np.stack(order) * 2 - 1) * np.array(source.span, np.float32)[:, None]
    return targets


def _strength(source: Light, toward: Floats, normals: Floats, square: Floats) -> Floats:
    """(K,) how much of a light reaches points at squared distances, before shadows."""
    cosine = dot(normals, toward)
    if source.facing is None:
        bare: Floats = np.maximum(cosine, 0) * np.maximum(1 - (square / REACH**2) ** 2, 0) / (square + 0.35)
        return bare
    # The sky is wide: surfaces turned a little away from the window still see some of it.
    leaving = 0.25 + 0.75 * np.maximum(-dot(np.array(source.facing, np.float32), toward), 0)
    wide: Floats = np.maximum((cosine + 0.25) / 1.25, 0) * leaving / (square + 0.8)
    return wide


def _highlight(surface: Surface, spots: Ids, toward: Floats, strength: Floats) -> Floats:
    """(K,) the mirror image of a light on polished surfaces."""
    shine = surface.shine[spots]
    half = toward - surface.view.take(spots, axis=1)
    half /= np.maximum(np.sqrt(dot(half, half)), 1e-6)
    cosine = np.maximum(dot(half, surface.normals.take(spots, axis=1)), 0)
    return shine * shine * 1.2 * cosine ** (8 + 70 * shine) * strength


def _reflection(surface: Surface) -> Floats:
    """What polished surfaces mirror of a bright ceiling and a darker floor; no rays are cast for it."""
    cosine = -dot(surface.view, surface.normals)
    mirrored = surface.view[1] + 2 * cosine * surface.normals[1]
    away = 1 - np.clip(cosine, 0, 1)
    square = away * away
    fresnel = 0.05 + 0.95 * square * square * away
    share = surface.shine**2 * np.clip(fresnel + 0.25 * (surface.shine > 0.85), 0, 0.6)
    room = 0.35 + 0.65 * (mirrored > 0.15) * np.clip(mirrored + 0.3, 0, 1)
    light = surface.light
    reflected: Floats = share * room * (light[0] + light[1] + light[2]) / 3
    return reflected


GROUND = 0.55
"""How bright the plain ground is that a view from above shows around a home."""


def background(day: Daylight, rays: Floats, plain: bool) -> Floats:
    """(3, N) sky and lawn outside, or a plain ground for views from above."""
    if plain:
        return np.full((3, rays.shape[1]), GROUND, np.float32)
    direction = rays[3:] / np.sqrt(dot(rays[3:], rays[3:]))
    up = np.clip(direction[1], 0, 1) ** np.float32(0.6)
    zenith, horizon = (np.array(c, np.float32)[:, None] for c in (day.zenith, day.horizon))
    color = horizon + (zenith - horizon) * up
    low = np.flatnonzero(direction[1] < -1e-3)
    if len(low):
        origin, way = rays[:3].take(low, axis=1), direction.take(low, axis=1)
        far = (origin[1] + 0.3) / -way[1]
        spot = origin + way * far
        slots = np.full(len(low), textures.SLOTS["grass"], np.int64)
        lawn = textures.sample(slots, spot[[0, 2]] * np.float32(0.4), far * np.float32(0.004))
        lawn *= np.array(((0.17,), (0.30,), (0.08,)), np.float32) * (0.25 + 0.75 * min(1.0, day.sky))
        haze = np.clip(far / 90.0, 0, 0.75)
        color[:, low] = lawn * (1 - haze) + horizon * haze * 0.85
    outside: Floats = color.astype(np.float32)
    return outside


EXPOSURE = 1.5

STEPS = 4096
"""Entries of the tone table: neighbours differ by less than one grey level."""


def _tone_table() -> NDArray[np.uint8]:
    """(STEPS + 1,) sRGB byte of sqrt(1 - exp(-x)) in equal steps: fine in the dark, where eyes are."""
    tone = (np.arange(STEPS + 1) / STEPS) ** 2
    code = np.where(tone <= 0.0031308, 12.92 * tone, 1.055 * np.power(np.maximum(tone, 1e-6), 1 / 2.4) - 0.055)
    return (code * 255 + 0.5).astype(np.uint8)


TONES = _tone_table()


def develop(image: Floats) -> NDArray[np.uint8]:
    """(3, N) linear light to (N, 3) sRGB bytes; bright parts are compressed, so that nothing is blown out."""
    tone = np.sqrt(1 - np.exp(np.float32(-EXPOSURE) * np.maximum(image, 0)))
    return np.ascontiguousarray(TONES.take((tone * np.float32(STEPS)).astype(np.int32)).T)
