"""The shots of a film: which camera shows which seconds, so that every act is seen and no shot is too short."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice

import numpy as np

from hearth.rendering.cameras.camera import Camera
from hearth.rendering.cameras.camera_candidates import around, free
from hearth.rendering.cameras.visibility_estimates import (
    Obstacles,
    Target,
    person,
)
from hearth.rendering.film.execution_keyframes import Trajectory
from hearth.rendering.film.film_moments import (  # noqa: F401 - all of them were here in 0.2
    IN_THE_WAY,
    JUDGED,
    MOST,
    RATE,
    FilmMoments,
    Moment,
    room_at,
)
from hearth.rendering.film.shot_sequence import Acts, States, Worths, best_cut
from hearth.schemas.graph import EnvironmentGraph

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

SEEN, HALF = 8.0, 2.0
"""Value of seeing an act, and the factor for acts of a person that is visible in less than half of its acts."""

ROUNDS, LOOKED_AT = 16, 40
"""Cuts that are tried, and pictures that are looked at to find a camera for an act that none shows."""


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
        agent: the agent to follow; None follows the agents that act.
    """

    def __init__(
        self,
        trajectory: Trajectory,
        home: EnvironmentGraph,
        views: Mapping[int, tuple[Camera, ...]],
        size: tuple[int, int],
        agent: int | None = None,
    ) -> None:
        self.film = FilmMoments(trajectory, home, agent)
        self.views, self.size = views, size
        self.moments, self.ticks, self.agents = self.film.moments, self.film.ticks, self.film.agents
        self.cameras: list[Camera] = []
        self.tried: list[frozenset[int]] = []

    def shots(self) -> Shots:
        """Return the camera of each moment."""
        for tick in sorted(set(self.ticks)):
            for agent in self.film.acting(self._span(tick)[-1]):
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
                total[some, number], shown[some, number] = self.film.values_at(cameras, number)
        return total, shown

    def _unobstructed(self, room: int) -> list[frozenset[int]]:
        """For each fixed camera of a room the moments at which somebody is in the room and nothing in its way."""
        views = self.views.get(room, ())
        found: list[set[int]] = [set() for _ in views]
        for tick in sorted({moment.frame.tick for moment in self.moments}):
            within = [n for n, known in enumerate(self.moments) if known.frame.tick == tick and room in known.rooms]
            good = free(views, self.film.obstacles_at(self.moments[within[0]].frame))[0] if within else ()
            for camera, moments in zip(views, found, strict=True):
                moments.update(within if camera in good else ())
        return [frozenset(moments) for moments in found]

    def _candidates(self, span: Sequence[int], agent: int) -> list[Camera]:
        """Return the best cameras for an act: at its end, on the way to it, and together with the next act."""
        last = self.moments[span[-1]]
        actor, room = last.frame.actors[agent], self.film.rooms.get(last.rooms[agent])
        who, objects = self.film.targets(last.frame, agent)
        name = f"near.{last.frame.tick}.{agent}"
        way = [self.moments[n].frame.actors[agent] for n in span if self.moments[n].rooms == last.rooms]
        whole = _together([person(each) for each in way[-AROUND:]])
        found = around(actor, who, objects, room, self.size, name, closer=True)
        found += around(actor, whole, objects, room, self.size, f"{name}.way")
        kept = self._best(found, (span[-1], span[len(span) // 2], max(span[-1] - 2, span[0])), agent)
        follows = self._next(span[-1], agent)
        if follows is not None:
            after = self.moments[follows].frame
            whom, more = self.film.targets(after, agent)
            both = around(actor, _together([whom, who]), [*objects, *more], room, self.size, f"{name}.both")
            kept += self._best(both, (span[-1], follows), agent)
        return kept

    def _next(self, number: int, agent: int) -> int | None:
        """Return the last moment of the next tick, if the agent acts then in the same room."""
        here = self.moments[number]
        later = [n for n, moment in enumerate(self.moments) if moment.frame.tick == here.frame.tick + 1]
        if not later or agent not in self.film.acting(later[-1]) or self.moments[later[-1]].rooms != here.rooms:
            return None
        return later[-1]

    def _best(self, cameras: Sequence[Camera], moments: Sequence[int], agent: int) -> list[Camera]:
        """Those of some cameras that show an agent best at some moments, with nothing in their way."""
        moved = [self.film.trajectory.variation.moved(camera) for camera in cameras]
        found, loss = free(moved, self.film.obstacles_at(self.moments[moments[0]].frame))
        worth = np.sum([self.film.exact(found, number, agent) - loss for number in dict.fromkeys(moments)], axis=0)
        return _distinct([found[number] for number in np.argsort(-worth, kind="stable").tolist()], KEPT)

    def closer(self, number: int, agent: int) -> list[Camera]:
        """Cameras for an act at a moment, the likeliest first, with closer views."""
        moment = self.moments[number]
        actor, room = moment.frame.actors[agent], self.film.rooms.get(moment.rooms[agent])
        name = f"near.{moment.frame.tick}.{agent}.{number}"
        found = around(actor, *self.film.targets(moment.frame, agent), room, self.size, name, closer=True, dense=True)
        every = [self.film.trajectory.variation.moved(camera) for camera in found]
        moved, loss = free(every, Obstacles.exact(moment.frame.scene))
        worth = self.film.exact(moved, number, agent) - loss
        return _distinct([moved[k] for k in np.argsort(-worth, kind="stable").tolist()], LOOKED_AT)


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
            for agent in planner.film.acting(end)
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
            self.known[key] = planner.film.shows(planner.cameras[row], number, planner.agents[bit])
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
                closer = (
                    camera for camera in planner.closer(number, agent) if planner.film.shows(camera, number, agent)
                )
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
