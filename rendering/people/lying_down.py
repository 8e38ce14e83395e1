"""Lying down: the bed is made ready, the legs are swung onto it, a blanket is drawn over them, the back is laid down.

Getting up is the same backwards.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import pi, sin

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.bedding import Remade, drawn, edge, glided
from hearth.rendering.people.body_pose import BodyPose, Foot, Hand
from hearth.rendering.people.motion_along_routes import angle, between, eased
from hearth.rendering.people.pose_blends import Segment, blended, changed, effort_between, least_seconds
from hearth.rendering.people.skeleton import feet_of
from hearth.schemas.graph import Point

RELAX, SWING, LAY, COVERING, MAKING, REACH, BACK = 0.3, 1.8, 1.8, 1.4, 1.6, 0.6, 0.4
"""Seconds, at least."""

STRETCHED = 0.997
"""Share of their length to which legs on a bed are stretched."""

HEEL = 0.03
"""Distance from a mattress to the heels of a person sitting on it, metres."""

APART = 0.17
"""Metres of each hand to the side of where both take hold."""

RAISED = 0.06
"""Metres by which feet are raised over the edge of a bed."""


def lying_down(sits: Actor, lying: Actor, bed: Remade) -> list[Segment]:
    """From sitting on the edge of a bed, or on a couch, to lying there."""
    up = sitting_up(lying)
    ready = _ready(sits, up)
    found = [blended(sits, ready, RELAX), _swung(ready, up)]
    over = bed.over
    if over is None:
        return [*found, changed(up, lying, LAY)]
    covering = _moving(up, lambda share: edge(drawn(over, share)))
    covered = Segment(COVERING, lambda share: covering(eased(share)), "cover")
    return [*found, blended(up, covering(0.0), REACH), covered, changed(covering(1.0), lying, LAY)]


def made_ready(stands: Actor, bed: Remade) -> list[Segment]:
    """Lay a bed's bedding as wanted, by a person standing next to it."""
    if not bed.moved:
        return []
    ways = bed.moved.get(bed.cover) or next(iter(bed.moved.values()))

    def top(share: float) -> Point:
        box = glided(*ways, share).box
        return box.center[0], box.center[1] + box.size[1] / 2, box.center[2]

    making = _moving(stands, top)
    made = Segment(MAKING, lambda share: making(eased(share)), "make")
    return [blended(stands, making(0.0), REACH), made, blended(making(1.0), stands, BACK)]


def sitting_up(lying: Actor) -> Actor:
    """Return the lying person sitting up on the bed with the legs stretched."""
    body, seat = lying.body.proportions, lying.body_pose.seat
    x, _, z = lying.world((0.0, 0.0, lying.body.height * 0.5 - body.pelvis))
    ahead = (body.thigh + body.shin) * STRETCHED
    feet = Foot(body.hip, ahead, seat + HEEL, 8.0, -75.0), Foot(-body.hip, ahead, seat + HEEL, -8.0, -75.0)
    return replace(lying, spot=(x, z), body_pose=BodyPose("sitting", seat, feet=feet))


def _ready(sits: Actor, up: Actor) -> Actor:
    """Return the person sitting on an edge or in a seat, arms and back as they will be when the legs are up."""
    pose = replace(up.body_pose, seat=sits.body_pose.seat, feet=feet_of(sits.body_pose, sits.body.proportions))
    return replace(sits, body_pose=pose)


def _swung(sits: Actor, up: Actor) -> Segment:
    """Return the legs are raised onto the bed while the body turns along it."""
    ends = feet_of(up.body_pose, up.body.proportions)
    starts = feet_of(sits.body_pose, sits.body.proportions)

    def at(share: float) -> Actor:
        if share <= 0 or share >= 1:
            return up if share >= 1 else sits
        raised, turned = eased(share / 0.5), eased((share - 0.15) / 0.85)
        feet = [_between(a, b, raised, turned) for a, b in zip(starts, ends, strict=True)]
        seat = sits.body_pose.seat + (up.body_pose.seat - sits.body_pose.seat) * turned
        pose = replace(up.body_pose, seat=seat, feet=(feet[0], feet[1]))
        yaw = sits.yaw + angle(sits.yaw, up.yaw) * turned
        return replace(up, spot=between(sits.spot, up.spot, turned), yaw=yaw, body_pose=pose)

    return Segment(max(SWING, least_seconds(sits, up)), at)


def _between(one: Foot, other: Foot, raised: float, turned: float) -> Foot:
    """Return a foot that is raised, and stretched and turned meanwhile."""
    flat = ((foot.x, foot.z, foot.yaw, foot.pitch) for foot in (one, other))
    x, z, yaw, pitch = (a + (b - a) * turned for a, b in zip(*flat, strict=True))
    lift = one.lift + (other.lift - one.lift) * raised + RAISED * sin(pi * turned)
    return Foot(x, z, lift, yaw, pitch)


def _moving(actor: Actor, way: Callable[[float], Point]) -> Callable[[float], Actor]:
    """Return the actor at each share of a way along which both hands take something.

    The body stoops evenly: how far it has to for each point alone changes by leaps.
    """
    first, last = (_holding(actor, way(share)) for share in (0.0, 1.0))

    def at(share: float) -> Actor:
        now = _holding(actor, way(share))
        return replace(now, body_pose=replace(now.body_pose, effort=effort_between(first, last, share)))

    return at


def _holding(actor: Actor, at: Point) -> Actor:
    """Return the actor with both hands at a point of the world, and looking there."""
    x, y, z = actor.local(at)
    hand = Hand("sheet", (0.0, -1.0, 0.0))
    pose = replace(actor.body_pose, right=(x + APART, y, z), left=(x - APART, y, z), right_hand=hand, left_hand=hand)
    return replace(actor, body_pose=replace(pose, gaze=(x, y, z), effort=None))
