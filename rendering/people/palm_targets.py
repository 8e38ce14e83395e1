"""Aims of palms: where they go in a person's frame, to carry what they hold or to reach things that stand somewhere."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hearth.kb.modifiers import value
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose, Hand, Held
from hearth.rendering.people.held_objects import Hold, grip_point, hold_of_node
from hearth.rendering.people.rotations import unit
from hearth.rendering.people.skeleton import PELVIS_ON_SEAT, in_reach
from hearth.rendering.scene.free_poses import Pose
from hearth.rendering.scene.instances import own_mesh
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.object_locations import HANDS
from hearth.schemas.graph import EnvironmentGraph, Node, Point
from hearth.schemas.program import Step

SIDES = {"right": 1.0, "left": -1.0}
OTHER = {"right": "left", "left": "right"}

PROTRUDING = 0.012
"""Metres behind the foremost point of a thing within which its front's handles are."""


class Aim(NamedTuple):
    """The target of a palm, in the person's frame, and the form of its hand."""

    palm: Point
    hand: Hand


Aims = Mapping[str, Aim]
"""By side; a hand without an aim hangs."""


def with_aims(pose: BodyPose, aims: Aims) -> BodyPose:
    """Return a pose with hands where they are aimed."""
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
    """Side -> id of the held object."""
    return {HANDS[e.relation]: e.target for e in graph.edges if e.source == me and e.relation in HANDS}


def node_of(graph: EnvironmentGraph, number: int) -> Node:
    """Return the node of a number."""
    return next(node for node in graph.nodes if node.id == number)


def raised(actor: Actor) -> float:
    """Metres by which hands of a sitting body are lower than of one that stands."""
    if actor.body_pose.posture != "sitting":
        return 0.0
    return actor.body_pose.seat + PELVIS_ON_SEAT * actor.body.height - actor.body.proportions.pelvis


def carrying(actor: Actor, held: Mapping[str, int], graph: EnvironmentGraph, places: Places) -> dict[str, Aim]:
    """Hands that carry what they hold."""
    found: dict[str, Aim] = {}
    h, lower = actor.body.height, raised(actor)
    for side, number in held.items():
        node = node_of(graph, number)
        hold, size = hold_of_node(node, places, side), places.size_of(node)
        x, y, z = (share * h for share in hold.carry)
        # What is tall stands on the floor, or hangs above it.
        y = max(y + lower, hold.point[1] + 0.02)
        if not hold.both:
            palm = (x, y, z + (0.1 if lower else 0.0))
            palm = in_reach(palm, actor.body_pose, actor.body.proportions)
            found[side] = Aim(palm, Hand(hold.grip, hold.palm))
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


def acting_side(step: Step, graph: EnvironmentGraph, me: int, held: Mapping[str, int]) -> str:
    """Return the acting hand: the one that holds the object, else a free one, preferring the right."""
    if asked := value(step, "hand"):
        return asked
    named = {ref.node for ref in step.objects}
    for side, node in sorted(held.items()):
        if node in named:
            return side
    return "left" if "right" in held and "left" not in held else "right"


def thing_aim(actor: Actor, hold: Hold, pose: Pose, side: str) -> Aim:
    """Return the palm at a thing that stands somewhere: at its handle, else on the side nearest to the chest."""
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


def nearest_point(actor: Actor, pose: Pose) -> Point:
    """Return the point of a box nearest to the chest, in the world."""
    chest = actor.world((0.12, actor.body.height * 0.72, 0.1))
    x, y, z = (min(max(p, c - s / 2), c + s / 2) for p, c, s in zip(chest, pose.box.center, pose.box.size, strict=True))
    return x, y, z


def front_point(places: Places, node: Node, actor: Actor) -> Point | None:
    """Return the point of a thing's handles, what protrudes from its front, that is nearest to the hands.

    None without any.
    """
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
