"""Measure pictures: `python benchmarks/render_speed.py [--home NAME] [--frames N] [--json FILE]`.

The scenario: a character walks through the largest room of a furnished home, and ten objects move. Nothing is written
to disk unless stated. Preparation is measured separately: compiling (once per installation), and building a home's
triangles (once per home). Frames per second are of the wall clock. The plain reference is a z-buffer in Python of the
same home, without light, which takes seconds per picture.
"""

from __future__ import annotations

import resource
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import plain_reference
from measurement import Figure, as_line, finish, parser, rate, seconds
from warm_up import warm

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import Camera, top_view
from hearth.rendering.cameras.viewpoints import home_box, room_views
from hearth.rendering.film.video_file import Writer
from hearth.rendering.modalities import MODALITIES, pictures_of, render
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.figure import Figure as Person
from hearth.rendering.people.figure import figure_mesh
from hearth.rendering.people.random_people import person
from hearth.rendering.rays import threads
from hearth.rendering.rays.incremental_pictures import incremental_frame
from hearth.rendering.scene.instances import Thing, forget
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import scene_of
from hearth.rendering.scene.triangles import StaticThings
from hearth.schemas.graph import EnvironmentGraph, Node

Picture = Callable[[int, Scene], object]
PASSES, PIECED = 3, 8
"""Number of passes with all threads, and piece by piece."""
PICTURES = 120
"""Pictures of a film that is written."""
SIZE, SMALL = (640, 480), (320, 240)
OBJECTS = 10
BODY = person(3)
"""A person of MakeHuman's mesh."""
BALL = Model("toy", Look((0.12, 0.12, 0.12), kind="ball"))


def scenes(graph: EnvironmentGraph, frames: int) -> Iterator[Scene]:
    """Scenes of a character that walks through the largest room, while ten objects move."""
    whole = scene_of(graph, default())
    static = StaticThings(whole.things)
    (x, y, z), (w, h, d) = room_of(graph).box or home_box(graph)
    for number in range(frames):
        share = number / max(frames - 1, 1) - 0.5
        at = (x + 0.5 * w * share, y - h / 2, z + 0.2 * d * share)
        body_pose = BodyPose(stride=0.6 * (-1) ** number, right=(0.2, 1.0 + 0.01 * number, 0.4))
        person = Thing(60_000, "character", Person(BODY, body_pose), at, 60.0)
        carried = tuple(
            Thing(60_001 + k, "ball", BALL, (at[0] + 0.4, at[1] + 0.2 * k, at[2] + 0.1 * k)) for k in range(OBJECTS)
        )
        yield replace(whole, things=(person, *carried), static=static)


def room_of(graph: EnvironmentGraph) -> Node:
    """The largest room."""
    rooms = [node for node in graph.nodes if node.category == "Rooms" and node.box]
    return max(rooms, key=lambda node: node.box.size[0] * node.box.size[2] if node.box else 0.0)


def measured(
    name: str,
    target: float | None,
    films: list[Scene],
    make: Callable[[], Picture],
    yardstick: plain_reference.Yardstick,
) -> Figure:
    """Frames per second over all scenes; the first picture prepares the home's cached data.

    Every pass starts without a previous picture, as a film does.
    """
    forgotten()
    each: list[float] = []
    for _ in range(PASSES):
        picture = make()
        for number, scene in enumerate(films):
            began = time.perf_counter()
            picture(number, scene)
            each += [time.perf_counter() - began] if number else []
    best = undisturbed(films, make)
    return replace(rate(name, 1, each, "frames/s", target), undisturbed=best, ratio=yardstick.ratio(1, [1 / best]))


def forgotten() -> None:
    """Forget all meshes of things and people."""
    forget()
    figure_mesh.cache_clear()


def undisturbed(films: list[Scene], make: Callable[[], Picture]) -> float:
    """Frames a second of a machine that never stands still, by one thread of ours (a cast uses all processors).

    A picture takes longer than a machine that others share goes on for at a time: its pieces are timed one by one and
    the least times of each piece are added up. What our threads gain over that is left out: casts hold the
    interpreter's lock, so that it is little.
    """
    pieces, runs = Pieces(), [list[tuple[float, list[float]]]() for _ in films]
    pool, threads._pool = threads._pool, lambda process: pieces
    try:
        for _ in range(PIECED):
            picture = make()
            for number, scene in enumerate(films):
                pieces.times = []
                began = time.perf_counter()
                picture(number, scene)
                alone = time.perf_counter() - began - sum(pieces.times)
                runs[number].append((alone, pieces.times))
    finally:
        threads._pool = pool
    return (len(films) - 1) / sum(shared(each) for each in runs[1:])


class Pieces:
    """Replaces the threads: processes pieces one after the other, and records their times."""

    def __init__(self) -> None:
        self.times: list[float] = []

    def map(self, work: Callable[[object], object], items: list[object]) -> Iterator[object]:
        for item in items:
            began = time.perf_counter()
            done = work(item)
            self.times.append(time.perf_counter() - began)
            yield done


def shared(runs: list[tuple[float, list[float]]]) -> float:
    """Least seconds of a picture over several runs: of its pieces, and of the work between them.

    A first run may prepare what later ones find, so that it has more pieces; such runs are left out.
    """
    fewest = min(len(times) for _, times in runs)
    runs = [run for run in runs if len(run[1]) == fewest]
    pieces = [min(times) for times in zip(*(times for _, times in runs), strict=True)]
    return min(alone for alone, _ in runs) + sum(pieces)


class Stayed:
    """A fixed camera that reuses its last picture."""

    def __init__(self, camera: Camera, modalities: tuple[str, ...]) -> None:
        self.camera, self.modalities, self.last = camera, modalities, None

    def __call__(self, number: int, scene: Scene) -> dict[str, Any]:
        self.last = incremental_frame(scene, self.camera, self.last)
        return {"rgb": self.last.picture, **pictures_of(self.last.shot, self.modalities)}


def film_written(graph: EnvironmentGraph, camera: Camera, yardstick: plain_reference.Yardstick) -> Figure:
    """Frames per second of a film that is drawn and written as VP80, until its file is complete.

    No pose is seen twice. The codec works while the next picture is drawn, so that single pictures cannot be timed.
    """
    taken = []
    for _ in range(PASSES):
        films = scenes(graph, PICTURES)
        forgotten()
        with tempfile.TemporaryDirectory() as folder:
            writer, stayed = Writer(Path(folder) / "bench.webm", camera.width, camera.height, 30), Stayed(camera, ())
            first = stayed(0, next(films))
            began = time.perf_counter()
            writer.add(first["rgb"])
            for number, scene in enumerate(films, 1):
                writer.add(stayed(number, scene)["rgb"])
            writer.close()
            taken.append(time.perf_counter() - began)
    found = rate("640x480 draft, camera stays, VP80 written", PICTURES, taken, "frames/s", 40)
    return replace(found, ratio=yardstick.ratio(1, [min(taken) / PICTURES]))


def whole(films: list[Scene], camera: Camera, modalities: tuple[str, ...], quality: str) -> Picture:
    """Whole pictures by a moving camera, which can reuse only the things' meshes.

    Each scene is built once, as in a film: as the successor of the one before.
    """
    own = [replace(scene, things=tuple(scene.things)) for scene in films]

    def picture(number: int, scene: Scene) -> object:
        eye = (camera.eye[0] + 0.001 * number, camera.eye[1], camera.eye[2])
        after = own[min(number + 1, len(own) - 1)]
        return render(own[number], replace(camera, eye=eye), modalities, quality=quality, after=after)

    return picture


def ready(graph: EnvironmentGraph) -> list[Figure]:
    """Preparation: seconds of one processor."""
    began = time.process_time()
    warm()
    compiled = time.process_time()
    part = StaticThings(scene_of(graph, default()).things).whole
    _ = part.rows, part.caster, part.shadows
    done = time.process_time()
    return [
        seconds("ready: import, compile or read what was compiled, textures", [compiled - began]),
        seconds("ready: a home's triangles", [done - compiled]),
    ]


def main() -> None:
    """Print a table."""
    known = parser(__doc__)
    known.add_argument("--home", default="maple")
    known.add_argument("--frames", type=int, default=10)
    asked = known.parse_args()
    graph = library.load_graph(asked.home, default())
    figures = ready(graph)
    films = list(scenes(graph, asked.frames))
    corner = room_views(graph, *SIZE)[room_of(graph).id][0]
    above = top_view(home_box(graph), "top", *SMALL)
    every, few = tuple(MODALITIES), films[:5]
    corners = films[0].geometry.static.mesh.corners
    large, small = plain_reference.z_buffer(corners, corner), plain_reference.z_buffer(corners, above)
    work: list[tuple[str, float | None, list[Scene], Callable[[], Picture], plain_reference.Yardstick]] = [
        (f"640x480 draft, all {len(every)} modalities", 12, films, lambda: whole(films, corner, every, "draft"), large),
        ("640x480 draft, whole, rgb", None, films, lambda: whole(films, corner, ("rgb",), "draft"), large),
        (f"640x480 fine, all {len(every)} modalities", 3, few, lambda: whole(films, corner, every, "fine"), large),
        ("640x480 draft, camera stays, rgb", 60, films, lambda: Stayed(corner, ()), large),
        ("320x240 bird's eye, rgb and instance ids", 100, films, lambda: Stayed(above, ("instance_ids",)), small),
    ]
    figures += [measured(*each) for each in work]
    figures.insert(-1, film_written(graph, corner, large))
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    figures.append(Figure("memory at the most", peak, "MiB", 1024))
    print(f"{threads.count()} threads")
    for figure in figures:
        print(as_line(figure))
    finish(figures, asked.json)


if __name__ == "__main__":
    main()
