"""Recordings of scripts: pictures, joints and time-stamps of each character, in the files that Unity writes."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import orjson

from hearth.interop.virtualhome.camera_images import MODES, png_of
from hearth.interop.virtualhome.recording_settings import ScriptSettings
from hearth.interop.virtualhome.scene_cameras import on_person
from hearth.interop.virtualhome.script_lines import unity_step
from hearth.interop.virtualhome.unity_scene import UnityScene
from hearth.rendering.cameras.camera import Camera
from hearth.rendering.film.execution_keyframes import Keyframe, Trajectory, trajectory_through
from hearth.rendering.film.video import FIRST, CameraSelector, first_person
from hearth.rendering.modalities import pictures_of
from hearth.rendering.people.motion import Frame, Span, frames, spans
from hearth.rendering.rays.camera_shot import shoot
from hearth.rendering.rays.incremental_pictures import IncrementalFrame, incremental_frame
from hearth.rendering.scene.film_variation import PLAIN
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import file_name, inside, numbered

MOST_FRAMES = 2_000
"""Pictures of a recording."""

MOST_BYTES = 8 << 30
"""Bytes of all recordings of a server."""

MOST_SECONDS = 280.0
"""Seconds that a recording may take; it then stops, and says so."""


class Recorded(NamedTuple):
    """A recording: its folder's name, its frames, and start and end of each tick in frames."""

    folder: str
    frames: int
    spans: tuple[tuple[str, int, int], ...]


class Recordings:
    """The folder into which all recordings of a server go.

    Args:
        out: the folder, given when the server starts; None records nothing.
    """

    def __init__(self, out: Path | None) -> None:
        self.out, self._bytes = out, 0
        self._folders: dict[str, str] = {}
        self._files: dict[str, list[Path]] = {}

    def check(self) -> None:
        """Check that there is a folder, and room in it.

        Raises:
            HearthError: UNWRITABLE.
        """
        if self.out is None:
            raise HearthError.of(Code.UNWRITABLE, "the server was started without a folder for recordings",
                                 suggestion="start it with --out DIR")  # fmt: skip
        if self._bytes >= MOST_BYTES:
            raise HearthError.of(Code.UNWRITABLE, f"the recordings have {MOST_BYTES >> 30} GiB",
                                 suggestion="start the server again with another --out DIR")  # fmt: skip

    def folder(self, prefix: str) -> Path:
        """Return the folder of a recording: an earlier one of this server is replaced, files of others stay."""
        assert self.out is not None
        self.out.mkdir(parents=True, exist_ok=True)
        wanted = file_name(prefix.strip())
        if wanted not in self._folders:
            self._folders[wanted] = numbered(wanted, [path.name for path in self.out.iterdir()])
        name = self._folders[wanted]
        for path in self._files.pop(name, ()):
            path.unlink(missing_ok=True)
        self._files[name] = []
        return inside(self.out, name)

    def write(self, folder: Path, name: str, data: bytes) -> None:
        """Write a file of a recording."""
        path = inside(folder, name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        self._files[folder.name].append(path)
        self._bytes += len(data)


def record(
    scene: UnityScene, keyframes: Sequence[Keyframe], settings: ScriptSettings, recordings: Recordings
) -> Recorded:
    """Write the pictures of a script that was done.

    Raises:
        HearthError: NOT_RENDERED: no such camera; TIMED_OUT or FILE_TOO_LARGE: it is longer than may be recorded.
    """
    recordings.check()
    variation = replace(PLAIN, seed=scene.seed, hour=scene.hour, speed=settings.speed)
    trajectory = trajectory_through(scene.followed.prepared, keyframes, variation)
    chosen = _Cameras(scene, trajectory, settings)
    folder = recordings.folder(settings.prefix)
    until, count = time.monotonic() + MOST_SECONDS, 0
    joints: dict[int, list[str]] = {}
    for number, (frame, later) in enumerate(_with_next(_frames(trajectory, settings))):
        if number >= MOST_FRAMES:
            raise HearthError.of(Code.FILE_TOO_LARGE, f"more than {MOST_FRAMES:,} frames", suggestion="a lower rate")
        if time.monotonic() > until:
            raise HearthError.of(Code.TIMED_OUT, f"the recording takes more than {MOST_SECONDS:g} s; {number} frames "
                                 "are written", suggestion="fewer lines, modes or pixels")  # fmt: skip
        for agent, place, pictures in chosen.pictures(frame, later):
            for mode in settings.modes:
                recordings.write(folder, f"{agent}/Action_{number:04d}_{place}_{mode}.png", png_of(mode, pictures))
        for agent, actor in enumerate(frame.actors):
            found = joints.setdefault(agent, [])
            found.append(" ".join([str(number), *(f"{v:.4f}" for p in _joints(actor) for v in p)]))
        count = number + 1
    stamps = _stamps(spans(trajectory, settings.speed), settings, count)
    _write_texts(recordings, folder, settings, trajectory, joints, stamps)
    return Recorded(folder.name, count, stamps)


def _frames(trajectory: Trajectory, settings: ScriptSettings) -> Iterator[Frame]:
    """Yield the frames of a recording: all, or the ends of its ticks."""
    if not settings.teleports:
        yield from frames(trajectory, settings.rate, settings.speed)
        return
    for keyframe in trajectory.keyframes:
        scene = keyframe.scene
        time_now = keyframe.tick / settings.rate
        yield Frame(time_now, keyframe.tick, keyframe.steps, scene, keyframe.actors, keyframe.places.holds)


def _with_next(found: Iterator[Frame]) -> Iterator[tuple[Frame, Frame]]:
    """Yield each frame with the one after it; the last one with itself."""
    before = next(found)
    for frame in found:
        yield before, frame
        before = frame
    yield before, before


def _stamps(found: Sequence[Span], settings: ScriptSettings, count: int) -> tuple[tuple[str, int, int], ...]:
    """Return the instruction, the first and the last frame of each instruction."""
    stamps = []
    for number, span in enumerate(found):
        first, last = (number, number) if settings.teleports else _of_rate(span, settings.rate)
        for step in span.steps:
            stamps.append((unity_step(step), min(first, count - 1), min(last, count - 1)))
    return tuple(stamps)


def _of_rate(span: Span, rate: float) -> tuple[int, int]:
    first = -int(-span.start * rate // 1)
    return first, max(first, -int(-span.end * rate // 1) - 1)


def _write_texts(
    recordings: Recordings,
    folder: Path,
    settings: ScriptSettings,
    trajectory: Trajectory,
    joints: dict[int, list[str]],
    stamps: Iterable[tuple[str, int, int]],
) -> None:
    """Write the time-stamps and, where they are asked for, the joints of each character."""
    name = file_name(settings.prefix.strip())
    for agent, actor in enumerate(trajectory.keyframes[0].actors):
        mine = [stamp for stamp in stamps if stamp[0].startswith(f"<char{agent}>")]
        text = "".join(f"{step} {first} {last}\n" for step, first, last in mine)
        recordings.write(folder, f"{agent}/ftaa_{name}.txt", text.encode())
        if settings.poses:
            head = " ".join(["frame", *(f"{joint}.{axis}" for joint in _names(actor) for axis in "xyz")])
            lines = "\n".join([head, *joints.get(agent, [])]) + "\n"
            recordings.write(folder, f"{agent}/pd_{name}.txt", lines.encode())
    rows: list[dict[str, Any]] = [{"step": step, "first": first, "last": last} for step, first, last in stamps]
    recordings.write(folder, "timestamps.json", orjson.dumps({"frame_rate": settings.rate, "steps": rows}))


def _names(actor: Any) -> list[str]:
    return sorted(actor.figure().joints())


def _joints(actor: Any) -> list[tuple[float, float, float]]:
    found = actor.figure().joints()
    return [actor.world(tuple(float(v) for v in found[name])) for name in sorted(found)]


class _Cameras:
    """The cameras of a recording, for each character."""

    def __init__(self, scene: UnityScene, trajectory: Trajectory, settings: ScriptSettings) -> None:
        self.scene, self.settings, self.trajectory = scene, settings, trajectory
        self.modalities = tuple(dict.fromkeys(MODES[mode][0] for mode in settings.modes))
        self.class_ids = scene.knowledge.class_ids
        self.drawn: dict[tuple[int, int], IncrementalFrame] = {}
        self.selectors: dict[int, CameraSelector] = {}
        for name in settings.cameras:
            self._check(name)

    def _check(self, name: str) -> None:
        if name.isascii() and name.isdecimal() and len(name) < 6:
            self.scene.cameras([int(name)], self.settings.size)
        elif name not in (*self.scene.mounts, "AUTO", "FIRST_PERSON"):
            known = ", ".join(("AUTO", "FIRST_PERSON", *self.scene.mounts, "the number of a camera"))
            raise HearthError.of(Code.NOT_RENDERED, f"no camera mode `{name[:40]}`", suggestion=known)

    def _camera(self, name: str, agent: int, frame: Frame) -> Camera:
        actor, size = frame.actors[agent], self.settings.size
        if name == "AUTO":
            if agent not in self.selectors:
                view = f"auto.{agent}"
                self.selectors[agent] = CameraSelector(self.trajectory, self.scene.built, view, size)
            return self.selectors[agent].camera(frame)
        if name == "FIRST_PERSON":
            return replace(first_person(actor, size), name=FIRST)
        if name in self.scene.mounts:
            return on_person(name, self.scene.mounts, actor, frame.scene, self.scene.around, size)
        return self.scene.cameras([int(name)], size)[0]

    def pictures(self, frame: Frame, later: Frame) -> Iterator[tuple[int, int, dict[str, Any]]]:
        """Yield for each character and camera of it the pictures of a frame, by modality."""
        for agent in range(len(frame.actors)):
            for place, name in enumerate(self.settings.cameras):
                camera, key = self._camera(name, agent, frame), (agent, place)
                if self.settings.teleports:
                    shot = shoot(frame.scene, camera)
                    known: dict[str, Any] = {}
                else:
                    self.drawn[key] = incremental_frame(frame.scene, camera, self.drawn.get(key))
                    shot, known = self.drawn[key].shot, {"rgb": self.drawn[key].picture}
                shot = replace(shot, class_ids=self.class_ids)
                if "flow" in self.modalities:
                    then = self._camera(name, agent, later)
                    cut = name == "AUTO" and then != camera
                    shot = replace(shot, after=later.scene, after_camera=then, cut=cut)
                yield agent, place, known | pictures_of(shot, [m for m in self.modalities if m not in known])
