"""Things that are pushed or pulled: they slide over the floor, with all that is on and in them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import cos, hypot, radians, sin

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.gestures import gesture_of
from hearth.rendering.scene.free_poses import Pose
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.solids import Solids
from hearth.schemas.graph import Box, Node, Spot
from hearth.schemas.program import Step

SHARES = (1.0, 0.6, 0.3)
"""Shares of the way that are tried until nothing is hit."""

SLIPS = 0.02
"""Distance between a sliding thing and its neighbors, metres."""

FLAT = frozenset({"floor", "mat", "rug", "carpet", "doormat"})
"""Classes on which things slide."""


def slid(places: Places, actors: Sequence[Actor], steps: Sequence[Step]) -> Places:
    """Yield the places after steps that push or pull.

    Away from the pushing actor, or towards the pulling one, as far as there is room.
    """
    poses = dict(places.poses)
    for step in steps:
        way, actor = gesture_of(step).moves, actors[step.agent] if step.agent < len(actors) else None
        target = (step.objects[0].node or 0) if step.objects else 0
        if not way or actor is None or not _slides(places, target):
            continue
        dx, dz = _direction(actor.spot, poses[target].box)
        solids = places.solids
        for share in SHARES:
            by = dx * way * share, dz * way * share
            if _is_free(poses[target].box, by, solids, _with(places, target), actor.spot):
                poses |= {number: _shifted(poses[number], by) for number in _with(places, target) if number in poses}
                break
    return places if poses == dict(places.poses) else replace(places, poses=poses)


def _slides(places: Places, target: int) -> bool:
    """Return whether a thing stands on the floor, and can be moved."""
    nodes: Mapping[int, Node] = {node.id: node for node in places.graph.nodes}
    location, node = places.locations.get(target), nodes.get(target)
    if node is None or target not in places.poses or location is None or "MOVABLE" not in node.properties:
        return False
    holder = nodes.get(location.holder)
    return location.kind == "room" or (location.kind == "on" and holder is not None and holder.class_name in FLAT)


def _with(places: Places, target: int) -> list[int]:
    """Return a thing and all that is on or in it."""
    found = [target]
    for number in found:
        found += places.contents(number)
    return found


def _direction(spot: Spot, box: Box) -> Spot:
    """From a person towards a thing, of length 1."""
    x, z = box.center[0] - spot[0], box.center[2] - spot[1]
    far = max(hypot(x, z), 1e-6)
    return x / far, z / far


def _is_free(box: Box, by: Spot, solids: Solids, without: Sequence[int], spot: Spot) -> bool:
    """Return whether a thing that is moved hits neither others nor the person."""
    (x, y, z), (w, h, d) = box.center, box.size
    x, z = x + by[0], z + by[1]
    for solid in solids.near((x, z), max(w, d) / 2 + SLIPS, without).all:
        reach = _across(solid.half, solid.yaw)
        beside = abs(solid.middle[0] - x) > w / 2 + reach[0] or abs(solid.middle[1] - z) > d / 2 + reach[1]
        if not beside and solid.low < y + h / 2 - SLIPS and solid.high > y - h / 2 + SLIPS:
            return False
    return max(abs(spot[0] - x) - w / 2, abs(spot[1] - z) - d / 2) > 0.12


def _across(half: Spot, yaw: float) -> Spot:
    """Half of the width and depth that a turned thing takes up."""
    c, s = abs(cos(radians(yaw))), abs(sin(radians(yaw)))
    return half[0] * c + half[1] * s, half[0] * s + half[1] * c


def _shifted(pose: Pose, by: Spot) -> Pose:
    (x, y, z), size = pose.box.center, pose.box.size
    return pose._replace(box=Box((x + by[0], y, z + by[1]), size))
