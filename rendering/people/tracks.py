"""The motion of one actor in a step: relax, rise, walk, turn, sit or lie down, reach, act."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import atan2, degrees, hypot, pi, sin, sqrt
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hearth.kb.modifiers import SPEEDS, value
from hearth.rendering.people.acting import Actor
from hearth.rendering.people.body_pose import Between, BodyPose, Hand, Held
from hearth.rendering.people.clearance import arms_on_the_way
from hearth.rendering.people.gait import Gait, Place, angle, between, eased, movements, planted, stepping
from hearth.rendering.people.gestures import Gesture, gesture_of
from hearth.rendering.people.reaching import posed, reach_for
from hearth.rendering.people.skeleton import PELVIS_ON_SEAT, effort_of
from hearth.rendering.scene.routes import WalkableFloor, led_on, path
from hearth.rendering.scene.solids import Solids
from hearth.schemas.graph import Point, Spot
from hearth.schemas.program import Step

if TYPE_CHECKING:
    from hearth.rendering.film.snapshots import Keyframe

WALKING, RUNNING = 1.1, 1.8
"""Metres per second."""

RELAX, RISE, LAY, REACH, BACK, HOLD = 0.3, 1.2, 1.8, 0.6, 0.4, 0.5
"""Seconds, at least."""

HEADS, HANDS = 1.1, 1.7
"""Greatest speeds of heads and hands in blends of poses, metres per second."""

QUICKENING = 9.0
"""Greatest acceleration of heads and hands in blends of poses, metres per second squared."""

AT_BED = 0.5
"""Metres from where one stands beside a bed to the hips of who sits on its edge."""


class Segment(NamedTuple):
    """A part of an actor's motion: its length in seconds, and the actor at a share of it."""

    seconds: float
    at: Callable[[float], Actor]


@dataclass(frozen=True, eq=False)
class Track:
    """An actor's motion in a tick.

    Attributes:
        segments: its parts, in order.
        change: seconds until the hand arrives and the world changes.
    """

    segments: tuple[Segment, ...]
    change: float

    @property
    def seconds(self) -> float:
        """Its length."""
        return sum(segment.seconds for segment in self.segments)

    def at(self, time: float) -> Actor:
        """The actor `time` seconds after the start of the tick."""
        for segment in self.segments:
            if time < segment.seconds:
                return segment.at(time / segment.seconds)
            time -= segment.seconds
        return self.segments[-1].at(1.0)


def track(one: Actor, other: Actor, before: Keyframe, step: Step | None) -> Track:
    """An actor's motion from one keyframe to the next."""
    segments: list[Segment] = []
    rest = _resting(one, before)
    if rest.body_pose != one.body_pose:
        segments.append(blended(one, rest, RELAX))
    here = _approach(segments, rest, other, step, before)
    if step is not None:
        reach = reach_for(here, other, before.places, step)
        if reach.body_pose != here.body_pose:
            segments.append(blended(here, reach, REACH))
        here = reach
    change = sum(segment.seconds for segment in segments)
    if here != other:
        segments.append(blended(here, other, BACK))
    if step is not None and gesture_of(step).seconds:
        segments.append(acted(other, gesture_of(step)))
    segments.append(motionless(other, HOLD))
    rate = SPEEDS.get(value(step, "speed"), 1.0) if step is not None else 1.0
    if rate != 1.0:
        segments = [segment._replace(seconds=segment.seconds / rate) for segment in segments]
    return Track(tuple(segments), change / rate)


def acted(actor: Actor, gesture: Gesture) -> Segment:
    """The hands at work: what they do once they have arrived."""

    def at(share: float) -> Actor:
        time, soft = share * gesture.seconds, sin(pi * min(max(share, 0.0), 1.0)) ** 0.5 if 0 < share < 1 else 0.0
        pose = actor.body_pose
        if not gesture.motion or not soft:
            return actor
        effort = effort_of(pose, actor.body.proportions)
        right, left = (_at_work(pose.target(side), gesture.motion, time, soft, side) for side in "rl")
        return replace(actor, body_pose=replace(pose, right=right, left=left, effort=effort))

    return Segment(gesture.seconds, at)


def _at_work(at: Point | None, motion: str, time: float, soft: float, side: str) -> Point | None:
    if at is None:
        return None
    x, y, z = at
    if motion == "keys":
        return x, y + 0.016 * soft * sin(2 * pi * (2.2 * time + (0.5 if side == "l" else 0.0))), z
    return x + 0.06 * soft * sin(2 * pi * 0.9 * time), y, z + 0.025 * soft * sin(4 * pi * 0.9 * time)


def motionless(actor: Actor, seconds: float) -> Segment:
    """An actor who does not move."""
    return Segment(seconds, lambda share: actor)


def _resting(actor: Actor, keyframe: Keyframe) -> Actor:
    """The actor with arms hanging, or carrying what it holds."""
    return posed(actor, keyframe.places.graph, keyframe.places, None)


def _approach(segments: list[Segment], one: Actor, other: Actor, step: Step | None, keyframe: Keyframe) -> Actor:
    """Append the segments up to the acting position; returns the actor there, hands in default pose."""
    before, after, ways = one.body_pose.posture, other.body_pose.posture, keyframe.floor.walkable
    if before == after and before != "standing" and one.place == other.place and one.spot == other.spot:
        return replace(other, body_pose=_with_hands(other.body_pose, one.body_pose))
    if "standing" not in (before, after) and one.place == other.place:
        there = replace(other, body_pose=_with_hands(other.body_pose, one.body_pose))
        segments.append(_changed(one, there, LAY))
        return there
    speed = RUNNING if step is not None and step.action == "Run" else WALKING
    if before != "standing":
        one = _got_up(segments, one, ways)
    if after == "standing":
        there = replace(other, body_pose=_with_hands(BodyPose(tucked=other.body_pose.tucked), one.body_pose))
        route = led_on(ways, path(ways, one.spot, other.spot), other.spot)
        return _walked(segments, one, there, route, speed, keyframe.places.solids)
    stop = _beside(other, ways, one.spot)
    side = other if after == "sitting" else _on_edge(other, stop)
    turned = replace(side, spot=stop, body_pose=_with_hands(BodyPose(), one.body_pose), place=0)
    route = led_on(ways, path(ways, one.spot, stop), stop)
    turned = _walked(segments, one, turned, route, speed, keyframe.places.solids)
    down = replace(side, body_pose=_with_hands(BodyPose("sitting", other.body_pose.seat), one.body_pose))
    segments.append(_seating(turned, down))
    there = replace(other, body_pose=_with_hands(other.body_pose, one.body_pose))
    if after == "lying":
        segments.append(_changed(down, there, LAY))
    return there


def _walked(
    segments: list[Segment], one: Actor, other: Actor, route: Sequence[Spot], speed: float, solids: Solids
) -> Actor:
    """Append turns and a walk to where another actor stands; returns the actor there, with arms as they are then."""
    arms = one.body_pose
    moves = movements(Place(*one.spot, one.yaw), route, speed, other.yaw)
    if moves:
        gait = Gait(one, moves, lambda places: arms_on_the_way(one, places, solids), other.body_pose.tucked)
        segments.append(Segment(gait.seconds, lambda share: gait.at(share * gait.seconds)))
        arms = gait.carried(gait.end)
    other = replace(other, body_pose=_with_hands(other.body_pose, arms))
    if one.level != other.level:
        segments.append(blended(replace(other, level=one.level), other, RELAX))
    return other


def _got_up(segments: list[Segment], one: Actor, ways: WalkableFloor | None) -> Actor:
    """Append getting up from a seat or bed; returns the actor beside it."""
    stop = _beside(one, ways, one.spot)
    side = one
    if one.body_pose.posture == "lying":
        side = _on_edge(one, stop)
        side = replace(side, body_pose=BodyPose("sitting", one.body_pose.seat))
        segments.append(_changed(one, side, LAY))
    up = replace(side, spot=stop, body_pose=_with_hands(BodyPose(), side.body_pose), place=0)
    sitting = _seating(up, side)
    segments.append(Segment(sitting.seconds, lambda share: sitting.at(1 - share)))
    return up


def _beside(rests: Actor, ways: WalkableFloor | None, near: Spot) -> Spot:
    """Where one stands before sitting or lying down: the walkable point nearest to the front of the hips."""
    x, _, z = rests.world((0.0, 0.0, 0.35 if rests.body_pose.posture == "sitting" else 0.0))
    if ways is not None:
        for cells in (ways.wide, ways.narrow):
            entry = ways.entry(cells, (x, z)) or ways.entry(cells, rests.spot)
            if entry is not None:
                return entry
    x, _, z = rests.world((0.0, 0.0, 0.6))
    return near if hypot(near[0] - x, near[1] - z) < 0.6 else (x, z)


def _on_edge(lying: Actor, stop: Spot) -> Actor:
    """Who lies, sitting on the edge of the bed, with the back to its middle."""
    away = hypot(stop[0] - lying.spot[0], stop[1] - lying.spot[1])
    share = min(AT_BED / max(away, 1e-6), 1.0)
    yaw = degrees(atan2(stop[0] - lying.spot[0], stop[1] - lying.spot[1])) if away > 1e-3 else lying.yaw
    pose = BodyPose("sitting", lying.body_pose.seat)
    return replace(lying, spot=between(stop, lying.spot, share), yaw=yaw, body_pose=pose)


def _seating(up: Actor, down: Actor) -> Segment:
    """Sitting down: the hips sink backwards, and the feet step to where they are when seated."""
    high = up.body.proportions.pelvis - PELVIS_ON_SEAT * up.body.height
    low = down.body_pose.seat

    def at(share: float) -> Actor:
        if share <= 0 or share >= 1:
            return down if share >= 1 else up
        part = eased(share)
        effort = _effort(up, down, part)
        pose = replace(_with_hands(BodyPose("sitting"), down.body_pose), seat=high + (low - high) * part, effort=effort)
        yaw = up.yaw + angle(up.yaw, down.yaw) * part
        now = replace(up, spot=between(up.spot, down.spot, part), yaw=yaw, body_pose=pose)
        return replace(now, body_pose=replace(pose, feet=stepping(planted(now, up), down, share)))

    far = hypot(up.spot[0] - down.spot[0], up.spot[1] - down.spot[1]) + abs(high - low)
    return Segment(max(RISE, far * pi / 2 / HEADS), at)


def _changed(one: Actor, other: Actor, seconds: float) -> Segment:
    """A change of posture in place: every joint goes from where it is to where it will be."""
    offset, turn = other.local(one.position), angle(other.yaw, one.yaw)

    def at(share: float) -> Actor:
        if share >= 1:
            return other
        former = Between(one.body_pose, offset, turn, eased(share))
        return replace(other, body_pose=replace(other.body_pose, between=former))

    return Segment(max(seconds, _seconds(one, other)), at)


def blended(one: Actor, other: Actor, seconds: float) -> Segment:
    """A transition between two actors' poses, slow enough for heads and hands."""

    def at(share: float) -> Actor:
        return other if share >= 1 else blend(one, other, eased(share))

    return Segment(max(seconds, _seconds(one, other)), at)


def _seconds(one: Actor, other: Actor) -> float:
    """The least time of an eased motion between two poses."""
    a, b = one.figure().joints(), other.figure().joints()
    least = 0.0
    for name, speed in (("head", HEADS), ("hand_r", HANDS), ("hand_l", HANDS)):
        start, end = (np.array(actor.world(tuple(found[name]))) for actor, found in ((one, a), (other, b)))
        far = float(np.linalg.norm(end - start))
        # An eased motion is fastest in its middle, and quickens most at its ends.
        least = max(least, far * pi / 2 / speed, pi * sqrt(far / 2 / QUICKENING))
    return least


def blend(one: Actor, other: Actor, share: float) -> Actor:
    """Interpolation between two poses of a posture; if postures differ, every joint goes straight."""
    a, b = one.body_pose, other.body_pose
    if a.posture != b.posture:
        former = Between(a, other.local(one.position), angle(other.yaw, one.yaw), share)
        return replace(other, body_pose=replace(b, between=former))
    body_pose = replace(
        b,
        seat=a.seat + (b.seat - a.seat) * share,
        right=_hand(one, other, "r", share),
        left=_hand(one, other, "l", share),
        right_hand=_turned(one, other, "r", share),
        left_hand=_turned(one, other, "l", share),
        gaze=_gaze(one, other, share),
        effort=_effort(one, other, share),
        tucked=_tucked(a, b, share),
    )
    yaw = one.yaw + angle(one.yaw, other.yaw) * share
    level = one.level + (other.level - one.level) * share
    return replace(other, spot=between(one.spot, other.spot, share), level=level, yaw=yaw, body_pose=body_pose)


def _tucked(one: BodyPose, other: BodyPose, share: float) -> tuple[float, float]:
    right, left = (a + (b - a) * share for a, b in zip(one.tucked, other.tucked, strict=True))
    return right, left


def _with_hands(body_pose: BodyPose, other: BodyPose) -> BodyPose:
    """A body pose with the hands of another; unchanged when lying."""
    if body_pose.posture == "lying" or other.posture == "lying":
        return body_pose
    return replace(
        body_pose,
        right=other.right,
        left=other.left,
        right_hand=other.right_hand,
        left_hand=other.left_hand,
        tucked=other.tucked,
    )


def _effort(one: Actor, other: Actor, share: float) -> float:
    start, end = (effort_of(actor.body_pose, actor.body.proportions) for actor in (one, other))
    return start + (end - start) * share


def _hand(one: Actor, other: Actor, side: str, share: float) -> Point | None:
    a, b = (actor.body_pose.target(side) for actor in (one, other))
    if (a is None and b is None) or one.body_pose.posture == "lying":
        return b
    start, end = (_reached(actor, side) if at else _hanging(actor, side) for at, actor in ((a, one), (b, other)))
    x, y, z = (p + (q - p) * share for p, q in zip(start, end, strict=True))
    # Hands move in arcs in front of the body.
    lift = 0.06 * sin(pi * share) * min(1.0, hypot(end[0] - start[0], end[2] - start[2]) / 0.3)
    return x, y, z + lift


def _turned(one: Actor, other: Actor, side: str, share: float) -> Hand:
    """The form of a hand between two poses; the fingers close in the second half."""
    a, b = (actor.body_pose.hand(side) for actor in (one, other))
    if a == b:
        return b
    starts, ends = (hand.palm or _palm(actor, side) for hand, actor in ((a, one), (b, other)))
    x, y, z = (p + (q - p) * share for p, q in zip(starts, ends, strict=True))
    grip = a.grip if share < 0.6 else b.grip
    return Hand(grip, (x, y, z), a.swivel + (b.swivel - a.swivel) * share, _held(a.held, b.held, share))


def _held(a: Held, b: Held, share: float) -> Held:
    """How a thing is held between two poses; what is poured flows while it is nearly tilted."""
    # What is out of reach comes quickly into the hand, and leaves it late.
    early, late = (1 - share) ** 3, share**3
    x, y, z = (p * early + q * late for p, q in zip(a.gap, b.gap, strict=True))
    turn, pitch, roll = (p + (q - p) * share for p, q in ((a.turn, b.turn), (a.pitch, b.pitch), (a.roll, b.roll)))
    stream = b.stream if share > 0.8 else (a.stream if share < 0.2 else None)
    return Held(turn, pitch, roll, (x, y, z), stream, b.opens if share > 0.5 else a.opens)


def _palm(actor: Actor, side: str) -> Point:
    """Where the palm of a hand without a direction looks: inwards and down, by the slope of its forearm."""
    found = actor.figure().joints()
    forearm = found[f"wrist_{side}"] - found[f"elbow_{side}"]
    level = 1 - abs(float(forearm[1])) / max(float(np.linalg.norm(forearm)), 1e-9)
    return ((-1.0 if side == "r" else 1.0) * (1 - level), -level, -0.35 * (1 - level))


def _reached(actor: Actor, side: str) -> Point:
    """Position of a palm, in the figure's frame: its target as far as it is in reach."""
    x, y, z = actor.figure().joints()[f"palm_{side}"]
    return float(x), float(y), float(z)


def _hanging(actor: Actor, side: str) -> Point:
    """Position of the hand of a hanging arm, in the figure's frame."""
    effort = effort_of(actor.body_pose, actor.body.proportions)
    body_pose = replace(
        actor.body_pose, right=None, left=None, right_hand=Hand(), left_hand=Hand(), effort=effort
    )  # fmt: skip
    x, y, z = replace(actor, body_pose=body_pose).figure().joints()[f"palm_{side}"]
    return float(x), float(y), float(z)


def _gaze(one: Actor, other: Actor, share: float) -> Point | None:
    a, b = one.body_pose.gaze, other.body_pose.gaze
    if a is None and b is None:
        return None
    ahead = (0.0, 0.88 * other.body.height, 2.0)
    x, y, z = (p + (q - p) * share for p, q in zip(a or ahead, b or ahead, strict=True))
    return x, y, z
