"""Parts of a home that a file leaves out, filled in from the knowledge: rooms, places, doors, boxes, nearness."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

from hearth.homes.from_graph.graph_layout import lay_out
from hearth.homes.from_graph.layout_from_boxes import has_geometry, measured
from hearth.homes.geometry import bottom, footprint, top
from hearth.homes.lint import CHECKS, NEEDS_STATES, View
from hearth.homes.object_shapes import Form, form
from hearth.homes.plans.home_shell import Thing
from hearth.homes.relations import close, facing, many_close
from hearth.interop.scene_graphs.single_holders import is_seat_for
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, CHARACTER_CLASS, ROOM_CATEGORY

OFTEN = 3
"""Least weight of a placement by which a thing without a place is put somewhere."""

TOUCHING = 0.12
"""Metres between a thing's underside and the top of its support."""

COVERED = 0.5
"""Least share of a thing's outline that lies over its support."""


def room_for(things: Sequence[str], knowledge: Knowledge) -> str:
    """Return the class of the room that things of some classes are most usual in; `living_room` where none says."""
    votes: Counter[str] = Counter()
    for name in things:
        rooms = {place.room or place.destination for place in knowledge.placements(name) if place.weight >= OFTEN}
        votes.update(room for room in rooms if knowledge.is_room(room))
    return max(sorted(votes), key=votes.__getitem__, default="living_room")


def usual_place(node: Node, nodes: Sequence[Node], knowledge: Knowledge) -> tuple[str, Node] | None:
    """Return where a thing usually is among the nodes there are, as the relation and the node.

    None: the knowledge names no such place, or none of them is there.
    """
    for place in knowledge.placements(node.class_name):
        relation = {"ON": "ON", "IN": "INSIDE"}.get(place.relation)
        if relation is None or place.weight < OFTEN:
            continue
        for other in nodes:
            if other.class_name == place.destination and other.id != node.id:
                return ("INSIDE" if other.category == ROOM_CATEGORY else relation), other
    return None


def usual_relation(class_name: str, holder: str, knowledge: Knowledge) -> str:
    """Return whether a thing of a class is usually ON or INSIDE a holder of another class."""
    for place in knowledge.placements(class_name):
        if place.destination == holder and place.relation in ("ON", "IN"):
            return "ON" if place.relation == "ON" else "INSIDE"
    return "INSIDE" if knowledge.has(holder, "CAN_OPEN") else "ON"


def states_with(states: Sequence[str], class_name: str, knowledge: Knowledge) -> list[str]:
    """Return some states of a class, and for the rest its usual ones; [] where it can be in none of them."""
    usual = knowledge.default_states(class_name)
    own = [state for state in states if _can_be(state, class_name, usual, knowledge)]
    groups = {knowledge.group_of(state) for state in own}
    return [*own, *(state for state in usual if knowledge.group_of(state) not in groups)] if own else []


def _can_be(state: str, class_name: str, usual: Sequence[str], knowledge: Knowledge) -> bool:
    """Return whether a class can be in a state: a property says so, or it is usually in a state of that group."""
    needs = {"OPEN": "CAN_OPEN", "CLOSED": "CAN_OPEN", "ON": "HAS_SWITCH", "OFF": "HAS_SWITCH"}.get(state)
    if needs:
        return knowledge.has(class_name, needs)
    return knowledge.group_of(state) in {knowledge.group_of(each) for each in usual}


def repeated_ids(graph: EnvironmentGraph, file: str) -> list[Diagnostic]:
    """Return a fault for each id that several nodes of a graph have: relations would be about all of them."""
    nodes: dict[int, list[str]] = {}
    for number, node in enumerate(graph.nodes):
        nodes.setdefault(node.id, []).append(f"{node.class_name} (nodes[{number}])")
    return [
        Diagnostic(
            Code.DUPLICATE, f"{' and '.join(names[:4])} have the id {node}", file, suggestion="give each its own"
        )
        for node, names in nodes.items()
        if len(names) > 1
    ]


def next_id(graph: EnvironmentGraph) -> int:
    """Return an id that no node of a graph has."""
    return max(node.id for node in graph.nodes) + 1


def rooms_above(rooms: Sequence[Node], things_below: Mapping[int, Sequence[int]]) -> dict[int, int]:
    """Return the room of each room, and of each thing in one through its holders: the room with the fewest between."""
    return spread({room.id: room.id for room in rooms}, [room.id for room in rooms], things_below)


def below(graph: EnvironmentGraph) -> dict[int, list[int]]:
    """Return the things that are ON or INSIDE each node."""
    found: dict[int, list[int]] = {}
    for edge in graph.edges:
        if edge.relation in ("ON", "INSIDE"):
            found.setdefault(edge.target, []).append(edge.source)
    return found


def spread(rooms: dict[int, int], level: list[int], things_below: Mapping[int, Sequence[int]]) -> dict[int, int]:
    """Return rooms with those of the things that some nodes hold, however deep, and that have none yet, added."""
    while level:
        new: list[int] = []
        for holder in level:
            for thing in things_below.get(holder, ()):
                if thing not in rooms:
                    rooms[thing] = rooms[holder]
                    new.append(thing)
        level = new
    return rooms


def held_by_box(node: Node, nodes: Sequence[Node], knowledge: Knowledge) -> tuple[str, Node] | None:
    """Return what a thing stands on or in by its box, of the nodes of its room; None where it stands on the floor."""
    if node.box is None:
        return None
    mine, area = footprint(node.box), max(node.box.size[0] * node.box.size[2], 1e-6)
    under: list[tuple[float, str, Node]] = []
    for other in nodes:
        if other.box is None or other.id == node.id or _area(other.box) < area or is_seat_for(node, other, knowledge):
            continue
        if mine.overlap(footprint(other.box)) < COVERED * area:
            continue
        if abs(bottom(node.box) - top(other.box)) <= TOUCHING:
            under.append((-top(other.box), "ON", other))
        elif bottom(other.box) - 0.02 <= bottom(node.box) and top(node.box) <= top(other.box) + 0.02:
            inside = knowledge.has(other.class_name, "CAN_OPEN") or knowledge.has(other.class_name, "CONTAINERS")
            under.append((-top(other.box), "INSIDE" if inside else "ON", other))
    return min(under, key=lambda each: (each[0], each[2].id))[1:] if under else None


def _area(box: Box) -> float:
    return box.size[0] * box.size[2]


def with_usual_fields(node: Node, knowledge: Knowledge) -> Node:
    """Return a node with its class's properties where it has none, and with a state of each group that they need."""
    known = knowledge.object_class(node.class_name)
    if known is None or known.category in (ROOM_CATEGORY, CHARACTER_CATEGORY):
        return node
    properties = node.properties or tuple(sorted(known.properties))
    own = set(node.states)
    lacking = [states for needed, states in NEEDS_STATES.items() if needed in properties and not own & set(states)]
    usual = knowledge.default_states(known.name)
    states = [next((state for state in usual if state in group), group[1]) for group in lacking]
    if properties == node.properties and not states:
        return node
    return replace(node, properties=properties, states=(*node.states, *states))


def boxed_by_holders(graph: EnvironmentGraph, knowledge: Knowledge) -> tuple[EnvironmentGraph, list[str]]:
    """Return a graph in which things without a box have one on or in the box of their holder, and their classes.

    Things on one holder stand side by side along its longer side.
    """
    rooms = {node.id for node in graph.nodes if node.category == ROOM_CATEGORY}
    holders = {e.source: e for e in graph.edges if e.relation in ("ON", "INSIDE") and e.target not in rooms}
    boxes = {node.id: node.box for node in graph.nodes if node.box is not None}
    names = {node.id: node.class_name for node in graph.nodes}
    groups: dict[int, list[int]] = {}
    for node, edge in holders.items():
        groups.setdefault(edge.target, []).append(node)
    order = {node.id: number for number, node in enumerate(graph.nodes)}
    placed: list[str] = []
    level = [node.id for node in graph.nodes if node.box is not None]
    while level:
        ready = [node for holder in level for node in groups.get(holder, ()) if node not in boxes]
        for node in sorted(ready, key=order.__getitem__):
            edge = holders[node]
            group = groups[edge.target]
            shaped = form(names[node], knowledge)
            boxes[node] = _on_or_in(boxes[edge.target], edge.relation, shaped, group.index(node), len(group))
            placed.append(names[node])
        level = ready
    nodes = tuple(replace(node, box=boxes.get(node.id, node.box)) for node in graph.nodes)
    return replace(graph, nodes=nodes), placed


def _on_or_in(holder: Box, relation: str, shaped: Form | None, number: int, count: int) -> Box:
    """Return a box for the thing of a number on, or in, a holder of `count` things."""
    w, h, d = shaped.size if shaped is not None else (0.1, 0.1, 0.1)
    (x, _, z), (long, _, deep) = holder.center, holder.size
    share = ((number + 0.5) / count - 0.5) * 0.8
    x, z = (x + share * long, z) if long >= deep else (x, z + share * deep)
    low = top(holder) if relation == "ON" else bottom(holder) + 0.05
    return Box((round(x, 4), round(low + h / 2, 4), round(z, 4)), (w, h, d))


def with_person(graph: EnvironmentGraph, number: int) -> EnvironmentGraph:
    """Return a graph with a person in its first room; the same graph where somebody is there."""
    if any(node.class_name == CHARACTER_CLASS for node in graph.nodes):
        return graph
    room = next(node for node in graph.nodes if node.category == ROOM_CATEGORY)
    person = Node(number, CHARACTER_CLASS, CHARACTER_CATEGORY)
    return replace(graph, nodes=(*graph.nodes, person), edges=(*graph.edges, Edge(number, "INSIDE", room.id)))


def with_doors(graph: EnvironmentGraph, first: int) -> tuple[EnvironmentGraph, int]:
    """Return a graph in which a doorjamb joins each room to the largest one, and their number.

    A graph that has a BETWEEN edge, or a single room, stays as it is.
    """
    rooms = [node for node in graph.nodes if node.category == ROOM_CATEGORY]
    if len(rooms) < 2 or any(edge.relation == "BETWEEN" for edge in graph.edges):
        return graph, 0
    held = Counter(edge.target for edge in graph.edges if edge.relation == "INSIDE")
    hub = max(rooms, key=lambda room: (room.class_name == "entrance_hall", held[room.id], -room.id))
    others = [room for room in rooms if room.id != hub.id]
    doors = [Node(first + number, "doorjamb", "Doors") for number in range(len(others))]
    edges = [
        Edge(door.id, relation, target)
        for door, room in zip(doors, others, strict=True)
        for relation, target in (("INSIDE", room.id), ("BETWEEN", room.id), ("BETWEEN", hub.id))
    ]
    return replace(graph, nodes=(*graph.nodes, *doors), edges=(*graph.edges, *edges)), len(doors)


def unreachable(graph: EnvironmentGraph, knowledge: Knowledge) -> set[int]:
    """Return the things of a graph with boxes that nobody can walk to."""
    return {int(fault.found) for fault in CHECKS["on foot"](View(graph, knowledge))}


def without_boxes(graph: EnvironmentGraph) -> EnvironmentGraph:
    """Return a graph without geometry."""
    return replace(graph, nodes=tuple(replace(node, box=None, yaw=None) for node in graph.nodes))


def laid_out(graph: EnvironmentGraph, name: str, knowledge: Knowledge) -> EnvironmentGraph:
    """Return a graph with boxes that its relations suggest.

    Raises:
        HearthError: as `lay_out`.
    """
    return lay_out(graph, name, knowledge).graph


MOST_NEAR = 100_000
"""CLOSE edges that are made for a graph; the largest homes of others have a third of them."""

MOST_LOOKS = 4_000_000
"""Pairs of things in one room, one of which may look at the other, that are looked at."""


def _need_few_near(things: Sequence[Thing], lookable: frozenset[str]) -> None:
    """Refuse things in heaps, and more things that look at one another than any room has."""
    close_edges = many_close(things, MOST_NEAR)
    held = Counter(thing.room for thing in things)
    aims = Counter(thing.room for thing in things if thing.class_name in lookable)
    looks = max((held[room] * count for room, count in aims.items()), default=0)
    if close_edges > MOST_NEAR or looks > MOST_LOOKS:
        message = (
            f"its things stand in heaps: more than {MOST_NEAR:,} CLOSE edges between {len(things):,} things"
            if close_edges > MOST_NEAR
            else f"a room of things that may look at one another in {looks:,} pairs; at most {MOST_LOOKS:,}"
        )
        remedy = "are its boxes in meters? else leave out --fill, or give it fewer things"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, suggestion=remedy)


def nearness(graph: EnvironmentGraph, knowledge: Knowledge) -> list[Edge]:
    """Return the CLOSE and FACING edges that the boxes of a graph show and that it lacks.

    Raises:
        HearthError: FILE_TOO_LARGE: the things stand in heaps, and have more than `MOST_NEAR` CLOSE edges.
    """
    if not has_geometry(graph):
        return []
    rooms = {node.id for node in graph.nodes if node.category == ROOM_CATEGORY}
    inside = {
        edge.source: str(edge.target) for edge in graph.edges if edge.relation == "INSIDE" and edge.target not in rooms
    }
    things = [
        replace(thing, inside=inside.get(thing.line, ""))
        for thing in measured(graph, "", knowledge).things
        if thing.room
    ]
    lookable = frozenset(name for name, known in knowledge.objects.items() if "LOOKABLE" in known.properties)
    _need_few_near(things, lookable)
    pairs = [("CLOSE", each) for each in close(things).tolist()] + [
        ("FACING", each) for each in facing(things, lookable)
    ]
    had = {(edge.source, edge.relation, edge.target) for edge in graph.edges}
    edges = (Edge(things[one].line, relation, things[other].line) for relation, (one, other) in pairs)
    return sorted({edge for edge in edges if tuple(edge) not in had})
