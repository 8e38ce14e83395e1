"""The motion of one actor in a step: relax, rise, walk, turn, sit or lie down, reach, act."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import atan2, cos, degrees, hypot, pi, radians, sin
from typing import TYPE_CHECKING

import numpy as np

from hearth.kb.modifiers import SPEEDS, value
from hearth.rendering.people.action_poses import Actor, open_side
from hearth.rendering.people.bedding import Remade
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.clearance import arms_on_the_way
from hearth.rendering.people.foot_steps import planted, stepping
from hearth.rendering.people.free_gestures import whole_body
from hearth.rendering.people.gait import Gait, movements
from hearth.rendering.people.gestures import Gesture, gesture_of
from hearth.rendering.people.lying_down import lying_down, made_ready
from hearth.rendering.people.motion_along_routes import Place, angle, between, eased
from hearth.rendering.people.motion_timing import holds_of, paced
from hearth.rendering.people.pose_blends import HEADS, Segment, blended, effort_between, with_hands
from hearth.rendering.people.skeleton import PELVIS_ON_SEAT, effort_of
from hearth.rendering.people.step_hands_and_gaze import posed, reach_for
from hearth.rendering.scene.routes import WalkableFloor, led_on, path
from hearth.rendering.scene.solids import Solids
from hearth.schemas.graph import Point, Spot
from hearth.schemas.program import Step

if TYPE_CHECKING:
    from hearth.rendering.film.execution_keyframes import Keyframe

WALKING, RUNNING = 1.1, 1.8
"""Metres per second."""

RELAX, RISE, REACH, BACK, HOLD = 0.3, 1.2, 0.6, 0.4, 0.5
"""Seconds, at least."""

RUBBED = 0.06
"""Metres to each side by which a hand rubs."""

CARRIED = 1.2
"""Least height of the hands of a person who has got up, as a share of that of the hips."""

AT_COUCH = 0.5
"""Distance from the middle of a person lying on a couch to the floor in front of it, metres."""

AT_BED = 0.5
"""Distance from the place where a person stands next to a bed to the hips of a person sitting on its edge, metres."""


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

    def done(self, work: str, time: float) -> float | None:
        """Return the share of a bedding's movement that is done after `time` seconds; None if nobody moves it."""
        for segment in self.segments:
            if segment.work == work:
                share = eased(time / segment.seconds)
                return 1 - share if segment.backwards else share
            time -= segment.seconds
        return None

    def at(self, time: float) -> Actor:
        """Return the actor `time` seconds after the start of the tick."""
        for segment in self.segments:
            if time < segment.seconds:
                return segment.at(time / segment.seconds)
            time -= segment.seconds
        return self.segments[-1].at(1.0)


def track(one: Actor, other: Actor, before: Keyframe, after: Keyframe, step: Step | None) -> Track:
    """Return an actor's motion from one keyframe to the next."""
    segments: list[Segment] = []
    rest = _resting(one, before)
    held, then = holds_of(one, before.places), holds_of(other, after.places)
    if rest.body_pose != one.body_pose:
        segments.append(paced(blended(one, rest, RELAX), held))
    here = _approach(segments, rest, other, step, (before, after))
    if step is not None:
        reach = reach_for(here, other, before.places, step)
        if reach.body_pose != here.body_pose:
            segments.append(paced(blended(here, reach, REACH), held))
        here = reach
    change = sum(segment.seconds for segment in segments)
    if here != other:
        segments.append(paced(blended(here, other, BACK), then))
    if step is not None and gesture_of(step).seconds:
        segments.append(acted(other, gesture_of(step)))
    segments.append(motionless(other, HOLD))
    rate = SPEEDS.get(value(step, "speed"), 1.0) if step is not None else 1.0
    if rate != 1.0:
        segments = [segment._replace(seconds=segment.seconds / rate) for segment in segments]
    return Track(tuple(segments), change / rate)


RATES = {"hop": 0.9, "beat": 2.4, "shake": 2.2, "circle": 1.1}
"""Motions of a hand, times a second."""

FAR = {"hop": 0.05, "beat": 0.06, "shake": 0.09, "circle": 0.05}
"""Distance of the hand from its place at most, metres."""


def acted(actor: Actor, gesture: Gesture) -> Segment:
    """Return the hands at work: what they do once they have arrived."""

    def at(share: float) -> Actor:
        time, soft = share * gesture.seconds, sin(pi * min(max(share, 0.0), 1.0)) ** 0.5 if 0 < share < 1 else 0.0
        pose = actor.body_pose
        if not gesture.motion or not soft:
            return actor
        effort = effort_of(pose, actor.body.proportions)
        wide = RUBBED / 2 if pose.right and pose.left else RUBBED
        right, left = (_at_work(pose.target(side), gesture.motion, time, soft, side, wide) for side in "rl")
        busy = replace(actor, body_pose=replace(pose, right=right, left=left, effort=effort))
        return whole_body(busy, gesture.motion, time, soft)

    return Segment(gesture.seconds, at)


def _at_work(at: Point | None, motion: str, time: float, soft: float, side: str, wide: float) -> Point | None:
    if at is None:
        return None
    x, y, z = at
    if motion == "keys":
        return x, y + 0.016 * soft * sin(2 * pi * (2.2 * time + (0.5 if side == "l" else 0.0))), z
    if motion in ("hop", "beat", "shake", "circle"):
        turn = 2 * pi * RATES[motion] * time
        far = FAR[motion] * soft
        return (
            x + (far * sin(turn + pi / 2) if motion == "circle" else 0.0),
            y + (far * sin(turn) if motion in ("shake", "hop") else 0.0),
            z + (far * sin(turn) if motion in ("beat", "circle") else 0.0),
        )
    # Two hands move against each other.
    across = wide if side == "r" else -wide
    return x + across * soft * sin(2 * pi * 0.9 * time), y, z + 0.025 * soft * sin(4 * pi * 0.9 * time)


def motionless(actor: Actor, seconds: float) -> Segment:
    """Return an actor who does not move."""
    return Segment(seconds, lambda share: actor)


def _resting(actor: Actor, keyframe: Keyframe) -> Actor:
    """Return the actor with arms hanging, or carrying what it holds."""
    return posed(actor, keyframe.places.graph, keyframe.places, None)


def _approach(
    segments: list[Segment], one: Actor, other: Actor, step: Step | None, keyframes: tuple[Keyframe, Keyframe]
) -> Actor:
    """Append the segments up to the acting position; returns the actor there, hands in default pose."""
    before, after, ways = one.body_pose.posture, other.body_pose.posture, keyframes[0].floor.walkable
    solids = keyframes[0].places.solids
    if before == after and before != "standing" and one.place == other.place and one.spot == other.spot:
        return replace(other, body_pose=with_hands(other.body_pose, one.body_pose))
    if "standing" not in (before, after) and one.place == other.place:
        there = replace(other, body_pose=with_hands(other.body_pose, one.body_pose))
        bed = _bed(keyframes, one.place)
        if after == "lying":
            segments += [*made_ready(one, bed), *lying_down(one, there, bed)]
        else:
            segments += [part.reversed() for part in reversed(lying_down(there, one, bed))]
        return there
    speed = RUNNING if step is not None and step.action == "Run" else WALKING
    if before != "standing":
        one = _got_up(segments, one, ways, _bed(keyframes, one.place), _front(one, keyframes[0]))
    if after == "standing":
        there = replace(other, body_pose=with_hands(BodyPose(tucked=other.body_pose.tucked), one.body_pose))
        route = led_on(ways, path(ways, one.spot, other.spot), other.spot)
        return _walked(segments, one, there, route, speed, solids)
    stop, bed = _beside(other, ways, one.spot, _front(other, keyframes[1])), _bed(keyframes, other.place)
    side = other if after == "sitting" else _on_edge(other, stop)
    turned = replace(side, spot=stop, body_pose=with_hands(BodyPose(), one.body_pose), place=0)
    route = led_on(ways, path(ways, one.spot, stop), stop)
    if after == "lying" and bed.moved:
        one = _walked(segments, one, replace(turned, yaw=turned.yaw + 180.0), route, speed, solids)
        segments += made_ready(one, bed)
        route = stop, stop
    turned = _walked(segments, one, turned, route, speed, solids)
    down = replace(side, body_pose=with_hands(BodyPose("sitting", other.body_pose.seat), one.body_pose))
    segments.append(_seating(turned, down))
    there = replace(other, body_pose=with_hands(other.body_pose, one.body_pose))
    if after == "lying":
        segments += lying_down(down, there, bed)
    return there


def _bed(keyframes: tuple[Keyframe, Keyframe], place: int) -> Remade:
    """Return the differences between two keyframes in the bed at a place."""
    return Remade.between(keyframes[0].places, keyframes[1].places, place)


def _walked(
    segments: list[Segment], one: Actor, other: Actor, route: Sequence[Spot], speed: float, solids: Solids
) -> Actor:
    """Append turns and a walk to where another actor stands; returns the actor there, with arms as they are then."""
    arms = one.body_pose
    moves = movements(Place(*one.spot, one.yaw), route, speed, other.yaw, _reach(one))
    if moves:
        gait = Gait(one, moves, lambda places: arms_on_the_way(one, places, solids), other.body_pose.tucked, speed)
        segments.append(Segment(gait.seconds, lambda share: gait.at(share * gait.seconds)))
        arms = gait.carried(gait.end)
    other = replace(other, body_pose=with_hands(other.body_pose, arms))
    if one.level != other.level:
        segments.append(blended(replace(other, level=one.level), other, RELAX))
    return other


def _reach(actor: Actor) -> float:
    """Distance from the body's axis to the farther palm, or to the object in it, metres."""
    joints, pose = actor.figure().joints(), actor.body_pose
    palms = [joints[f"palm_{side}"] + np.array(pose.hand(side).held.gap) for side in "rl"]
    return max(hypot(float(palm[0]), float(palm[2])) for palm in palms)


def _got_up(
    segments: list[Segment], one: Actor, ways: WalkableFloor | None, bed: Remade, front: float | None = None
) -> Actor:
    """Append getting up from a seat or bed; return the actor next to it, in front of a couch."""
    stop = _beside(one, ways, one.spot, front)
    side = one
    if one.body_pose.posture == "lying":
        side = _on_edge(one, stop)
        side = replace(side, body_pose=BodyPose("sitting", one.body_pose.seat))
        segments += [part.reversed() for part in reversed(lying_down(side, one, bed))]
    low = one.body.proportions.pelvis * CARRIED
    raised = with_hands(BodyPose(), side.body_pose)
    raised = replace(raised, right=_not_below(raised.right, low), left=_not_below(raised.left, low))
    up = replace(side, spot=stop, body_pose=raised, place=0)
    sitting = _seating(up, side)
    segments.append(sitting.reversed())
    return up


def _not_below(hand: Point | None, low: float) -> Point | None:
    """Return a hand that comes along as one rises from the floor, so that one need not stoop for it."""
    return hand and (hand[0], max(hand[1], low), hand[2])


def _front(rests: Actor, keyframe: Keyframe) -> float | None:
    """Return the direction of the front of the couch on which a person lies, or None for other persons and for beds."""
    pose = keyframe.places.poses.get(rests.place)
    return open_side(pose) if pose and rests.body_pose.posture == "lying" else None


def _beside(rests: Actor, ways: WalkableFloor | None, near: Spot, front: float | None) -> Spot:
    """Return where one stands before sitting or lying down: the walkable point nearest to the front of the hips."""
    x, _, z = rests.world((0.0, 0.0, 0.35 if rests.body_pose.posture == "sitting" else 0.0))
    if front is not None:
        x, z = x + AT_COUCH * sin(radians(front)), z + AT_COUCH * cos(radians(front))
    if ways is not None:
        for cells in (ways.wide, ways.narrow):
            entry = ways.entry(cells, (x, z)) or ways.entry(cells, rests.spot)
            if entry is not None:
                return entry
    x, _, z = rests.world((0.0, 0.0, 0.6))
    return near if hypot(near[0] - x, near[1] - z) < 0.6 else (x, z)


def _on_edge(lying: Actor, stop: Spot) -> Actor:
    """Return the lying person sitting on the edge of the bed, with the back to its middle."""
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
        effort = effort_between(up, down, part)
        pose = replace(with_hands(BodyPose("sitting"), down.body_pose), seat=high + (low - high) * part, effort=effort)
        right, left = (_way(up.body_pose.target(side), down.body_pose.target(side), part) for side in "rl")
        pose = replace(pose, right=right, left=left)
        yaw = up.yaw + angle(up.yaw, down.yaw) * part
        now = replace(up, spot=between(up.spot, down.spot, part), yaw=yaw, body_pose=pose)
        return replace(now, body_pose=replace(pose, feet=stepping(planted(now, up), down, share)))

    far = hypot(up.spot[0] - down.spot[0], up.spot[1] - down.spot[1]) + abs(high - low)
    return Segment(max(RISE, far * pi / 2 / HEADS), at)


def _way(one: Point | None, other: Point | None, share: float) -> Point | None:
    """Return where a hand is between two places; at the second if it has none at first."""
    if one is None or other is None:
        return other
    x, y, z = (a + (b - a) * share for a, b in zip(one, other, strict=True))
    return x, y, z
