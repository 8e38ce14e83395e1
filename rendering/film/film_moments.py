"""The moments of a film: what agents do in each, and the worth of cameras for showing it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.camera_candidates import preference
from hearth.rendering.cameras.recognition import in_the_way, shows
from hearth.rendering.cameras.visibility import objects_of
from hearth.rendering.cameras.visibility_estimates import (
    Obstacles,
    Target,
    Worth,
    ahead,
    person,
    thing,
    too_near,
    values,
)
from hearth.rendering.film.execution_keyframes import Trajectory, named_nodes
from hearth.rendering.film.shot_sequence import States, Worths
from hearth.rendering.people.motion import Frame, frames
from hearth.rendering.rays.fixed_cameras import StillCameras
from hearth.schemas.graph import Box, EnvironmentGraph, Spot
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import ROOM_CATEGORY

RATE = 2.0
"""Moments a second at which cameras are compared."""

JUDGED = (160, 120)
"""Size of the pictures by which cameras are judged, pixels."""

IN_THE_WAY = 1.5
"""Loss of value of a camera at a moment at which a person is close in front of it."""

MOST = 3
"""Agents whose acts are counted apart."""


class Moment(NamedTuple):
    """A moment of the film: its frame, and the room of each actor."""

    frame: Frame
    rooms: tuple[int, ...]


class FilmMoments:
    """The moments of a film at which cameras are compared.

    Args:
        trajectory: of the film.
        home: the home's graph.
        agent: the agent to follow; None follows the agents that act.
    """

    def __init__(self, trajectory: Trajectory, home: EnvironmentGraph, agent: int | None = None) -> None:
        self.trajectory, self.agent = trajectory, agent
        self.rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY and node.box}
        self.keyframes = {keyframe.tick: keyframe for keyframe in trajectory.keyframes}
        self.obstacles: dict[int, Obstacles] = {}
        self.losses: dict[int, dict[Camera, float]] = {}
        self.pictures = StillCameras()
        self.moments = list(self._moments())
        self.ticks = [moment.frame.tick for moment in self.moments]
        self.agents = sorted({agent for number in range(len(self.moments)) for agent in self.acting(number)})[:MOST]

    def _moments(self) -> Iterator[Moment]:
        rooms: dict[int, int] = {}
        for frame in frames(self.trajectory, RATE, self.trajectory.variation.speed):
            for number, actor in enumerate(frame.actors):
                found = room_at(self.rooms, actor.spot)
                rooms[number] = found or rooms.get(number, 0) or actor.room
            yield Moment(frame, tuple(rooms[number] for number in range(len(frame.actors))))

    def acting(self, moment: int) -> list[int]:
        """Return the agents to be seen at a moment."""
        frame = self.moments[moment].frame
        if self.agent is not None:
            return [self.agent]
        return sorted({step.agent for step in frame.steps if step.agent < len(frame.actors)}) or [0]

    def _steps(self, frame: Frame, agent: int) -> list[Step]:
        return [step for step in frame.steps if step.agent == agent]

    def obstacles_at(self, frame: Frame) -> Obstacles:
        """Occluders at a moment; slow ones are computed once a tick."""
        if frame.tick not in self.obstacles:
            keyframe = self.keyframes[frame.tick]
            held = frozenset(node for things in keyframe.places.holds.values() for node in things)
            self.obstacles[frame.tick] = Obstacles.of(keyframe.scene, held, ())
        return self.obstacles[frame.tick]._replace(people=frame.actors)

    def targets(self, frame: Frame, agent: int) -> tuple[Target, list[Target]]:
        """Return an agent at a moment, and the objects of its steps, as targets of cameras."""
        named = named_nodes(self._steps(frame, agent), self.rooms)
        objects = [thing(frame.scene, node) for node in named if node != frame.actors[agent].node.id]
        return person(frame.actors[agent]), [target for target in objects if target is not None]

    def exact(self, cameras: Sequence[Camera], number: int, agent: int) -> Worths:
        """(cameras,) the values of showing an agent at a moment."""
        frame = self.moments[number].frame
        if not cameras:
            return np.zeros(0)
        found = values(cameras, *self.targets(frame, agent), Obstacles.exact(frame.scene))
        return found.total * preference(cameras, frame.actors[agent])

    def values_at(self, cameras: Sequence[Camera], number: int) -> tuple[Worths, States]:
        """(cameras,) the values at a moment, summed over the characters that act, and bits of those that seem shown."""
        frame = self.moments[number].frame
        total, shown = np.zeros(len(cameras)), np.zeros(len(cameras), np.int64)
        for agent in self.acting(number):
            found: Worth = values(cameras, *self.targets(frame, agent), self.obstacles_at(frame))
            total += found.total * preference(cameras, frame.actors[agent])
            if agent in self.agents:
                shown |= found.enough.astype(np.int64) << self.agents.index(agent)
        for actor in frame.actors:
            total -= IN_THE_WAY * too_near(cameras, person(actor))
        return total - self._loss(cameras, frame), shown

    def _loss(self, cameras: Sequence[Camera], frame: Frame) -> Worths:
        """(cameras,) what near things take of their values; looked at once a tick."""
        known = self.losses.setdefault(frame.tick, {})
        new = [camera for camera in cameras if camera not in known]
        known.update(zip(new, ahead(new, self.obstacles_at(frame)).loss.tolist(), strict=True))
        return np.array([known[camera] for camera in cameras])

    def shows(self, camera: Camera, number: int, agent: int) -> bool:
        """Return whether a camera's picture at a moment shows the act of an agent, by its pixels."""
        frame = self.moments[number].frame
        step = next((step for step in frame.steps if step.agent == agent), None)
        shot = self.pictures.shoot(frame.scene, replace(camera, width=JUDGED[0], height=JUDGED[1]))
        objects = objects_of(step, self.trajectory, self.keyframes[frame.tick]) if step else ()
        return not in_the_way(shot) and shows(shot, frame.actors[agent].node.id, objects)


def room_at(rooms: Mapping[int, Box], spot: Spot) -> int:
    """Return the room whose box contains a spot; 0 in doorways."""
    return next((room for room, box in rooms.items() if _holds(box, spot)), 0)


def _holds(box: Box, spot: Spot) -> bool:
    return all(abs(spot[k] - box.center[2 * k]) <= box.size[2 * k] / 2 for k in (0, 1))
