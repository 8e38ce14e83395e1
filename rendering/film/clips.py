"""Two-second clips of films, with the instruction that is done in their middle (thesis 4.3.3)."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.cameras.camera import Camera
from hearth.rendering.film.execution_keyframes import Trajectory
from hearth.rendering.film.execution_pictures import AUTO
from hearth.rendering.film.video import CameraSelector
from hearth.rendering.modalities import pictures_of
from hearth.rendering.people.motion import Frame, frames
from hearth.rendering.rays.camera_shot import Shot, shoot, shoot_after
from hearth.rendering.rays.incremental_pictures import IncrementalFrame, incremental_frame
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Step

FRAMES = 9
"""Frames of a clip."""

SECONDS = 2.0
"""Length of a clip."""

RATE = FRAMES / SECONDS
"""Frames a second."""

MOST = 5
"""Clips of a step, at most: long steps, as walks, would otherwise be nearly all."""

SIZE = (128, 96)
"""Width and height, pixels: at half of it most things that are grabbed are two or three pixels, and it costs a tenth
more."""

MASKS = "class_ids"
"""The modality that every film of clips has; numbers as in the table `vocabulary`."""

MASKS_ONLY = (MASKS,)

MODALITIES = (MASKS, "rgb", "depth")
"""Of films that have more."""


class Clip(NamedTuple):
    """A clip of a film.

    Attributes:
        tick: the tick in its middle, from 1.
        step: that tick's step; its objects have the classes that masks show, whatever the program calls them.
        first: number of its first frame in the film, from 0; it has `FRAMES` of them.
        camera: of the middle frame.
    """

    tick: int
    step: Step
    first: int
    camera: str


class ClipFilm(NamedTuple):
    """A film of clips.

    Attributes:
        pictures: modality -> (T, H, W) or (T, H, W, 3), one for each frame.
        clips: in order; none of ticks in which several agents act, which one instruction does not tell.
        changes: the frames at which the camera changes, from 0; the first is 0.
        cameras: from those frames on.
    """

    pictures: Mapping[str, NDArray[Any]]
    clips: tuple[Clip, ...]
    changes: tuple[int, ...]
    cameras: tuple[Camera, ...]


def clip_film(
    trajectory: Trajectory, home: EnvironmentGraph, class_ids: Mapping[str, int], modalities: Iterable[str] = MASKS_ONLY
) -> ClipFilm:
    """Film an execution for clips, by the cameras that a film would choose.

    Args:
        trajectory: as `snapshots.trajectory_of` gives it.
        home: the home's graph, with boxes.
        class_ids: class -> number in the masks; others are 0.
        modalities: of each frame; `rgb` takes most of the time.
    """
    names = tuple(modalities)
    taken = [*_taken(trajectory, home, class_ids, names)]
    kept = [(frame, camera) for frame, camera, _ in taken]
    changes = [n for n, (_, camera) in enumerate(kept) if n == 0 or camera != kept[n - 1][1]]
    pictures = {name: np.stack([found[name] for *_, found in taken]) for name in names}
    classes = {node.id: node.class_name for node in trajectory.keyframes[0].places.graph.nodes}
    return ClipFilm(pictures, tuple(_clips(kept, classes)), tuple(changes), tuple(kept[n][1] for n in changes))


def _taken(
    trajectory: Trajectory, home: EnvironmentGraph, class_ids: Mapping[str, int], names: Sequence[str]
) -> Iterator[tuple[Frame, Camera, dict[str, NDArray[Any]]]]:
    """Each frame with its camera and its pictures."""
    selector = CameraSelector(trajectory, home, AUTO, SIZE)
    others = [name for name in names if name != "rgb"]
    last: IncrementalFrame | None = None
    shot: Shot | None = None
    for frame in frames(trajectory, RATE, trajectory.variation.speed):
        camera = selector.camera(frame)
        if "rgb" in names:
            last = incremental_frame(frame.scene, camera, last)
            shot = last.shot
        elif shot is not None and shot.camera == camera:
            shot = shoot_after(frame.scene, shot)
        else:
            shot = shoot(frame.scene, camera)
        found = pictures_of(replace(shot, class_ids=class_ids), others)
        yield frame, camera, {**found, **({"rgb": last.picture.copy()} if last else {})}


def _clips(kept: Sequence[tuple[Frame, Camera]], classes: Mapping[int, str]) -> Iterator[Clip]:
    """At most `MOST` clips of each tick, their middles spread evenly over it; the film's ends have no whole clip.

    Ticks in which several agents act have none: the camera may show any of them.
    """
    half = FRAMES // 2
    whole = range(half, len(kept) - half)
    for tick, group in groupby(whole, key=lambda number: kept[number][0].tick):
        middles = [*group]
        if not tick or len(kept[middles[0]][0].steps) != 1:
            continue
        count = min(MOST, len(middles))
        for k in range(count):
            middle = middles[(2 * k + 1) * len(middles) // (2 * count)]
            frame, camera = kept[middle]
            yield Clip(tick, by_class(frame.steps[0], classes), middle - half, camera.name)


def by_class(step: Step, classes: Mapping[int, str]) -> Step:
    """Return a step with the classes of its nodes as names: a `table` may be a `kitchen_table`."""
    return replace(step, objects=tuple(replace(ref, name=classes.get(ref.node or 0, ref.name)) for ref in step.objects))


def stored(film: ClipFilm) -> bytes:
    """Return the pictures of a film as the bytes of an .npz file, which NumPy reads; equal films are equal bytes."""
    buffer = BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **{name: film.pictures[name] for name in sorted(film.pictures)})
    return buffer.getvalue()
