"""Walking and turning on feet that stay where they are put, step by step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil, cos, degrees, hypot, pi, radians, sin
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hearth.rendering.arrays import Floats
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose, Foot, drawn_in
from hearth.rendering.people.motion_along_routes import (  # noqa: F401 - the first three were here in 0.2
    AROUND,
    ROUNDED,
    STARTING,
    Place,
    Route,
    angle,
    between,
    eased,
)
from hearth.rendering.people.skeleton import STEP, effort_of, feet_of, sinking
from hearth.schemas.graph import Spot

STEP_TIME = 0.52
"""Seconds of a walking step."""

LONGEST = 0.62
"""Longest step of an adult, metres.

A running person takes quicker steps instead, because longer ones would lower the hips.
"""

ADULT = 1.65
"""Metres of height below which steps are shorter."""

TURNING = 130.0
"""Degrees per second."""

CORNERING = 170.0
"""Fastest turn of a person walking round a corner, degrees per second.

The person slows down at sharp corners, so that the head does not jerk.
"""

SWUNG = 1.5
"""Fastest movement of hands while the body turns, metres per second: a person carrying a wide object turns slowly."""

BRIEF = 0.6
"""Share of `TURNING` at which one turns, on average, on a way of a few steps."""

LOOKED = 0.05
"""Seconds between the moments of a walk at which it is looked how fast it turns."""

SWING = (0.08, 0.92)
"""The part of a step's time in which a foot is in the air."""

LIFT, HEEL, TOE = 0.045, 38.0, -14.0
"""Height of a swinging foot as a share of the body's height; pitches in degrees with which it leaves and lands."""


SAMPLED = 0.1
"""Seconds between the moments of a walk at which it is looked whether there is room for arms."""

SETTLING = 0.4
"""Seconds in which arms change from how they are held before a walk, and to how they are held after it."""

SMOOTHED = ((-0.13, 0.25), (0.0, 0.5), (0.13, 0.25))
"""Seconds before and after a moment, and their weights, over which the swing of the arms is averaged."""


BOBBING = 0.05
"""Seconds between the moments of a walk at which it is looked how low the hips have to be."""

SOFT = 2
"""Number of those before and after a moment at which the hips are as low, and over which that is averaged."""


class Print(NamedTuple):
    """A foot's place from one moment until its next step begins."""

    start: float
    place: Place


Arms = Callable[[Sequence[Place]], Floats]


class Movement(NamedTuple):
    """A movement of a body over the floor: its length in seconds, and place at a time."""

    seconds: float
    at: Callable[[float], Place]


def turning(place: Place, yaw: float, reach: float = 0.0) -> Movement:
    """Return a turn on the spot, with hands as far as `reach` metres from the body's axis."""
    turn = angle(place.yaw, yaw)
    # An eased turn is fastest in its middle.
    seconds = max(abs(turn) / TURNING, abs(radians(turn)) * reach * pi / 2 / SWUNG, 0.4)
    return Movement(seconds, lambda time: Place(place.x, place.z, place.yaw + turn * eased(time / seconds)))


def walking(place: Place, points: Sequence[Spot], speed: float, yaw: float, reach: float = 0.0) -> Movement:
    """Return a walk along a route, which starts in the direction of `place` and ends in the direction `yaw`.

    Hands are as far as `reach` metres from the body's axis.
    """
    route = Route(points, speed)
    slower = max(1.0, abs(angle(place.yaw, yaw)) / (BRIEF * TURNING) / route.seconds)
    middle = place.yaw + angle(place.yaw, yaw) / 2
    most = abs(angle(middle, route.heading(route.length / 2)))
    # Few steps are made without turning that way and back.
    turned = 0.0 if route.length <= SIDEWAYS else min(1.0, TURNING * route.seconds / 4 / max(most, 1.0))

    def at(time: float) -> Place:
        way = route.way(time / slower)
        ends = eased(way / 0.45) * eased((route.length - way) / 0.45) * turned
        straight = place.yaw + angle(place.yaw, yaw) * eased(way / route.length)
        aside = angle(straight, route.heading(way))
        # A person walking backwards does not flip from one side to the other.
        return Place(*route.spot(way), straight + aside * ends * min(1.0, (180 - abs(aside)) / 120))

    return slowed(Movement(route.seconds * slower, at), reach)


def slowed(move: Movement, reach: float = 0.0) -> Movement:
    """Return the movement, slower where the body turns faster than `CORNERING` or hands at `reach` than `SWUNG`."""
    most = min(CORNERING, degrees(SWUNG / max(reach, 1e-6)))
    count = max(1, ceil(move.seconds / LOOKED))
    times = [move.seconds * k / count for k in range(count + 1)]
    yaws = [move.at(time).yaw for time in times]
    real = [0.0]
    for (start, end), (one, other) in zip(pairwise(times), pairwise(yaws), strict=True):
        real.append(real[-1] + max(end - start, abs(angle(one, other)) / most))
    if real[-1] < move.seconds + 1e-6:
        return move
    return Movement(real[-1], lambda time: move.at(float(np.interp(time, real, times))))


def movements(place: Place, points: Sequence[Spot], speed: float, yaw: float, reach: float = 0.0) -> list[Movement]:
    """Turns and a walk from a place along a route, at the end of which the body has the direction `yaw`.

    Hands are as far as `reach` metres from the body's axis.
    """
    route = Route(points, speed)
    if route.length < 0.01:
        return [turning(place, yaw, reach)] if abs(angle(place.yaw, yaw)) > 1 else []
    found = []
    first, last = route.heading(0.0), route.heading(route.length)
    if route.length > SIDEWAYS and abs(angle(place.yaw, first)) > ASIDE:
        found.append(turning(place, first, reach))
        place = place._replace(yaw=first)
    if route.length <= SIDEWAYS and abs(angle(place.yaw, yaw)) > ASIDE:
        found.append(turning(place, yaw, reach))
        place = place._replace(yaw=yaw)
    ends = last if route.length > SIDEWAYS and abs(angle(last, yaw)) > ASIDE else yaw
    found.append(walking(place, points, speed, ends, reach))
    if ends != yaw:
        found.append(turning(Place(*route.points[-1], ends), yaw, reach))
    return found


SIDEWAYS, ASIDE = 0.6, 50.0
"""Metres up to which one walks without turning that way, and degrees up to which one turns while walking."""


class Gait:
    """The motion of a body and its feet over the floor.

    Args:
        actor: the walking actor, standing; its feet begin where they are.
        moves: what its body does.
        arms: how far both arms are drawn in at places every `SAMPLED` seconds, (n, 2); None draws in none.
        end: how far they are drawn in at the end.
        speed: metres per second.
    """

    def __init__(
        self, actor: Actor, moves: Sequence[Movement], arms: Arms | None = None, end: tuple[float, float] = (0.0, 0.0),
        speed: float = 1.0,
    ) -> None:  # fmt: skip
        self.actor, self.moves, self.end = actor, moves, end
        self.effort = effort_of(actor.body_pose, actor.body.proportions)
        self.moving = sum(move.seconds for move in moves)
        # A person with shorter legs takes more steps.
        step = min(STEP_TIME, LONGEST / speed) * min(actor.body.height / ADULT, 1.0)
        self.count = max(1, ceil(self.moving / step))
        self.step = self.moving / self.count
        self.seconds = self.moving + self.step
        self.prints = self._prints()
        self.sinks = self._sinks()
        self.arms = None
        if arms is not None:
            count = ceil(self.moving / SAMPLED) + 1
            self.arms = arms([self.place(min(k * SAMPLED, self.moving)) for k in range(count)])

    def tucked(self, time: float) -> tuple[float, float]:
        """Return how far the right and the left arm are drawn in."""
        early, late = eased(time / SETTLING), eased((self.seconds - time) / SETTLING)
        brief = min(1.0, self.seconds / (4 * SETTLING))
        found: list[float] = []
        for side, (start, end) in enumerate(zip(self.actor.body_pose.tucked, self.end, strict=True)):
            way = 0.0
            if self.arms is not None:
                at = min(time / SAMPLED, len(self.arms) - 1)
                low = int(at)
                high = min(low + 1, len(self.arms) - 1)
                way = float(self.arms[low, side] + (self.arms[high, side] - self.arms[low, side]) * (at - low))
            found.append(min(way * brief * early * late + start * (1 - early) + end * (1 - late), 1.0))
        return found[0], found[1]

    def place(self, time: float) -> Place:
        """Return the body's place."""
        for move in self.moves:
            if time < move.seconds:
                return move.at(time)
            time -= move.seconds
        return self.moves[-1].at(self.moves[-1].seconds)

    def _prints(self) -> tuple[list[Print], list[Print]]:
        """Return where the right and the left foot stand, and from when."""
        own = self.actor.body.proportions
        start = Place(*self.actor.spot, self.actor.yaw)
        rest = feet_of(replace(self.actor.body_pose, posture="standing", stride=0.0, feet=None), own)
        found = tuple([Print(-1.0, in_world(start, foot))] for foot in feet_of(self.actor.body_pose, own))
        first = 0 if self._first_turn() > 0 else 1
        for number in range(self.count + 1):
            side = (number + first) % 2
            # A foot lands where the body is in the middle of the time for which it stands there.
            middle = self.place(min((number + 1.5) * self.step, self.moving))
            found[side].append(Print(number * self.step, in_world(middle, rest[side])))
        return found[0], found[1]

    def _first_turn(self) -> float:
        return angle(self.actor.yaw, self.place(min(self.step * 1.5, self.moving)).yaw)

    def feet(self, time: float, place: Place) -> tuple[Foot, Foot]:
        """Both feet in the body's frame."""
        right, left = (self._foot(prints, time, place) for prints in self.prints)
        return right, left

    def _foot(self, prints: list[Print], time: float, place: Place) -> Foot:
        number = max(k for k, mark in enumerate(prints) if mark.start <= time)
        here = prints[number]
        before = prints[number - 1] if number else here
        far = hypot(here.place.x - before.place.x, here.place.z - before.place.z)
        share = (time - here.start) / self.step
        low, high = SWING
        length = self.actor.body.height
        vigour = min(far / (0.35 * length), 1.0)
        if number and share < high:
            swing = min(max((share - low) / (high - low), 0.0), 1.0)
            # The foot moves while it is well above the floor.
            part = eased((swing - 0.14) / 0.81)
            turn = before.place.yaw + angle(before.place.yaw, here.place.yaw) * part
            x, z = between((before.place.x, before.place.z), (here.place.x, here.place.z), part)
            lift = LIFT * length * (0.45 + 0.55 * vigour) * sin(pi * swing) ** 0.7
            raised = sin(pi * min(max(swing - 0.5, 0.0) / 0.44, 1.0))
            heel = vigour * (HEEL * max(1 - 2.2 * swing, 0.0) + TOE * raised)
            if share < low:
                heel = HEEL * vigour
            return local(place, Place(x, z, turn), lift, heel)
        pitch = 0.0
        later = prints[number + 1] if number + 1 < len(prints) else None
        if later is not None and time > later.start - 0.45 * self.step:
            ahead = hypot(later.place.x - here.place.x, later.place.z - here.place.z)
            pitch = HEEL * min(ahead / (0.35 * length), 1.0) * eased(1 - (later.start - time) / (0.45 * self.step))
        return local(place, here.place, 0.0, pitch)

    def _sinks(self) -> Floats:
        """Return how low the hips are every `BOBBING` seconds.

        As low as feet that are far apart need, without haste.
        """
        pose, own = replace(self.actor.body_pose, stride=0.0), self.actor.body.proportions
        found = np.zeros(ceil(self.seconds / BOBBING) + 1)
        for number in range(len(found)):
            time = min(number * BOBBING, self.moving)
            feet = self.feet(min(number * BOBBING, self.seconds), self.place(time))
            found[number] = sinking(replace(pose, feet=feet), own)
        around = np.pad(found, 2 * SOFT)
        lowest = sliding_window_view(around, 2 * SOFT + 1).max(axis=1)
        smooth: Floats = sliding_window_view(lowest, 2 * SOFT + 1).mean(axis=1)
        return smooth

    def sink(self, time: float) -> float:
        """Metres by which the hips are lower."""
        ends = eased(min(time, self.seconds - time) / SETTLING)
        return float(np.interp(time / BOBBING, np.arange(len(self.sinks)), self.sinks)) * ends

    def stride(self, time: float) -> float:
        """Return the swing of the arms: as far as the feet are apart on average over some moments, -1.3 to 1.3."""
        found = 0.0
        for shift, weight in SMOOTHED:
            now = min(max(time + shift, 0.0), self.moving)
            right, left = self.feet(now, self.place(now))
            found += weight * (right.z - left.z) / (2 * STEP * self.actor.body.height)
        return min(max(found, -1.3), 1.3) * eased(min(time, self.seconds - time) / SETTLING)

    def carried(self, tucked: tuple[float, float]) -> BodyPose:
        """Return the pose of trunk and arms, drawn in by some shares more than at the start."""
        pose, start = self.actor.body_pose, self.actor.body_pose.tucked
        more = tuple(max(now - was, 0.0) for now, was in zip(tucked, start, strict=True))
        return replace(drawn_in(pose, (more[0], more[1])), tucked=tucked)

    def at(self, time: float) -> Actor:
        """Return the actor after some seconds."""
        if time >= self.seconds:
            place, feet = self.place(self.moving), None
        else:
            place = self.place(min(time, self.moving))
            feet = self.feet(time, place)
        pose = replace(self.carried(self.tucked(time)), feet=feet, stride=self.stride(time), effort=self.effort)
        pose = replace(pose, sink=self.sink(time))
        return replace(self.actor, spot=(place.x, place.z), yaw=place.yaw, body_pose=pose)


def in_world(place: Place, foot: Foot) -> Place:
    """Return where a foot of a body at a place is."""
    c, s = cos(place.yaw * pi / 180), sin(place.yaw * pi / 180)
    return Place(place.x + foot.x * c + foot.z * s, place.z - foot.x * s + foot.z * c, place.yaw + foot.yaw)


def local(place: Place, foot: Place, lift: float, pitch: float) -> Foot:
    """Return a foot that is somewhere, in the frame of a body at a place."""
    c, s = cos(place.yaw * pi / 180), sin(place.yaw * pi / 180)
    dx, dz = foot.x - place.x, foot.z - place.z
    return Foot(dx * c - dz * s, dx * s + dz * c, lift, angle(place.yaw, foot.yaw), pitch)
