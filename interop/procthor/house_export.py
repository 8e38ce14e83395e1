"""A home of ours as a house of ProcTHOR. What AI2-THOR has no word for stands in fields of ours, which it ignores."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from hearth.homes.geometry import bottom, footprint, top
from hearth.homes.plans.home_shell import WALL
from hearth.interop.procthor.asset_sizes import Asset
from hearth.interop.procthor.house import EXTENSION
from hearth.interop.procthor.house_reading import panel_key, turned
from hearth.interop.procthor.object_types import model_for, types_of
from hearth.interop.procthor.wall_sides import Side, exterior_id, side_at, sides
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY

PANELS = frozenset({"wall", "floor", "ceiling"})
"""Classes of the parts of a building that a house has in its walls and rooms."""

DOOR, DOORFRAME, WINDOW = "Doorway_1", "Doorframe_1", "Window_Slider_36x36"
"""Models of a door with a leaf, of one without, and of a window."""

WALLS, FLOORS = "PureWhite", "LightWoodCounters 1"
"""Materials of AI2-THOR."""


class WrittenHouse(NamedTuple):
    """A house, the classes that AI2-THOR has no object for, and the relations that a house can't say, as words."""

    data: Mapping[str, Any]
    foreign: tuple[str, ...]
    unsaid: tuple[str, ...]


def house_of(
    graph: EnvironmentGraph, knowledge: Knowledge, assets: Mapping[str, Sequence[Asset]], name: str = ""
) -> WrittenHouse:
    """Return a home with boxes as a house.

    Args:
        graph: of the home.
        knowledge: for classes.
        assets: models with their sizes, by object type; {}: a usual model of each type.
        name: of the home, for faults.

    Raises:
        HearthError: BAD_GRAPH: a node has no box.
    """
    bare = [node for node in graph.nodes if node.box is None and node.class_name != CHARACTER_CLASS]
    if bare or not any(node.category == ROOM_CATEGORY for node in graph.nodes):
        message = f"{bare[0].class_name} ({bare[0].id}) has no box" if bare else "there is no room"
        raise HearthError.of(Code.BAD_GRAPH, message, file=name,
                             suggestion="`home convert HOME OUT --layout` gives boxes to a graph")  # fmt: skip
    return _Export(graph, knowledge, assets).written()


@dataclass
class _Export:
    """The writing of one home, part by part."""

    graph: EnvironmentGraph
    knowledge: Knowledge
    assets: Mapping[str, Sequence[Asset]]
    nodes: dict[int, Node] = field(default_factory=dict)
    rooms: dict[int, str] = field(default_factory=dict)
    inside: dict[int, int] = field(default_factory=dict)
    holders: dict[int, tuple[str, int]] = field(default_factory=dict)
    between: dict[int, list[int]] = field(default_factory=dict)
    unsaid: list[str] = field(default_factory=list)

    def written(self) -> WrittenHouse:
        self._index()
        walls = sides({name: footprint(_box(self.nodes[number])).inset(-WALL) for number, name in self.rooms.items()})
        height = max(_box(self.nodes[number]).size[1] for number in self.rooms)
        objects, others = self._objects()
        person = next((node for node in self.graph.nodes if node.class_name == CHARACTER_CLASS), None)
        panels = {panel_key(node.class_name, _box(node)): node.id for node in self._of(PANELS)}
        own: dict[str, Any] = {"objects": others, "panels": panels}
        metadata: dict[str, Any] = {"roomSpecId": EXTENSION, "schema": "1.0.0", EXTENSION: own}
        if person is not None:
            own["character"] = person.id
            if person.box is not None:
                x, y, z = person.box.center
                metadata["agent"] = {"horizon": 30, "position": _xyz((x, y, z)), "standing": True,
                                     "rotation": _xyz((0, person.yaw or 0, 0))}  # fmt: skip
        data = {
            "rooms": [self._room(number) for number in self.rooms],
            "walls": [wall for side in walls for wall in _walls(side, height)],
            "doors": list(self._doors(walls)),
            "windows": list(self._windows(walls)),
            "objects": objects,
            "proceduralParameters": {"ceilingMaterial": {"name": WALLS}, "floorColliderThickness": 1.0, "lights": [],
                                     "receptacleHeight": 0.7, "reflections": [], "skyboxId": "Sky1"},
            "metadata": metadata,
        }  # fmt: skip
        foreign = Counter(str(each[EXTENSION]["class"]) for each in _all(others))
        return WrittenHouse(data, tuple(sorted(foreign.elements())), tuple(self.unsaid))

    def _index(self) -> None:
        self.nodes = {node.id: node for node in self.graph.nodes}
        numbers = [node.id for node in self.graph.nodes if node.category == ROOM_CATEGORY]
        self.rooms = {number: f"room|{index}" for index, number in enumerate(numbers, 2)}
        for source, relation, target in self.graph.edges:
            node, other = self.nodes.get(source), self.nodes.get(target)
            if node is None or other is None:
                continue
            if relation == "INSIDE" and target in self.rooms:
                self.inside[source] = target
            elif relation == "BETWEEN":
                self.between.setdefault(source, []).append(target)
            elif relation in ("ON", "INSIDE") and other.class_name not in PANELS:
                first = self.holders.setdefault(source, (relation, target))
                if first != (relation, target):
                    self.unsaid.append(f"{node.class_name} ({source}) {relation} {other.class_name} ({target})")

    def _of(self, classes: frozenset[str]) -> Iterator[Node]:
        return (node for node in self.graph.nodes if node.class_name in classes)

    def _room(self, number: int) -> dict[str, Any]:
        node = self.nodes[number]
        rect = footprint(_box(node)).inset(-WALL)
        kind = "".join(word.capitalize() for word in node.class_name.split("_"))
        corners = ((rect.x0, rect.z0), (rect.x0, rect.z1), (rect.x1, rect.z1), (rect.x1, rect.z0))
        return {"id": self.rooms[number], "roomType": kind, "floorMaterial": {"name": FLOORS},
                "floorPolygon": [_xyz((x, 0, z)) for x, z in corners], "ceilings": [], "children": [],
                EXTENSION: {"id": number, "class": node.class_name}}  # fmt: skip

    def _doors(self, walls: Sequence[Side]) -> Iterator[dict[str, Any]]:
        leaves = list(self._of(frozenset({"door", "maindoor"})))
        taken: set[int] = set()
        for number, jamb in enumerate(self._of(frozenset({"doorjamb"}))):
            leaf = min((each for each in leaves if each.id not in taken), default=None,
                       key=lambda each: (_gap(_box(each), _box(jamb)), each.id))  # fmt: skip
            if leaf is not None and _gap(_box(leaf), _box(jamb)) > WALL:
                leaf = None
            taken |= {leaf.id} if leaf is not None else set()
            ends = self.between.get(jamb.id) or (self.between.get(leaf.id) if leaf is not None else None)
            ends = sorted(ends or [self.inside[jamb.id]], key=lambda each: each != self.inside.get(jamb.id))
            rooms = [self.rooms[each] for each in ends if each in self.rooms]
            side = side_at(walls, rooms[0], footprint(_box(jamb)), rooms[1] if len(rooms) > 1 else "")
            if side is None:
                self.unsaid.append(f"doorjamb ({jamb.id}) in no wall")
                continue
            own: dict[str, Any] = {"jamb": jamb.id}
            if leaf is not None:
                own |= {"id": leaf.id, "states": list(leaf.states), **self._hung(leaf, jamb, side)}
            yield {
                "id": f"door|{number}", "assetId": DOORFRAME if leaf is None else DOOR,
                "assetPosition": _middle(side, jamb),
                "holePolygon": _hole(side, _box(jamb)), "openable": leaf is not None,
                "openness": 1 if leaf is not None and "OPEN" in leaf.states else 0,
                "room0": rooms[0], "room1": rooms[-1], "wall0": side.id,
                "wall1": side.behind or exterior_id(side), EXTENSION: own,
            }  # fmt: skip

    def _hung(self, leaf: Node, jamb: Node, side: Side) -> dict[str, str]:
        """Return the room that a leaf opens into, and the end of its hole at which it hangs."""
        x, _, z = _box(leaf).center
        along, middle = (x, _box(jamb).center[0]) if side.along else (z, _box(jamb).center[2])
        into = next(
            (name for number, name in self.rooms.items() if footprint(_box(self.nodes[number])).holds(x, z)), ""
        )
        return {"into": into, "hinge": "low" if along < middle else "high"}

    def _windows(self, walls: Sequence[Side]) -> Iterator[dict[str, Any]]:
        for number, node in enumerate(self._of(frozenset({"window"}))):
            room = self.rooms.get(self.inside.get(node.id, -1), "")
            side = side_at(walls, room, footprint(_box(node)))
            if side is None:
                self.unsaid.append(f"window ({node.id}) in no wall")
                continue
            yield {"id": f"window|{number}", "assetId": WINDOW, "assetPosition": _middle(side, node),
                   "holePolygon": _hole(side, _box(node)), "room0": room, "room1": room, "wall0": side.id,
                   "wall1": exterior_id(side), EXTENSION: {"id": node.id, "states": list(node.states)}}  # fmt: skip

    def _objects(self) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
        """Return the objects that AI2-THOR has, each with those on and in it, and the others."""
        types = types_of(self.knowledge)
        skipped = {*PANELS, CHARACTER_CLASS, "door", "maindoor", "doorjamb", "window"}
        things = [n for n in self.graph.nodes if n.class_name not in skipped and n.id not in self.rooms]
        made = {node.id: self._object(node, types.get(node.class_name, "")) for node in things}
        found: tuple[list[dict[str, Any]], list[dict[str, Any]]] = ([], [])
        for node in things:
            each, foreign = made[node.id], node.class_name not in types
            holder = self.holders.get(node.id, ("", -1))[1]
            if holder in made and (self.nodes[holder].class_name not in types) == foreign:
                made[holder].setdefault("children", []).append(each)
                continue
            if holder in made:
                each[EXTENSION]["holder"] = made[holder]["id"]
            found[foreign].append(each)
        return found

    def _object(self, node: Node, kind: str) -> dict[str, Any]:
        box, yaw = _box(node), node.yaw or 0.0
        size = turned(box.size, yaw)
        own: dict[str, Any] = {"id": node.id, "class": node.class_name, "size": list(size), "states": list(node.states),
                               "room": self.rooms.get(self.inside.get(node.id, -1), "")}  # fmt: skip
        if node.yaw is None:
            own["front"] = False
        if node.id in self.holders:
            own["relation"] = self.holders[node.id][0]
        each: dict[str, Any] = {
            "id": f"{kind or node.class_name}|{node.id}",
            "position": _xyz(box.center),
            "rotation": _xyz((0, yaw, 0)),
        }
        if kind:
            each |= {"assetId": model_for(kind, size, self.assets), "layer": "Procedural0", "material": None,
                     "kinematic": not self.knowledge.has(node.class_name, "GRABBABLE")}  # fmt: skip
            if "CAN_OPEN" in node.properties:
                each["openness"] = 1.0 if "OPEN" in node.states else 0.0
            if "HAS_SWITCH" in node.properties:
                each["isOn"] = "ON" in node.states
        return {**each, EXTENSION: own}


def _walls(side: Side, height: float) -> Iterator[dict[str, Any]]:
    """Yield a room's side of a wall, and the outer side where no room is behind it."""
    corners = [*((x, 0.0, z) for x, z in (side.start, side.end)), *((x, height, z) for x, z in (side.start, side.end))]
    material = {"material": {"name": WALLS}}
    yield {"id": side.id, "roomId": side.room, "polygon": list(map(_xyz, corners)), **material}
    if not side.behind:
        outer = [corners[1], corners[0], corners[3], corners[2]]
        yield {"id": exterior_id(side), "roomId": "exterior", "polygon": list(map(_xyz, outer)), **material}


def _hole(side: Side, box: Box) -> list[dict[str, float]]:
    low, high = side.within(footprint(box))
    return [_xyz((low, bottom(box), 0)), _xyz((high, top(box), 0))]


def _middle(side: Side, node: Node) -> dict[str, float]:
    low, high = side.within(footprint(_box(node)))
    return _xyz(((low + high) / 2, _box(node).center[1], 0))


def _box(node: Node) -> Box:
    assert node.box is not None
    return node.box


def _gap(one: Box, other: Box) -> float:
    a, b = footprint(one), footprint(other)
    return max(a.x0 - b.x1, b.x0 - a.x1, a.z0 - b.z1, b.z0 - a.z1)


def _xyz(values: Sequence[float]) -> dict[str, float]:
    return {axis: round(float(value), 4) for axis, value in zip("xyz", values, strict=True)}


def _all(objects: Sequence[Mapping[str, Any]]) -> Iterator[Mapping[str, Any]]:
    waiting = list(objects)
    while waiting:
        each = waiting.pop()
        yield each
        waiting += each.get("children", [])
