"""Fine pictures: soft shadows, ambient occlusion, and several rays where one is not enough."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering import maps, shading
from hearth.rendering.modalities import Shot, camera_rays, everywhere, setting_of
from hearth.rendering.rays import Hits
from hearth.rendering.threads import each

Floats = NDArray[np.floating[Any]]
Ints = NDArray[np.int32]
Bytes = NDArray[np.uint8]

SUBPIXELS = ((0.625, 0.125), (0.125, 0.375), (0.875, 0.625), (0.375, 0.875))
"""Where the four rays of a pixel at an edge go: a rotated grid."""

STEP = 14
"""Grey levels between neighbouring pixels from which on they are drawn with four rays."""


def fine(shot: Shot) -> Bytes:
    """(H*W, 3) colours: each point sees lights with one ray, and shares what it sees with its neighbours on the same
    surface; pixels at edges are drawn again with four rays each.
    """
    camera, size = shot.camera, len(shot.rays)
    setting, noise = setting_of(shot, fine=True), _noise(camera.height, camera.width, 0)
    chunks = shading.chunks(everywhere(size))
    points, flats = np.empty((2, size, 3), np.float32)
    seen = np.empty((size, len(setting.lights) + 2), np.uint8)

    def look(chunk: Ints) -> None:
        spots = shading.located(chunk, shot.rays, shot.hits, shot.geometry)
        points[chunk], flats[chunk] = spots.points, spots.flats
        seen[chunk] = shading.expose(spots, shot.geometry, setting, noise[chunk]).seen

    each(look, chunks)
    smooth, out = _smoothed(shot, seen, flats, points), np.empty((size, 3), np.uint8)

    def paint(chunk: Ints) -> None:
        spots = shading.located(chunk, shot.rays, shot.hits, shot.geometry)
        near = setting.reaching(spots.bounds)
        shading.paint(spots, near, smooth[chunk], shot.rays, shot.hits, setting, out)

    each(paint, chunks)
    rough = np.zeros(size, np.bool_)
    maps.edges(out, shot.hits.triangle, shot.geometry.owners, camera.width, camera.height, STEP, rough)
    again = np.flatnonzero(rough).astype(np.int32)
    if len(again):
        out[again] = _mixed(shot, again)
    return out


BAND = 40
"""Rows of pixels that are smoothed together."""


def _smoothed(shot: Shot, seen: Bytes, flats: Floats, points: Floats) -> Bytes:
    """What points see of the lights, shared with their neighbours."""
    width, height = shot.camera.width, shot.camera.height
    columns = np.flatnonzero((seen != seen[0]).any(axis=0)).astype(np.int32)
    smooth = seen.copy()

    def work(top: int) -> None:
        maps.smoothed(seen, columns, flats, points, width, height, top, min(top + BAND, height), smooth)

    each(work, range(0, height, BAND))
    return smooth


def _mixed(shot: Shot, pixels: Ints) -> Bytes:
    """(M, 3) colours of some pixels, each from four rays."""
    camera, geometry = shot.camera, shot.geometry
    total = np.zeros((len(pixels), 3), np.uint16)
    setting = setting_of(shot, fine=True, share=0.5)
    for number, offset in enumerate(SUBPIXELS):
        rays = camera_rays(camera, offset)[0][pixels]
        noise = _noise(camera.height, camera.width, number)[pixels]
        hits, out = Hits.none(len(pixels)), np.empty((len(pixels), 3), np.uint8)

        def work(chunk: Ints) -> None:
            part = slice(int(chunk[0]), int(chunk[-1]) + 1)
            for values, found in zip(hits, geometry.cast(rays[part]), strict=True):  # noqa: B023 - called at once
                values[part] = found
            spots = shading.located(chunk, rays, hits, geometry)  # noqa: B023
            plate = shading.expose(spots, geometry, setting, noise[chunk])  # noqa: B023
            shading.paint(spots, plate.near, plate.seen, rays, hits, setting, out)  # noqa: B023

        each(work, shading.chunks(everywhere(len(pixels))))
        total += out
    return ((total + len(SUBPIXELS) // 2) // len(SUBPIXELS)).astype(np.uint8)


ORDER = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])


@lru_cache(maxsize=8)
def _noise(height: int, width: int, number: int) -> Floats:
    """(H*W, 2) numbers from 0 to 1: 16 points of a plastic sequence over each 4 by 4 pixels, other ones a pass."""
    index = np.tile(ORDER, (height // 4 + 1, width // 4 + 1))[:height, :width].reshape(-1) + 16 * number
    return np.stack(((0.5 + index * 0.7548776662) % 1, (0.5 + index * 0.5698402910) % 1), axis=1).astype(np.float32)
