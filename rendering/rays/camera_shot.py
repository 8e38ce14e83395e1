"""Shots: a camera's rays, cast once at a scene; every modality is computed from them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats, Image
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.rays import shading
from hearth.rendering.rays.first_hits import drawable, moving_hits, static_hits
from hearth.rendering.rays.kernels import taken
from hearth.rendering.rays.mirrors import mirrored
from hearth.rendering.rays.ray_casting import Hits
from hearth.rendering.rays.shading import Setting
from hearth.rendering.rays.threads import each
from hearth.rendering.scene.lights import from_above
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import Geometry


@dataclass(frozen=True, eq=False)
class Shot:
    """One cast of a camera's rays, shared by all modalities.

    Attributes:
        scene, camera, geometry: the scene, its camera and its triangles.
        rays: (H*W, 6); in views from above they begin at the cut.
        skipped: (H*W,) length of the ray before `rays` begins, in units of its direction; empty without a cut.
        hits: first hits of the rays.
        class_ids: class -> number.
        after: the next scene, if known, for optical flow.
        behind: first hits on static things, reused by the next shot.
        by_rays: whether first hits are cast, as for fine pictures; else they are rasterised.
        after_camera: the next scene's; None if it is this one.
        cut: whether the film is cut before the next scene, so that no point can be followed to it.
    """

    scene: Scene
    camera: Camera
    geometry: Geometry
    rays: Floats
    skipped: Floats
    hits: Hits
    class_ids: Mapping[str, int]
    after: Scene | None = None
    behind: Hits | None = None
    by_rays: bool = False
    after_camera: Camera | None = None
    cut: bool = False

    @cached_property
    def owner(self) -> NDArray[np.int32]:
        """(H*W,) index of the visible thing, -1 for the background."""
        return self.geometry.owner(self.hits.triangle)

    @cached_property
    def distance(self) -> Floats:
        """(H*W,) depth along the camera's axis, metres; infinite for the background."""
        far: Floats = self.hits.distance + self.skipped if len(self.skipped) else self.hits.distance
        return far

    def image(self, values: NDArray[Any]) -> Image:
        """(H*W, ...) values as (H, W, ...)."""
        return values.reshape(self.camera.height, self.camera.width, *values.shape[1:])


def shoot(
    scene: Scene,
    camera: Camera,
    class_ids: Mapping[str, int] | None = None,
    after: Scene | None = None,
    *,
    by_rays: bool = False,
) -> Shot:
    """Return the first hits of a camera's rays; see `Shot`."""
    rays, skipped = camera_rays(camera)
    geometry = scene.geometry if camera.cut is None else scene.opened
    by_rays = by_rays or not drawable(camera)
    hits = behind = hits_on_static(geometry, camera, rays, by_rays=by_rays)
    if len(geometry.moving.mesh):
        hits = behind.copy()
        overlay(geometry, camera, rays, hits, by_rays=by_rays)
    return Shot(scene, camera, geometry, rays, skipped, hits, class_ids or {}, after, behind, by_rays)


def shoot_after(scene: Scene, shot: Shot) -> Shot:
    """Return the shot of a later scene by the same camera; only moving things are looked for again."""
    camera = shot.camera
    geometry = scene.geometry if camera.cut is None else scene.opened
    if shot.behind is None or geometry.static is not shot.geometry.static:
        return shoot(scene, camera, by_rays=shot.by_rays)
    hits = shot.behind.copy()
    overlay(geometry, camera, shot.rays, hits, by_rays=shot.by_rays)
    return replace(shot, scene=scene, geometry=geometry, hits=hits, after=None)


def hits_on_static(geometry: Geometry, camera: Camera, rays: Floats, *, by_rays: bool = False) -> Hits:
    """Return the first hits of a camera's rays on static things."""
    hits = Hits.none(len(rays))
    if not by_rays and drawable(camera):
        static_hits(geometry.static, camera, rays, hits)
        return hits
    prepare(geometry)

    def work(chunk: NDArray[np.int32]) -> None:
        part = slice(int(chunk[0]), int(chunk[-1]) + 1)
        for values, found in zip(hits, geometry.static.caster.cast(rays[part]), strict=True):
            values[part] = found

    each(work, shading.chunks(everywhere(len(rays))))
    return hits


def prepare(geometry: Geometry) -> None:
    """Build the casters before threads share them."""
    for part in (geometry.static, geometry.moving):
        _ = part.caster, part.shadows, part.rows


def overlay(
    geometry: Geometry, camera: Camera, rays: Floats, hits: Hits, *, by_rays: bool = False
) -> NDArray[np.int32]:
    """Replace hits on static things by nearer hits on moving things; returns the pixels that show one."""
    moving = geometry.moving
    if not len(moving.mesh):
        return everywhere(0)
    if not by_rays and drawable(camera):
        return moving_hits(moving, camera, rays, geometry.first, hits)
    prepare(geometry)
    covered = np.zeros(camera.height * camera.width, np.bool_)
    for box in moving.boxes:
        left, top, right, bottom = camera.extent(box)
        covered.reshape(camera.height, camera.width)[top:bottom, left:right] = True
    pixels = np.flatnonzero(covered).astype(np.int32)

    def work(chunk: NDArray[np.int32]) -> NDArray[np.int32]:
        some = np.empty((len(chunk), 6), np.float32)
        taken(rays, chunk, some)
        return geometry.overlay(chunk, some, hits)

    found = each(work, shading.chunks(pixels))
    return np.concatenate(found) if found else everywhere(0)


@lru_cache(maxsize=8)
def everywhere(size: int) -> NDArray[np.int32]:
    """All pixels; read-only."""
    return np.arange(size, dtype=np.int32)


NO_CUT: Floats = np.zeros(0, np.float32)


@lru_cache(maxsize=6)
def camera_rays(camera: Camera, offset: tuple[float, float] = (0.5, 0.5)) -> tuple[Floats, Floats]:
    """(N, 6) rays that begin at the camera's cut, and their length before it; read-only."""
    rays = camera.rays(offset)
    if camera.cut is None:
        return rays, NO_CUT
    skipped = np.maximum((rays[:, 1] - camera.cut) / np.maximum(-rays[:, 4], 1e-6), 0).astype(np.float32)
    rays[:, :3] += rays[:, 3:] * skipped[:, None]
    return rays, skipped


def draft(shot: Shot) -> NDArray[np.uint8]:
    """(H*W, 3) colours with one ray per pixel and hard shadows."""
    out, setting = np.empty((len(shot.rays), 3), np.uint8), setting_of(shot)
    shading.whole(shading.chunks(everywhere(len(shot.rays))), shot.rays, shot.hits, shot.geometry, setting, out)
    mirrored(shot.rays, shot.hits, shot.geometry, setting, out)
    return out


def setting_of(shot: Shot, *, fine: bool = False, share: float = 1.0) -> Setting:
    """Return the light of a shot; one ray covers `share` of a pixel."""
    above = shot.camera.cut is not None
    day = from_above(shot.scene.day) if above else shot.scene.day
    return Setting.of(shot.scene.lights, day, plain=above, angle=pixel_angle(shot) * share, fine=fine)


def pixel_angle(shot: Shot) -> float:
    """Radians per pixel, for distances along the rays."""
    angle = 1 / float(shot.camera.intrinsics[0, 0])
    if shot.camera.cut is None:
        return angle
    # Distances begin at the cut, but textures shrink with the distance from the camera.
    return angle * (1 + float(np.median(shot.skipped)) / max((shot.camera.cut - shot.camera.target[1]) / 2, 0.1))
