"""The shots of a film: which camera shows which seconds, so that every act is seen and no shot is too short."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import NamedTuple

import numpy as np

from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.camera_candidates import around, free, preference
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
from hearth.rendering.film.shot_sequence import Acts, States, Worths, best_cut
from hearth.rendering.film.snapshots import Trajectory, named_nodes
from hearth.rendering.people.motion import Frame, frames
from hearth.rendering.rays.fixed_cameras import StillCameras
from hearth.schemas.graph import Box, EnvironmentGraph, Spot
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import ROOM_CATEGORY

RATE = 2.0
"""Moments a second at which cameras are compared."""

JUDGED = (160, 120)
"""Size of the pictures by which cameras are judged, pixels."""

SHORTEST = 6
"""Moments of the shortest shot: three seconds."""

KEPT = 5
"""Cameras kept for each act, and for each pair of acts that follow each other."""

APART = 0.5
"""Metres between the kept cameras of an act, unless their fields of view differ by a third."""

AROUND = 8
"""Moments before and after a tick at which its cameras are tried."""

ELSEWHERE = -0.4
"""Value of a camera at a moment for which it is not tried."""

CUT = 0.5
"""Cost of a cut."""

IN_THE_WAY = 1.5
"""Loss of value of a camera at a moment at which a person is close in front of it."""

SEEN, HALF = 8.0, 2.0
"""Value of seeing an act, and the factor for acts of a person that is visible in less than half of its acts."""

MOST = 3
"""Agents whose acts are counted apart."""

ROUNDS, LOOKED_AT = 16, 40
"""Cuts that are tried, and pictures that are looked at to find a camera for an act that none shows."""


class Moment(NamedTuple):
    """A moment of the film: its frame, and the room of each actor."""

    frame: Frame
    rooms: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Shots:
    """The camera of each moment."""

    cameras: tuple[Camera, ...]

    def at(self, time: float) -> Camera:
        """Return the camera at a time, in seconds from the film's start."""
        return self.cameras[min(int(time * RATE + 1e-6), len(self.cameras) - 1)]


class Planner:
    """Plans the shots of a film.

    Args:
        trajectory: of the film.
        home: the home's graph.
        views: fixed cameras by room.
        size: of the picture.
        agent: the agent to follow; None follows whoever acts.
    """

    def __init__(
        self,
        trajectory: Trajectory,
        home: EnvironmentGraph,
        views: Mapping[int, tuple[Camera, ...]],
        size: tuple[int, int],
        agent: int | None = None,
    ) -> None:
        self.trajectory, self.views, self.size, self.agent = trajectory, views, size, agent
        self.rooms = {node.id: node.box for node in home.nodes if node.category == ROOM_CATEGORY and node.box}
        self.keyframes = {keyframe.tick: keyframe for keyframe in trajectory.keyframes}
        self.obstacles: dict[int, Obstacles] = {}
        self.losses: dict[int, dict[Camera, float]] = {}
        self.pictures = StillCameras()
        self.moments = list(self._moments())
        self.ticks = [moment.frame.tick for moment in self.moments]
        self.agents = sorted({agent for number in range(len(self.moments)) for agent in self.acting(number)})[:MOST]
        self.cameras: list[Camera] = []
        self.tried: list[frozenset[int]] = []

    def _moments(self) -> Iterator[Moment]:
        rooms: dict[int, int] = {}
        for frame in frames(self.trajectory, RATE, self.trajectory.variation.speed):
            for number, actor in enumerate(frame.actors):
                found = room_at(self.rooms, actor.spot)
                rooms[number] = found or rooms.get(number, 0) or actor.room
            yield Moment(frame, tuple(rooms[number] for number in range(len(frame.actors))))

    def shots(self) -> Shots:
        """Return the camera of each moment."""
        for tick in sorted(set(self.ticks)):
            for agent in self.acting(self._span(tick)[-1]):
                self.add(self._candidates(self._span(tick), agent), self._span(tick))
        for room in sorted({room for moment in self.moments for room in moment.rooms}):
            self.add(self.views.get(room, ()), (), self._unobstructed(room))
        if not self.cameras:
            raise LookupError
        return Shots(tuple(self.cameras[row] for row in Verified(self).rows()))

    def _span(self, tick: int) -> list[int]:
        return [number for number, known in enumerate(self.ticks) if known == tick]

    def add(
        self, cameras: Sequence[Camera], span: Sequence[int], tried: Sequence[frozenset[int]] | None = None
    ) -> None:
        """Add cameras, to be tried at some moments each, or around a span of moments."""
        for number, camera in enumerate(cameras):
            self.cameras.append(camera)
            near = tried[number] if tried else frozenset(range(span[0] - AROUND, span[-1] + AROUND + 1))
            self.tried.append(near)

    def worth(self, rows: Sequence[int]) -> tuple[Worths, States]:
        """(rows, moments) values of cameras, and the acts that they seem to show, bit by bit: `shot_sequence.Acts`."""
        total = np.full((len(rows), len(self.moments)), ELSEWHERE)
        shown = np.zeros((len(rows), len(self.moments)), np.int64)
        for number in range(len(self.moments)):
            some = [k for k, row in enumerate(rows) if number in self.tried[row]]
            cameras = [self.cameras[rows[k]] for k in some]
            if cameras:
                total[some, number], shown[some, number] = self._values(cameras, number)
        return total, shown

    def _unobstructed(self, room: int) -> list[frozenset[int]]:
        """For each fixed camera of a room the moments at which somebody is in the room and nothing in its way."""
        views = self.views.get(room, ())
        found: list[set[int]] = [set() for _ in views]
        for tick in sorted({moment.frame.tick for moment in self.moments}):
            within = [n for n, known in enumerate(self.moments) if known.frame.tick == tick and room in known.rooms]
            good = free(views, self._obstacles(self.moments[within[0]].frame))[0] if within else ()
            for camera, moments in zip(views, found, strict=True):
                moments.update(within if camera in good else ())
        return [frozenset(moments) for moments in found]

    def acting(self, moment: int) -> list[int]:
        """Return the agents to be seen at a moment."""
        frame = self.moments[moment].frame
        if self.agent is not None:
            return [self.agent]
        return sorted({step.agent for step in frame.steps if step.agent < len(frame.actors)}) or [0]

    def _steps(self, frame: Frame, agent: int) -> list[Step]:
        return [step for step in frame.steps if step.agent == agent]

    def _obstacles(self, frame: Frame) -> Obstacles:
        """Occluders at a moment; slow ones are computed once a tick."""
        if frame.tick not in self.obstacles:
            keyframe = self.keyframes[frame.tick]
            held = frozenset(node for things in keyframe.places.holds.values() for node in things)
            self.obstacles[frame.tick] = Obstacles.of(keyframe.scene, held, ())
        return self.obstacles[frame.tick]._replace(people=frame.actors)

    def _targets(self, frame: Frame, agent: int) -> tuple[Target, list[Target]]:
        named = named_nodes(self._steps(frame, agent), self.rooms)
        objects = [thing(frame.scene, node) for node in named if node != frame.actors[agent].node.id]
        return person(frame.actors[agent]), [target for target in objects if target is not None]

    def _candidates(self, span: Sequence[int], agent: int) -> list[Camera]:
        """Return the best cameras for an act: at its end, on the way to it, and together with the next act."""
        last = self.moments[span[-1]]
        actor, room = last.frame.actors[agent], self.rooms.get(last.rooms[agent])
        who, objects = self._targets(last.frame, agent)
        name = f"near.{last.frame.tick}.{agent}"
        way = [self.moments[n].frame.actors[agent] for n in span if self.moments[n].rooms == last.rooms]
        whole = _together([person(each) for each in way[-AROUND:]])
        found = around(actor, who, objects, room, self.size, name, closer=True)
        found += around(actor, whole, objects, room, self.size, f"{name}.way")
        kept = self._best(found, (span[-1], span[len(span) // 2], max(span[-1] - 2, span[0])), agent)
        follows = self._next(span[-1], agent)
        if follows is not None:
            after = self.moments[follows].frame
            whom, more = self._targets(after, agent)
            both = around(actor, _together([whom, who]), [*objects, *more], room, self.size, f"{name}.both")
            kept += self._best(both, (span[-1], follows), agent)
        return kept

    def _next(self, number: int, agent: int) -> int | None:
        """Return the last moment of the next tick, if the agent acts then in the same room."""
        here = self.moments[number]
        later = [n for n, moment in enumerate(self.moments) if moment.frame.tick == here.frame.tick + 1]
        if not later or agent not in self.acting(later[-1]) or self.moments[later[-1]].rooms != here.rooms:
            return None
        return later[-1]

    def _best(self, cameras: Sequence[Camera], moments: Sequence[int], agent: int) -> list[Camera]:
        """Those of some cameras that show an agent best at some moments, with nothing in their way."""
        moved = [self.trajectory.variation.moved(camera) for camera in cameras]
        found, loss = free(moved, self._obstacles(self.moments[moments[0]].frame))
        worth = np.sum([self._exact(found, number, agent) - loss for number in dict.fromkeys(moments)], axis=0)
        return _distinct([found[number] for number in np.argsort(-worth, kind="stable").tolist()], KEPT)

    def _exact(self, cameras: Sequence[Camera], number: int, agent: int) -> Worths:
        """(cameras,) the values of showing an agent at a moment."""
        frame = self.moments[number].frame
        if not cameras:
            return np.zeros(0)
        found = values(cameras, *self._targets(frame, agent), Obstacles.exact(frame.scene))
        return found.total * preference(cameras, frame.actors[agent])

    def closer(self, number: int, agent: int) -> list[Camera]:
        """Cameras for an act at a moment, the likeliest first, with closer views."""
        moment = self.moments[number]
        actor, room = moment.frame.actors[agent], self.rooms.get(moment.rooms[agent])
        name = f"near.{moment.frame.tick}.{agent}.{number}"
        found = around(actor, *self._targets(moment.frame, agent), room, self.size, name, closer=True, dense=True)
        every = [self.trajectory.variation.moved(camera) for camera in found]
        moved, loss = free(every, Obstacles.exact(moment.frame.scene))
        worth = self._exact(moved, number, agent) - loss
        return _distinct([moved[k] for k in np.argsort(-worth, kind="stable").tolist()], LOOKED_AT)

    def _values(self, cameras: Sequence[Camera], number: int) -> tuple[Worths, States]:
        """(cameras,) the values at a moment, over who acts, and whose acts cameras seem to show."""
        frame = self.moments[number].frame
        total, shown = np.zeros(len(cameras)), np.zeros(len(cameras), np.int64)
        for agent in self.acting(number):
            found: Worth = values(cameras, *self._targets(frame, agent), self._obstacles(frame))
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
        known.update(zip(new, ahead(new, self._obstacles(frame)).loss.tolist(), strict=True))
        return np.array([known[camera] for camera in cameras])

    def shows(self, camera: Camera, number: int, agent: int) -> bool:
        """Return whether a camera's picture at a moment shows the act of an agent, by its pixels."""
        frame = self.moments[number].frame
        step = next((step for step in frame.steps if step.agent == agent), None)
        shot = self.pictures.shoot(frame.scene, replace(camera, width=JUDGED[0], height=JUDGED[1]))
        objects = objects_of(step, self.trajectory, self.keyframes[frame.tick]) if step else ()
        return not in_the_way(shot) and shows(shot, frame.actors[agent].node.id, objects)


def _distinct(cameras: Sequence[Camera], most: int) -> list[Camera]:
    """Return the first of some cameras that stand apart, or see more or less than each other."""
    found: list[Camera] = []
    for camera in cameras:
        if all(_apart(camera, other) for other in found):
            found.append(camera)
        if len(found) == most:
            break
    return found


def _apart(one: Camera, other: Camera) -> bool:
    far = max(abs(a - b) for a, b in zip(one.eye, other.eye, strict=True))
    return far > APART or not 0.75 < one.fov / other.fov < 4 / 3


class Verified:
    """The best cut of a film whose acts are seen in the pixels of its pictures.

    Whether a camera shows an act is estimated first; the pictures on which a cut relies are drawn, and where they do
    not show the act, the film is cut again. Acts that no camera shows get closer ones.
    """

    def __init__(self, planner: Planner) -> None:
        self.planner = planner
        self.total, self.shown = planner.worth(range(len(planner.cameras)))
        self.ticks = np.array(planner.ticks)
        self.known: dict[tuple[int, int, int], bool] = {}
        self.gains = [SEEN] * len(planner.agents)

    def rows(self) -> list[int]:
        """Return the camera of each moment."""
        rows, missed = self._cut()
        if self._add_closer(missed):
            rows, missed = self._cut()
        rare = self._rare(missed)
        if rare and len(self.gains) > 1:
            self.gains = [gain * HALF if bit in rare else gain for bit, gain in enumerate(self.gains)]
            rows, missed = self._cut()
        return rows

    def _acts(self) -> list[tuple[int, int]]:
        """Return the (tick, agent's number among those that act) of all acts."""
        planner, ends = self.planner, np.flatnonzero(np.diff(self.ticks, append=-1))
        return [
            (int(self.ticks[end]), planner.agents.index(agent))
            for end in ends.tolist()
            for agent in planner.acting(end)
            if agent in planner.agents
        ]

    def _rare(self, missed: Sequence[tuple[int, int]]) -> set[int]:
        """Persons that are visible in less than half of their acts."""
        acts, unseen = Counter(bit for _, bit in self._acts()), Counter(bit for _, bit in missed)
        return {bit for bit in acts if unseen[bit] > acts[bit] / 2}

    def _cut(self) -> tuple[list[int], list[tuple[int, int]]]:
        """Return a cut whose acts are verified, and those that it does not show."""
        rows: list[int] = []
        missed: list[tuple[int, int]] = []
        for _ in range(ROUNDS):
            rows = best_cut(self.total, SHORTEST, CUT, Acts(self.ticks, self.shown, self.gains))
            missed, wrong = self._checked(rows)
            if not wrong:
                break
        return rows, missed

    def _checked(self, rows: Sequence[int]) -> tuple[list[tuple[int, int]], bool]:
        """Return the acts that a cut does not show, and whether it was mistaken about any."""
        missed: list[tuple[int, int]] = []
        wrong = False
        for tick, bit in self._acts():
            span = np.flatnonzero(self.ticks == tick).tolist()
            seeming = [n for n in reversed(span) if self.shown[rows[n], n] >> bit & 1]
            if not any(self._verified(rows[n], n, bit) for n in seeming):
                missed.append((tick, bit))
                wrong |= bool(seeming)
        return missed, wrong

    def _verified(self, row: int, number: int, bit: int) -> bool:
        """Return whether a camera shows an act, by pixels; if not, this is remembered."""
        key = row, number, bit
        if key not in self.known:
            planner = self.planner
            self.known[key] = planner.shows(planner.cameras[row], number, planner.agents[bit])
            if not self.known[key]:
                self.shown[row, number] &= ~(1 << bit)
        return self.known[key]

    def _add_closer(self, missed: Sequence[tuple[int, int]]) -> bool:
        """Find cameras for acts that are not shown; returns whether there are some."""
        planner, first = self.planner, len(self.planner.cameras)
        good: list[tuple[int, int, int]] = []
        for tick, bit in missed:
            span = np.flatnonzero(self.ticks == tick).tolist()
            agent = planner.agents[bit]
            for number in dict.fromkeys((span[-1], span[len(span) // 2], span[0])):
                closer = (camera for camera in planner.closer(number, agent) if planner.shows(camera, number, agent))
                found = list(islice(closer, KEPT))
                good += [(len(planner.cameras) + k, number, bit) for k in range(len(found))]
                planner.add(found, span)
        new = range(first, len(planner.cameras))
        if new:
            total, shown = planner.worth(new)
            self.total, self.shown = np.concatenate((self.total, total)), np.concatenate((self.shown, shown))
        for row, number, bit in good:
            self.shown[row, number] |= 1 << bit
        return len(new) > 0


def _together(found: Sequence[Target]) -> Target:
    """Several moments of a person as one target."""
    points = np.concatenate([target.points for target in found])
    low, high = (
        np.min([target.low for target in found], axis=0),
        np.max([target.high for target in found], axis=0),
    )
    return replace(found[-1], points=points, low=low, high=high)


def room_at(rooms: Mapping[int, Box], spot: Spot) -> int:
    """Return the room whose box contains a spot; 0 in doorways."""
    return next((room for room, box in rooms.items() if _holds(box, spot)), 0)


def _holds(box: Box, spot: Spot) -> bool:
    return all(abs(spot[k] - box.center[2 * k]) <= box.size[2 * k] / 2 for k in (0, 1))
