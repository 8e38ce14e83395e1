"""Ahead-of-time compilation of the loops."""

from __future__ import annotations

from hearth.rendering.cameras.camera import look_at
from hearth.rendering.modalities import MODALITIES, render
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.rays.incremental_pictures import incremental_frame
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.lights import Light
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import StaticThings


def warm() -> None:
    """Compile all loops by drawing a small scene; later processes load them from disk.

    Raises:
        HearthError: open3d is missing.
    """
    ball = Thing(1, "toy", Model("toy", Look((0.5, 0.5, 0.5), kind="ball")))
    ground = Thing(2, "floor", Model("ceiling", Look((4.0, 0.1, 4.0))), (0.0, -0.2, 0.0))
    lights = (Light((0.5, 2.0, 0.5), (1.0, 1.0, 1.0)), Light((2.0, 1.0, 0.0), (1.0, 1.0, 1.0), facing=(-1.0, 0.0, 0.0)))
    scene = Scene((ball,), lights, static=StaticThings((ground,)))
    camera = look_at("warm", (1.0, 1.5, 2.0), (0.0, 0.2, 0.0), 32, 24)
    for quality in ("draft", "fine"):
        render(scene, camera, MODALITIES, quality=quality)
    incremental_frame(scene, camera)
