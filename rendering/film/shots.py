"""The shots of a film: which camera shows which seconds, so that every act is seen and no shot is too short."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.candidates import around, free, preference
from hearth.rendering.cameras.recognition import CLOSE
from hearth.rendering.cameras.sight import Obstacles, Target, person, thing, values
from hearth.rendering.film.snapshots import Trajectory, named_nodes
from hearth.rendering.people.motion import Frame, frames
from hearth.schemas.graph import Box, EnvironmentGraph, Spot
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import ROOM_CATEGORY

RATE = 2.0
"""Moments a second at which cameras are compared."""

SHORTEST = 7
"""Moments of the shortest shot: three seconds, and half a second more for where frames fall."""

KEPT = 4
"""Cameras kept for each act, and for each pair of acts that follow each other."""

AROUND = 8
"""Moments before and after a tick at which its cameras are tried."""

ELSEWHERE = -0.4
"""Value of a camera at a moment for which it is not tried."""

CUT = 0.5
"""Cost of a cut."""

IN_THE_WAY = 1.5
"""Loss of value of a camera at a moment at which a person is close in front of it."""

SEEN, SEEN_AT_ALL = 0.6, 4.0
"""The value from which on an act is seen, and how much more what exceeds it counts at the best moment of an act."""


class Moment(NamedTuple):
    """A moment of the film: its frame, and the room of each actor."""

    frame: Frame
    rooms: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Shots:
    """The camera of each moment."""

    cameras: tuple[Camera, ...]

    def at(self, time: float) -> Camera:
        """The camera at a time, in seconds from the film's start."""
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
        self.moments = list(self._moments())

    def _moments(self) -> Iterator[Moment]:
        rooms: dict[int, int] = {}
        for frame in frames(self.trajectory, RATE, self.trajectory.variation.speed):
            for number, actor in enumerate(frame.actors):
                found = room_at(self.rooms, actor.spot)
                rooms[number] = found or rooms.get(number, 0) or actor.room
            yield Moment(frame, tuple(rooms[number] for number in range(len(frame.actors))))

    def shots(self) -> Shots:
        """The camera of each moment."""
        ticks = [moment.frame.tick for moment in self.moments]
        cameras: list[Camera] = []
        tried: list[frozenset[int]] = []
        for tick in sorted(set(ticks)):
            span = [n for n, known in enumerate(ticks) if known == tick]
            for agent in self._acting(span[-1]):
                found = self._candidates(span, agent)
                cameras += found
                tried += [frozenset(range(span[0] - AROUND, span[-1] + AROUND + 1))] * len(found)
        for room in sorted({room for moment in self.moments for room in moment.rooms}):
            cameras += self.views.get(room, ())
            tried += self._unobstructed(room)
        if not cameras:
            raise LookupError
        worth = np.full((len(cameras), len(self.moments)), ELSEWHERE)
        for number in range(len(self.moments)):
            some = [k for k, where in enumerate(tried) if number in where]
            worth[some, number] = self._values([cameras[k] for k in some], number, self._acting(number))
        worth = self._weighted(worth, ticks)
        return Shots(tuple(cameras[number] for number in best_cut(worth, SHORTEST, CUT)))

    def _unobstructed(self, room: int) -> list[frozenset[int]]:
        """For each fixed camera of a room the moments at which somebody is in the room and nothing in its way."""
        views = self.views.get(room, ())
        found: list[set[int]] = [set() for _ in views]
        for tick in sorted({moment.frame.tick for moment in self.moments}):
            within = [n for n, known in enumerate(self.moments) if known.frame.tick == tick and room in known.rooms]
            good = free(views, self._obstacles(self.moments[within[0]].frame)) if within else ()
            for camera, moments in zip(views, found, strict=True):
                moments.update(within if camera in good else ())
        return [frozenset(moments) for moments in found]

    def _weighted(self, found: NDArray[np.float64], ticks: Sequence[int]) -> NDArray[np.float64]:
        """(cameras, moments) values; what shows a tick's act counts more at the moment that shows it best."""
        worth = found.copy()
        for tick in sorted(set(ticks) - {0}):
            span = np.flatnonzero(np.array(ticks) == tick)
            for best in {int(span[found[:, span].max(axis=0).argmax()]), int(span[-1])}:
                worth[:, best] += SEEN_AT_ALL * np.maximum(found[:, best] - SEEN, 0)
        return worth

    def _acting(self, moment: int) -> list[int]:
        """The agents to be seen at a moment."""
        frame = self.moments[moment].frame
        if self.agent is not None:
            return [self.agent]
        return sorted({step.agent for step in frame.steps if step.agent < len(frame.actors)}) or [0]

    def _steps(self, frame: Frame, agent: int) -> list[Step]:
        return [step for step in frame.steps if step.agent == agent]

    def _obstacles(self, frame: Frame) -> Obstacles:
        """What hides things at a moment: what moves least is looked at once a tick."""
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
        """The best cameras for an act: at its end, on the way to it, and together with the next act."""
        last = self.moments[span[-1]]
        actor, room = last.frame.actors[agent], self.rooms.get(last.rooms[agent])
        who, objects = self._targets(last.frame, agent)
        name = f"near.{last.frame.tick}.{agent}"
        way = [self.moments[n].frame.actors[agent] for n in span if self.moments[n].rooms == last.rooms]
        whole = _together([person(each) for each in way[-AROUND:]])
        found = around(actor, who, objects, room, self.size, name)
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
        """The last moment of the next tick, if the agent acts then in the same room."""
        here = self.moments[number]
        later = [n for n, moment in enumerate(self.moments) if moment.frame.tick == here.frame.tick + 1]
        if not later or agent not in self._acting(later[-1]) or self.moments[later[-1]].rooms != here.rooms:
            return None
        return later[-1]

    def _best(self, cameras: Sequence[Camera], moments: Sequence[int], agent: int) -> list[Camera]:
        """Those of some cameras that show an agent best at some moments, with nothing in their way."""
        moved = [self.trajectory.variation.moved(camera) for camera in cameras]
        found = free(moved, self._obstacles(self.moments[moments[0]].frame))
        worth = sum((self._values(found, number, [agent]) for number in moments), np.zeros(len(found)))
        return [found[number] for number in np.argsort(-worth, kind="stable")[:KEPT].tolist()]

    def _values(self, cameras: Sequence[Camera], number: int, agents: Sequence[int]) -> NDArray[np.float64]:
        """(cameras,) the values at a moment, over some agents."""
        frame = self.moments[number].frame
        total = np.zeros(len(cameras))
        for agent in agents if cameras else ():
            who, objects = self._targets(frame, agent)
            total += values(cameras, who, objects, self._obstacles(frame)) * preference(cameras, frame.actors[agent])
        for actor in frame.actors if cameras else ():
            total -= IN_THE_WAY * _too_near(cameras, person(actor))
        return total


def _too_near(cameras: Sequence[Camera], who: Target) -> NDArray[np.bool_]:
    """(cameras,) whether a person is so near that it fills the picture."""
    eyes = np.array([camera.eye for camera in cameras])
    near = np.linalg.norm(eyes[:, None] - who.points[None], axis=2).min(axis=1)
    return np.asarray(near < CLOSE + 0.15)


def _together(found: Sequence[Target]) -> Target:
    """Several moments of a person as one target."""
    points = np.concatenate([target.points for target in found])
    low, high = (
        np.min([target.low for target in found], axis=0),
        np.max([target.high for target in found], axis=0),
    )
    return replace(found[-1], points=points, low=low, high=high)


def best_cut(worth: NDArray[np.float64], shortest: int, cost: float) -> list[int]:
    """The row to show at each moment: the greatest sum of values, less the cost of cuts, in runs of a least length.

    Args:
        worth: (rows, moments) the values.
        shortest: least moments of a run; where there are fewer in all, one row is shown.
        cost: of changing the row.

    Returns:
        A row for each moment.
    """
    rows, moments = worth.shape
    if moments < 2 * shortest:
        return [int(worth.sum(axis=1).argmax())] * moments
    sums = np.concatenate((np.zeros((rows, 1)), np.cumsum(worth, axis=1)), axis=1)
    # best[t]: the greatest value of moments before t, with a run that ends there.
    best, row, start = np.full(moments + 1, -np.inf), np.zeros(moments + 1, int), np.zeros(moments + 1, int)
    best[0] = 0.0
    run = np.full(rows, -np.inf)
    since = np.zeros(rows, int)
    for t in range(shortest, moments + 1):
        begin = t - shortest
        fresh = best[begin] - (cost if begin else 0.0) - sums[:, begin]
        better = fresh > run
        run, since = np.where(better, fresh, run), np.where(better, begin, since)
        total = run + sums[:, t]
        row[t] = int(total.argmax())
        best[t], start[t] = total[row[t]], since[row[t]]
    found: list[int] = []
    t = moments
    while t > 0:
        found[:0] = [int(row[t])] * (t - int(start[t]))
        t = int(start[t])
    return found


def room_at(rooms: Mapping[int, Box], spot: Spot) -> int:
    """The room whose box contains a spot; 0 in doorways."""
    return next((room for room, box in rooms.items() if _holds(box, spot)), 0)


def _holds(box: Box, spot: Spot) -> bool:
    return all(abs(spot[k] - box.center[2 * k]) <= box.size[2 * k] / 2 for k in (0, 1))
