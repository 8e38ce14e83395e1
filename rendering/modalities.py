"""Pictures of a scene: colour, depth, who is where, normals (thesis 2.4, 4.4). `render` is the primitive."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering import shading
from hearth.rendering.camera import Camera, cached_rays
from hearth.rendering.geometry import Geometry
from hearth.rendering.lights import from_above
from hearth.rendering.rays import Hits
from hearth.rendering.scene import Scene
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

Image = NDArray[Any]
Floats = NDArray[np.floating[Any]]

QUALITIES = ("draft", "fine")
SUBPIXELS = ((0.625, 0.125), (0.125, 0.375), (0.875, 0.625), (0.375, 0.875))
"""Where the four rays of a fine pixel go: a rotated grid."""


@dataclass(frozen=True, eq=False)
class Shot:
    """One cast of a camera's rays, shared by all modalities.

    Attributes:
        scene, camera, geometry: what, from where.
        rays: (6, H*W); moved down to the cut for views from above.
        skipped: (H*W,) length of the ray before `rays` begins, in units of its direction; 0 without a cut.
        hits: what they hit.
        class_ids: class -> number.
    """

    scene: Scene
    camera: Camera
    geometry: Geometry
    rays: Floats
    skipped: Floats | float
    hits: Hits
    class_ids: Mapping[str, int]

    @cached_property
    def owner(self) -> NDArray[np.int64]:
        """(H*W,) index of the thing that is seen, -1 for none."""
        return self.geometry.owner(self.hits.triangle)

    def image(self, values: NDArray[Any]) -> Image:
        """(H*W, ...) values as (H, W, ...)."""
        return values.reshape(self.camera.height, self.camera.width, *values.shape[1:])


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
        along the camera's axis, 0 for nothing; `instance_ids` uint16 node ids (int32 if one needs it), 0 for nothing;
        `class_ids` uint16;
        `normals` float32 unit vectors of the world, 0 for nothing.

    Raises:
        HearthError: an unknown modality or quality, or no open3d.
    """
    wanted = list(modalities)
    unknown = [name for name in wanted if name not in MODALITIES] + [q for q in (quality,) if q not in QUALITIES]
    if unknown:
        known = ", ".join((*MODALITIES, *QUALITIES))
        raise HearthError.of(Code.NOT_RENDERED, f"unknown modality or quality: {', '.join(unknown)}", suggestion=known)
    return pictures_of(shoot(scene, camera, class_ids=class_ids), wanted, quality)


def pictures_of(shot: Shot, modalities: Iterable[str], quality: str = "draft") -> dict[str, Image]:
    """The pictures of a shot by modality, as `render` gives them."""
    return {name: MODALITIES[name](shot, quality) for name in modalities}


def shoot(
    scene: Scene, camera: Camera, offset: tuple[float, float] = (0.5, 0.5), class_ids: Mapping[str, int] | None = None
) -> Shot:
    """Cast a camera's rays, through `offset` in each pixel."""
    rays, skipped = camera_rays(camera, offset)
    geometry = scene.geometry if camera.cut is None else scene.opened
    return Shot(scene, camera, geometry, rays, skipped, geometry.cast(rays), class_ids or {})


@lru_cache(maxsize=16)
def camera_rays(camera: Camera, offset: tuple[float, float]) -> tuple[Floats, Floats | float]:
    """(6, N) rays that begin at the camera's cut, and what of them lies before it. Not to be written to."""
    rays = cached_rays(camera, offset)
    if camera.cut is None:
        return rays, 0.0
    skipped = np.maximum((rays[1] - camera.cut) / np.maximum(-rays[4], 1e-6), 0).astype(np.float32)
    rays = rays.copy()
    rays[:3] += rays[3:] * skipped
    return rays, skipped


def _rgb(shot: Shot, quality: str) -> Image:
    if quality == "draft":
        return shot.image(draft(shot))
    camera = shot.camera
    total = np.zeros((camera.height * camera.width, 3), np.float32)
    for number, offset in enumerate(SUBPIXELS):
        one = shoot(shot.scene, camera, offset, shot.class_ids)
        noise = _noise(camera.height, camera.width, number)
        total += shading.develop(_light(one, shading.View(one.rays, one.hits, noise, pixel_angle(one), True)))
    return shot.image((total / len(SUBPIXELS) + 0.5).astype(np.uint8))


def draft(shot: Shot, among: NDArray[np.int64] | None = None) -> NDArray[np.uint8]:
    """(N, 3) colours of all pixels, or of those among these indices."""
    view = shading.View(shot.rays, shot.hits, NO_NOISE, pixel_angle(shot), False)
    return shading.develop(_light(shot, view if among is None else view.part(among)))


NO_NOISE: Floats = np.zeros((2, 0), np.float32)


def pixel_angle(shot: Shot) -> float:
    """Radians a pixel spans, as distances along the rays have it."""
    angle = 1 / float(shot.camera.intrinsics[0, 0])
    if shot.camera.cut is None:
        return angle
    # Distances count from the cut, and textures must shrink with the distance from the eye.
    return angle * (1 + float(np.median(shot.skipped)) / max((shot.camera.cut - shot.camera.target[1]) / 2, 0.1))


def _light(shot: Shot, view: shading.View) -> Floats:
    above = shot.camera.cut is not None
    day = from_above(shot.scene.day) if above else shot.scene.day
    light = shading.radiance(shot.scene.lights, shot.geometry, view, day)
    missed = np.flatnonzero(view.hits.triangle < 0)
    if len(missed):
        light[:, missed] = shading.background(shot.scene.day, view.rays.take(missed, axis=1), above)
    return light


def _noise(height: int, width: int, number: int) -> Floats:
    """(2, H*W) numbers from 0 to 1: the 16 points of a plastic sequence over each 4 by 4 pixels, other ones a pass."""
    order = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]])
    index = np.tile(order, (height // 4 + 1, width // 4 + 1))[:height, :width].reshape(-1) + 16 * number
    return np.stack(((0.5 + index * 0.7548776662) % 1, (0.5 + index * 0.5698402910) % 1)).astype(np.float32)


def _depth(shot: Shot, quality: str) -> Image:
    far = np.where(shot.hits.triangle >= 0, shot.hits.distance + shot.skipped, 0)
    return shot.image(np.minimum(far * 1000 + 0.5, 65535).astype(np.uint16))


def _per_thing(shot: Shot, values: Sequence[int]) -> Image:
    """(H, W) a value of each thing where it is seen, 0 elsewhere."""
    dtype = np.uint16 if max(values, default=0) < 1 << 16 else np.int32
    return shot.image(np.array([*values, 0], dtype).take(shot.owner, mode="wrap"))


def _instances(shot: Shot, quality: str) -> Image:
    return _per_thing(shot, [thing.id for thing in shot.geometry.things])


def _classes(shot: Shot, quality: str) -> Image:
    known = shot.class_ids or {
        name: number for number, name in enumerate(sorted({thing.class_name for thing in shot.scene.everything}), 1)
    }
    return _per_thing(shot, [known.get(thing.class_name, 0) for thing in shot.geometry.things])


def _normals(shot: Shot, quality: str) -> Image:
    found = np.flatnonzero(shot.hits.triangle >= 0)
    image = np.zeros((shot.rays.shape[1], 3), np.float32)
    if len(found):
        view = shading.View(shot.rays, shot.hits, NO_NOISE, 0.0, False).part(found)
        normals = shading.surface_at(shot.geometry, view).normals
        image[found] = (normals / np.sqrt(shading.dot(normals, normals))).T
    return shot.image(image)


MODALITIES: dict[str, Callable[[Shot, str], Image]] = {
    "rgb": _rgb,
    "depth": _depth,
    "instance_ids": _instances,
    "class_ids": _classes,
    "normals": _normals,
}
"""What a picture can show. To add one: a function of a shot, and a row here."""
