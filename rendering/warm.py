"""Compiling ahead: so that the first picture need not wait for it."""

from __future__ import annotations

from hearth.rendering.camera import look_at
from hearth.rendering.geometry import Still
from hearth.rendering.lights import Light
from hearth.rendering.meshes.look import Look
from hearth.rendering.modalities import MODALITIES, render
from hearth.rendering.models import Model
from hearth.rendering.retake import take
from hearth.rendering.scene import Scene
from hearth.rendering.things import Thing


def warm() -> None:
    """Compile all loops, by drawing a small scene; afterwards they are read from disk.

    Raises:
        HearthError: there is no open3d.
    """
    ball = Thing(1, "toy", Model("toy", Look((0.5, 0.5, 0.5), kind="ball")))
    ground = Thing(2, "floor", Model("ceiling", Look((4.0, 0.1, 4.0))), (0.0, -0.2, 0.0))
    lights = (Light((0.5, 2.0, 0.5), (1.0, 1.0, 1.0)), Light((2.0, 1.0, 0.0), (1.0, 1.0, 1.0), facing=(-1.0, 0.0, 0.0)))
    scene = Scene((ball,), lights, still=Still((ground,)))
    camera = look_at("warm", (1.0, 1.5, 2.0), (0.0, 0.2, 0.0), 32, 24)
    for quality in ("draft", "fine"):
        render(scene, camera, MODALITIES, quality=quality)
    take(scene, camera)
