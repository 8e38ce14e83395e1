"""Videos of executions, with start and end time of each step (thesis 2.4.1)."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from math import cos, radians, sin
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from hearth.rendering.annotations import camera_of
from hearth.rendering.arrays import Image
from hearth.rendering.cameras.camera import Camera, look_at, top_view
from hearth.rendering.cameras.viewpoints import behind, bulky, home_box, room_views
from hearth.rendering.film.execution_keyframes import Trajectory
from hearth.rendering.film.execution_pictures import AUTO, TOP
from hearth.rendering.film.film_moments import room_at
from hearth.rendering.film.film_rate import FILM_RATE
from hearth.rendering.film.modality_archives import FrameFiles, FrameTime
from hearth.rendering.film.shots import Planner, Shots
from hearth.rendering.film.video_file import Writer
from hearth.rendering.modalities import check_modalities, pictures_of
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.motion import Frame, Span, frames, spans
from hearth.rendering.rays.camera_shot import Shot, shoot
from hearth.rendering.rays.incremental_pictures import IncrementalFrame, incremental_frame
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, to_release
from hearth.schemas.program import Step
from hearth.schemas.row_types import FilmedStepRow
from hearth.schemas.vocabulary import ROOM_CATEGORY
from hearth.storage.names import inside

FIRST, THIRD = "first", "third"
VIEWS = (AUTO, TOP, FIRST, THIRD)
"""Moving cameras and `top`; fixed ones have the names of `viewpoints.room_views`. A suffix names the agent to follow
(`first.1`); without it `auto` follows the acting agent, and the others agent 0.
"""


def agent_of(view: str) -> tuple[str, int | None]:
    """Return a view's name and its agent: (`first`, 1) for `first.1`; None without an agent."""
    name, _, number = view.partition(".")
    return (name, int(number)) if name in (AUTO, FIRST, THIRD) and number.isdecimal() else (view, None)


class FilmFrame(NamedTuple):
    """One picture of a film: its frame and camera, what is seen, and (H, W, 3) colours."""

    frame: Frame
    camera: Camera
    shot: Shot
    rgb: Image

    def pictures(self, modalities: Iterable[str], quality: str = "draft") -> dict[str, Any]:
        """Further modalities of the picture, as `modalities.render` gives them.

        Flow is towards the next frame by that frame's camera, and unknown (NaN) across a cut.
        """
        return pictures_of(self.shot, modalities, quality)


def film(
    trajectory: Trajectory,
    home: EnvironmentGraph,
    view: str = AUTO,
    *,
    size: tuple[int, int] = (640, 480),
    fps: float = FILM_RATE,
    quality: str = "draft",
) -> Iterator[FilmFrame]:
    """Yield the pictures of a video.

    Args:
        trajectory: as `snapshots.trajectory_of` gives it.
        home: the home's graph, with boxes.
        view: one of `VIEWS`, or the name of a room's camera.
        size: width and height, pixels; even for a file.
        fps: pictures per second.
        quality: as in `modalities.render`.

    Raises:
        HearthError: the camera does not exist.
    """
    speed = trajectory.variation.speed
    selector = CameraSelector(trajectory, home, view, size)
    class_ids = trajectory.prepared.knowledge.class_ids
    last: IncrementalFrame | None = None
    pictured = ((frame, selector.camera(frame)) for frame in frames(trajectory, fps, speed))
    for (frame, camera), (later, next_camera) in _with_next(pictured):
        if quality == "fine":
            shot = shoot(frame.scene, camera, by_rays=True)
            picture = pictures_of(shot, ["rgb"], quality)["rgb"]
        else:
            last = incremental_frame(frame.scene, camera, last)
            shot, picture = last.shot, last.picture
        # The other views move; `auto` has cameras that stand, and changes between them.
        cut = selector.view == AUTO and next_camera != camera
        after: dict[str, Any] = {"after": later.scene, "after_camera": next_camera, "cut": cut}
        yield FilmFrame(frame, camera, replace(shot, class_ids=class_ids, **after), picture)


def _with_next(found: Iterable[tuple[Frame, Camera]]) -> Iterator[tuple[tuple[Frame, Camera], tuple[Frame, Camera]]]:
    """Each frame and the one after it, with their cameras; the last one and itself."""
    before: tuple[Frame, Camera] | None = None
    for frame in found:
        if before is not None:
            yield before, frame
        before = frame
    if before is not None:
        yield before, before


class CameraSelector:
    """Selects the camera of each frame.

    `auto` shows each act so that the person and its objects can be recognised, in shots of at least three seconds; see
    `shots`.

    Raises:
        HearthError: NOT_RENDERED: no such camera; UNKNOWN_AGENT: no such agent.
    """

    def __init__(self, trajectory: Trajectory, home: EnvironmentGraph, view: str, size: tuple[int, int]) -> None:
        self.trajectory, self.home, self.size = trajectory, home, size
        self.view, self.agent = agent_of(view)
        self.views = {
            room: tuple(trajectory.variation.moved(camera) for camera in cameras)
            for room, cameras in room_views(home, *size).items()
        }
        self.rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY and node.box}
        fixed = {camera.name: camera for cameras in self.views.values() for camera in cameras}
        fixed[TOP] = top_view(home_box(home), TOP, *size)
        if self.view not in VIEWS and view not in fixed:
            known_names = ", ".join((*VIEWS, *sorted(fixed)[:3], "..."))
            raise HearthError.of(Code.NOT_RENDERED, f"no camera `{view}`", suggestion=known_names)
        people = len(trajectory.keyframes[0].actors)
        if self.agent is not None and self.agent >= people:
            message = f"no agent {self.agent} to go with; there are {people}, from 0"
            raise HearthError.of(Code.UNKNOWN_AGENT, message)
        self.fixed = fixed.get(view)
        self.furniture = bulky(home)
        self.room = 0

    @cached_property
    def shots(self) -> Shots:
        """The shots of `auto`."""
        return Planner(self.trajectory, self.home, self.views, self.size, self.agent).shots()

    def camera(self, frame: Frame) -> Camera:
        """Return the camera of a frame."""
        if self.fixed is not None:
            return self.fixed
        if self.view == AUTO:
            return self.shots.at(frame.time)
        actor = frame.actors[self.agent or 0]
        if self.view == FIRST:
            return first_person(actor, self.size)
        # In a doorway no room contains the position: the camera stays.
        self.room = room_at(self.rooms, actor.spot) or self.room or actor.room
        return behind(THIRD, actor, frame.scene, self.size, self.rooms.get(self.room), self.furniture)


def first_person(actor: Actor, size: tuple[int, int], pitch: float = 22.0) -> Camera:
    """Return a camera between the actor's eyes, along its gaze; without a gaze it looks `pitch` degrees down.

    A slight pitch shows the hands and the objects in them.
    """
    found = actor.figure().joints()
    head, face = found["head"], found["face"]
    way = (face - head) / np.linalg.norm(face - head)
    if actor.body_pose.gaze is None and actor.body_pose.posture != "lying":
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
            "visible": None,
        }
        for span in found
    ]


class Recorded(NamedTuple):
    """The result of `record`.

    Attributes:
        files: the videos.
        frames: number of pictures in each.
        steps: as `times` gives them, each with its cameras and the share of its objects that some picture shows; None
            where it names none.
        track: tick and camera of each picture.
        keyframes: the last picture of each tick, for a contact sheet.
        further: files of the other modalities, and their index.
    """

    files: tuple[Path, ...]
    frames: int
    steps: list[FilmedStepRow]
    track: list[tuple[int, Camera]]
    keyframes: list[tuple[Image, Span]]
    further: tuple[Path, ...] = ()


def record(
    trajectory: Trajectory,
    home: EnvironmentGraph,
    out: Path,
    view: str = AUTO,
    *,
    size: tuple[int, int] = (640, 480),
    fps: float = FILM_RATE,
    suffixes: Sequence[str] = (".webm", ".mp4"),
    modalities: Sequence[str] = ("rgb",),
    quality: str = "draft",
) -> Recorded:
    """Write the videos of one camera into a folder, as `VIEW.webm` and `VIEW.mp4` (thesis 2.4.1).

    Modalities other than `rgb` become files of their own, see `modality_archives`.

    Args:
        trajectory, home, view, size, fps: as in `film`.
        out: an existing folder.
        suffixes: of `CODECS`.
        modalities, quality: as in `modalities.render`; `class_ids` are those of the table `vocabulary`, and `graph` is
            the scene graph after the tick.

    Raises:
        HearthError: no such camera, modality or quality, an odd size, or an unwritable file; complete files stay.

    Examples:
        >>> trajectory = hearth.trajectory_of(execution, graph, known)
        >>> film = hearth.record(trajectory, graph, Path(), size=(64, 48), fps=1, suffixes=[".mp4"])
        >>> film.frames, len(film.steps), [path.name for path in film.files]
        (15, 4, ['auto.mp4'])
    """
    drawn = check_modalities([name for name in modalities if name not in ("graph", "rgb")], quality)
    CameraSelector(trajectory, home, view, size)  # refuses an unknown camera before a file begins
    known, wanted = _shown(trajectory)
    steps = times(list(known.values()))
    seen: dict[int, set[int]] = {tick: set() for tick in known}
    writers = [Writer(inside(out, f"{view}{suffix}"), *size, fps) for suffix in suffixes]
    files, graphs = FrameFiles(out, view, modalities), _graphs(trajectory) if "graph" in modalities else {}
    last: dict[int, Image] = {}
    track: list[tuple[int, Camera]] = []
    for film_frame in film(trajectory, home, view, size=size, fps=fps, quality=quality):
        for writer in writers:
            writer.add(film_frame.rgb)
        if files.names:
            pictures = film_frame.pictures(drawn, quality) | {"graph": graphs.get(film_frame.frame.tick)}
            files.add(FrameTime(film_frame.frame.time, film_frame.frame.tick, camera_of(film_frame.camera)), pictures)
        tick, name = film_frame.frame.tick, film_frame.camera.name
        last[tick] = film_frame.rgb
        seen[tick] |= _newly_seen(film_frame, wanted[tick] - seen[tick])
        track.append((tick, film_frame.camera))
        if name not in steps[tick]["cameras"]:
            steps[tick]["cameras"].append(name)
    for writer in writers:
        writer.close()
    for step, tick in zip(steps, known, strict=True):
        step["visible"] = _share(seen[tick], wanted[tick])
    videos, keyframes = tuple(writer.path for writer in writers), [(last[tick], known[tick]) for tick in last]
    return Recorded(videos, len(track), steps, track, keyframes, files.close(fps, steps))


def _shown(trajectory: Trajectory) -> tuple[dict[int, Span], dict[int, frozenset[int]]]:
    """Return the span of each tick, and the things that its steps name."""
    known = {span.tick: span for span in spans(trajectory, trajectory.variation.speed)}
    return known, {tick: named_in(trajectory, span.steps) for tick, span in known.items()}


def _share(seen: Collection[int], wanted: Collection[int]) -> float | None:
    """Return the share of some things that were seen; None where there are none."""
    return round(len(seen) / len(wanted), 4) if wanted else None


def _graphs(trajectory: Trajectory) -> dict[int, Any]:
    """Return the scene graph after each tick."""
    return {keyframe.tick: to_release(keyframe.places.graph) for keyframe in trajectory.keyframes}


def named_in(trajectory: Trajectory, steps: Sequence[Step]) -> frozenset[int]:
    """Return the objects that steps name, without rooms."""
    return frozenset(
        ref.node for step in steps for ref in step.objects if ref.node and ref.node not in trajectory.prepared.rooms
    )


def _newly_seen(film_frame: FilmFrame, wanted: frozenset[int]) -> frozenset[int]:
    """Return the wanted nodes that a frame shows."""
    if not wanted:
        return wanted
    shot = film_frame.shot
    numbers = np.flatnonzero(np.bincount(shot.owner + 1)[1:])
    return wanted & {shot.geometry.things[number].id for number in numbers.tolist()}
