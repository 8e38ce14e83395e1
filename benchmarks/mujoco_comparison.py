"""Compare with MuJoCo's software renderer: `python benchmarks/mujoco_comparison.py [--home NAME] [--frames N]`.

It needs the wheel `mujoco`, which nothing else here needs, and Mesa's software EGL. The scenario is that of
`render_speed`: a person walks through the largest room, and ten things move; MuJoCo gets the same triangles, with one
mean colour each thing, without textures, the sun and the room's lamps, up to the eight lights that OpenGL has. Its
person moves without bending, which is less work. All modalities are its three: colours, depth, and ids; ours are nine.
Both draw the same pictures by turns, so that load of others slows both; ratios are of the medians.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from statistics import median
from typing import Any

import numpy as np
from measurement import Figure, as_line, finish, parser
from render_speed import SIZE, Stayed, room_of, scenes, whole
from warm_up import warm

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.viewpoints import room_views
from hearth.rendering.modalities import MODALITIES
from hearth.rendering.scene.instances import Thing, placed
from hearth.rendering.scene.scene import Scene

os.environ.setdefault("MUJOCO_GL", "egl")
os.environ.setdefault("LIBGL_ALWAYS_SOFTWARE", "1")

MOST_LIGHTS = 8
"""Of OpenGL's fixed pipeline, the sun among them."""

TURNS = 3

MIRRORED = np.array((1.0, 1.0, -1.0))
"""Our axes are left-handed, MuJoCo's right-handed."""


def load() -> Any:
    """The library, or the end of the program with what to install."""
    try:
        import mujoco
    except ImportError:
        raise SystemExit("MuJoCo is missing: pip install mujoco") from None
    return mujoco


class Theirs:
    """A scene in MuJoCo, with the things that move as bodies that are put where they are.

    Args:
        films: the scenes; the first has the moving things where they begin.
        camera: the camera.
    """

    def __init__(self, films: list[Scene], camera: Camera) -> None:
        self.mujoco, self.films = load(), films
        spec = self.mujoco.MjSpec()
        spec.visual.map.znear, spec.visual.map.zfar = 0.001, 5.0
        # OpenGL's pictures are made in a buffer that must be as large.
        spec.visual.global_.offwidth, spec.visual.global_.offheight = SIZE
        for number, thing in enumerate(films[0].static.things):
            self._add(spec, spec.worldbody, f"static{number}", thing)
        for number, thing in enumerate(films[0].things):
            body = spec.worldbody.add_body(name=f"moving{number}", mocap=True)
            self._add(spec, body, f"moving{number}", thing)
        _lights(self.mujoco, spec, films[0], camera)
        lens = float(np.degrees(2 * np.arctan(camera.height / 2 / camera.intrinsics[0, 0])))
        spec.worldbody.add_camera(name="eye", pos=camera.eye * MIRRORED, fovy=lens, quat=_turned(self.mujoco, camera))
        self.model = spec.compile()
        self.data = self.mujoco.MjData(self.model)
        self.renderer = self.mujoco.Renderer(self.model, camera.height, camera.width, max_geom=20_000)

    def _add(self, spec: Any, body: Any, name: str, thing: Thing) -> None:
        mesh = placed(thing)
        if len(mesh) < 1:
            return
        corners = (mesh.corners[:, ::-1] * MIRRORED).reshape(-1, 3)
        shell = self.mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        faces = np.arange(len(corners), dtype=np.int32)
        spec.add_mesh(name=name, uservert=corners.ravel(), userface=faces, inertia=shell)
        colour = np.sqrt(np.clip(mesh.surface[:, :3].mean(axis=0), 0, 1))
        kind = self.mujoco.mjtGeom.mjGEOM_MESH
        body.add_geom(type=kind, meshname=name, rgba=[*colour.tolist(), 1.0], contype=0, conaffinity=0, mass=0)

    def place(self, number: int) -> None:
        """Put the moving things where they are in a scene."""
        for k, (first, thing) in enumerate(zip(self.films[0].things, self.films[number].things, strict=True)):
            self.data.mocap_pos[k] = np.subtract(thing.position, first.position) * MIRRORED
        self.mujoco.mj_forward(self.model, self.data)
        self.renderer.update_scene(self.data, camera="eye")

    def colours(self, number: int) -> object:
        """A picture."""
        self.place(number)
        return self.renderer.render()

    def all(self, number: int) -> object:
        """Colours, depth and ids."""
        self.place(number)
        found = [self.renderer.render()]
        for on, off in (
            (self.renderer.enable_depth_rendering, self.renderer.disable_depth_rendering),
            (self.renderer.enable_segmentation_rendering, self.renderer.disable_segmentation_rendering),
        ):
            on()
            found.append(self.renderer.render())
            off()
        return found


def _turned(mujoco: Any, camera: Camera) -> Any:
    """A camera's orientation; MuJoCo's look backwards along their third axis."""
    found, axes = np.zeros(4), camera.pose[:3, :3] * MIRRORED * MIRRORED[:, None]
    mujoco.mju_mat2Quat(found, np.ascontiguousarray(axes, np.float64).ravel())
    return found


def _lights(mujoco: Any, spec: Any, scene: Scene, camera: Camera) -> None:
    """The sun and the nearest lamps, which cast shadows."""
    sun = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL
    spec.worldbody.add_light(type=sun, dir=-np.array(scene.day.sun or (0, 1, 0)) * MIRRORED, castshadow=True)
    lamps = [light for light in scene.lights if light.facing is None]
    lamps.sort(key=lambda light: float(np.linalg.norm(np.subtract(light.position, camera.eye))))
    for lamp in lamps[: MOST_LIGHTS - 1]:
        spot = mujoco.mjtLightType.mjLIGHT_SPOT
        spec.worldbody.add_light(type=spot, pos=lamp.position * MIRRORED, dir=(0, -1, 0), cutoff=80, castshadow=True)


def alternately(ours: list[Callable[[int], object]], theirs: list[Callable[[int], object]], count: int) -> list[float]:
    """Median seconds of a picture by each of some renderers, which take turns."""
    every = [*ours, *theirs]
    times: list[list[float]] = [[] for _ in every]
    for turn in range(TURNS):
        for number in range(count):
            for picture, found in zip(every, times, strict=True):
                began = time.perf_counter()
                picture(number)
                if turn or number:
                    found.append(time.perf_counter() - began)
    return [median(found) for found in times]


def main() -> None:
    """Print a table."""
    known = parser(__doc__)
    known.add_argument("--home", default="maple")
    known.add_argument("--frames", type=int, default=8)
    asked = known.parse_args()
    warm()
    graph = library.load_graph(asked.home, default())
    films = list(scenes(graph, asked.frames))
    camera = replace(room_views(graph, *SIZE)[room_of(graph).id][0])
    other, every, still = Theirs(films, camera), whole(films, camera, tuple(MODALITIES), "draft"), Stayed(camera, ())
    mine = [lambda number: every(number, films[number]), lambda number: still(number, films[number])]
    found = alternately(mine, [other.all, other.colours], len(films))
    nine, film, three, colours = found
    figures = [
        Figure("640x480, all nine modalities", 1 / nine, "frames/s", 12),
        Figure("640x480, camera stays, rgb", 1 / film, "frames/s", 60),
        Figure("MuJoCo: rgb, depth and ids", 1 / three, "frames/s"),
        Figure("MuJoCo: rgb", 1 / colours, "frames/s"),
        Figure("all modalities, times MuJoCo", three / nine, "times", 3.5),
        Figure("static film, times MuJoCo", colours / film, "times", 12),
    ]
    for figure in figures:
        print(as_line(figure))
    finish(figures, asked.json)


if __name__ == "__main__":
    main()
