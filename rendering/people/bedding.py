"""Bedding around a person who lies in a bed.

A pillow under the head, a blanket over the legs, the rest next to the body or on top.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, pi, radians, sin

from hearth.homes.object_shapes import form
from hearth.rendering.models.blanket import EMPTY
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.scene.free_poses import Pose
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene_preparation import local_size
from hearth.schemas.graph import Box, Node, Point
from hearth.simulation.world.affordance import is_of_kind

UNDER_HEAD = (0.6, 0.12, 0.4)
"""Width, height and depth in metres of a pillow on which a head lies."""

OVER_LEGS = 0.32
"""Height in metres of a blanket that covers somebody's legs."""

COVER, SPREAD = (0.84, 0.8), 0.8
"""Width of a spread blanket and its least depth, and the depth from which one is spread, metres.
The recipe `folded` drapes what is as wide or as deep."""

OPENED = 0.34
"""Depth in metres of a blanket that is folded back to the foot of the bed."""

HEAD, HIPS = -0.43, 0.01
"""Positions of a lying body's head and hips along it, as shares of its height; its feet are towards +."""

RAISED = 0.3
"""Share of the way of a blanket in which it rises over the feet."""

GRASPED = 0.7
"""Height at which hands hold a blanket's edge, as a share of its greatest."""

PALM = 0.05
"""Distance from a held object up to the middle of a palm, metres."""

LIFTED = 0.12
"""Metres by which bedding is lifted where it is moved."""

EDGE = 0.1
"""Metres between bedding and the head or foot of the bed."""

BESIDE = 0.3
"""Metres across from a lying body's middle, from which a bed is free."""


def turned_back(places: Places, actors: Sequence[Actor]) -> Places:
    """Return the places with the bedding laid around those who lie, and folded back where nobody does any more."""
    poses = dict(places.poses)
    sleepers = {actor.place: actor for actor in actors if actor.body_pose.posture == "lying" and actor.place in poses}
    for bed, nodes in _bedding_on(places).items():
        if bed in sleepers:
            poses |= _Bed.of(sleepers[bed], places).laid(nodes, places)
        else:
            poses |= {node.id: drawn(poses[node.id], 0.0) for node in nodes if covers(poses[node.id])}
    return places if poses == dict(places.poses) else replace(places, poses=poses)


def _bedding_on(places: Places) -> dict[int, list[Node]]:
    """Bedding by the id of the bed."""
    on: dict[int, list[Node]] = {}
    for node in places.graph.nodes:
        location = places.locations.get(node.id)
        lies_on = node.id in places.poses and location is not None and location.kind == "on"
        if lies_on and location is not None and is_of_kind(node.class_name, "bedding", places.knowledge):
            on.setdefault(location.holder, []).append(node)
    return on


def covers(pose: Pose) -> bool:
    """Return whether bedding is a blanket over somebody's legs."""
    return pose.box.size[1] > EMPTY and local_size(pose.box.size, pose.yaw or 0.0)[2] >= SPREAD


def drawn(pose: Pose, share: float) -> Pose:
    """Return a blanket over legs, drawn over them by a share: folded back to the foot at 0, as it is at 1."""
    yaw, (x, y, z) = pose.yaw or 0.0, pose.box.center
    w, high, deep = local_size(pose.box.size, yaw)
    d = OPENED + (deep - OPENED) * share
    h = EMPTY + (high - EMPTY) * min(share / RAISED, 1.0)
    back = (deep - d) / 2
    at = (x + back * sin(radians(yaw)), y - (high - h) / 2, z + back * cos(radians(yaw)))
    return Pose(Box(at, local_size((w, h, d), yaw)), pose.yaw)


def edge(pose: Pose) -> Point:
    """Return the middle of a blanket's upper edge, which hands hold."""
    yaw, (x, y, z), h = pose.yaw or 0.0, pose.box.center, pose.box.size[1]
    half = local_size(pose.box.size, yaw)[2] / 2
    return x - half * sin(radians(yaw)), y + (GRASPED - 0.5) * h + PALM, z - half * cos(radians(yaw))


@dataclass(frozen=True, slots=True)
class Remade:
    """A bed whose bedding differs between two keyframes.

    Attributes:
        moved: poses of bedding before, and once the bed is made for somebody, by id; a blanket is folded back then.
        cover: id of the blanket over somebody's legs; 0 for none.
        over: its pose over them.
    """

    moved: Mapping[int, tuple[Pose, Pose]]
    cover: int = 0
    over: Pose | None = None

    @classmethod
    def between(cls, before: Places, after: Places, bed: int) -> Remade:
        """Differences in a bed between two keyframes' places."""
        moved: dict[int, tuple[Pose, Pose]] = {}
        cover, over = 0, None
        for node in _bedding_on(before).get(bed, ()):
            start, end = before.poses[node.id], after.poses.get(node.id)
            if end is None or start == end or after.locations.get(node.id) != before.locations[node.id]:
                continue
            if covers(start) or covers(end):
                cover, over = node.id, end if covers(end) else start
                folded = drawn(over, 0.0)
                start, end = folded if covers(start) else start, folded
            if start != end:
                moved[node.id] = start, end
        return cls(moved, cover, over)

    def at(self, made: float | None, covered: float | None) -> dict[int, Pose]:
        """Return the poses of bedding that lies otherwise than in the keyframes, by id.

        Args:
            made: share of the way on which things are; None if nobody moves them.
            covered: share by which the blanket is drawn over the legs; None if nobody draws it.
        """
        found = {} if made is None else {number: glided(*ways, made) for number, ways in self.moved.items()}
        if self.over is not None and covered is not None and (covered > 0 or self.cover not in found):
            found[self.cover] = drawn(self.over, covered)
        return found


def glided(start: Pose, end: Pose, share: float) -> Pose:
    """Return a pose between two, in an arc over what lies there; bedding is the same from both ends."""
    turn = ((end.yaw or 0.0) - (start.yaw or 0.0) + 90) % 180 - 90
    yaw = (end.yaw or 0.0) - turn * (1 - share)
    sizes = (local_size(pose.box.size, pose.yaw or 0.0) for pose in (start, end))
    size = tuple(a + (b - a) * share for a, b in zip(*sizes, strict=True))
    x, y, z = (a + (b - a) * share for a, b in zip(start.box.center, end.box.center, strict=True))
    w, h, d = size
    c, s = abs(cos(radians(yaw))), abs(sin(radians(yaw)))
    return Pose(Box((x, y + LIFTED * sin(pi * share), z), (w * c + d * s, h, w * s + d * c)), yaw)


@dataclass(frozen=True, slots=True)
class _Bed:
    """A bed in the frame of the person lying in it: x to the side, z towards the feet.

    Attributes:
        actor: the lying actor.
        top: height of the mattress in that frame.
        middle, size: of the bed's box.
    """

    actor: Actor
    top: float
    middle: Point
    size: Point

    @classmethod
    def of(cls, actor: Actor, places: Places) -> _Bed:
        box = places.poses[actor.place].box
        return cls(actor, actor.body_pose.seat, actor.local(box.center), local_size(box.size, actor.yaw))

    @property
    def free(self) -> tuple[float, float]:
        """Return the range across the bed that is free on the wider side of the lying person."""
        low, high = self.middle[0] - self.size[0] / 2, self.middle[0] + self.size[0] / 2
        return (BESIDE, high) if high > -low else (low, -BESIDE)

    def laid(self, nodes: Sequence[Node], places: Places) -> dict[int, Pose]:
        """Return the poses of its bedding, by id; what would be in another is on top of it."""
        covers = [node for node in nodes if places.knowledge.has(node.class_name, "COVER_OBJECT")]
        pillows = [node for node in nodes if node not in covers]
        wanted = [(node, self._under_head()) for node in pillows[:1]] + [
            (node, self._over_legs()) for node in covers[:1]
        ]
        for others, towards in ((pillows[1:], 1), (covers[1:], -1)):
            boxes = self._beside([_folded(node, places) for node in others], towards)
            wanted += zip(others, boxes, strict=True)
        found: dict[int, Box] = {}
        for node, box in wanted:
            found[node.id] = _lifted(box, [*found.values()])
        return {number: self._pose(box) for number, box in found.items()}

    def _pose(self, box: Box) -> Pose:
        x, y, z = self.actor.world(box.center)
        return Pose(Box((x, y, z), local_size(box.size, self.actor.yaw)), self.actor.yaw)

    def _under_head(self) -> Box:
        w, h, d = UNDER_HEAD
        return Box((0.0, self.top + h / 2, HEAD * self.actor.body.height), (min(w, self.size[0] - 0.1), h, d))

    def _over_legs(self) -> Box:
        start, end = HIPS * self.actor.body.height, self.middle[2] + self.size[2] / 2
        depth = max(min(end, 0.6 * self.actor.body.height) - start, COVER[1])
        width = min(COVER[0], self.size[0])
        return Box((0.0, self.top + OVER_LEGS / 2, start + depth / 2), (width, OVER_LEGS, depth))

    def _beside(self, sizes: Sequence[Point], towards: int) -> Iterator[Box]:
        """Boxes on the free side, in rows from the head (towards 1) or the foot (-1); else at the foot."""
        low, high = self.free
        end = self.middle[2] - self.size[2] / 2 * towards
        for number, (w, h, d) in enumerate(sizes):
            if high - low <= BESIDE:
                yield Box((0.0, self.top + h / 2, self.middle[2] + (self.size[2] - d) / 2), (w, h, d))
                continue
            across = max(1, int((high - low) / w))
            row, column = divmod(number, across)
            x = low + (high - low) / across * (column + 0.5)
            z = end + (EDGE + min(d * (row + 0.5), self.size[2] - EDGE - d / 2)) * towards
            yield Box((x, self.top + h / 2, z), (min(w, high - low), h, d))


def _lifted(box: Box, others: Sequence[Box]) -> Box:
    """Return a box, lifted onto those in which it would be."""
    (x, y, z), (w, h, d) = box
    for (ox, oy, oz), (ow, oh, od) in sorted(others, key=lambda other: other.center[1]):
        beside = abs(x - ox) >= (w + ow) / 2 - 1e-6 or abs(z - oz) >= (d + od) / 2 - 1e-6
        if not beside and abs(y - oy) < (h + oh) / 2 - 1e-6:
            y = oy + (oh + h) / 2
    return Box((x, y, z), (w, h, d))


def _folded(node: Node, places: Places) -> Point:
    """Return the size of bedding that is not spread."""
    if node.box is not None:
        return local_size(node.box.size, node.yaw or 0.0)
    known = form(node.class_name, places.knowledge)
    return known.size if known is not None and all(known.size) else places.size_of(node)
