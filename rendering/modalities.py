"""Pictures of a scene: colour, depth, who is where, normals (thesis 2.4, 4.4). `render` is the primitive."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering import shading
from hearth.rendering.camera import Camera, cached_rays
from hearth.rendering.lights import from_above
from hearth.rendering.rays import Hits
from hearth.rendering.scene import Geometry, Scene
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

Image = NDArray[Any]
Floats = NDArray[np.float32]

QUALITIES = ("draft", "fine")
SUBPIXELS = ((0.625, 0.125), (0.125, 0.375), (0.875, 0.625), (0.375, 0.875))
"""Where the four rays of a fine pixel go: a rotated grid."""


@dataclass(frozen=True, eq=False)
class Shot:
    """One cast of a camera's rays, shared by all modalities.

    Attributes:
        scene, camera, geometry: what, from where.
        rays: (H*W, 6); moved down to the cut for views from above.
        skipped: (H*W,) length of the ray before `rays` begins, in units of its direction.
        hits: what they hit.
    """

    scene: Scene
    camera: Camera
    geometry: Geometry
    rays: Floats
    skipped: Floats
    hits: Hits
    class_ids: Mapping[str, int]


def render(
    scene: Scene,
    camera: Camera,
    modalities: Iterable[str] = ("rgb",),
    *,
    quality: str = "draft",
    class_ids: Mapping[str, int] | None = None,
) -> dict[str, Image]:
    """Take pictures of a scene.

    Args:
        scene: what there is.
        camera: from where, and how large.
        modalities: names of `MODALITIES`.
        quality: `draft` (one ray a pixel, hard shadows) or `fine` (four rays, soft shadows, ambient occlusion).
        class_ids: class -> number, for `class_ids`; the scene's classes from 1 on, sorted, where none are given.

    Returns:
        For each modality an array of (height, width) or (height, width, 3): `rgb` uint8; `depth` uint16 millimetres
        along the camera's axis, 0 for nothing; `instance_ids` uint16 node ids, 0 for nothing; `class_ids` uint16;
        `normals` float32 unit vectors of the world, 0 for nothing.

    Raises:
        HearthError: an unknown modality or quality, or no open3d.
    """
    wanted = list(modalities)
    unknown = [name for name in wanted if name not in MODALITIES] + [q for q in (quality,) if q not in QUALITIES]
    if unknown:
        known = ", ".join((*MODALITIES, *QUALITIES))
        raise HearthError.of(Code.NOT_RENDERED, f"unknown modality or quality: {', '.join(unknown)}", suggestion=known)
    shot = _shoot(scene, camera, (0.5, 0.5), class_ids or {})
    return {name: MODALITIES[name](shot, quality) for name in wanted}


def _shoot(scene: Scene, camera: Camera, offset: tuple[float, float], class_ids: Mapping[str, int]) -> Shot:
    rays = cached_rays(camera, offset)
    skipped = np.zeros(len(rays), np.float32)
    geometry = scene.geometry
    if camera.cut is not None:
        geometry = scene.opened
        skipped = np.maximum((rays[:, 1] - camera.cut) / np.maximum(-rays[:, 4], 1e-6), 0).astype(np.float32)
        rays = rays.copy()
        rays[:, :3] += rays[:, 3:] * skipped[:, None]
    return Shot(scene, camera, geometry, rays, skipped, geometry.caster.cast(rays), class_ids)


def _rgb(shot: Shot, quality: str) -> Image:
    camera = shot.camera
    shape = (camera.height, camera.width, 3)
    if quality == "draft":
        return shading.develop(_light(shot, 0, False)).reshape(shape)
    total = np.zeros((camera.height * camera.width, 3), np.float32)
    for number, offset in enumerate(SUBPIXELS):
        one = _shoot(shot.scene, camera, offset, shot.class_ids)
        total += shading.develop(_light(one, number, True))
    return (total / len(SUBPIXELS) + 0.5).astype(np.uint8).reshape(shape)


def _light(shot: Shot, number: int, fine: bool) -> Floats:
    camera = shot.camera
    angle = 1 / float(camera.intrinsics[0, 0])
    noise = _noise(camera.height, camera.width, number)
    # Distances count from the cut, and textures must shrink with the distance from the eye.
    far = 1 + float(np.median(shot.skipped)) / max(float(np.median(shot.hits.distance)), 0.1) if camera.cut else 1.0
    view = shading.View(shot.rays, shot.hits, noise, angle * far, fine)
    day = shot.scene.day if camera.cut is None else from_above(shot.scene.day)
    light = shading.radiance(shot.scene, shot.geometry, view, day)
    missed = np.flatnonzero(shot.hits.triangle < 0)
    if len(missed):
        light[missed] = shading.background(shot.scene.day, shot.rays[missed], camera.cut is not None)
    return light


def _noise(height: int, width: int, number: int) -> Floats:
    """(H*W, 2) numbers from 0 to 1: the 16 points of a plastic sequence over each 4 by 4 pixels, other ones a pass."""
    order = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])
    index = np.tile(order, (height // 4 + 1, width // 4 + 1))[:height, :width].reshape(-1) + 16 * number
    return np.column_stack(((0.5 + index * 0.7548776662) % 1, (0.5 + index * 0.5698402910) % 1)).astype(np.float32)


def _depth(shot: Shot, quality: str) -> Image:
    far = np.where(shot.hits.triangle >= 0, shot.hits.distance + shot.skipped, 0)
    return np.minimum(np.rint(far * 1000), 65535).astype(np.uint16).reshape(shot.camera.height, shot.camera.width)


def _per_thing(shot: Shot, values: NDArray[np.int64]) -> Image:
    """(H, W) a value of each thing where it is seen, 0 elsewhere."""
    owner = shot.geometry.owner[shot.hits.triangle] if len(shot.geometry.owner) else shot.hits.triangle
    seen = values[np.minimum(owner, len(values) - 1)] if len(values) else np.zeros(len(owner), np.int64)
    found = np.where(shot.hits.triangle >= 0, seen, 0)
    return found.astype(np.uint16).reshape(shot.camera.height, shot.camera.width)


def _instances(shot: Shot, quality: str) -> Image:
    return _per_thing(shot, np.array([thing.id for thing in shot.geometry.things], np.int64))


def _classes(shot: Shot, quality: str) -> Image:
    known = shot.class_ids or {
        name: number for number, name in enumerate(sorted({thing.class_name for thing in shot.scene.things}), 1)
    }
    return _per_thing(shot, np.array([known.get(thing.class_name, 0) for thing in shot.geometry.things], np.int64))


def _normals(shot: Shot, quality: str) -> Image:
    found = np.flatnonzero(shot.hits.triangle >= 0)
    image = np.zeros((len(shot.rays), 3), np.float32)
    if len(found):
        noise = np.zeros((len(shot.rays), 2), np.float32)
        surface = shading.surface_at(shot.geometry, shading.View(shot.rays, shot.hits, noise, 0.0, False).part(found))
        image[found] = surface.normals / np.linalg.norm(surface.normals, axis=1, keepdims=True)
    return image.reshape(shot.camera.height, shot.camera.width, 3)


MODALITIES: dict[str, Callable[[Shot, str], Image]] = {
    "rgb": _rgb,
    "depth": _depth,
    "instance_ids": _instances,
    "class_ids": _classes,
    "normals": _normals,
}
"""What a picture can show. To add one: a function of a shot, and a row here."""
