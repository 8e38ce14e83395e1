"""Pictures by a fixed camera: only pixels that moving things, or their shadows, can change are drawn again.

Static things are drawn once, into a static layer. For each scene, rays are cast at moving things within their boxes in
the picture, and from lit points to the light if a box lies between them. The result equals a full drawing: a pixel is
kept if the ray that found it, and every ray that lit it, misses all moving things.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Bytes, Ints
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.modalities import pictures_of as others
from hearth.rendering.rays import shading
from hearth.rendering.rays.camera_shot import (
    Shot,
    camera_rays,
    everywhere,
    hits_on_static,
    overlay,
    prepare,
    setting_of,
)
from hearth.rendering.rays.mirrors import mirrored, showing
from hearth.rendering.rays.shading import Exposure, Setting
from hearth.rendering.rays.threads import each
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import Geometry


@dataclass(frozen=True, eq=False)
class StaticLayer:
    """A camera's picture of the static things.

    Attributes:
        shot: of the static things alone.
        setting: its light.
        exposures: all pixels, with the light that reaches them.
        rgb: (H*W, 3) its colours.
    """

    shot: Shot
    setting: Setting
    exposures: list[Exposure]
    rgb: Bytes

    @classmethod
    def of(cls, scene: Scene, camera: Camera) -> StaticLayer:
        """Draw a scene's static things."""
        alone = replace(scene, things=())
        geometry = alone.geometry if camera.cut is None else alone.opened
        rays, skipped = camera_rays(camera, (0.5, 0.5))
        hits = hits_on_static(geometry, camera, rays)
        shot = Shot(alone, camera, geometry, rays, skipped, hits, {})
        setting, rgb = setting_of(shot), np.empty((len(rays), 3), np.uint8)
        exposures = shading.whole(shading.chunks(everywhere(len(rays))), rays, hits, geometry, setting, rgb)
        return cls(shot, setting, exposures, rgb)

    @cached_property
    def mirrors(self) -> Ints:
        """The pixels that show a mirror among the static things."""
        return showing(self.shot.hits, self.shot.geometry)

    def serves(self, scene: Scene, camera: Camera) -> bool:
        """Return whether it is also the static layer of another scene."""
        mine = self.shot.scene
        same = mine.static is scene.static and mine.day == scene.day and mine.lights == scene.lights
        return same and self.shot.camera == camera


@dataclass(frozen=True, eq=False)
class IncrementalFrame:
    """A draft picture, and the static layers that the next one can reuse.

    Attributes:
        shot: hits of the camera's rays.
        rgb: (H*W, 3) its colours.
        drawn: number of pixels drawn: all, or those over a reused static layer.
        layer: the static layer.
        others: static layers used before, the latest first.
    """

    shot: Shot
    rgb: Bytes
    drawn: int
    layer: StaticLayer
    others: tuple[StaticLayer, ...] = ()

    @property
    def picture(self) -> NDArray[np.uint8]:
        """(H, W, 3) the colours."""
        return self.shot.image(self.rgb)


KEPT = 3
"""Number of static layers that are kept, for lights that are switched on and off."""


def incremental_frame(scene: Scene, camera: Camera, last: IncrementalFrame | None = None) -> IncrementalFrame:
    """Return a draft picture of a scene; cheaper if `last` is by the same camera and has the same static things."""
    known = (last.layer, *last.others) if last else ()
    ready = next((one for one in known if one.serves(scene, camera)), None)
    layer = ready or StaticLayer.of(scene, camera)
    rest = tuple(one for one in known if one is not layer and one.shot.camera == camera)
    if last and layer is last.layer and last.shot.scene.things == scene.things:
        return replace(last, drawn=0)
    static = layer.shot.geometry.static
    moving = (scene.geometry if camera.cut is None else scene.opened).moving
    taken = _drawn(layer, scene, Geometry(static, moving), rest[: KEPT - 1])
    return taken if ready else replace(taken, drawn=len(taken.rgb))


def _drawn(layer: StaticLayer, scene: Scene, geometry: Geometry, rest: tuple[StaticLayer, ...]) -> IncrementalFrame:
    prepare(geometry)
    base = layer.shot
    hits = base.hits.copy()
    shown = overlay(geometry, base.camera, base.rays, hits)
    shot = Shot(scene, base.camera, geometry, base.rays, base.skipped, hits, base.class_ids, None, base.hits)
    rgb = layer.rgb.copy()
    hidden = np.zeros(len(rgb), np.bool_)
    hidden[shown] = True

    def shadowed(exposure: Exposure) -> int:
        part = slice(int(exposure.pixels[0]), int(exposure.pixels[-1]) + 1)
        seen, changed = shading.dim(exposure, geometry, layer.setting, hidden[part])
        if len(changed):
            surface = shading.located(exposure.pixels[changed], base.rays, hits, geometry)
            shading.paint(surface, exposure.near, seen[changed], base.rays, hits, layer.setting, rgb)
        return len(changed)

    shading.make_grids(layer.exposures, geometry.moving, layer.setting)
    count = sum(each(shadowed, layer.exposures)) if len(geometry.moving.mesh) else 0
    shading.whole(shading.chunks(shown), base.rays, hits, geometry, layer.setting, rgb)
    # What mirrors show can change wherever something moves: they are drawn anew.
    among = np.union1d(layer.mirrors, shown) if geometry.moving.mirrors.any() else layer.mirrors
    count += mirrored(base.rays, hits, geometry, layer.setting, rgb, among)
    return IncrementalFrame(shot, rgb, count + len(shown), layer, rest)


def pictures_of(shown: IncrementalFrame, modalities: Iterable[str]) -> dict[str, NDArray[Any]]:
    """Return the pictures of a frame by modality, as `modalities.render` gives them."""
    names = list(modalities)
    found = others(shown.shot, [name for name in names if name != "rgb"])
    return {name: shown.shot.image(shown.rgb) if name == "rgb" else found[name] for name in names}
