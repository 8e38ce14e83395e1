"""The minimal home of a program: its own objects, of which only its conditions hold.

Every object has no states and a room of its own, unless a condition says more; what can be grabbed stands on a stand of
its own, so that it can be put back.
"""

from dataclasses import dataclass

from hearth.grounding.preconditions.conditions import Preconditions
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import Edge, Node
from hearth.schemas.literals import CHARACTER, HANDS, RELATION_OF, STATE_OF, STATE_OF_SET_3, Key
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, CHARACTER_CLASS, ROOM_CATEGORY
from hearth.simulation.world.home import Home

CHARACTER_ID = 1
_OBJECTS_FROM = 10
_ROOMS_FROM = 1000
_STANDS_FROM = 2000
_CHARACTERS_ROOM = 3

_LINKS = ("in", "inside", "atreach", "together", "facing")
"""Conditions that put their two objects into one room; the first object follows the second, facing the other way."""


@dataclass(frozen=True, slots=True)
class SketchHome:
    """A home of a program's objects, and which node is which object."""

    home: Home
    program: Program
    keys: dict[int, Key]


def sketch(program: Program, conditions: Preconditions, knowledge: Knowledge) -> SketchHome:
    """Build the home in which exactly the conditions hold, and bind the program to it."""
    keys = dict.fromkeys(ref.key for ref in program.objects())
    ids = {key: _OBJECTS_FROM + number for number, key in enumerate(keys)}
    nodes = [_character(conditions), Node(_CHARACTERS_ROOM, "room", ROOM_CATEGORY)]
    edges: list[Edge] = []
    rooms = _rooms(keys, ids, conditions, knowledge)
    for number, (key, node_id) in enumerate(ids.items()):
        nodes.append(_node(node_id, key, conditions, knowledge))
        if rooms[key] == node_id:
            continue
        nodes.append(Node(_ROOMS_FROM + number, "room", ROOM_CATEGORY))
        edges.append(Edge(node_id, "INSIDE", rooms[key]))
        if not any(c.name in ("in", "inside", "holds") and c.objects[0] == key for c in conditions):
            nodes.append(Node(_STANDS_FROM + number, "stand", "Furniture"))
            edges.append(Edge(node_id, "ON", _STANDS_FROM + number))
    stands = {edge.source: edge.target for edge in edges if edge.relation == "ON"}
    edges += _edges(ids, rooms, conditions)
    edges += _beside(ids, stands, conditions)
    nodes.sort(key=lambda node: node.id)
    home = Home(nodes, edges, "sketch", knowledge)
    bound = program.bound(ids)
    return SketchHome(home, bound, {node_id: key for key, node_id in ids.items()})


def _character(conditions: Preconditions) -> Node:
    resting = tuple(name.upper() for name in ("sitting", "lying") if conditions.has(name, CHARACTER))
    return Node(CHARACTER_ID, CHARACTER_CLASS, CHARACTER_CATEGORY, (), resting)


def _node(node_id: int, key: Key, conditions: Preconditions, knowledge: Knowledge) -> Node:
    thing = knowledge.object_class(key[0])
    states = tuple(_STATES[c.name] for c in conditions if c.name in _STATES and c.objects[0] == key)
    if thing is None:
        return Node(node_id, key[0], "", (), states)
    return Node(node_id, key[0], thing.category, tuple(sorted(thing.properties)), states)


_STATES = STATE_OF | STATE_OF_SET_3


def _rooms(
    keys: dict[Key, None], ids: dict[Key, int], conditions: Preconditions, knowledge: Knowledge
) -> dict[Key, int]:
    """Return the room of every object.

    Itself, where its location says, where what it is linked to is, or one of its own.
    """
    rooms: dict[Key, int] = {}
    leads: dict[Key, list[Key]] = {}
    for condition in conditions:
        if condition.name == "location" and condition.objects[1] in ids:
            rooms.setdefault(condition.objects[0], ids[condition.objects[1]])
        elif condition.name in _LINKS:
            first, second = condition.objects
            leads.setdefault(first, []).append(second)
            leads.setdefault(second, []).append(first)
    for key in keys:
        if knowledge.is_room(key[0]):
            rooms[key] = ids[key]
    for number, key in enumerate(keys):
        if key not in rooms:
            group = _group(key, leads)
            found = next((rooms[other] for other in group if other in rooms), _ROOMS_FROM + number)
            rooms.update((other, found) for other in group if other not in rooms)
    return rooms


def _group(key: Key, leads: dict[Key, list[Key]]) -> list[Key]:
    group = [key]
    for member in group:
        group.extend(other for other in leads.get(member, ()) if other not in group)
    return group


def _edges(ids: dict[Key, int], rooms: dict[Key, int], conditions: Preconditions) -> list[Edge]:
    edges: list[Edge] = []
    where = _CHARACTERS_ROOM
    for condition in conditions:
        if condition.name in ("nearby", "holds"):
            key = condition.objects[0]
            where = rooms[key]
            edges.append(Edge(CHARACTER_ID, "CLOSE", ids[key]))
            if condition.name == "holds":
                edges.append(Edge(CHARACTER_ID, _hand(edges), ids[key]))
        elif condition.name == "in" and condition.objects[1] not in ids:
            edges.append(Edge(ids[condition.objects[0]], "ON", CHARACTER_ID))
        elif condition.name in RELATION_OF and condition.name != "location":
            first, second = (ids[key] for key in condition.objects)
            edges.append(Edge(first, RELATION_OF[condition.name], second))
            if condition.name in ("in", "inside"):
                edges.append(Edge(first, "CLOSE", second))
    edges.append(Edge(CHARACTER_ID, "INSIDE", where))
    return edges


def _beside(ids: dict[Key, int], stands: dict[int, int], conditions: Preconditions) -> list[Edge]:
    """Return a node within reach of a thing is also within reach of the thing's support or container."""
    places = dict(stands)
    places.update(
        {ids[c.objects[0]]: ids[c.objects[1]] for c in conditions if c.name in ("in", "inside") and c.objects[1] in ids}
    )
    near = [(ids[c.objects[0]], places.get(ids[c.objects[1]])) for c in conditions if c.name == "atreach"]
    return [Edge(first, "CLOSE", place) for first, place in near if place is not None and place != first]


def _hand(edges: list[Edge]) -> str:
    return HANDS[any(edge.relation == HANDS[0] for edge in edges)]
