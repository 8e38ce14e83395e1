"""Hands that act: the aims of each kind of gesture on the object of a step."""

from collections.abc import Callable, Mapping
from math import radians, sin

import numpy as np

from hearth.kb.modifiers import value
from hearth.rendering.people.action_poses import Actor, reachable
from hearth.rendering.people.body_pose import Hand, Held
from hearth.rendering.people.free_gestures import free_aims
from hearth.rendering.people.gestures import Gesture
from hearth.rendering.people.held_objects import hold_of_node
from hearth.rendering.people.own_body_targets import PLACE_OF, at_body
from hearth.rendering.people.palm_targets import (
    OTHER,
    SIDES,
    Aim,
    acting_side,
    carrying,
    front_point,
    nearest_point,
    node_of,
    raised,
    thing_aim,
)  # fmt: skip
from hearth.rendering.people.rotations import unit
from hearth.rendering.scene.object_boxes import Places
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Step

ABOVE = 0.12
"""Metres above a vessel from which is poured into it."""

ACROSS = 0.1
"""Metres beyond the middle of the body from which on a hand reaches across it."""

TEETH = "teeth"
"""The part of the body that is washed at the mouth."""

TILTED, DRINKING = 80.0, 38.0
"""Degrees by which a pouring vessel, and one at the mouth, are tilted."""


def gesturing(
    gesture: Gesture, actor: Actor, held: Mapping[str, int], graph: EnvironmentGraph, places: Places, step: Step | None
) -> dict[str, Aim]:
    """Return the aims of the hands that act."""
    if step is None or not gesture.hand:
        return {}
    acting = _acting(gesture, actor, held, graph, places, step)
    named = [ref.node or 0 for ref in step.objects]
    about = named[min(gesture.about, len(named) - 1)] if named else 0
    makers = {
        "put": lambda: _putting(actor, named[0] if named else 0, acting, graph, places),
        "pour": lambda: _pouring(actor, held, acting, about, graph, places),
        "mouth": lambda: _to_mouth(actor, held, acting, graph, places),
        "type": lambda: _typing(actor, about, places),
        "read": lambda: _reading(actor, held, acting, graph, places),
        "wear": lambda: at_body(actor, node_of(graph, about).class_name if about else "", acting, held, "sheet"),
        "free": lambda: free_aims(gesture.free, actor, carrying(actor, held, graph, places)),
        "wave": lambda: _waving(actor, acting),
        "rub": lambda: _rubbing(actor, held, acting, about, graph, places),
        "push": lambda: _pushing(actor, held, about, places),
        "object": lambda: _by_nearer_hand(
            lambda side: _touching(gesture, actor, side, about, graph, places), acting, held, bool(value(step, "hand"))
        ),
    }
    return makers[gesture.hand]()


def _acting(
    gesture: Gesture, actor: Actor, held: Mapping[str, int], graph: EnvironmentGraph, places: Places, step: Step
) -> str:
    """Return the acting hand: the one that holds a tool of the gesture, unless a hand is asked for."""
    if gesture.tools and not value(step, "hand"):
        for side, number in sorted(held.items(), reverse=True):
            name = node_of(graph, number).class_name
            if {*gesture.tools} & {name, *places.knowledge.ancestors(name)}:
                return side
    return acting_side(step, graph, actor.node.id, held)


def _putting(actor: Actor, thing: int, side: str, graph: EnvironmentGraph, places: Places) -> dict[str, Aim]:
    """Return the hand where the thing has been put down."""
    pose = places.poses.get(thing)
    if pose is None:
        return {}
    return {side: thing_aim(actor, hold_of_node(node_of(graph, thing), places, side), pose, side)}


def _pouring(
    actor: Actor, held: Mapping[str, int], side: str, target: int, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """Tilt the held object over the target."""
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None or side not in held:
        return {}
    node = node_of(graph, held[side])
    hold, size, sign = hold_of_node(node, places, side), places.size_of(node), SIDES[side]
    x, y, z = actor.local(pose.box.center)
    top = y + pose.box.size[1] / 2
    # Tilted to the other side, the lip is next to the hand.
    out = 0.5 * size[1] * sin(radians(TILTED)) + 0.02
    palm = (x + sign * out, top + ABOVE + 0.35 * size[1], z - 0.02)
    stream = (x, y, z)
    held_so = Held(roll=-sign * TILTED, stream=stream)
    return {side: Aim(palm, Hand(hold.grip, (-sign, -0.2, 0.1), 25.0, held_so))}


def _to_mouth(
    actor: Actor, held: Mapping[str, int], side: str, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """Bring the rim of the held object to the mouth; an empty hand goes there itself."""
    joints, h, sign = actor.figure().joints(), actor.body.height, SIDES[side]
    head = joints["head"]
    mouth = (float(head[0]), float(head[1]) - 0.045 * h, float(head[2]) + 0.085 * h / 1.7)
    if side not in held:
        before = (mouth[0] + sign * 0.02, mouth[1] - 0.02, mouth[2] + 0.03)
        return {side: Aim(before, Hand("pinch", (-sign, 0.2, -0.6)))}
    node = node_of(graph, held[side])
    hold, size = hold_of_node(node, places, side), places.size_of(node)
    if not {"RECIPIENT", "DRINKABLE", "POURABLE"} & set(node.properties):
        # Food comes to the lips with its nearest end, from below.
        palm = (mouth[0] + sign * 0.02, mouth[1] - 0.5 * size[1] - 0.02, mouth[2] + 0.5 * min(size[0], size[2]) + 0.01)
        return {side: Aim(palm, Hand(hold.grip, (-sign, 0.3, -0.5), 15.0))}
    lift = min(size[1], 0.3)
    tilt = radians(DRINKING)
    # The rim's near edge is at the lips: from there to the grip point.
    down = lift - min(hold.point[1], lift)
    near = min(size[0], size[2]) / 2
    palm = (mouth[0] + sign * min(abs(hold.point[0]), 0.06), mouth[1] - down * 0.8, mouth[2] + near + down * sin(tilt))
    return {side: Aim(palm, Hand(hold.grip, (-sign, 0.0, -0.2), 20.0, Held(pitch=DRINKING)))}


def _waving(actor: Actor, side: str) -> dict[str, Aim]:
    """Raise a hand next to the head."""
    sign = SIDES[side]
    return {side: Aim((sign * 0.3, 0.94 * actor.body.height + raised(actor), 0.2), Hand("flat", (0.0, 0.0, 1.0)))}


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
    """Hold the object open before the chest, with both hands if the other is free."""
    if side not in held:
        return {}
    node, h, lower, sign = node_of(graph, held[side]), actor.body.height, raised(actor), SIDES[side]
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
    """Move a hand, or the tool in it, on the wiped or washed object; a held object is rubbed by the other hand."""
    if target in held.values():
        holder = next(s for s, node in held.items() if node == target)
        found = carrying(actor, {holder: target}, graph, places)
        x, y, z = found[holder].palm
        node = node_of(graph, target)
        middle = -SIDES[holder] * 0.5 * places.size_of(node)[0]
        other = OTHER[holder]
        found[other] = Aim((x + middle, y + 0.03, z), Hand("flat", (SIDES[holder], -0.4, 0.0)))
        return found
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None:
        return _on_body(actor, held, side, target, graph, places)
    x, y, z = actor.local(nearest_point(actor, pose))
    center = actor.local(pose.box.center)
    way = unit(np.array(center) - (x, y, z) + np.array((0.0, -1e-3, 0.0)))
    facing = (0.0, -1.0, 0.15) if y >= center[1] else (float(way[0]), float(way[1]), float(way[2]))
    if side not in held:
        return {side: Aim((x, y, z), Hand("flat", facing))}
    node = node_of(graph, held[side])
    hold, size = hold_of_node(node, places, side), places.size_of(node)
    tall = size[1] > 0.6
    above = hold.point[1] if tall else 0.5 * size[1] + 0.01
    return {side: Aim((x, y + above, z), Hand(hold.grip, hold.palm if tall else facing))}


def _on_body(
    actor: Actor, held: Mapping[str, int], side: str, target: int, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """Return a hand, or what it holds, on a part of one's own body; nothing if the target is none."""
    name = node_of(graph, target).class_name if target else ""
    if name == TEETH:
        return _to_mouth(actor, held, side, graph, places)
    if name not in PLACE_OF:
        return {}
    tool = hold_of_node(node_of(graph, held[side]), places, side).grip if side in held else "flat"
    return at_body(actor, name, side, held, tool)


def _pushing(actor: Actor, held: Mapping[str, int], target: int, places: Places) -> dict[str, Aim]:
    """Lay flat hands on the near side of the pushed or pulled object."""
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


def _by_nearer_hand(
    touch: Callable[[str], dict[str, Aim]], side: str, held: Mapping[str, int], asked: bool
) -> dict[str, Aim]:
    """Return a touch by the hand that is meant.

    By the other, if both are free and the first would reach across the body.
    """
    found = touch(side)
    across = any(SIDES[side] * aim.palm[0] < -ACROSS for aim in found.values())
    return touch(OTHER[side]) if across and not held and not asked else found


def _touching(
    gesture: Gesture, actor: Actor, side: str, target: int, graph: EnvironmentGraph, places: Places
) -> dict[str, Aim]:
    """Return a hand on an object: at its handle if the gesture opens it, else at the nearest point."""
    pose = places.poses.get(target) or reachable(target, places)[0]
    if pose is None:
        return _on_body(actor, {}, side, target, graph, places)
    handle = front_point(places, node_of(graph, target), actor) if gesture.grip == "handle" else None
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
