"""Feet that stay, or step one by one, while a body changes its posture."""

from dataclasses import replace
from math import hypot, pi, sin

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import Foot
from hearth.rendering.people.gait import in_world, local
from hearth.rendering.people.motion_along_routes import Place, angle, between, eased
from hearth.rendering.people.skeleton import feet_of


def planted(actor: Actor, feet: Actor) -> Actor:
    """Return an actor whose feet are where another's are."""
    pair = feet_of(feet.body_pose, feet.body.proportions)
    places = [in_world(Place(*feet.spot, feet.yaw), foot) for foot in pair]
    here = Place(*actor.spot, actor.yaw)
    right, left = (local(here, at, foot.lift, foot.pitch) for at, foot in zip(places, pair, strict=True))
    return replace(actor, body_pose=replace(actor.body_pose, feet=(right, left)))


def stepping(one: Actor, other: Actor, share: float) -> tuple[Foot, Foot]:
    """Return the feet, in the frame of `one` at present, of a body whose feet step to where another's are, one by one.

    Args:
        one: the actor now, anywhere between the start and `other`; its feet are those at the start.
        other: the actor at the end.
        share: of the whole motion.
    """
    here = Place(*one.spot, one.yaw)
    starts = feet_of(one.body_pose, one.body.proportions)
    ends = feet_of(other.body_pose, other.body.proportions)
    there = Place(*other.spot, other.yaw)
    found = []
    for number, (start, end) in enumerate(zip(starts, ends, strict=True)):
        a, b = in_world(here, start), in_world(there, end)
        lifted = min(max((share - 0.06 - 0.44 * number) / 0.42, 0.0), 1.0)
        part = min(max((lifted - 0.15) / 0.7, 0.0), 1.0)
        x, z = between((a.x, a.z), (b.x, b.z), eased(part))
        far = hypot(b.x - a.x, b.z - a.z) + abs(angle(a.yaw, b.yaw)) / 300
        raised = min(0.06, 0.3 * far + 0.004) * sin(pi * lifted) ** 0.7
        lift = raised + start.lift + (end.lift - start.lift) * eased(part)
        found.append(local(here, Place(x, z, a.yaw + angle(a.yaw, b.yaw) * eased(part)), lift, 0.0))
    return found[0], found[1]
