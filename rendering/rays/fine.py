"""Fine pictures: soft shadows, ambient occlusion, and several rays where one is not enough."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from hearth.rendering.arrays import Bytes, Floats, Ints
from hearth.rendering.rays import maps, shading
from hearth.rendering.rays.casting import Hits
from hearth.rendering.rays.shading import Setting
from hearth.rendering.rays.shot import Shot, camera_rays, everywhere, prepare, setting_of
from hearth.rendering.rays.threads import each

SUBPIXELS = ((0.625, 0.125), (0.125, 0.375), (0.875, 0.625), (0.375, 0.875))
"""Where the four rays of a pixel at an edge go: a rotated grid."""

STEP = 14
"""Grey levels between neighbouring pixels from which on they are drawn with four rays."""


class Sight(NamedTuple):
    """What all pixels show: (N, 3) points and normals of triangles, and (N, K) what they see of the lights."""

    points: Floats
    flats: Floats
    seen: Bytes


def fine(shot: Shot) -> Bytes:
    """(H*W, 3) colours: each point sees lights with one ray, and shares what it sees with its neighbours on the same
    surface; pixels at edges are drawn again with four rays each.
    """
    camera, size = shot.camera, len(shot.rays)
    prepare(shot.geometry)
    setting, chunks = setting_of(shot, fine=True), shading.chunks(everywhere(size))
    sight = _smoothed(shot, _looked(shot, setting, chunks))
    out = np.empty((size, 3), np.uint8)

    def paint(chunk: Ints) -> None:
        spots = shading.located(chunk, shot.rays, shot.hits, shot.geometry)
        near = setting.reaching(spots.bounds)
        shading.paint(spots, near, sight.seen[chunk], shot.rays, shot.hits, setting, out)

    each(paint, chunks)
    rough = np.zeros(size, np.bool_)
    maps.edges(out, shot.hits.triangle, shot.geometry.owners, camera.width, camera.height, STEP, rough)
    again = np.flatnonzero(rough).astype(np.int32)
    if len(again):
        out[again] = _mixed(shot, again, sight)
    return out


def _looked(shot: Shot, setting: Setting, chunks: list[Ints]) -> Sight:
    """What each pixel sees of the lights with one ray at each."""
    size = len(shot.rays)
    points, flats = np.empty((2, size, 3), np.float32)
    seen = np.empty((size, len(setting.lights) + 2), np.uint8)
    noise = _noise(shot.camera.height, shot.camera.width, 0)

    def look(chunk: Ints) -> None:
        spots = shading.located(chunk, shot.rays, shot.hits, shot.geometry)
        points[chunk], flats[chunk] = spots.points, spots.flats
        seen[chunk] = shading.expose(spots, shot.geometry, setting, noise[chunk]).seen

    each(look, chunks)
    return Sight(points, flats, seen)


BAND = 40
"""Rows of pixels that are smoothed together."""


def _smoothed(shot: Shot, sight: Sight) -> Sight:
    """Shared with the neighbours."""
    width, height = shot.camera.width, shot.camera.height
    points, flats, seen = sight
    columns = np.flatnonzero((seen != seen[0]).any(axis=0)).astype(np.int32)
    smooth = seen.copy()

    def work(top: int) -> None:
        maps.smoothed(seen, columns, flats, points, width, height, top, min(top + BAND, height), smooth)

    each(work, range(0, height, BAND))
    return Sight(points, flats, smooth)


def _mixed(shot: Shot, pixels: Ints, sight: Sight) -> Bytes:
    """(M, 3) colours of some pixels, each from four rays."""
    setting, total = setting_of(shot, fine=True, share=0.5), np.zeros((len(pixels), 3), np.uint16)
    for number in range(len(SUBPIXELS)):
        total += _again(shot, pixels, sight, setting, number)
    return ((total + len(SUBPIXELS) // 2) // len(SUBPIXELS)).astype(np.uint8)


def _again(shot: Shot, pixels: Ints, sight: Sight, setting: Setting, number: int) -> Bytes:
    """(M, 3) colours of some pixels from one ray each, through one of `SUBPIXELS`."""
    camera, geometry = shot.camera, shot.geometry
    rays = camera_rays(camera, SUBPIXELS[number])[0][pixels]
    noise = _noise(camera.height, camera.width, number)[pixels]
    hits, out = Hits.none(len(pixels)), np.empty((len(pixels), 3), np.uint8)

    def work(chunk: Ints) -> None:
        part = slice(int(chunk[0]), int(chunk[-1]) + 1)
        for values, found in zip(hits, geometry.cast(rays[part]), strict=True):
            values[part] = found
        spots = shading.located(chunk, rays, hits, geometry)
        seen, rest = np.zeros((len(chunk), sight.seen.shape[1]), np.uint8), np.empty(len(chunk), np.int32)
        size = (camera.width, camera.height)
        faces = (spots.flats, spots.points)
        missing = maps.borrowed(pixels[part], *faces, *size, sight.flats, sight.points, sight.seen, seen, rest)
        if missing:
            rest = rest[:missing]
            some = shading.located(chunk[rest], rays, hits, geometry, "others")
            seen[rest] = shading.expose(some, geometry, setting, noise[chunk[rest]]).seen
        shading.paint(spots, setting.reaching(spots.bounds), seen, rays, hits, setting, out)

    each(work, shading.chunks(everywhere(len(pixels))))
    return out


ORDER = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])


@lru_cache(maxsize=8)
def _noise(height: int, width: int, number: int) -> Floats:
    """(H*W, 2) numbers from 0 to 1: 16 points of a plastic sequence over each 4 by 4 pixels, other ones a pass."""
    index = np.tile(ORDER, (height // 4 + 1, width // 4 + 1))[:height, :width].reshape(-1) + 16 * number
    return np.stack(((0.5 + index * 0.7548776662) % 1, (0.5 + index * 0.5698402910) % 1), axis=1).astype(np.float32)
