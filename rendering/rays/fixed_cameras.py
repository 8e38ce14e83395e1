"""Pictures by cameras that stay, of scenes that follow each other: what each sees of static things is found once."""

from dataclasses import replace

from hearth.rendering.cameras.camera import Camera
from hearth.rendering.rays.camera_shot import Shot, shoot, shoot_after
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import Geometry, Part

KEPT = 48
"""Cameras that are remembered; those used longest ago are forgotten."""


class StillCameras:
    """Takes shots that equal those of `shoot`, several times as fast where a camera is used again."""

    def __init__(self) -> None:
        self.known: dict[Camera, Shot] = {}

    def shoot(self, scene: Scene, camera: Camera) -> Shot:
        """Return the first hits of a camera's rays; see `camera_shot.shoot`."""
        key = replace(camera, name="")
        known = self.known.pop(key, None)
        shot = shoot(scene, camera) if known is None else shoot_after(scene, replace(known, camera=camera))
        if shot.behind is not None:
            # Without what moves, which would take up memory.
            still = Geometry(shot.geometry.static, Part.of(()))
            bare = replace(scene, things=())
            self.known[key] = replace(shot, scene=bare, geometry=still, hits=shot.behind)
            if len(self.known) > KEPT:
                del self.known[next(iter(self.known))]
        return shot
