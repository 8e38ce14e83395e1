"""Hands and gaze in a step: carrying, reaching, and the gestures of actions on their objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import radians, sin
from typing import NamedTuple

import numpy as np

from hearth.kb.modifiers import value
from hearth.rendering.people.acting import Actor, dressed_for, reachable
from hearth.rendering.people.body_pose import BodyPose, Hand, Held
from hearth.rendering.people.clearance import at_rest
from hearth.rendering.people.gestures import Gesture, gesture_of
from hearth.rendering.people.holding import Hold, grip_point, hold_of_node
from hearth.rendering.people.rotations import unit
from hearth.rendering.people.skeleton import PELVIS_ON_SEAT
from hearth.rendering.scene.instances import own_mesh
from hearth.rendering.scene.places import HANDS, Places, Pose
from hearth.schemas.graph import EnvironmentGraph, Node, Point
from hearth.schemas.program import Step

SIDES = {"right": 1.0, "left": -1.0}
OTHER = {"right": "left", "left": "right"}

ABOVE = 0.12
"""Metres above a vessel from which is poured into it."""

TILTED, DRINKING = 80.0, 38.0
"""Degrees by which a pouring vessel, and one at the mouth, are tilted."""


class Aim(NamedTuple):
    """Where a palm goes, in the person's frame, and the form of its hand."""

    palm: Point
    hand: Hand


Aims = Mapping[str, Aim]
"""By side; a hand without an aim hangs."""


def posed(actor: Actor, graph: EnvironmentGraph, places: Places, step: Step | None) -> Actor:
    """The character with hands and gaze on the step's targets."""
    gesture = gesture_of(step)
    body = dressed_for(actor.body, graph, actor.node.id)
    pose = replace(actor.body_pose, asleep=gesture.asleep)
    look = target_point(step, gesture.gaze, places, actor) if gesture.gaze else None
    gaze = actor.local(look) if look else None
    aims: dict[str, Aim] = {}
    acting: dict[str, Aim] = {}
    if pose.posture != "lying":
        held = held_by(graph, actor.node.id)
        acting = _gesturing(gesture, actor, held, graph, places, step)
        aims = _carrying(actor, held, graph, places) | acting
        if gesture.hand == "read":
            gaze = aims["right"].palm if "right" in aims else gaze
    found = replace(actor, body_pose=replace(with_aims(pose, aims), gaze=gaze), body=body)
    return at_rest(found, places.solids, [side[0] for side in acting])


def with_aims(pose: BodyPose, aims: Aims) -> BodyPose:
    """A pose with hands where they are aimed."""
    right, left = aims.get("right"), aims.get("left")
    return replace(
        pose,
        tucked=(0.0, 0.0),
        right=right.palm if right else None,
        left=left.palm if left else None,
        right_hand=right.hand if right else Hand(),
        left_hand=left.hand if left else Hand(),
    )


def held_by(graph: EnvironmentGraph, me: int) -> dict[str, int]:
    """Side -> id of what the hand holds."""
    return {HANDS[e.relation]: e.target for e in graph.edges if e.source == me and e.relation in HANDS}


def _node(graph: EnvironmentGraph, number: int) -> Node:
    return next(node for node in graph.nodes if node.id == number)


def _raised(actor: Actor) -> float:
    """Metres by which hands of a sitting body are lower than of one that stands."""
    if actor.body_pose.posture != "sitting":
        return 0.0
    return actor.body_pose.seat + PELVIS_ON_SEAT * actor.body.height - actor.body.proportions.pelvis


def _carrying(actor: Actor, held: Mapping[str, int], graph: EnvironmentGraph, places: Places) -> dict[str, Aim]:
    """Hands that carry what they hold."""
    found: dict[str, Aim] = {}
    h, lower = actor.body.height, _raised(actor)
    for side, number in held.items():
        node = _node(graph, number)
        hold, size = hold_of_node(node, places, side), places.size_of(node)
        x, y, z = (share * h for share in hold.carry)
        # What is tall stands on the floor, or hangs above it.
        y = max(y + lower, hold.point[1] + 0.02)
        if not hold.both:
            found[side] = Aim((x, y, z + (0.1 if lower else 0.0)), Hand(hold.grip, hold.palm))
            continue
        deep = size[2] / 2 + 0.02
        x = abs(hold.point[0])
        palm = (SIDES[side] * min(x, 0.3), y, z + deep)
        gap = (SIDES[side] * (x - min(x, 0.3)), 0.0, 0.0)
        found[side] = Aim(palm, Hand(hold.grip, hold.palm, held=Held(gap=gap)))
        if OTHER[side] not in held:
            other = hold_of_node(node, places, OTHER[side])
            found[OTHER[side]] = Aim((-palm[0], palm[1], palm[2]), Hand(other.grip, other.palm))
    return found


def _gesturing(
    gesture: Gesture, actor: Actor, held: Mapping[str, int], graph: EnvironmentGraph, places: Places, step: Step | None
) -> dict[str, Aim]:
    """The aims of the hands that act."""
    if step is None or not gesture.hand:
        return {}
    acting = acting_side(step, graph, actor.node.id, held)
    named = [ref.node or 0 for ref in step.objects]
    about = named[min(gesture.about, len(named) - 1)] if named else 0
    makers = {
        "put": lambda: _putting(actor, named[0] if named else 0, acting, graph, places),
        "pour": lambda: _pouring(actor, held, acting, about, graph, places),
        "mouth": lambda: _to_mouth(actor, held, acting, graph, places),
        "type": lambda: _typing(actor, about, places),
        "read": lambda: _reading(actor, held, acting, graph, places),
        "rub": lambda: _rubbing(actor, held, acting, about, graph, places),
        "push": lambda: _pushing(actor, held, about, places),
        "object": lambda: _touching(gesture, actor, acting, about, graph, places),
    }
    if gesture.hand in makers:
        return makers[gesture.hand]()
    h, lower, sign = actor.body.height, _raised(actor), SIDES[acting]
    fixed: dict[str, Aim] = {
        "chest": Aim((0.09 * sign, 0.7 * h + lower, 0.2), Hand("sheet", (-sign, 0.0, -0.4))),
        "wave": Aim((sign * 0.3, 0.94 * h + lower, 0.2), Hand("flat", (0.0, 0.0, 1.0))),
    }
    if gesture.hand not in fixed:
        return {}
    aim = fixed[gesture.hand]
    found = {acting: aim}
    if gesture.both:
        (x, y, z), (px, py, pz) = aim.palm, aim.hand.palm or (0.0, 0.0, 0.0)
        found[OTHER[acting]] = Aim((-x, y, z), aim.hand._replace(palm=(-px, py, pz)))
    return found


def acting_side(step: Step, graph: EnvironmentGraph, me: int, held: Mapping[str, int]) -> str:
    """The acting hand: the one that holds the object, else a free one, preferring the right."""
    if asked := value(step, "hand"):
        return asked
    named = {ref.node for ref in step.objects}
    for side, node in sorted(held.items()):
        if node in named:
            return side
    return "left" if "right" in held and "left" not in held else "right"


def thing_aim(actor: Actor, hold: Hold, pose: Pose, side: str) -> Aim:
    """The palm at a thing that stands somewhere: at its handle, else on the side nearest to the chest."""
    yaw = pose.yaw or 0.0
    grip = np.array(actor.local(grip_point(hold, pose.box, yaw)))
    if hold.fixed:
        palm, facing = grip, hold.palm
    else:
        palm = np.array(actor.local(nearest_point(actor, pose)))
        palm[1] = max(palm[1], min(grip[1], palm[1] + 0.5 * pose.box.size[1]))
        middle = np.array(actor.local(pose.box.center))
        way = unit((middle - palm) * (1.0, 0.3, 1.0) + np.array(hold.palm) * 0.03)
        facing = (float(way[0]), float(way[1]), float(way[2]))
    gap = grip - palm
    turn = (yaw - actor.yaw - hold.turn + 180) % 360 - 180
    held = Held(turn=turn, gap=(float(gap[0]), float(gap[1]), float(gap[2])))
    return Aim((float(palm[0]), float(palm[1]), float(palm[2])), Hand(hold.grip, facing, held=held))


def _putting(actor: Actor, thing: int, side: str, graph: EnvironmentGraph, places: Places) -> dict[str, Aim]:
    """The hand where the thing has been put down."""
    pose = places.poses.get(thing)
    if pose is None:
        return {}
    return {side: thing_aim(actor, hold_of_node(_node(graph, thing), places, side), pose, side)}


def _pouring(
    actor: Actor, held: Mapping[str, int], side: str, target: int, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """What is held tilts over the target."""
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None or side not in held:
        return {}
    node = _node(graph, held[side])
    hold, size, sign = hold_of_node(node, places, side), places.size_of(node), SIDES[side]
    x, y, z = actor.local(pose.box.center)
    top = y + pose.box.size[1] / 2
    # Tilted to the other side the lip is beside the hand.
    out = 0.5 * size[1] * sin(radians(TILTED)) + 0.02
    palm = (x + sign * out, top + ABOVE + 0.35 * size[1], z - 0.02)
    stream = (x, y, z)
    held_so = Held(roll=-sign * TILTED, stream=stream)
    return {side: Aim(palm, Hand(hold.grip, (-sign, -0.2, 0.1), 25.0, held_so))}


def _to_mouth(
    actor: Actor, held: Mapping[str, int], side: str, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """What is held with its rim at the mouth; without anything the hand itself."""
    joints, h, sign = actor.figure().joints(), actor.body.height, SIDES[side]
    head = joints["head"]
    mouth = (float(head[0]), float(head[1]) - 0.035 * h, float(head[2]) + 0.085 * h / 1.7)
    if side not in held:
        before = (mouth[0] + sign * 0.02, mouth[1] - 0.02, mouth[2] + 0.03)
        return {side: Aim(before, Hand("pinch", (-sign, 0.2, -0.6)))}
    node = _node(graph, held[side])
    hold, size = hold_of_node(node, places, side), places.size_of(node)
    lift = min(size[1], 0.3)
    tilt = radians(DRINKING)
    # The rim's near edge is at the lips: from there to the grip point.
    down = lift - min(hold.point[1], lift)
    near = min(size[0], size[2]) / 2
    palm = (mouth[0] + sign * min(abs(hold.point[0]), 0.06), mouth[1] - down * 0.8, mouth[2] + near + down * sin(tilt))
    return {side: Aim(palm, Hand(hold.grip, (-sign, 0.0, -0.2), 20.0, Held(pitch=DRINKING)))}


def _typing(actor: Actor, target: int, places: Places) -> dict[str, Aim]:
    """Both hands above the keys."""
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None:
        return {}
    x, y, z = actor.local(pose.box.center)
    flat = pose.box.size[1] < 0.12
    near = z - 0.04 if flat else z - 0.1
    top = y + pose.box.size[1] / 2 + 0.03 if flat else y - pose.box.size[1] / 2 + 0.06
    return {
        side: Aim((x + sign * 0.09, top, near), Hand("typing", (-0.1 * sign, -1.0, 0.1)))
        for side, sign in SIDES.items()
    }


def _reading(
    actor: Actor, held: Mapping[str, int], side: str, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """What is held open before the chest, with both hands if the other is free."""
    if side not in held:
        return {}
    node, h, lower, sign = _node(graph, held[side]), actor.body.height, _raised(actor), SIDES[side]
    hold, size = hold_of_node(node, places, side), places.size_of(node)
    half = min(max(abs(hold.point[0]) * 1.35, 0.09), 0.2)
    palm = (sign * half, 0.665 * h + lower, 0.32)
    opens = "CAN_OPEN" in node.properties or size[1] < 0.06
    found = {side: Aim(palm, Hand("sheet", (-0.4 * sign, 0.6, -0.5), held=Held(pitch=48.0, opens=opens)))}
    if OTHER[side] not in held:
        found[OTHER[side]] = Aim((-palm[0], palm[1], palm[2]), Hand("sheet", (0.4 * sign, 0.6, -0.5)))
    return found


def _rubbing(
    actor: Actor, held: Mapping[str, int], side: str, target: int, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """A hand, or the tool in it, on what is wiped or washed; what is held itself is rubbed by the other hand."""
    if target in held.values():
        holder = next(s for s, node in held.items() if node == target)
        found = _carrying(actor, {holder: target}, graph, places)
        x, y, z = found[holder].palm
        node = _node(graph, target)
        middle = -SIDES[holder] * 0.5 * places.size_of(node)[0]
        other = OTHER[holder]
        found[other] = Aim((x + middle, y + 0.03, z), Hand("flat", (SIDES[holder], -0.4, 0.0)))
        return found
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None:
        return {}
    x, y, z = actor.local(nearest_point(actor, pose))
    center = actor.local(pose.box.center)
    way = unit(np.array(center) - (x, y, z) + np.array((0.0, -1e-3, 0.0)))
    facing = (0.0, -1.0, 0.15) if y >= center[1] else (float(way[0]), float(way[1]), float(way[2]))
    if side not in held:
        return {side: Aim((x, y, z), Hand("flat", facing))}
    node = _node(graph, held[side])
    hold, size = hold_of_node(node, places, side), places.size_of(node)
    tall = size[1] > 0.6
    above = hold.point[1] if tall else 0.5 * size[1] + 0.01
    return {side: Aim((x, y + above, z), Hand(hold.grip, hold.palm if tall else facing))}


def _pushing(actor: Actor, held: Mapping[str, int], target: int, places: Places) -> dict[str, Aim]:
    """Flat hands on the near side of what is pushed or pulled."""
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None:
        return {}
    x, y, z = actor.local(nearest_point(actor, pose))
    width = min(max(0.35 * min(pose.box.size[0], pose.box.size[2]), 0.06), 0.2)
    found = {}
    for side, sign in SIDES.items():
        if side not in held:
            found[side] = Aim((x + sign * width, y, z), Hand("flat", (0.0, 0.0, 1.0)))
    return found


def _touching(
    gesture: Gesture, actor: Actor, side: str, target: int, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """A hand on an object: at its handle if the gesture opens it, else at the nearest point."""
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None:
        return {}
    handle = front_point(places, _node(graph, target), actor) if gesture.grip == "handle" else None
    point = np.array(actor.local(handle or nearest_point(actor, pose)))
    middle = np.array(actor.local(pose.box.center))
    way = middle - point
    way = unit(way * (np.abs(way) >= 0.8 * np.abs(way).max()) + (0.0, 0.0, 1e-6))
    facing = (float(way[0]), float(way[1]), float(way[2]))
    if gesture.grip == "handle":
        facing = (-0.6 * SIDES[side], -0.3, 0.7)
    palm = (float(point[0]), float(point[1]), float(point[2]))
    if gesture.grip == "point":
        # The finger touches it: the palm is a finger's length before it.
        before = point - unit(point - (0.1 * SIDES[side], 0.78 * actor.body.height, 0.0)) * 0.1
        palm = (float(before[0]), float(before[1]), float(before[2]))
        facing = (-0.3 * SIDES[side], -1.0, 0.0)
    return {side: Aim(palm, Hand(gesture.grip or "flat", facing))}


def front_point(places: Places, node: Node, actor: Actor) -> Point | None:
    """The point of a thing's handles, what protrudes from its front, that is nearest to the hands; None without any."""
    pose = places.poses.get(node.id)
    if places.prepared is None or pose is None:
        return None
    closed = replace(node, box=pose.box, yaw=pose.yaw, states=tuple(s for s in node.states if s != "OPEN"))
    found: list[Point] = []
    for thing in places.prepared.things(closed):
        corners = own_mesh(thing).corners.astype(np.float64)
        middles = corners.mean(axis=1)
        front = middles[:, 2] > corners[:, :, 2].max() - PROTRUDING
        chosen = corners[front]
        spread = np.ptp(chosen.reshape(-1, 3), axis=0) / np.maximum(np.ptp(corners.reshape(-1, 3), axis=0), 1e-6)
        if spread[0] * spread[1] > 0.8 and np.ptp(middles[front][:, 0]) < 0.02:
            continue
        turned = replace(actor, spot=(thing.position[0], thing.position[2]), level=thing.position[1], yaw=thing.yaw)
        found += [turned.world((float(x), float(y), float(z))) for x, y, z in middles[front]]
    chest = actor.world((0.1, actor.body.height * 0.62, 0.2))
    return min(found, key=lambda at: sum((a - b) ** 2 for a, b in zip(at, chest, strict=True))) if found else None


PROTRUDING = 0.012
"""Metres behind the foremost point of a thing within which its front's handles are."""


def reach_for(here: Actor, there: Actor, places: Places, step: Step) -> Actor:
    """The character at the moment its hand reaches the object, before the world changes.

    Args:
        here: at its acting position, hands in default pose.
        there: after the step.
        places: before the step.
        step: the step.
    """
    if step.action != "Grab" or there.body_pose.posture == "lying" or not step.objects:
        return there
    target = step.objects[0].node or 0
    held = held_by(places.graph, here.node.id)
    side = acting_side(step, places.graph, here.node.id, held)
    pose = places.poses.get(target)
    if pose is None:
        return there
    aim = thing_aim(here, hold_of_node(_node(places.graph, target), places, side), pose, side)
    aims = {s: Aim(at, there.body_pose.hand(s[0])) for s in SIDES if (at := there.body_pose.target(s[0])) and s in held}
    reaching = replace(there, body_pose=replace(with_aims(there.body_pose, aims | {side: aim}), gaze=aim.palm))
    return at_rest(reaching, places.solids, [side[0]])


def nearest_point(actor: Actor, pose: Pose) -> Point:
    """The point of a box nearest to the chest, in the world."""
    chest = actor.world((0.12, actor.body.height * 0.72, 0.1))
    x, y, z = (min(max(p, c - s / 2), c + s / 2) for p, c, s in zip(chest, pose.box.center, pose.box.size, strict=True))
    return x, y, z


def target_point(step: Step | None, which: str, places: Places, actor: Actor) -> Point | None:
    """The target of the gaze in the world: the nearest point of a step's object."""
    if step is None or not step.objects:
        return None
    ref = step.objects[-1 if which == "second" else 0]
    pose = places.poses.get(ref.node or -1) or reachable(ref.node or -1, places)[0]
    return nearest_point(actor, pose) if pose else None
