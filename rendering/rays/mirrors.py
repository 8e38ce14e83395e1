"""Mirrors: pixels that show one show what a ray sees that it throws back. A mirror in a mirror is a shiny plate."""

import numpy as np

from hearth.rendering.arrays import Bytes, Floats, Ints
from hearth.rendering.rays import shading
from hearth.rendering.rays.ray_casting import Hits
from hearth.rendering.rays.shading import Setting
from hearth.rendering.scene.triangles import Geometry

SILVER = np.array((0.9, 0.93, 0.92))
"""Share of each colour's grey level that a mirror throws back."""


def mirrored(
    rays: Floats, hits: Hits, geometry: Geometry, setting: Setting, out: Bytes, among: Ints | None = None
) -> int:
    """Replace the colors of mirrors' pixels by their reflections; return the number of these pixels.

    Args:
        rays, hits, geometry: of all pixels.
        setting: the lights.
        out: (N, 3) colours of all pixels, changed.
        among: the pixels that may show a mirror; None for all.
    """
    pixels = showing(hits, geometry, among)
    if not len(pixels):
        return 0
    thrown = _thrown_back(pixels, rays, hits, geometry)
    found, seen = geometry.cast(thrown), np.empty((len(pixels), 3), np.uint8)
    # Textures shrink with the whole way, of which the ray's own length is the second part.
    shading.whole(shading.chunks(np.arange(len(pixels), dtype=np.int32)), thrown, found, geometry, setting, seen)
    out[pixels] = (seen * SILVER).astype(np.uint8)
    return len(pixels)


def showing(hits: Hits, geometry: Geometry, among: Ints | None = None) -> Ints:
    """Return the pixels, all or some, that show a mirror."""
    mirrors = np.concatenate((geometry.static.mirrors, geometry.moving.mirrors, [np.False_]))
    if not mirrors.any():
        return np.empty(0, np.int32)
    if among is not None:
        return among[mirrors[hits.triangle[among]]]
    return np.flatnonzero(mirrors[hits.triangle]).astype(np.int32)


def _thrown_back(pixels: Ints, rays: Floats, hits: Hits, geometry: Geometry) -> Floats:
    """(M, 6) rays from M pixels' surface points; their directions are as long as those of the rays that arrive."""
    surface = shading.located(pixels, rays, hits, geometry)
    ways, flats = rays[pixels, 3:], surface.flats
    back = ways - 2 * (ways * flats).sum(axis=1, keepdims=True) * flats
    return np.ascontiguousarray(np.concatenate((surface.points, back), axis=1), np.float32)
