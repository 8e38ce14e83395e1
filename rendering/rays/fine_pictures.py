"""Fine pictures: soft shadows, ambient occlusion, and four rays per pixel at edges."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from hearth.rendering.arrays import Bytes, Floats, Ints
from hearth.rendering.rays import pixel_maps, shading
from hearth.rendering.rays.camera_shot import Shot, camera_rays, everywhere, prepare, setting_of
from hearth.rendering.rays.mirrors import mirrored
from hearth.rendering.rays.ray_casting import Hits
from hearth.rendering.rays.shading import Setting
from hearth.rendering.rays.threads import each

SUBPIXELS = ((0.625, 0.125), (0.125, 0.375), (0.875, 0.625), (0.375, 0.875))
"""Offsets of the four rays of an edge pixel: a rotated grid."""

STEP = 14
"""Least difference in grey levels at which neighbouring pixels are drawn with four rays."""


class LightVisibility(NamedTuple):
    """(N, 3) surface points and flat normals of all pixels, and the (N, K) visibility of the lights from them."""

    points: Floats
    flats: Floats
    seen: Bytes


def fine(shot: Shot) -> Bytes:
    """(H*W, 3) colours. Visibility of lights is sampled with one ray per point and averaged over neighbours on the same
    surface; edge pixels are drawn again with four rays each.
    """
    camera, size = shot.camera, len(shot.rays)
    prepare(shot.geometry)
    setting, chunks = setting_of(shot, fine=True), shading.chunks(everywhere(size))
    visibility = _smoothed(shot, _looked(shot, setting, chunks))
    out = np.empty((size, 3), np.uint8)

    def paint(chunk: Ints) -> None:
        surface = shading.located(chunk, shot.rays, shot.hits, shot.geometry)
        near = setting.reaching(surface.bounds)
        shading.paint(surface, near, visibility.seen[chunk], shot.rays, shot.hits, setting, out)

    each(paint, chunks)
    mirrored(shot.rays, shot.hits, shot.geometry, setting_of(shot), out)
    rough = np.zeros(size, np.bool_)
    pixel_maps.edges(out, shot.hits.triangle, shot.geometry.owners, camera.width, camera.height, STEP, rough)
    again = np.flatnonzero(rough).astype(np.int32)
    if len(again):
        out[again] = _mixed(shot, again, visibility)
    return out


def _looked(shot: Shot, setting: Setting, chunks: list[Ints]) -> LightVisibility:
    """Return the lights' visibility from each pixel, sampled with one ray per light."""
    size = len(shot.rays)
    points, flats = np.empty((2, size, 3), np.float32)
    seen = np.empty((size, len(setting.lights) + 2), np.uint8)
    noise = _noise(shot.camera.height, shot.camera.width, 0)

    def look(chunk: Ints) -> None:
        surface = shading.located(chunk, shot.rays, shot.hits, shot.geometry)
        points[chunk], flats[chunk] = surface.points, surface.flats
        seen[chunk] = shading.expose(surface, shot.geometry, setting, noise[chunk]).seen

    each(look, chunks)
    return LightVisibility(points, flats, seen)


BAND = 40
"""Rows of pixels in one unit of smoothing work."""


def _smoothed(shot: Shot, visibility: LightVisibility) -> LightVisibility:
    """Visibility averaged over neighbouring pixels."""
    width, height = shot.camera.width, shot.camera.height
    points, flats, seen = visibility
    columns = np.flatnonzero((seen != seen[0]).any(axis=0)).astype(np.int32)
    smooth = seen.copy()

    def work(top: int) -> None:
        pixel_maps.smoothed(seen, columns, flats, points, width, height, top, min(top + BAND, height), smooth)

    each(work, range(0, height, BAND))
    return LightVisibility(points, flats, smooth)


def _mixed(shot: Shot, pixels: Ints, visibility: LightVisibility) -> Bytes:
    """(M, 3) colours of M pixels, each from four rays."""
    setting, total = setting_of(shot, fine=True, share=0.5), np.zeros((len(pixels), 3), np.uint16)
    for number in range(len(SUBPIXELS)):
        total += _again(shot, pixels, visibility, setting, number)
    return ((total + len(SUBPIXELS) // 2) // len(SUBPIXELS)).astype(np.uint8)


def _again(shot: Shot, pixels: Ints, visibility: LightVisibility, setting: Setting, number: int) -> Bytes:
    """(M, 3) colours of M pixels from one ray each, through one of `SUBPIXELS`."""
    camera, geometry = shot.camera, shot.geometry
    rays = camera_rays(camera, SUBPIXELS[number])[0][pixels]
    noise = _noise(camera.height, camera.width, number)[pixels]
    hits, out = Hits.none(len(pixels)), np.empty((len(pixels), 3), np.uint8)

    def work(chunk: Ints) -> None:
        part = slice(int(chunk[0]), int(chunk[-1]) + 1)
        for values, found in zip(hits, geometry.cast(rays[part]), strict=True):
            values[part] = found
        surface = shading.located(chunk, rays, hits, geometry)
        seen, rest = np.zeros((len(chunk), visibility.seen.shape[1]), np.uint8), np.empty(len(chunk), np.int32)
        size = (camera.width, camera.height)
        faces = (surface.flats, surface.points)
        missing = pixel_maps.borrowed(
            pixels[part], *faces, *size, visibility.flats, visibility.points, visibility.seen, seen, rest
        )
        if missing:
            rest = rest[:missing]
            some = shading.located(chunk[rest], rays, hits, geometry, "others")
            seen[rest] = shading.expose(some, geometry, setting, noise[chunk[rest]]).seen
        shading.paint(surface, setting.reaching(surface.bounds), seen, rays, hits, setting, out)

    each(work, shading.chunks(everywhere(len(pixels))))
    mirrored(rays, hits, geometry, setting_of(shot, share=0.5), out)
    return out


ORDER = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])


@lru_cache(maxsize=8)
def _noise(height: int, width: int, number: int) -> Floats:
    """(H*W, 2) numbers from 0 to 1: 16 points of a plastic sequence per 4 by 4 pixels, different in each pass."""
    index = np.tile(ORDER, (height // 4 + 1, width // 4 + 1))[:height, :width].reshape(-1) + 16 * number
    return np.stack(((0.5 + index * 0.7548776662) % 1, (0.5 + index * 0.5698402910) % 1), axis=1).astype(np.float32)
