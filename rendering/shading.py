"""From hits to light: textures, sun, windows, lamps, ambient light with occlusion, gloss, and a picture's tone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hearth.rendering import textures
from hearth.rendering.lights import Daylight, Light
from hearth.rendering.rays import Caster, Hits
from hearth.rendering.scene import Geometry, Scene

Floats = NDArray[np.float32]

LIFT = 2e-3
"""Metres by which points are lifted off their surface before rays are cast from them."""

REACH = 7.0
"""Metres beyond which lamps are not looked at."""

NEAR = 0.7
"""Metres within which something darkens the ambient light of a corner."""

SECTION = np.array((0.05, 0.055, 0.065), np.float32)
"""Where a view from above cuts through a wall."""


@dataclass(frozen=True, eq=False)
class View:
    """N rays, what they hit, and how they are to be shaded.

    Attributes:
        rays: (N, 6).
        hits: what they hit.
        noise: (N, 2) for soft shadows and occlusion.
        angle: radians a pixel spans.
        fine: soft shadows and ambient occlusion.
    """

    rays: Floats
    hits: Hits
    noise: Floats
    angle: float
    fine: bool

    def part(self, found: NDArray[np.int64]) -> View:
        """Only those rays."""
        hits = Hits(*(values[found] for values in self.hits))
        return View(self.rays[found], hits, self.noise[found], self.angle, self.fine)


@dataclass(frozen=True, eq=False)
class Surface:
    """M visible points: what shading needs to know of them.

    Attributes:
        points, normals: (M, 3), normals towards the viewer; `flat` are those of the triangles.
        view: (M, 3) unit vectors along the ray.
        albedo: (M, 3) linear. glow, shine: (M,).
        noise: (M, 2) numbers from 0 to 1 that differ among neighbouring pixels and passes.
        inner: (M,) whether it is the inside of a wall that was cut through.
        light, gloss: (M, 3) light that arrives, and mirror images of lights: filled while shading.
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


def radiance(scene: Scene, geometry: Geometry, view: View, day: Daylight) -> Floats:
    """(N, 3) linear light along N rays; zero where nothing was hit."""
    found = np.flatnonzero(view.hits.triangle >= 0)
    image = np.zeros((len(view.rays), 3), np.float32)
    if not len(found):
        return image
    surface = surface_at(geometry, view.part(found))
    surface.light[:] = _ambient(day, surface, geometry.caster, view.fine)
    _add_sun(day, surface, geometry.caster, view.fine)
    for source in scene.lights:
        _add_light(source, surface, geometry.shadows, view.fine)
    color = surface.albedo * (surface.light + surface.glow[:, None]) + surface.gloss + _reflection(surface)
    color[surface.inner] = SECTION
    image[found] = color
    return image


def surface_at(geometry: Geometry, view: View) -> Surface:
    """The visible points of rays that all hit something."""
    mesh, triangle, hits = geometry.mesh, view.hits.triangle, view.hits
    weights = np.column_stack((1 - hits.uv[:, 0] - hits.uv[:, 1], hits.uv)).astype(np.float32)[:, None, :]
    normals = np.matmul(weights, mesh.normals[triangle])[:, 0]
    uvs = np.matmul(weights, mesh.uvs[triangle])[:, 0]
    direction = view.rays[:, 3:]
    length = np.sqrt(np.einsum("ij,ij->i", direction, direction))
    toward = direction / length[:, None]
    flat = geometry.flat[triangle]
    behind = np.einsum("ij,ij->i", flat, toward) > 0
    flat[behind] *= -1
    normals[np.einsum("ij,ij->i", normals, flat) < 0] *= -1
    points = view.rays[:, :3] + direction * hits.distance[:, None] + flat * LIFT
    footprint = hits.distance * length * view.angle * geometry.density[triangle]
    attributes = mesh.surface[triangle]
    albedo = attributes[:, :3] * textures.sample(mesh.textures[triangle], uvs, footprint)
    light, gloss = np.zeros_like(points), np.zeros_like(points)
    inner = behind & geometry.solid[triangle]
    return Surface(
        points, normals, flat, toward, albedo, attributes[:, 3], attributes[:, 4], view.noise, inner, light, gloss
    )


def _ambient(day: Daylight, surface: Surface, caster: Caster, fine: bool) -> Floats:
    """Light from everywhere: more from above, less in corners."""
    up = surface.normals[:, 1]
    level = day.ambient * (1.0 + 0.22 * up + 0.06 * surface.normals[:, 0])
    if fine:
        level = level * (1 - 0.85 * _occlusion(surface, caster, 2))
    return np.outer(level, np.array((1.0, 0.985, 0.96), np.float32)).astype(np.float32)


def _occlusion(surface: Surface, caster: Caster, count: int) -> Floats:
    """(M,) share of `count` rays over the hemisphere that hit something near."""
    blocked = np.zeros(len(surface.points), np.float32)
    for k in range(count):
        u = (surface.noise[:, 0] + k / count) % 1.0
        phi = 2 * np.pi * ((surface.noise[:, 1] + k * 0.618) % 1.0)
        z = 1 - 2 * u
        ring = np.sqrt(np.maximum(1 - z * z, 0))
        # A point of the unit ball set on the normal's tip is a direction of cosine density.
        direction = surface.flat * 1.02 + np.column_stack((ring * np.cos(phi), z, ring * np.sin(phi)))
        direction *= (NEAR / np.maximum(np.linalg.norm(direction, axis=1), 1e-3))[:, None]
        blocked += caster.occluded(surface.points, direction.astype(np.float32))
    return blocked / count


def _add_sun(day: Daylight, surface: Surface, caster: Caster, fine: bool) -> None:
    """Add direct sunlight, with soft edges when fine."""
    if day.sun is None:
        return
    sun = np.array(day.sun, np.float32)
    facing = surface.normals @ sun
    lit = np.flatnonzero((facing > 0) & (surface.flat @ sun > 0))
    direction = np.broadcast_to(sun, (len(lit), 3)).copy()
    if fine:
        direction += (surface.noise[lit][:, [0, 1, 0]] - 0.5) * np.array((0.05, 0.02, -0.05), np.float32)
    free = lit[~caster.occluded(surface.points[lit], direction * 60.0)]
    surface.light[free] += facing[free, None] * np.array(day.sunlight, np.float32)


def _add_light(source: Light, surface: Surface, caster: Caster, fine: bool) -> None:
    """Add what a lamp or window gives to the surface's light, and its highlights to its gloss."""
    near = _within(source, surface.points)
    if not len(near):
        return
    points, normals = surface.points[near], surface.normals[near]
    way = _targets(source, surface.noise[near], fine) - points
    square = np.einsum("ij,ij->i", way, way)
    toward = way / np.sqrt(square)[:, None]
    strength = _strength(source, toward, normals, square)
    seen = strength > 3e-3
    if fine or source.facing is None:
        cast = np.flatnonzero(seen & (np.einsum("ij,ij->i", surface.flat[near], toward) > 0))
        blocked = caster.occluded(points[cast], way[cast], 0.97)
        strength[cast[blocked]] *= 0.0 if source.facing is None else 0.25
    color = np.array(source.color, np.float32)
    surface.light[near] += strength[:, None] * color
    glossy = np.flatnonzero(seen & (surface.shine[near] > 0.05))
    if len(glossy):
        spots = near[glossy]
        surface.gloss[spots] += _highlight(surface, spots, toward[glossy], strength[glossy])[:, None] * color


def _within(source: Light, points: Floats) -> NDArray[np.int64]:
    """Which points a light may reach: those in its room; a lamp's also a little beyond, through doors."""
    x0, x1, z0, z1 = source.room or (source.position[0] - REACH, source.position[0] + REACH,
                                     source.position[2] - REACH, source.position[2] + REACH)  # fmt: skip
    x, z = points[:, 0], points[:, 2]
    return np.flatnonzero((x > x0) & (x < x1) & (z > z0) & (z < z1))


def _targets(source: Light, noise: Floats, fine: bool) -> Floats:
    """(3,) the light's middle, or (K, 3) points all over it."""
    middle = np.array(source.position, np.float32)
    if not fine:
        return middle
    third = (noise[:, 0] + noise[:, 1]) % 1.0
    order = (third, noise[:, 1], noise[:, 0]) if source.span[0] < source.span[2] else (noise[:, 0], noise[:, 1], third)
    return middle + (np.column_stack(order) * 2 - 1) * np.array(source.span, np.float32)


def _strength(source: Light, toward: Floats, normals: Floats, square: Floats) -> Floats:
    """(K,) how much of a light reaches points at squared distances, before shadows."""
    cosine = np.einsum("ij,ij->i", normals, toward)
    if source.facing is None:
        return np.maximum(cosine, 0) * np.maximum(1 - (square / REACH**2) ** 2, 0) / (square + 0.35)
    # The sky is wide: surfaces turned a little away from the window still see some of it.
    leaving = 0.25 + 0.75 * np.maximum(-(toward @ np.array(source.facing, np.float32)), 0)
    return np.maximum((cosine + 0.25) / 1.25, 0) * leaving / (square + 0.8)


def _highlight(surface: Surface, spots: NDArray[np.int64], toward: Floats, strength: Floats) -> Floats:
    """(K,) the mirror image of a light on polished surfaces."""
    shine = surface.shine[spots]
    half = toward - surface.view[spots]
    half /= np.maximum(np.sqrt(np.einsum("ij,ij->i", half, half)), 1e-6)[:, None]
    cosine = np.maximum(np.einsum("ij,ij->i", half, surface.normals[spots]), 0)
    return shine * shine * 1.2 * cosine ** (8 + 70 * shine) * strength


def _reflection(surface: Surface) -> Floats:
    """What polished surfaces mirror of a bright ceiling and a darker floor; no rays are cast for it."""
    cosine = -np.einsum("ij,ij->i", surface.view, surface.normals)
    mirrored = surface.view[:, 1] + 2 * cosine * surface.normals[:, 1]
    fresnel = 0.05 + 0.95 * (1 - np.clip(cosine, 0, 1)) ** 5
    share = surface.shine**2 * np.clip(fresnel + 0.25 * (surface.shine > 0.85), 0, 0.6)
    room = (0.35 + 0.65 * (mirrored > 0.15) * np.clip(mirrored + 0.3, 0, 1)).astype(np.float32)
    return (share * room)[:, None] * surface.light.mean(axis=1, keepdims=True)


def background(day: Daylight, rays: Floats, plain: bool) -> Floats:
    """(N, 3) sky and lawn outside, or a plain ground for views from above."""
    if plain:
        return np.full((len(rays), 3), 0.55, np.float32)
    direction = rays[:, 3:] / np.linalg.norm(rays[:, 3:], axis=1, keepdims=True)
    up = np.clip(direction[:, 1:2], 0, 1) ** 0.6
    zenith, horizon = np.array(day.zenith, np.float32), np.array(day.horizon, np.float32)
    color = horizon + (zenith - horizon) * up
    low = np.flatnonzero(direction[:, 1] < -1e-3)
    if len(low):
        far = (rays[low, 1] + 0.3) / -direction[low, 1]
        spot = rays[low, :3] + direction[low] * far[:, None]
        slots = np.full(len(low), textures.SLOTS["grass"], np.int16)
        lawn = textures.sample(slots, spot[:, [0, 2]] * 0.4, far * 0.004) * np.array((0.17, 0.30, 0.08), np.float32)
        lawn *= 0.25 + 0.75 * min(1.0, day.sky)
        haze = np.clip(far / 90.0, 0, 0.75)[:, None]
        color[low] = lawn * (1 - haze) + horizon * haze * 0.85
    return color.astype(np.float32)


EXPOSURE = 1.5


def develop(image: Floats) -> NDArray[np.uint8]:
    """Linear light to sRGB bytes; bright parts are compressed smoothly, so that nothing is blown out."""
    tone = 1 - np.exp(-EXPOSURE * np.maximum(image, 0))
    code = np.where(tone <= 0.0031308, 12.92 * tone, 1.055 * np.power(np.maximum(tone, 1e-6), 1 / 2.4) - 0.055)
    return (code * 255 + 0.5).astype(np.uint8)
