"""Blends of poses: parts of an actor's motion in which a pose or posture changes into another."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import dist, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import Between, BodyPose, Hand, Held
from hearth.rendering.people.motion_along_routes import angle, between, eased
from hearth.rendering.people.skeleton import effort_of
from hearth.schemas.graph import Point

HEADS, HANDS = 1.1, 1.7
"""Greatest speeds of heads and hands in blends of poses, metres per second."""

QUICKENING = 9.0
"""Greatest acceleration of heads and hands in blends of poses, metres per second squared."""


COMES = 2.45
"""Largest speed at which the gap between a hand and its object closes, as a multiple of the even speed."""

TURNING = 360.0
"""Greatest speed at which things turn in the hand, degrees per second."""


class Segment(NamedTuple):
    """A part of an actor's motion.

    Attributes:
        seconds: its length.
        at: the actor at a share of it.
        work: what happens to bedding meanwhile: `make` (it is laid aside), `cover` (it is drawn over the legs), or "".
        backwards: whether that is undone.
    """

    seconds: float
    at: Callable[[float], Actor]
    work: str = ""
    backwards: bool = False

    def reversed(self) -> Segment:
        """Return the same from its end to its start."""
        return Segment(self.seconds, lambda share: self.at(1 - share), self.work, not self.backwards)


def changed(one: Actor, other: Actor, seconds: float) -> Segment:
    """Return a change of posture in place: every joint goes from where it is to where it will be."""
    offset, turn = other.local(one.position), angle(other.yaw, one.yaw)

    def at(share: float) -> Actor:
        if share >= 1:
            return other
        former = Between(one.body_pose, offset, turn, eased(share))
        return replace(other, body_pose=replace(other.body_pose, between=former))

    return Segment(max(seconds, least_seconds(one, other)), at)


def blended(one: Actor, other: Actor, seconds: float) -> Segment:
    """Return a transition between two actors' poses, slow enough for heads and hands."""

    def at(share: float) -> Actor:
        return other if share >= 1 else blend(one, other, eased(share))

    return Segment(max(seconds, least_seconds(one, other)), at)


def least_seconds(one: Actor, other: Actor) -> float:
    """Return the least time of an eased motion between two poses."""
    a, b = one.figure().joints(), other.figure().joints()
    least = 0.0
    for name, speed in (("head", HEADS), ("hand_r", HANDS), ("hand_l", HANDS)):
        start, end = (np.array(actor.world(tuple(found[name]))) for actor, found in ((one, a), (other, b)))
        far = float(np.linalg.norm(end - start))
        # An eased motion is fastest in its middle, and quickens most at its ends.
        least = max(least, far * pi / 2 / speed, pi * sqrt(far / 2 / QUICKENING))
    for side in "rl":
        held, then = (actor.body_pose.hand(side).held for actor in (one, other))
        turns = abs(held.turn - then.turn) * pi / 2 / TURNING
        least = max(least, dist(held.gap, then.gap) * COMES / HANDS, turns)
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
        effort=effort_between(one, other, share),
        tucked=_tucked(a, b, share),
    )
    yaw = one.yaw + angle(one.yaw, other.yaw) * share
    level = one.level + (other.level - one.level) * share
    return replace(other, spot=between(one.spot, other.spot, share), level=level, yaw=yaw, body_pose=body_pose)


def _tucked(one: BodyPose, other: BodyPose, share: float) -> tuple[float, float]:
    right, left = (a + (b - a) * share for a, b in zip(one.tucked, other.tucked, strict=True))
    return right, left


def with_hands(body_pose: BodyPose, other: BodyPose) -> BodyPose:
    """Return a body pose with the hands of another; unchanged when lying."""
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


def effort_between(one: Actor, other: Actor, share: float) -> float:
    """Return how far a body stoops between two poses."""
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
    """Return the form of a hand between two poses; the fingers close in the second half."""
    a, b = (actor.body_pose.hand(side) for actor in (one, other))
    if a == b:
        return b
    starts, ends = (hand.palm or _palm(actor, side) for hand, actor in ((a, one), (b, other)))
    x, y, z = (p + (q - p) * share for p, q in zip(starts, ends, strict=True))
    grip = a.grip if share < 0.6 else b.grip
    return Hand(grip, (x, y, z), a.swivel + (b.swivel - a.swivel) * share, _held(a.held, b.held, share))


def _held(a: Held, b: Held, share: float) -> Held:
    """Return how a thing is held between two poses; what is poured flows while it is nearly tilted."""
    # What is out of reach comes quickly into the hand, and leaves it late.
    early, late = (1 - share) ** 3, share**3
    x, y, z = (p * early + q * late for p, q in zip(a.gap, b.gap, strict=True))
    turn, pitch, roll = (p + (q - p) * share for p, q in ((a.turn, b.turn), (a.pitch, b.pitch), (a.roll, b.roll)))
    stream = b.stream if share > 0.8 else (a.stream if share < 0.2 else None)
    return Held(turn, pitch, roll, (x, y, z), stream, b.opens if share > 0.5 else a.opens)


def _palm(actor: Actor, side: str) -> Point:
    """Return where the palm of a hand without a direction looks: inwards and down, by the slope of its forearm."""
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
