"""Scene graphs as Unity writes them, and the changes that a graph of a client asks for."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from math import cos, radians, sin
from typing import Any

from hearth.homes.node_defaults import filled
from hearth.interop.virtualhome.unity_class_names import means, to_unity
from hearth.kb.knowledge import Knowledge
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.scene.object_boxes import Places
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node, from_release, to_release
from hearth.schemas.vocabulary import (
    CHARACTER_CATEGORY,
    CHARACTER_CLASS,
    EVERY_STATE_ID,
    OPPOSITE,
    RELATION_ID,
    RELATIONS,
    ROOM_CATEGORY,
    STATES,
)

MOST_NODES = 20_000
"""Nodes of a graph that a client sends."""

HELD = ("ON", "INSIDE")
"""Relations that say where a thing is."""

IN_HAND = ("HOLDS_RH", "HOLDS_LH")
"""Relations that say which hand holds a thing."""


def unity_graph(graph: EnvironmentGraph, places: Places, actors: Iterable[Actor]) -> dict[str, Any]:
    """Return a graph as Unity writes it: its names, boxes as things lie now, and transforms.

    A thing in a hand has the box of the hand, a character that of its place.
    """
    boxes = {node.id: (node.box, node.yaw) for node in places.nodes() if node.box is not None}
    for actor in actors:
        x, y, z = actor.position
        boxes[actor.node.id] = (Box((x, y + 0.85, z), (0.45, 1.7, 0.45)), actor.yaw)
        for held, side in places.holds.get(actor.node.id, {}).items():
            boxes[held] = (Box(actor.hand(side), (0.1, 0.1, 0.1)), actor.yaw)
    data = to_release(graph)
    for row in data["nodes"]:
        row["class_name"] = to_unity(row["class_name"])
        row["prefab_name"] = row["prefab_name"] or row["class_name"]
        box, yaw = boxes.get(row["id"], (None, None))
        if box is not None:
            row["bounding_box"] = {"center": list(box.center), "size": list(box.size)}
            row["obj_transform"] = _transform(box, yaw or 0.0)
    return data


def _transform(box: Box, yaw: float) -> dict[str, list[float]]:
    half = radians(yaw) / 2
    return {"position": list(box.center), "rotation": [0.0, sin(half), 0.0, cos(half)], "scale": [1.0, 1.0, 1.0]}


@dataclass
class GraphChange:
    """The changes that a client's graph asks for.

    Attributes:
        add: new nodes, without relations.
        remove: ids of nodes that the graph lacks.
        place: node id -> relation and holder, holders first.
        set: states that nodes enter.
        clear: states that nodes leave.
        boxes: node id -> its box, of known nodes that are elsewhere or of another size.
    """

    add: list[Node] = field(default_factory=list)
    remove: list[int] = field(default_factory=list)
    place: dict[int, tuple[str, int]] = field(default_factory=dict)
    set: list[tuple[int, str]] = field(default_factory=list)
    clear: list[tuple[int, str]] = field(default_factory=list)
    boxes: dict[int, Box] = field(default_factory=dict)

    def as_json(self) -> dict[str, Any]:
        """Return the ids of changed nodes, by kind."""
        return {
            "added": [node.id for node in self.add],
            "removed": self.remove,
            "placed": list(self.place),
            "states": sorted({node for node, _ in (*self.set, *self.clear)}),
            "boxes": sorted(self.boxes),
        }


def read_graph(data: Mapping[str, Any], now: EnvironmentGraph, knowledge: Knowledge) -> EnvironmentGraph:
    """Return a client's graph by our names.

    Raises:
        HearthError: FILE_TOO_LARGE; BAD_GRAPH or UNKNOWN_OBJECT, each fault by name.
    """
    nodes, edges = data.get("nodes"), data.get("edges")
    if isinstance(nodes, list) and isinstance(edges, list) and max(len(nodes), len(edges) // 20) > MOST_NODES:
        raise HearthError.of(Code.FILE_TOO_LARGE, f"a graph of {len(nodes):,} nodes and {len(edges):,} edges",
                             suggestion=f"at most {MOST_NODES:,} nodes")  # fmt: skip
    known = {node.id: node.class_name for node in now.nodes}
    faults: list[Diagnostic] = []
    renamed = dict(data)
    if isinstance(nodes, list):
        renamed["nodes"] = [_renamed(node, known, knowledge, faults) for node in nodes]
    if faults:
        raise HearthError(faults)
    return from_release(filled(renamed, knowledge).data)


def _renamed(node: Any, known: Mapping[int, str], knowledge: Knowledge, faults: list[Diagnostic]) -> Any:
    """Return a node with the class of ours that its name means.

    A new node has the properties of its class where the client gives none, as those of Unity's models are known there.
    """
    if not isinstance(node, dict) or not isinstance(node.get("class_name"), str) or type(node.get("id")) is not int:
        return node
    name, number = node["class_name"], node["id"]
    if number in known:
        if not means(name, known[number], knowledge):
            message = f"node {number} is a `{to_unity(known[number])}`, and the graph calls it `{name[:60]}`"
            faults.append(Diagnostic(Code.BAD_GRAPH, message, suggestion="give a new thing a new id"))
        return {**node, "class_name": known[number]}
    found = knowledge.object_class(name.strip().lower())
    if found is None:
        near = knowledge.suggest(name)
        hint = f"did you mean `{near[0]}`?" if near else ""
        faults.append(Diagnostic(Code.UNKNOWN_OBJECT, f"no class is called `{name[:60]}`", suggestion=hint))
        return node
    said = {key: value for key, value in node.items() if value not in (None, [])}
    return {**said, "class_name": found.name}


def change_between(now: EnvironmentGraph, wanted: EnvironmentGraph, moved: Mapping[int, Box]) -> GraphChange:
    """Return what a wanted graph changes in that of now. Nearness and facing follow from places, and are not read.

    Args:
        now: of the scene.
        wanted: of a client.
        moved: the boxes of the scene, to see which the client changed.

    Raises:
        HearthError: BAD_GRAPH: every contradiction of the graph.
    """
    faults = [*_contradictions(now, wanted)]
    if faults:
        raise HearthError(faults)
    found = GraphChange()
    before, after = _by_id(now), _by_id(wanted)
    found.remove = sorted(before.keys() - after.keys())
    found.add = [node for number, node in sorted(after.items()) if number not in before]
    rooms = {number for number, node in after.items() if node.category == ROOM_CATEGORY}
    held_now, held_then = _holders(now, rooms), _holders(wanted, rooms)
    people = {n for n, node in after.items() if node.category == CHARACTER_CATEGORY and n in before}
    changed = [number for number in after if number not in people and number not in rooms]
    places = {n: held_then[n] for n in changed if n in held_then and held_then[n] != held_now.get(n)}
    order, _ = _in_order({number: (holder,) for number, (_, holder) in places.items()})
    found.place = {number: places[number] for number in order}
    for number, node in sorted(after.items()):
        old = before.get(number)
        if old is None:
            continue
        found.set += [(number, state) for state in node.states if state not in old.states]
        gone = [state for state in old.states if state not in node.states]
        found.clear += [(number, state) for state in gone if OPPOSITE.get(state) not in node.states]
        if node.box is not None and number in moved and not _same(node.box, moved[number]):
            found.boxes[number] = node.box
    return found


def _by_id(graph: EnvironmentGraph) -> dict[int, Node]:
    return {node.id: node for node in graph.nodes}


def _holders(graph: EnvironmentGraph, rooms: Iterable[int]) -> dict[int, tuple[str, int]]:
    """Return where each thing is: on or in another thing, else in its room."""
    found: dict[int, tuple[str, int]] = {}
    for edge in graph.edges:
        if edge.relation in HELD and (edge.source not in found or edge.target not in rooms):
            found[edge.source] = (edge.relation, edge.target)
    return found


def _in_order(above: Mapping[int, Collection[int]]) -> tuple[list[int], set[int]]:
    """Return things after their holders, and the things that are in circles, or on such."""
    left = {number: {holder for holder in holders if holder in above} for number, holders in above.items()}
    bears: dict[int, list[int]] = {}
    for number, holders in left.items():
        for holder in holders:
            bears.setdefault(holder, []).append(number)
    waiting = sorted((number for number, holders in left.items() if not holders), reverse=True)
    order: list[int] = []
    while waiting:
        order.append(waiting.pop())
        for number in bears.get(order[-1], ()):
            left[number].discard(order[-1])
            if not left[number]:
                waiting.append(number)
    return order, above.keys() - set(order)


def _same(one: Box, other: Box) -> bool:
    pairs = zip((*one.center, *one.size), (*other.center, *other.size), strict=True)
    return all(abs(a - b) < 1e-3 for a, b in pairs)


def _contradictions(now: EnvironmentGraph, wanted: EnvironmentGraph) -> Iterable[Diagnostic]:
    """Yield every fault for which no scene can be as a graph says."""
    nodes: dict[int, Node] = {}
    for node in wanted.nodes:
        if node.id in nodes:
            yield _fault(f"two nodes have the id {node.id}", "give each its own")
        nodes[node.id] = node
        for state in node.states:
            if state not in EVERY_STATE_ID and node.class_name != CHARACTER_CLASS:  # characters are STANDING
                yield _fault(f"{_label(node)} has the unknown state {state[:40]}", f"states: {', '.join(STATES)}")
            if OPPOSITE.get(state) in node.states and state < OPPOSITE[state]:
                yield _fault(f"{_label(node)} is both {state} and {OPPOSITE[state]}", "keep one of them")
    for node in now.nodes:
        if node.category == ROOM_CATEGORY and node.id not in nodes:
            yield _fault(f"the graph lacks the room {_label(node)}", "rooms stay; `reset` takes another home")
    known = {node.id for node in now.nodes}
    for node in nodes.values():
        if node.id not in known and (node.category == ROOM_CATEGORY or node.class_name == CHARACTER_CLASS):
            remedy = "`add_character`" if node.class_name == CHARACTER_CLASS else "`reset` takes another home"
            yield _fault(f"a graph does not add {_label(node)}", remedy)
    yield from _impossible_places(now, wanted, nodes)


def _impossible_places(
    now: EnvironmentGraph, wanted: EnvironmentGraph, nodes: Mapping[int, Node]
) -> Iterable[Diagnostic]:
    rooms = {number for number, node in nodes.items() if node.category == ROOM_CATEGORY}
    had = {(edge.source, edge.relation, edge.target) for edge in now.edges}
    above: dict[int, set[tuple[str, int]]] = {}
    housed: set[int] = set()
    for edge in wanted.edges:
        for end in (edge.source, edge.target):
            if end not in nodes:
                yield _fault(f"{_edge(edge)}: there is no node {end}", "remove the edge")
        if edge.relation not in RELATION_ID:
            yield _fault(f"{_edge(edge)}: no relation has that name", f"relations: {', '.join(RELATIONS)}")
        if edge.relation in IN_HAND and (edge.source, edge.relation, edge.target) not in had:
            yield _fault(f"{_edge(edge)}: a graph puts nothing into hands", "a script does, with [grab]")
        if edge.relation in HELD and edge.source in nodes and edge.target in nodes:
            housed.add(edge.source)
            if edge.target not in rooms:
                above.setdefault(edge.source, set()).add((edge.relation, edge.target))
    _, circles = _in_order({number: {holder for _, holder in places} for number, places in above.items()})
    for number, places in above.items():
        new = any((number, *place) not in had for place in places)
        if len(places) > 1 and new:
            there = sorted(places, key=lambda place: (place[1], place[0]))[:3]
            names = " and ".join(f"{relation} {_label(nodes[holder])}" for relation, holder in there)
            yield _fault(f"{_label(nodes[number])} is {names} at once", "remove the edge to the old place")
        if new and number in circles:
            yield _fault(f"{_label(nodes[number])} is on or in itself, by others between", "break the circle")
    known = {node.id for node in now.nodes}
    for number in nodes.keys() - known - housed - rooms:
        yield _fault(f"{_label(nodes[number])} is nowhere", "add an edge ON or INSIDE to a thing or a room")


def _edge(edge: Edge) -> str:
    return f"{edge.source} {edge.relation[:40]} {edge.target}"


def _label(node: Node) -> str:
    return f"{to_unity(node.class_name)[:60]} ({node.id})"


def _fault(message: str, suggestion: str) -> Diagnostic:
    return Diagnostic(Code.BAD_GRAPH, message, suggestion=suggestion)
