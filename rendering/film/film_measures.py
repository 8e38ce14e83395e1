"""Measures of a film's cameras: which steps it shows, how long its shots are, and whether something is in their way."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby
from typing import NamedTuple

from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.recognition import in_the_way, shows
from hearth.rendering.cameras.visibility import objects_of
from hearth.rendering.film.execution_keyframes import Trajectory
from hearth.rendering.film.execution_pictures import AUTO
from hearth.rendering.film.video import CameraSelector
from hearth.rendering.people.motion import frames
from hearth.rendering.rays.fixed_cameras import StillCameras
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Step

SIZE = (160, 120)
RATE = 2.0
"""Size, and number a second, of the pictures that are judged."""


class StepShown(NamedTuple):
    """The verdict whether a film shows a step.

    The person and the step's objects can be recognised in one of its pictures.

    Attributes:
        tick, step: the step.
        objects: ids of the nodes that have to be seen, besides the person.
        shown: whether they are.
    """

    tick: int
    step: Step
    objects: tuple[int, ...]
    shown: bool


class FilmQuality(NamedTuple):
    """Measures of one film.

    Attributes:
        steps: each step of each character.
        shots: seconds of each shot.
        pictures: number of judged pictures; `blocked`: of those with something in the camera's way.
    """

    steps: tuple[StepShown, ...]
    shots: tuple[float, ...]
    pictures: int
    blocked: int


def film_quality(trajectory: Trajectory, home: EnvironmentGraph, view: str = AUTO) -> FilmQuality:
    """Judge the pictures of a film by one camera (see `RATE` and `SIZE`)."""
    selector = CameraSelector(trajectory, home, view, SIZE)
    keyframes = {keyframe.tick: keyframe for keyframe in trajectory.keyframes}
    shown: dict[tuple[int, int], bool] = {}
    cameras: list[Camera] = []
    pictures = StillCameras()
    blocked = 0
    for frame in frames(trajectory, RATE, trajectory.variation.speed):
        cameras.append(selector.camera(frame))
        shot = pictures.shoot(frame.scene, cameras[-1])
        blocked += in_the_way(shot)
        for step in frame.steps:
            key = frame.tick, step.agent
            if not shown.get(key):
                person = frame.actors[step.agent].node.id
                shown[key] = shows(shot, person, objects_of(step, trajectory, keyframes[frame.tick]))
    steps = [
        StepShown(tick, step, objects_of(step, trajectory, keyframe), shown.get((tick, step.agent), False))
        for tick, keyframe in keyframes.items()
        for step in keyframe.steps
    ]
    return FilmQuality(tuple(steps), tuple(_lengths(cameras)), len(cameras), blocked)


def _lengths(cameras: list[Camera]) -> Iterator[float]:
    """Seconds of each shot."""
    for _, shot in groupby(cameras, lambda camera: replace(camera, name="")):
        yield len(list(shot)) / RATE
