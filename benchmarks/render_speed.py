"""Measure pictures: `python benchmarks/render_speed.py [--home NAME] [--frames N]`.

The work is what users ask for: somebody walks and works in a furnished home. Frames a second are given by wall time,
and by CPU time of one core, which other processes disturb less. Nothing is written to disk.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

from hearth.rendering.camera import Camera, top_view
from hearth.rendering.figure import BODIES, Figure
from hearth.rendering.geometry import Still
from hearth.rendering.meshes.look import Look
from hearth.rendering.modalities import MODALITIES, render
from hearth.rendering.models import Model
from hearth.rendering.retake import pictures_of, take
from hearth.rendering.scene import Scene
from hearth.rendering.skeleton import Stance
from hearth.rendering.staging import scene_of
from hearth.rendering.things import Thing
from hearth.rendering.viewpoints import home_box, room_views
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.simulation.homes import catalog

SIZE = (640, 480)
SMALL = (320, 240)
OBJECTS = 10


def scenes(graph: EnvironmentGraph, frames: int) -> Iterator[Scene]:
    """Somebody walks through the largest room; ten objects move with them."""
    whole = scene_of(graph)
    still = Still(whole.things)
    (x, y, z), (w, h, d) = room_of(graph).box or home_box(graph)
    for number in range(frames):
        share = number / max(frames - 1, 1) - 0.5
        at = (x + 0.5 * w * share, y - h / 2, z + 0.2 * d * share)
        person = Thing(60_000, "character", Figure(BODIES["ana"], Stance(stride=0.6 * (-1) ** number)), at, 60.0)
        carried = tuple(
            Thing(60_001 + k, "ball", BALL, (at[0] + 0.4, at[1] + 0.2 * k, at[2] + 0.1 * k)) for k in range(OBJECTS)
        )
        yield replace(whole, things=(person, *carried), still=still)


BALL = Model("toy", Look((0.12, 0.12, 0.12), kind="ball"))


def room_of(graph: EnvironmentGraph) -> Node:
    """The largest room."""
    rooms = [node for node in graph.nodes if node.category == "Rooms" and node.box]
    return max(rooms, key=lambda node: node.box.size[0] * node.box.size[2] if node.box else 0.0)


def measured(name: str, goal: str, films: list[Scene], picture: Callable[[Scene], object]) -> None:
    """Print frames a second of a picture of each scene; the first warms up."""
    picture(films[0])
    wall, cpu = time.perf_counter(), time.process_time()
    for scene in films[1:]:
        picture(scene)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    count = len(films) - 1
    print(f"{name:58} {count / wall:8.1f} {count / cpu:10.1f} {goal:>8}")


class Stayed:
    """A camera that stays and remembers its last picture."""

    def __init__(self, camera: Camera, modalities: tuple[str, ...]) -> None:
        self.camera, self.modalities, self.last = camera, modalities, None

    def __call__(self, scene: Scene) -> object:
        self.last = take(scene, self.camera, self.last)
        return pictures_of(self.last, self.modalities)


def video(films: list[Scene], camera: Camera) -> Callable[[Scene], object]:
    """Pictures written as VP80."""
    import tempfile
    from pathlib import Path

    from hearth.rendering.video import Writer

    writer = Writer(Path(tempfile.mkdtemp()) / "bench.webm", camera.width, camera.height, 30)
    stayed = Stayed(camera, ("rgb",))

    def picture(scene: Scene) -> object:
        return writer.add(stayed(scene)["rgb"])  # type: ignore[index]

    return picture


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--home", default="maple")
    parser.add_argument("--frames", type=int, default=24)
    asked = parser.parse_args()
    graph = catalog.load_graph(asked.home)
    films = list(scenes(graph, asked.frames))
    corner = room_views(graph, *SIZE)[room_of(graph).id][0]
    above = top_view(home_box(graph), "top", *SMALL)
    every = tuple(MODALITIES)
    print(f"{'frames a second':58} {'by wall':>8} {'a CPU s':>10} {'asked':>8}")
    measured(f"640x480 draft, whole, {len(every)} modalities", "12", films, lambda s: render(s, corner, every))
    measured("640x480 draft, whole, rgb", "", films, lambda s: render(s, corner, ("rgb",)))
    fine = films[: max(4, asked.frames // 6)]
    measured("640x480 fine, whole, all", "3", fine, lambda s: render(s, corner, every, quality="fine"))
    measured("640x480 draft, camera stays, rgb", "60", films, Stayed(corner, ("rgb",)))
    measured("640x480 draft, camera stays, VP80 written", "30", films, video(films, corner))
    measured("320x240 bird's eye, rgb and instance ids", "100", films, Stayed(above, ("rgb", "instance_ids")))


if __name__ == "__main__":
    main()
