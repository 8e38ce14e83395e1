"""Hands and gaze in a step: carrying, and reaching for its objects before and after the world changes."""

from dataclasses import replace

import numpy as np

from hearth.rendering.people.action_poses import Actor, dressed_for, reachable
from hearth.rendering.people.clearance import at_rest
from hearth.rendering.people.free_gestures import freely
from hearth.rendering.people.gestures import gesture_of
from hearth.rendering.people.hand_gestures import gesturing
from hearth.rendering.people.held_objects import hold_of_node
from hearth.rendering.people.palm_targets import (
    SIDES,
    Aim,
    Aims,
    acting_side,
    carrying,
    held_by,
    nearest_point,
    node_of,
    thing_aim,
    with_aims,
)  # fmt: skip
from hearth.rendering.scene.object_boxes import Places
from hearth.schemas.graph import EnvironmentGraph, Point
from hearth.schemas.program import Step


def posed(actor: Actor, graph: EnvironmentGraph, places: Places, step: Step | None) -> Actor:
    """Return the character with hands and gaze on the step's targets."""
    gesture = gesture_of(step)
    body = dressed_for(actor.body, graph, actor.node.id)
    pose = replace(actor.body_pose, asleep=gesture.asleep)
    look = target_point(step, gesture.gaze, places, actor) if gesture.gaze else None
    gaze = actor.local(look) if look else None
    aims: dict[str, Aim] = {}
    acting: dict[str, Aim] = {}
    if pose.posture != "lying":
        held = held_by(graph, actor.node.id)
        acting = gesturing(gesture, actor, held, graph, places, step)
        carried = carrying(actor, held, graph, places)
        aims = {side: _stooped(aim, actor, acting) for side, aim in carried.items()} | acting
        if gesture.hand == "read":
            gaze = aims["right"].palm if "right" in aims else gaze
    pose = replace(with_aims(pose, aims), gaze=gaze)
    if gesture.free and pose.posture != "lying":
        pose = freely(pose, gesture.free, body.height)
    found = replace(actor, body_pose=pose, body=body)
    return at_rest(found, places.solids, [side[0] for side in acting])


def _stooped(aim: Aim, actor: Actor, acting: Aims) -> Aim:
    """Return the aim of a hand that carries a thing, which sinks with the shoulders as the other hand reaches down."""
    if not acting:
        return aim
    up, down = (
        replace(actor, body_pose=with_aims(actor.body_pose, aims)).figure().joints()["chest"] for aims in ({}, acting)
    )
    # The chest comes forward too; what is carried stays before it.
    x, y, z = np.array(aim.palm) + (down - up) * (1.0, 1.0, 0.6)
    return aim._replace(palm=(float(x), float(y), float(z)))


def reach_for(here: Actor, there: Actor, places: Places, step: Step) -> Actor:
    """Return the character at the moment its hand reaches the object, before the world changes.

    Args:
        here: at its acting position, hands in default pose.
        there: after the step.
        places: before the step.
        step: the step.
    """
    if gesture_of(step).moves:
        return posed(here, places.graph, places, step)
    if step.action != "Grab" or there.body_pose.posture == "lying" or not step.objects:
        return there
    target = step.objects[0].node or 0
    held = held_by(places.graph, here.node.id)
    side = acting_side(step, places.graph, here.node.id, held)
    pose = places.poses.get(target)
    if pose is None:
        return there
    aim = thing_aim(here, hold_of_node(node_of(places.graph, target), places, side), pose, side)
    aims = {s: Aim(at, there.body_pose.hand(s[0])) for s in SIDES if (at := there.body_pose.target(s[0])) and s in held}
    reaching = replace(there, body_pose=replace(with_aims(there.body_pose, aims | {side: aim}), gaze=aim.palm))
    return at_rest(reaching, places.solids, [side[0]])


def target_point(step: Step | None, which: str, places: Places, actor: Actor) -> Point | None:
    """Return the target of the gaze in the world: the nearest point of a step's object."""
    if step is None or not step.objects:
        return None
    ref = step.objects[-1 if which == "second" else 0]
    pose = places.poses.get(ref.node or -1) or reachable(ref.node or -1, places)[0]
    return nearest_point(actor, pose) if pose else None
