"""Pictures of a camera that stays: only what moving things, and their shadows, can change is drawn again.

The part of a scene that stays is drawn once. For each moment, rays are cast at the moving things where their boxes
are seen, and from the points that a light reaches if a box lies on the way. Equal to drawing everything: a pixel is
kept when the ray that found it, and every ray that lit it, misses all that moves.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Bytes
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.modalities import pictures_of as others
from hearth.rendering.rays import shading
from hearth.rendering.rays.casting import Hits
from hearth.rendering.rays.shading import Plate, Setting
from hearth.rendering.rays.shot import Shot, camera_rays, cast_at, everywhere, overlay, prepare, setting_of
from hearth.rendering.rays.threads import each
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import Geometry


@dataclass(frozen=True, eq=False)
class Ground:
    """What a camera sees of the part that stays.

    Attributes:
        shot: of that part alone.
        setting: its light.
        plates: all pixels, and what lights them.
        rgb: (H*W, 3) its colours.
    """

    shot: Shot
    setting: Setting
    plates: list[Plate]
    rgb: Bytes

    @classmethod
    def of(cls, scene: Scene, camera: Camera) -> Ground:
        """Draw what stays in a scene."""
        alone = replace(scene, things=())
        geometry = alone.geometry if camera.cut is None else alone.opened
        rays, skipped = camera_rays(camera, (0.5, 0.5))
        hits = Hits.none(len(rays))
        cast_at(geometry, rays, everywhere(len(rays)), hits)
        shot = Shot(alone, camera, geometry, rays, skipped, hits, {})
        setting, rgb = setting_of(shot), np.empty((len(rays), 3), np.uint8)
        plates = shading.whole(shading.chunks(everywhere(len(rays))), rays, hits, geometry, setting, rgb)
        return cls(shot, setting, plates, rgb)

    def serves(self, scene: Scene, camera: Camera) -> bool:
        """Whether it is the ground of a scene, too."""
        mine = self.shot.scene
        same = mine.still is scene.still and mine.day == scene.day and mine.lights == scene.lights
        return same and self.shot.camera == camera


@dataclass(frozen=True, eq=False)
class Take:
    """A draft picture with what the next one needs of it.

    Attributes:
        shot: what each pixel's ray hit.
        rgb: (H*W, 3) its colours.
        drawn: how many pixels were drawn: all, or those over a ground that was there.
        ground: what stays; and others that served before, the latest first.
    """

    shot: Shot
    rgb: Bytes
    drawn: int
    ground: Ground
    others: tuple[Ground, ...] = ()

    @property
    def picture(self) -> NDArray[np.uint8]:
        """(H, W, 3) the colours."""
        return self.shot.image(self.rgb)


KEPT = 3
"""Grounds that are kept: lights are switched on and off again."""


def take(scene: Scene, camera: Camera, last: Take | None = None) -> Take:
    """A draft picture of a scene; at less cost where `last` is one of the same camera and of nearly the same scene."""
    known = (last.ground, *last.others) if last else ()
    ready = next((one for one in known if one.serves(scene, camera)), None)
    ground = ready or Ground.of(scene, camera)
    rest = tuple(one for one in known if one is not ground and one.shot.camera == camera)
    if last and ground is last.ground and last.shot.scene.things == scene.things:
        return replace(last, drawn=0)
    still = ground.shot.geometry.still
    moving = (scene.geometry if camera.cut is None else scene.opened).moving
    taken = _drawn(ground, scene, Geometry(still, moving), rest[: KEPT - 1])
    return taken if ready else replace(taken, drawn=len(taken.rgb))


def _drawn(ground: Ground, scene: Scene, geometry: Geometry, rest: tuple[Ground, ...]) -> Take:
    prepare(geometry)
    base = ground.shot
    hits = base.hits.copy()
    shown = overlay(geometry, base.camera, base.rays, hits)
    shot = Shot(scene, base.camera, geometry, base.rays, base.skipped, hits, base.class_ids, None, base.hits)
    rgb = ground.rgb.copy()
    hidden = np.zeros(len(rgb), np.bool_)
    hidden[shown] = True

    def shadowed(plate: Plate) -> int:
        part = slice(int(plate.pixels[0]), int(plate.pixels[-1]) + 1)
        seen, changed = shading.dim(plate, geometry, ground.setting, hidden[part])
        if len(changed):
            spots = shading.located(plate.pixels[changed], base.rays, hits, geometry)
            shading.paint(spots, plate.near, seen[changed], base.rays, hits, ground.setting, rgb)
        return len(changed)

    count = sum(each(shadowed, ground.plates)) if len(geometry.moving.mesh) else 0
    shading.whole(shading.chunks(shown), base.rays, hits, geometry, ground.setting, rgb)
    return Take(shot, rgb, count + len(shown), ground, rest)


def pictures_of(shown: Take, modalities: Iterable[str]) -> dict[str, NDArray[Any]]:
    """The pictures of a take by modality, as `modalities.render` gives them."""
    names = list(modalities)
    found = others(shown.shot, [name for name in names if name != "rgb"])
    return {name: shown.shot.image(shown.rgb) if name == "rgb" else found[name] for name in names}
