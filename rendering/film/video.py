"""Videos of executions: every step in motion, with the times of each step (thesis 2.4.1)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import cos, radians, sin
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hearth.rendering.arrays import Image
from hearth.rendering.cameras.camera import Camera, follow, look_at, top_view
from hearth.rendering.cameras.viewpoints import best_view, home_box, kept_inside, room_views
from hearth.rendering.film.quiet import quiet
from hearth.rendering.film.snapshots import AUTO, TOP, Play, acting, named_nodes
from hearth.rendering.people.acting import Actor
from hearth.rendering.people.motion import Frame, Span, frames, spans
from hearth.rendering.rays.incremental import Take, take
from hearth.rendering.scene.variation import PLAIN, Variation
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, EnvironmentGraph
from hearth.schemas.program import Step
from hearth.schemas.structs import FilmedStepRow
from hearth.schemas.vocabulary import ROOM_CATEGORY

FIRST, THIRD = "first", "third"
VIEWS = (AUTO, TOP, FIRST, THIRD)
"""Cameras that move or choose; others are named by `viewpoints.room_views`. All but `top` may be those of an agent by
number: `first.1`; else `auto` goes with whoever acts, and the others with agent 0.
"""


def agent_of(view: str) -> tuple[str, int | None]:
    """A view's own name, and the agent it is of: `first.1` is (`first`, 1); None where it names no agent."""
    name, _, number = view.partition(".")
    return (name, int(number)) if name in (AUTO, FIRST, THIRD) and number.isdecimal() else (view, None)


CODECS = {".webm": "VP80", ".mp4": "mp4v"}
"""What OpenCV writes into each kind of file: browsers play VP80."""


class Writer:
    """A video file that is there under its name only when it is complete."""

    def __init__(self, path: Path, width: int, height: int, fps: float) -> None:
        import cv2

        codec = CODECS.get(path.suffix)
        self.path, self.part = path, path.with_name(f".part{path.suffix}")
        self.file: Any = None
        if codec:
            with quiet():
                self.file = cv2.VideoWriter(str(self.part), cv2.VideoWriter.fourcc(*codec), fps, (width, height))
        if self.file is None or not self.file.isOpened():
            known = ", ".join(f"*{suffix}" for suffix in CODECS)
            raise HearthError.of(Code.NOT_RENDERED, f"OpenCV can't write {path}", suggestion=f"a file {known}")

    def add(self, picture: Image) -> None:
        """Add a picture, (H, W, 3) in the order red, green, blue."""
        self.file.write(np.ascontiguousarray(picture[..., ::-1]))

    def close(self) -> None:
        """Finish the file.

        Raises:
            HearthError: nothing was written, as when the disk is full.
        """
        self.file.release()
        if not self.part.exists() or not self.part.stat().st_size:
            raise HearthError.of(Code.NOT_RENDERED, f"nothing could be written to {self.path}", file=str(self.path))
        if self.path.suffix == ".webm":
            _renumber(self.part)
        self.part.replace(self.path)


TRACK_IDS = (b"\x73\xc5\x88", b"\x63\xc5\x88")
"""How Matroska's TrackUID and TagTrackUID of eight bytes begin."""

HEAD = 4096
"""Bytes of a file in which they stand."""


def _renumber(path: Path) -> None:
    """Write 1 over the number that is drawn anew for the track of every webm, so that equal films are equal bytes."""
    with path.open("r+b") as file:
        head = file.read(HEAD)
        for mark in TRACK_IDS:
            at = head.find(mark)
            if at >= 0:
                file.seek(at + len(mark))
                file.write((1).to_bytes(8, "big"))


class Shown(NamedTuple):
    """One picture of a film: its moment, the camera that took it, and the picture."""

    frame: Frame
    camera: Camera
    take: Take

    @property
    def rgb(self) -> Image:
        """(H, W, 3) colours."""
        return self.take.picture


def film(
    staged: Play,
    home: EnvironmentGraph,
    view: str = AUTO,
    *,
    size: tuple[int, int] = (640, 480),
    fps: float = 15.0,
) -> Iterator[Shown]:
    """The pictures of a video.

    Args:
        staged: what `snapshots.play` makes of an execution.
        home: the home's graph, with boxes.
        view: one of `VIEWS`, or the name of a room's camera.
        size: width and height.
        fps: pictures a second.

    Raises:
        HearthError: there is no such camera.
    """
    speed = staged.variation.speed
    director = Director(home, view, size, staged.variation)
    last: Take | None = None
    for frame in frames(staged, fps, speed):
        camera = director.camera(frame)
        last = take(frame.scene, camera, last)
        yield Shown(frame, camera, last)


class Director:
    """Chooses the camera of each frame.

    `auto` keeps a camera through a step while the actor stays in its room, and chooses among those of the room, and
    two over the actor's shoulders, the one that sees best what the step names.
    """

    def __init__(self, home: EnvironmentGraph, view: str, size: tuple[int, int], variation: Variation = PLAIN) -> None:
        self.size = size
        self.view, self.agent = agent_of(view)
        self.views = {
            room: tuple(variation.moved(camera) for camera in cameras)
            for room, cameras in room_views(home, *size).items()
        }
        self.rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY and node.box}
        fixed = {camera.name: camera for cameras in self.views.values() for camera in cameras}
        fixed[TOP] = top_view(home_box(home), TOP, *size)
        if self.view not in VIEWS and view not in fixed:
            known_names = ", ".join((*VIEWS, *sorted(fixed)[:3], "..."))
            raise HearthError.of(Code.NOT_RENDERED, f"no camera `{view}`", suggestion=known_names)
        self.fixed = fixed.get(view)
        self.chosen: Camera | None = None
        self.scene = (-1, 0)
        self.since = 0.0
        self.room = 0

    def _followed(self, frame: Frame) -> Actor:
        """Who the camera goes with.

        Raises:
            HearthError: there is no such agent.
        """
        if self.agent is None:
            return frame.actors[acting(frame.steps, len(frame.actors)) if self.view == AUTO else 0]
        if self.agent >= len(frame.actors):
            message = f"no agent {self.agent} to go with; there are {len(frame.actors)}, from 0"
            raise HearthError.of(Code.UNKNOWN_AGENT, message)
        return frame.actors[self.agent]

    def camera(self, frame: Frame) -> Camera:
        """The camera of a frame."""
        if self.fixed is not None:
            return self.fixed
        actor = self._followed(frame)
        if self.view == FIRST:
            return first_person(actor, self.size)
        room = self._room(actor)
        if self.view == THIRD:
            return kept_inside(follow(THIRD, actor.position, actor.yaw, *self.size), self.rooms.get(room))
        now = (frame.tick, room)
        waits = self.scene == now and frame.time - self.since <= PATIENCE
        if self.chosen is not None and self.scene == now and (waits or _in_picture(self.chosen, actor)):
            return self.chosen
        self.chosen = self._best(frame, replace(actor, room=room), self.chosen)
        self.scene, self.since = now, frame.time
        return self.chosen

    def _best(self, frame: Frame, actor: Actor, last: Camera | None) -> Camera:
        named = named_nodes([step for step in frame.steps if self.agent in (None, step.agent)], self.rooms)
        return best_view(frame.scene, self.views, actor, named, last, self.rooms.get(actor.room), wide=True)

    def _room(self, actor: Actor) -> int:
        """The room the actor is in now, while it walks to another."""
        # Between two rooms one is in the door: the camera stays.
        self.room = next((room for room, box in self.rooms.items() if _holds(box, actor.spot)), self.room or actor.room)
        return self.room


PATIENCE = 0.7
"""Seconds that a camera is kept at least."""

BORDER = 0.06
"""Share of the picture at its edges where an actor is taken to be leaving it."""


def _in_picture(camera: Camera, actor: Actor) -> bool:
    """Whether a camera shows the actor's body, not too near its edges."""
    places, depths = camera.project(np.array([actor.world((0.0, y, 0.0)) for y in (0.5, 1.4)]))
    share = places / (camera.width, camera.height)
    return bool((depths > 0.5).all() and (share > BORDER).all() and (share < 1 - BORDER).all())


def _holds(box: Box, spot: tuple[float, float]) -> bool:
    return all(abs(spot[k] - box.center[2 * k]) <= box.size[2 * k] / 2 for k in (0, 1))


def first_person(actor: Actor, size: tuple[int, int], pitch: float = 22.0) -> Camera:
    """What someone sees: from between the eyes, along the gaze; `pitch` degrees down where there is nothing to look at.

    Looking down a little, one sees one's hands and what they hold.
    """
    found = actor.figure().joints()
    head, face = found["head"], found["face"]
    way = (face - head) / np.linalg.norm(face - head)
    if actor.stance.gaze is None and actor.stance.posture != "lying":
        way = np.array((0.0, -sin(radians(pitch)), cos(radians(pitch))))
    eye = head + way * 0.13
    target = eye + way
    near, far = (actor.world((float(p[0]), float(p[1]), float(p[2]))) for p in (eye, target))
    if abs(far[0] - near[0]) + abs(far[2] - near[2]) < 1e-3:
        far = (far[0] + 0.01, far[1], far[2])
    return look_at(FIRST, near, far, *size, fov=82.0)


def times(found: Sequence[Span]) -> list[FilmedStepRow]:
    """Spans as plain values: tick, step texts, start and end in seconds."""
    from hearth.schemas.syntax import print_step

    return [
        {
            "tick": span.tick,
            "steps": [print_step(step) for step in span.steps],
            "start": round(span.start, 4),
            "end": round(span.end, 4),
            "cameras": [],
            "visible": 0.0,
        }
        for span in found
    ]


class Recorded(NamedTuple):
    """What `record` wrote.

    Attributes:
        files: the videos.
        frames: how many pictures each has.
        steps: as `times` gives them, each with the cameras that show it, and the share of the objects it names
            that are visible in some picture.
        track: the tick and the camera of each picture.
        moments: the last picture of each tick, for a contact sheet.
    """

    files: tuple[Path, ...]
    frames: int
    steps: list[FilmedStepRow]
    track: list[tuple[int, Camera]]
    moments: list[tuple[Image, Span]]


def record(
    staged: Play,
    home: EnvironmentGraph,
    out: Path,
    view: str = AUTO,
    *,
    size: tuple[int, int] = (640, 480),
    fps: float = 15.0,
    suffixes: Sequence[str] = (".webm", ".mp4"),
) -> Recorded:
    """Write the videos of one camera into a folder, as `VIEW.webm` and `VIEW.mp4`.

    Args:
        staged, home, view, size, fps: as of `film`.
        out: a folder that is there.
        suffixes: of `CODECS`.

    Raises:
        HearthError: no such camera, or a file can't be written; what was complete stays.
    """
    known = {span.tick: span for span in spans(staged, staged.variation.speed)}
    steps = times(list(known.values()))
    wanted = {tick: named_in(staged, span.steps) for tick, span in known.items()}
    seen: dict[int, set[int]] = {tick: set() for tick in known}
    writers = [Writer(out / f"{view}{suffix}", *size, fps) for suffix in suffixes]
    last: dict[int, Image] = {}
    track: list[tuple[int, Camera]] = []
    for shown in film(staged, home, view, size=size, fps=fps):
        for writer in writers:
            writer.add(shown.rgb)
        tick, name = shown.frame.tick, shown.camera.name
        last[tick] = shown.rgb
        seen[tick] |= _newly_seen(shown, wanted[tick] - seen[tick])
        track.append((tick, shown.camera))
        if name not in steps[tick]["cameras"]:
            steps[tick]["cameras"].append(name)
    for writer in writers:
        writer.close()
    for step, tick in zip(steps, known, strict=True):
        step["visible"] = round(len(seen[tick]) / len(wanted[tick]), 4) if wanted[tick] else 1.0
    moments = [(picture, known[tick]) for tick, picture in last.items()]
    return Recorded(tuple(writer.path for writer in writers), len(track), steps, track, moments)


def named_in(staged: Play, steps: Sequence[Step]) -> frozenset[int]:
    """The things that steps name; rooms are none."""
    return frozenset(
        ref.node for step in steps for ref in step.objects if ref.node and ref.node not in staged.prepared.rooms
    )


def _newly_seen(shown: Shown, wanted: frozenset[int]) -> frozenset[int]:
    """The nodes among those wanted that a frame shows."""
    if not wanted:
        return wanted
    shot = shown.take.shot
    numbers = np.flatnonzero(np.bincount(shot.owner + 1)[1:])
    return wanted & {shot.geometry.things[number].id for number in numbers.tolist()}
