"""Positions of things from relations: boxes for things that were moved, put down or added."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType

from hearth.homes.object_shapes import form
from hearth.kb.knowledge import Knowledge
from hearth.rendering.models.appearance import Look, Region
from hearth.rendering.models.class_appearance import recipe_of
from hearth.rendering.scene.free_poses import Pose, best, lying_flat, overlap
from hearth.rendering.scene.object_locations import BUILDING, HANDS, Location, locations_of, parents_first
from hearth.rendering.scene.scene_preparation import LIQUIDS, PreparedScene, liquid, local_size
from hearth.rendering.scene.solids import Solids, solids_of
from hearth.schemas.graph import Box, EnvironmentGraph, Node, Point, Spot
from hearth.schemas.rng import derive
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY

FITS = 1.5
"""Largest length of a vessel's content that is carried along, as a multiple of the vessel's length."""

NOWHERE: Mapping[int, Spot] = MappingProxyType({})


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
        """Supports that actors do not walk to, such as floors and walls."""
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
        """Return the places of a home as it was built, with its boxes."""
        poses = {node.id: Pose(node.box, node.yaw) for node in home.nodes if node.box}
        return cls(home, locations_of(home), poses, knowledge, prepared)

    def settled(
        self, graph: EnvironmentGraph, near: Mapping[int, Point] | None = None, at: Mapping[int, Spot] = NOWHERE
    ) -> Places:
        """Return the places after the graph changed.

        Things with an unchanged location stay, others get a free position.

        Args:
            graph: of the next keyframe.
            near: character id -> its position; things are put down on that side.
            at: where things are put down, by id.
        """
        nodes = {node.id: node for node in graph.nodes}
        locations = self._along(locations_of(graph), nodes)
        in_hands = _carried(locations)
        poses: dict[int, Pose] = {}
        for node_id in parents_first(nodes, locations):
            node, location = nodes[node_id], locations.get(node_id)
            if node.category in (ROOM_CATEGORY, CHARACTER_CATEGORY, "BodyParts"):
                if node_id in self.poses:
                    poses[node_id] = self.poses[node_id]
                continue
            if node_id in in_hands:
                continue
            pose = self._pose(node, location, nodes, poses, near or {})
            if pose is not None and node_id in at and location is not None and location.kind in ("on", "inside"):
                (x, z), (_, y, _) = at[node_id], pose.box.center
                pose = Pose(Box((x, y, z), pose.box.size), pose.yaw)
            if pose is not None:
                poses[node_id] = pose
        return Places(graph, locations, poses, self.knowledge, self.prepared)

    def nodes(self) -> list[Node]:
        """Return the graph's nodes with their current boxes."""
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
        people: Mapping[int, Point],
    ) -> Pose | None:
        before, old = self.poses.get(node.id), self.locations.get(node.id)
        if location is None or location.holder not in nodes:
            return before
        if before and old == location:
            stood, stands = self.poses.get(location.holder), poses.get(location.holder)
            if location.kind == "room" or stood is None or stands is None or stood == stands:
                return before
        parent, near = nodes[location.holder], tuple(people.values())
        if location.kind == "room" and old is not None:
            left = self.locations.get(old.holder) if before and old.kind in ("on", "inside") else None
            if before and left and left.kind in ("on", "inside") and left.holder in poses:
                # What was in or on a thing that somebody took stays there where that was.
                return self._placed(
                    node, nodes[left.holder], poses[left.holder], left.kind, poses, (before.box.center,)
                )
            if old.kind == "worn" and old.holder in people:
                near = (people[old.holder],)
                parent = self._room_at(near[0], nodes) or parent
            elif left and before:
                near = (before.box.center,)
        support = poses.get(location.holder)
        if location.kind == "room" or parent.class_name == "floor" or support is None:
            return self._on_floor(node, parent, poses, near) if location.kind != "on" or support else before
        return self._in_or_on(node, parent, support, location.kind, poses, near)

    def _along(self, found: Mapping[int, Location], nodes: Mapping[int, Node]) -> Mapping[int, Location]:
        """Locations; what is in or on a vessel that somebody carries stays there, though the rules forget it."""
        kept: dict[int, Location] = {}
        for thing, now in found.items():
            old = self.locations.get(thing)
            if now.kind != "room" or old is None or old.kind not in ("on", "inside") or old.holder not in nodes:
                continue
            if self._goes_along(nodes[thing], nodes[old.holder]):
                kept[thing] = old
        return {**found, **kept} if kept else found

    def _goes_along(self, thing: Node, vessel: Node) -> bool:
        """Return whether a thing stays in or on a vessel that somebody takes."""
        holds = {"RECIPIENT", "CONTAINERS", "SURFACES"} & {*vessel.properties}
        if not holds or "GRABBABLE" not in vessel.properties or "SITTABLE" in vessel.properties:
            return False
        if thing.class_name in LIQUIDS:
            return True
        return "GRABBABLE" in thing.properties and max(self.size_of(thing)) <= FITS * max(self.size_of(vessel))

    def contents(self, vessel: int) -> list[int]:
        """Ids of the things that are in or on one, which go where that goes."""
        return [thing for thing, at in self.locations.items() if at.holder == vessel and at.kind in ("on", "inside")]

    @cached_property
    def packed(self) -> Mapping[int, Mapping[int, Pose]]:
        """Carried thing -> each thing in or on it -> its pose in the frame of the former, foot in the origin."""
        nodes = {node.id: node for node in self.graph.nodes}
        found: dict[int, dict[int, Pose]] = {}
        for number in _carried(self.locations):
            at = self.locations[number]
            if at.kind in ("on", "inside"):
                w, h, d = self.size_of(nodes[at.holder])
                support, beside = Pose(Box((0.0, h / 2, 0.0), (w, h, d)), 0.0), found.setdefault(at.holder, {})
                beside[number] = self._in_or_on(nodes[number], nodes[at.holder], support, at.kind, beside, ())
        return found

    def _room_at(self, point: Point, nodes: Mapping[int, Node]) -> Node | None:
        """Return the room over whose floor a point is."""
        x, _, z = point
        for number, pose in self.poses.items():
            (cx, _, cz), (w, _, d) = pose.box.center, pose.box.size
            inside = abs(x - cx) <= w / 2 and abs(z - cz) <= d / 2
            if inside and number in nodes and nodes[number].category == ROOM_CATEGORY:
                return nodes[number]
        return None

    def _in_or_on(
        self, node: Node, parent: Node, support: Pose, kind: str, poses: Mapping[int, Pose], near: tuple[Point, ...]
    ) -> Pose:
        """Return a pose in or on a thing that has a pose."""
        if node.class_name in LIQUIDS and kind == "inside" and max(support.box.size) < 0.5:
            return Pose(liquid(node, support.box).box or support.box, support.yaw)
        return self._placed(node, parent, support, kind, poses, near)

    def _placed(
        self, node: Node, parent: Node, support: Pose, kind: str, poses: Mapping[int, Pose], near: tuple[Point, ...]
    ) -> Pose:
        """Return the free pose on or in a support with a box that is nearest to a character."""
        recipe = recipe_of(parent.class_name, self.knowledge)
        yaw = support.yaw or 0.0
        known = form(parent.class_name, self.knowledge)
        size = local_size(support.box.size, yaw)
        level = known.levels[0] if known and known.levels and known.levels[0] < size[1] else 0.0
        regions = (recipe.inside if kind == "inside" else recipe.on)(Look(size, level=level, kind=""))
        regions = regions or (Region(0.02, -size[0] * 0.3, size[0] * 0.3, -size[2] * 0.3, size[2] * 0.3, size[1]),)
        wanted = (
            lying_flat(self.size_of(node))
            if kind == "on" and recipe_of(node.class_name, self.knowledge).size[1] < 0.05
            else self.size_of(node)
        )
        others = self._around(support.box, poses, (node.id, parent.id))
        return best(wanted, regions, support, others, near, derive(0, "place", node.id))

    def _around(self, box: Box, poses: Mapping[int, Pose], but: tuple[int, ...]) -> list[Box]:
        """Return the boxes of other things above or in a box."""
        (x, y, z), (w, h, d) = box
        space = Box((x, y + 0.5, z), (w, h + 1.0, d))
        bulky = {node.id for node in self.graph.nodes if node.category == ROOM_CATEGORY}
        found = (pose.box for other, pose in poses.items() if other not in but and other not in bulky)
        return [other for other in found if overlap(other, space) > 0]

    def _on_floor(self, node: Node, room: Node, poses: Mapping[int, Pose], near: tuple[Point, ...]) -> Pose | None:
        """Return a pose on the floor next to a character, else in the middle of the room."""
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
        return best(self.size_of(node), (region,), ground, others + people, tuple(inside), derive(0, "place", node.id))


def _carried(locations: Mapping[int, Location]) -> list[int]:
    """Return the ids of held and worn objects, and of the objects in or on them."""
    found: dict[int, bool] = {}

    def carried(number: int, depth: int = 8) -> bool:
        at = locations.get(number)
        if number not in found:
            vessel = at is not None and at.kind in ("on", "inside") and depth > 0
            found[number] = at is not None and (
                at.kind in ("held", "worn") or (vessel and carried(at.holder, depth - 1))
            )
        return found[number]

    return [number for number in locations if carried(number)]
