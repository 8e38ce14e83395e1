"""Positions of things from relations: boxes for things that were moved, put down or added."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, radians, sin
from types import MappingProxyType
from typing import NamedTuple

from hearth.homes.forms import form
from hearth.kb.knowledge import Knowledge
from hearth.rendering.models.look import Look, Region
from hearth.rendering.models.looks import recipe_of
from hearth.rendering.scene.prepared import LIQUIDS, PreparedScene, liquid, local_size
from hearth.rendering.scene.solids import Solids, solids_of
from hearth.schemas.graph import Box, EnvironmentGraph, Node, Point, Spot
from hearth.schemas.rng import derive
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY

HANDS = {"HOLDS_RH": "right", "HOLDS_LH": "left"}
BUILDING = frozenset({"floor", "wall", "ceiling", "doorjamb", "window"})
STEP = 0.04
"""Metres between candidate positions."""


NOWHERE: Mapping[int, Spot] = MappingProxyType({})


class Location(NamedTuple):
    """A thing's location in the graph.

    Attributes:
        kind: `held`, `worn`, `on`, `inside`, or `room` if no nearer holder is known.
        holder: id of the character, support, container or room.
    """

    kind: str
    holder: int


class Pose(NamedTuple):
    """A box and its direction."""

    box: Box
    yaw: float | None


@dataclass(frozen=True, eq=False)
class Places:
    """Positions of all things in one keyframe. Immutable; `settled` gives the next.

    Attributes:
        graph: of the keyframe.
        locations: node id -> its location in the graph.
        poses: node id -> box and yaw; held and worn things, and those without a location, are absent.
        knowledge: for recipes and sizes.
        prepared: for the shapes of things; None if they are not known.
    """

    graph: EnvironmentGraph
    locations: Mapping[int, Location]
    poses: Mapping[int, Pose]
    knowledge: Knowledge
    prepared: PreparedScene | None = None

    @cached_property
    def building(self) -> frozenset[int]:
        """Floors, walls and the like: supports that actors do not walk to."""
        return frozenset(node.id for node in self.graph.nodes if node.class_name in BUILDING)

    @cached_property
    def solids(self) -> Solids:
        """The solid things, as far as their shapes are known."""
        return Solids(()) if self.prepared is None else solids_of(self.prepared, self.nodes())

    @cached_property
    def holds(self) -> Mapping[int, Mapping[int, str]]:
        """Character id -> id of each thing that it holds -> `right` or `left`."""
        found: dict[int, dict[int, str]] = {}
        for edge in self.graph.edges:
            if edge.relation in HANDS:
                found.setdefault(edge.source, {})[edge.target] = HANDS[edge.relation]
        return found

    @classmethod
    def start(cls, home: EnvironmentGraph, knowledge: Knowledge, prepared: PreparedScene | None = None) -> Places:
        """The places of a home as it was built, with its boxes."""
        poses = {node.id: Pose(node.box, node.yaw) for node in home.nodes if node.box}
        return cls(home, locations_of(home), poses, knowledge, prepared)

    def settled(
        self, graph: EnvironmentGraph, near: Mapping[int, Point] | None = None, at: Mapping[int, Spot] = NOWHERE
    ) -> Places:
        """The places after the graph changed: things with an unchanged location stay, others get a free position.

        Args:
            graph: of the next keyframe.
            near: character id -> its position; things are put down on that side.
            at: where things are put down, by id.
        """
        locations = locations_of(graph)
        nodes = {node.id: node for node in graph.nodes}
        poses: dict[int, Pose] = {}
        for node_id in _parents_first(nodes, locations):
            node, location = nodes[node_id], locations.get(node_id)
            if node.category in (ROOM_CATEGORY, CHARACTER_CATEGORY, "BodyParts"):
                if node_id in self.poses:
                    poses[node_id] = self.poses[node_id]
                continue
            pose = self._pose(node, location, nodes, poses, tuple((near or {}).values()))
            if pose is not None and node_id in at and location is not None and location.kind in ("on", "inside"):
                (x, z), (_, y, _) = at[node_id], pose.box.center
                pose = Pose(Box((x, y, z), pose.box.size), pose.yaw)
            if pose is not None:
                poses[node_id] = pose
        return Places(graph, locations, poses, self.knowledge, self.prepared)

    def nodes(self) -> list[Node]:
        """The graph's nodes with their current boxes."""
        found = []
        for node in self.graph.nodes:
            pose = self.poses.get(node.id)
            if pose is None:
                found.append(replace(node, box=None) if node.box else node)
            else:
                same = node.box == pose.box and node.yaw == pose.yaw
                found.append(node if same else replace(node, box=pose.box, yaw=pose.yaw))
        return found

    def size_of(self, node: Node) -> Point:
        """Width, height and depth of a thing in its own frame."""
        pose = self.poses.get(node.id)
        if pose:
            return local_size(pose.box.size, pose.yaw or 0.0)
        if node.box:
            return local_size(node.box.size, node.yaw or 0.0)
        known = form(node.class_name, self.knowledge)
        return known.size if known and all(known.size) else recipe_of(node.class_name, self.knowledge).size

    def _pose(
        self,
        node: Node,
        location: Location | None,
        nodes: Mapping[int, Node],
        poses: Mapping[int, Pose],
        near: tuple[Point, ...],
    ) -> Pose | None:
        before = self.poses.get(node.id)
        if location is None or location.kind in ("held", "worn"):
            return before if location is None else None
        if before and self.locations.get(node.id) == location:
            old, new = self.poses.get(location.holder), poses.get(location.holder)
            if location.kind == "room" or old is None or new is None or old == new:
                return before
        parent = nodes.get(location.holder)
        if parent is None:
            return before
        support = poses.get(location.holder)
        if location.kind == "room" or parent.class_name == "floor" or support is None:
            return self._on_floor(node, parent, poses, near) if location.kind != "on" or support else before
        if node.class_name in LIQUIDS and location.kind == "inside" and max(support.box.size) < 0.5:
            return Pose(liquid(node, support.box).box or support.box, support.yaw)
        return self._placed(node, parent, support, location.kind, poses, near)

    def _placed(
        self, node: Node, parent: Node, support: Pose, kind: str, poses: Mapping[int, Pose], near: tuple[Point, ...]
    ) -> Pose:
        """The free pose on or in a support with a box that is nearest to a character."""
        recipe = recipe_of(parent.class_name, self.knowledge)
        yaw = support.yaw or 0.0
        known = form(parent.class_name, self.knowledge)
        size = local_size(support.box.size, yaw)
        level = known.levels[0] if known and known.levels and known.levels[0] < size[1] else 0.0
        regions = (recipe.inside if kind == "inside" else recipe.on)(Look(size, level=level, kind=""))
        regions = regions or (Region(0.02, -size[0] * 0.3, size[0] * 0.3, -size[2] * 0.3, size[2] * 0.3, size[1]),)
        wanted = (
            _lying_flat(self.size_of(node))
            if kind == "on" and recipe_of(node.class_name, self.knowledge).size[1] < 0.05
            else self.size_of(node)
        )
        others = self._around(support.box, poses, (node.id, parent.id))
        return _best(wanted, regions, support, others, near, derive(0, "place", node.id))

    def _around(self, box: Box, poses: Mapping[int, Pose], but: tuple[int, ...]) -> list[Box]:
        """The boxes of other things above or in a box."""
        (x, y, z), (w, h, d) = box
        space = Box((x, y + 0.5, z), (w, h + 1.0, d))
        bulky = {node.id for node in self.graph.nodes if node.category == ROOM_CATEGORY}
        found = (pose.box for other, pose in poses.items() if other not in but and other not in bulky)
        return [other for other in found if _overlap(other, space) > 0]

    def _on_floor(self, node: Node, room: Node, poses: Mapping[int, Pose], near: tuple[Point, ...]) -> Pose | None:
        """A pose on the floor beside a character, else in the middle of the room."""
        base = poses.get(room.id)
        if base is None:
            return self.poses.get(node.id)
        (x, y, z), (w, h, d) = base.box.center, base.box.size
        top = y + h / 2 if room.class_name == "floor" else y - h / 2
        ground = Pose(Box((x, top, z), (w, 0.0, d)), 0.0)
        region = Region(0.0, -w / 2 + 0.1, w / 2 - 0.1, -d / 2 + 0.1, d / 2 - 0.1)
        others = self._around(Box((x, top + 0.05, z), (w, 0.1, d)), poses, (node.id, room.id))
        people = [Box((px, top + 0.9, pz), (0.4, 1.8, 0.4)) for px, _, pz in near]
        inside = [p for p in near if abs(p[0] - x) < w / 2 and abs(p[2] - z) < d / 2]
        return _best(self.size_of(node), (region,), ground, others + people, tuple(inside), derive(0, "place", node.id))


def locations_of(graph: EnvironmentGraph) -> dict[int, Location]:
    """The most specific location of every thing: hand, wearer, support, container or room."""
    nodes = {node.id: node for node in graph.nodes}
    ranks = {"held": 0, "worn": 1, "on": 2, "inside": 3, "on building": 4, "room": 5}
    best: dict[int, tuple[int, int, Location]] = {}
    for edge in graph.edges:
        kind, thing, holder = _read(edge.relation, edge.source, edge.target, nodes)
        if not kind:
            continue
        rank = (ranks[kind], holder, Location(kind.removesuffix(" building"), holder))
        if thing not in best or rank < best[thing]:
            best[thing] = rank
    return {thing: found[2] for thing, found in sorted(best.items())}


def _read(relation: str, source: int, target: int, nodes: Mapping[int, Node]) -> tuple[str, int, int]:
    """(kind, thing, holder) of the location that an edge gives; kind is empty if it gives none."""
    if source not in nodes or target not in nodes:
        return "", source, target
    if relation in HANDS:
        return "held", target, source
    if nodes[source].category == CHARACTER_CATEGORY:
        return "", source, target
    if relation == "ON":
        if nodes[target].category == CHARACTER_CATEGORY:
            return "worn", source, target
        return "on building" if nodes[target].class_name in BUILDING else "on", source, target
    if relation == "INSIDE":
        return "room" if nodes[target].category == ROOM_CATEGORY else "inside", source, target
    return "", source, target


def _parents_first(nodes: Mapping[int, Node], locations: Mapping[int, Location]) -> list[int]:
    """Ids, each after its support or container."""
    done: dict[int, None] = {}

    def visit(node_id: int, trail: tuple[int, ...]) -> None:
        location = locations.get(node_id)
        if location and location.holder in nodes and location.holder not in done and location.holder not in trail:
            visit(location.holder, (*trail, node_id))
        done.setdefault(node_id)

    # Things that stay come first: low ids are the home's own.
    for node_id in sorted(nodes):
        visit(node_id, ())
    return list(done)


def _lying_flat(size: Point) -> Point:
    """The size of a flat thing lying down."""
    w, h, d = size
    return (w, d, h) if h > d else size


def _best(
    size: Point, regions: Iterable[Region], support: Pose, others: list[Box], near: tuple[Point, ...], seed: int
) -> Pose:
    """The free pose nearest to a character, in the first region that has one; stacked if none has."""
    yaw = support.yaw or 0.0
    fallback: tuple[float, Pose] | None = None
    for region in regions:
        fitted = _fitted(size, region)
        for pose in _candidates(fitted, region, support, yaw, near, seed):
            crowd = sum(_overlap(pose.box, other) for other in others)
            if crowd <= 1e-9:
                return pose
            if fallback is None or crowd < fallback[0]:
                fallback = (crowd, pose)
    assert fallback is not None
    return _stacked(fallback[1], others)


def _fitted(size: Point, region: Region) -> Point:
    """The size, scaled down to fit the region."""
    room = (region.x1 - region.x0, region.clear, region.z1 - region.z0)
    share = min(1.0, *(max(r, 0.01) / max(s, 1e-6) for r, s in zip(room, size, strict=True)))
    return size[0] * share, size[1] * share, size[2] * share


def _candidates(
    size: Point, region: Region, support: Pose, yaw: float, near: tuple[Point, ...], seed: int
) -> list[Pose]:
    """Candidate poses all over a region, best first."""
    (cx, cy, cz), height = support.box.center, support.box.size[1]
    c, s = cos(radians(yaw)), sin(radians(yaw))
    y = cy - height / 2 + region.y + size[1] / 2 + 0.001
    xs = _ticks(region.x0 + size[0] / 2, region.x1 - size[0] / 2)
    zs = _ticks(region.z0 + size[2] / 2, region.z1 - size[2] / 2)
    found = []
    for i, x in enumerate(xs):
        for k, z in enumerate(zs):
            at = (cx + x * c + z * s, y, cz - x * s + z * c)
            away = min((abs(at[0] - p[0]) + abs(at[2] - p[2]) for p in near), default=0.0)
            middle = abs(x) * 0.3 + abs(z - (region.z0 + region.z1) / 2) * 0.15
            found.append((round(away * 0.7 + middle + 0.02 * ((seed + i * 7919 + k * 104729) % 101) / 101, 6), at))
    w, d = (size[0], size[2]) if abs(c) > abs(s) else (size[2], size[0])
    return [Pose(Box(at, (w, size[1], d)), yaw) for _, at in sorted(found)]


def _ticks(low: float, high: float) -> list[float]:
    if high <= low:
        return [(low + high) / 2]
    count = min(max(1, int((high - low) / STEP)), 40)
    return [low + (high - low) * k / count for k in range(count + 1)]


def _overlap(a: Box, b: Box) -> float:
    """Volume of the intersection of two boxes."""
    volume = 1.0
    for p, q, s, t in zip(a.center, b.center, a.size, b.size, strict=True):
        side = (s + t) / 2 - abs(p - q)
        if side <= 1e-4:
            return 0.0
        volume *= min(side, s, t)
    return volume


def _stacked(pose: Pose, others: list[Box]) -> Pose:
    """The pose lifted onto things at its position that are small enough to carry it."""
    (x, y, z), size = pose.box.center, pose.box.size
    low = y - size[1] / 2
    tops = [o.center[1] + o.size[1] / 2 for o in others if _overlap(pose.box, o) > 1e-9 and o.size[1] < 0.35]
    return Pose(Box((x, max([low, *tops]) + size[1] / 2, z), size), pose.yaw)
