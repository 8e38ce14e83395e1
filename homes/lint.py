"""Faults of a scene graph, each with the ids of the nodes concerned."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from functools import cached_property

from hearth.homes.from_graph.layout_from_boxes import has_geometry, measured
from hearth.homes.node_defaults import CATEGORIES
from hearth.homes.object_shapes import form
from hearth.homes.plans.plan_checks import joined
from hearth.homes.plans.walkable_floor import REACH
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.literals import HANDS
from hearth.schemas.vocabulary import CHARACTER_CLASS, PROPERTIES, RELATIONS, ROOM_CATEGORY, STATES

NEEDS_STATES = {"CAN_OPEN": ("OPEN", "CLOSED"), "HAS_SWITCH": ("ON", "OFF")}
"""A thing with the property is in one of the states."""

SITTING_ON_EDGES = "SITTING"
"""A relation that some files of the release have; nothing follows from it."""


class View:
    """A graph with the indexes that the checks use.

    Attributes:
        graph: the graph.
        knowledge: for classes.
        nodes: by id; of two with one id, the first.
    """

    def __init__(self, graph: EnvironmentGraph, knowledge: Knowledge) -> None:
        self.graph = graph
        self.knowledge = knowledge
        self.nodes: dict[int, Node] = {}
        for node in graph.nodes:
            self.nodes.setdefault(node.id, node)

    @cached_property
    def targets(self) -> dict[str, dict[int, list[int]]]:
        """Relation -> source -> targets, each once, edges to missing nodes left out."""
        found: dict[str, dict[int, list[int]]] = defaultdict(dict)
        for edge in dict.fromkeys(self.graph.edges):
            if edge.source in self.nodes and edge.target in self.nodes:
                found[edge.relation].setdefault(edge.source, []).append(edge.target)
        return found

    @cached_property
    def housed(self) -> dict[int, int]:
        """The nodes from which following INSIDE leads to a room, and the rooms: node -> room."""
        return self._led_to("INSIDE")

    @cached_property
    def stood(self) -> dict[int, int]:
        """`housed`, following ON as well: where a thing stands whose file does not say its room."""
        return self._led_to("INSIDE", "ON")

    def _led_to(self, *relations: str) -> dict[int, int]:
        held: dict[int, list[int]] = defaultdict(list)
        for relation in relations:
            for source, targets in self.targets[relation].items():
                for target in targets:
                    held[target].append(source)
        waiting = list(filter(self.is_room, self.nodes))
        found = {room: room for room in waiting}
        while waiting:
            at = waiting.pop()
            new = [node_id for node_id in held.get(at, ()) if node_id not in found]
            found.update(dict.fromkeys(new, found[at]))
            waiting += new
        return found

    def label(self, node_id: int) -> str:
        """Return a node as people call it: `fridge (41)`."""
        node = self.nodes.get(node_id)
        return f"{node.class_name} ({node_id})" if node else f"node {node_id}"

    def is_room(self, node_id: int) -> bool:
        """Return whether it is a room."""
        return self.nodes[node_id].category == ROOM_CATEGORY

    def parents(self, node_id: int) -> list[int]:
        """Return the node's container."""
        return self.targets["INSIDE"].get(node_id, [])


def lint(graph: EnvironmentGraph, knowledge: Knowledge, file: str = "") -> tuple[Diagnostic, ...]:
    """Every fault of a graph, in the order of `CHECKS`; empty when it is sound. Node ids stand in `found`.

    Examples:
        >>> from hearth.homes.lint import lint
        >>> lint(graph, known)
        ()
    """
    view = View(graph, knowledge)
    return tuple(fault.at(file) for check in CHECKS.values() for fault in check(view))


def _fault(code: Code, message: str, ids: tuple[int, ...], suggestion: str = "") -> Diagnostic:
    return Diagnostic(code, message, found=" ".join(map(str, ids)), suggestion=suggestion)


def _ids(view: View) -> Iterator[Diagnostic]:
    counts = Counter(node.id for node in view.graph.nodes)
    for node_id, count in counts.items():
        if count > 1:
            yield _fault(Code.DUPLICATE, f"{count} nodes have the id {node_id}", (node_id,), "give each its own")


def _names(view: View) -> Iterator[Diagnostic]:
    for node in view.graph.nodes:
        me = (node.id,)
        if node.category not in CATEGORIES:
            message = f"{view.label(node.id)} is of the unknown category `{node.category}`"
            yield _fault(Code.BAD_GRAPH, message, me, f"one of {', '.join(CATEGORIES)}")
        if view.knowledge.object_class(node.class_name) is None:
            near = view.knowledge.suggest(node.class_name)
            hint = f"did you mean `{near[0]}`?" if near else "add it to the knowledge"
            yield _fault(Code.UNKNOWN_OBJECT, f"no class is called `{node.class_name}`", me, hint)
        for kind, words, known in (("state", node.states, STATES), ("property", node.properties, PROPERTIES)):
            for word in words:
                if word not in known:
                    yield _fault(Code.BAD_GRAPH, f"{view.label(node.id)} has the unknown {kind} `{word}`", me)


def _edges(view: View) -> Iterator[Diagnostic]:
    counts = Counter(view.graph.edges)
    for edge, count in counts.items():
        ends = (edge.source, edge.target)
        shown = f"{edge.source} {edge.relation} {edge.target}"
        for end in dict.fromkeys(ends):
            if end not in view.nodes:
                yield _fault(Code.UNKNOWN_ID, f"{shown}: there is no node {end}", ends, "remove the edge")
        if count > 1:
            yield _fault(Code.DUPLICATE, f"{shown} stands {count} times", ends, "keep one")
        if edge.relation not in (*RELATIONS, SITTING_ON_EDGES):
            hint = f"one of {', '.join(RELATIONS)}"
            yield _fault(Code.BAD_GRAPH, f"{shown}: no relation is called `{edge.relation}`", ends, hint)
        if edge.source == edge.target:
            yield _fault(Code.LOOP, f"{shown}: a thing related to itself", ends, "remove the edge")


def _states(view: View) -> Iterator[Diagnostic]:
    for node in view.graph.nodes:
        for i in range(0, len(STATES), 2):
            if STATES[i] in node.states and STATES[i + 1] in node.states:
                message = f"{view.label(node.id)} is both {STATES[i]} and {STATES[i + 1]}"
                yield _fault(Code.CONTRADICTION, message, (node.id,), "keep one")
        for prop, states in NEEDS_STATES.items():
            if prop in node.properties and not set(states) & set(node.states):
                message = f"{view.label(node.id)} has {prop} and is neither {states[0]} nor {states[1]}"
                yield _fault(Code.CONDITION_UNMET, message, (node.id,), f"give it the state {states[1]}")


def _rooms(view: View) -> Iterator[Diagnostic]:
    if not any(map(view.is_room, view.nodes)):
        yield _fault(Code.NO_ROOM, "there is no room", (), f"a node of the category {ROOM_CATEGORY}")
    held = {target for hand in HANDS for targets in view.targets[hand].values() for target in targets}
    for node_id in view.nodes:
        rooms = [parent for parent in view.parents(node_id) if view.is_room(parent)]
        if len(rooms) > 1:
            where = ", ".join(map(view.label, rooms))
            yield _fault(
                Code.BAD_GRAPH,
                f"{view.label(node_id)} is INSIDE {len(rooms)} rooms: {where}",
                (node_id, *rooms),
                "keep one",
            )
        if node_id not in held and node_id not in view.housed:
            yield _no_room(view, node_id)


def _no_room(view: View, node_id: int) -> Diagnostic:
    """Return a thing that nobody can walk to, as ON leads to no room; the remedy is the edge that is missing."""
    room = view.stood.get(node_id)
    if room is None:
        hint = f"add {node_id} INSIDE the id of its room"
    else:
        hint = f'add {{"from_id": {node_id}, "relation_type": "INSIDE", "to_id": {room}}}'
    return _fault(Code.NO_ROOM, f"{view.label(node_id)} is INSIDE no room: nobody can walk to it", (node_id,), hint)


def _containers(view: View) -> Iterator[Diagnostic]:
    """Yield a thing may be INSIDE a box INSIDE a closet, and say both.

    Two that are not in each other cannot both hold it.
    """
    for node_id in view.nodes:
        holders = [parent for parent in view.parents(node_id) if not view.is_room(parent)]
        outer = {parent for other in holders for parent in view.parents(other)}
        innermost = [h for h in holders if h not in outer]
        if len(innermost) > 1:
            where = " and ".join(map(view.label, innermost))
            yield _fault(Code.BAD_GRAPH, f"{view.label(node_id)} is INSIDE {where}", (node_id, *innermost), "keep one")
        if view.is_room(node_id) and view.parents(node_id):
            yield _fault(Code.BAD_GRAPH, f"{view.label(node_id)} is a room INSIDE something", (node_id,), "remove it")


def _seats(view: View) -> Iterator[Diagnostic]:
    """Furniture on or in a seat: simulators that compare boxes say so of a table before a corner couch."""
    for relation in ("ON", "INSIDE"):
        for node_id, holders in view.targets[relation].items():
            node = view.nodes[node_id]
            if node.category != FURNITURE or "GRABBABLE" in node.properties:
                continue
            for seat in (holder for holder in holders if _is_seat(view.nodes[holder])):
                message = f"{view.label(node_id)} is {relation} {view.label(seat)}: a person sitting there sits in it"
                yield _fault(Code.CONFLICT, message, (node_id, seat), "remove the edge")


def _is_seat(node: Node) -> bool:
    """Return whether a node is furniture to sit on; mats are to sit on, too, and carry furniture."""
    return node.category == FURNITURE and "SITTABLE" in node.properties


FURNITURE = "Furniture"
"""The category of things that stand on the floor."""


def _circles(view: View) -> Iterator[Diagnostic]:
    """Circles of INSIDE, or of ON, each named once."""
    for relation in ("INSIDE", "ON"):
        done: set[int] = set()
        for start in view.targets[relation]:
            circle = _circle(view.targets[relation], start, done)
            if len(circle) > 1:
                way = f" {relation} ".join(map(view.label, (*circle, circle[0])))
                yield _fault(Code.LOOP, f"a circle: {way}", circle, "remove one of the edges")


def _circle(targets: dict[int, list[int]], start: int, done: set[int]) -> tuple[int, ...]:
    """Return a circle reached from `start` through nodes not yet done, or (); marks what it visits as done."""
    path: dict[int, int] = {}  # node -> its place on the way, in that order
    stack: list[tuple[int, int]] = [(start, 0)]
    while stack:
        node, depth = stack.pop()
        while len(path) > depth:
            path.popitem()
        if node in path:
            return tuple(path)[path[node] :]
        if node not in done:
            done.add(node)
            path[node] = depth
            stack.extend((target, depth + 1) for target in targets.get(node, ()))
    return ()


def _doors(view: View) -> Iterator[Diagnostic]:
    for door, rooms in view.targets["BETWEEN"].items():
        real = [room for room in rooms if view.is_room(room)]
        if len(real) != 2 or len(rooms) != 2:
            message = f"{view.label(door)} is BETWEEN {len(real)} room{'s' * (len(real) != 1)}"
            yield _fault(Code.BAD_GRAPH, message, (door, *rooms), "a door joins two rooms")
    rooms = [node_id for node_id in view.nodes if view.is_room(node_id)]
    cut = sorted(set(rooms) - joined(rooms[0], map(set, view.targets["BETWEEN"].values()))) if rooms else []
    if rooms and cut and view.targets["BETWEEN"]:
        names = ", ".join(map(view.label, cut))
        yield _fault(Code.NO_PATH, f"no door leads from {view.label(rooms[0])} to {names}", tuple(cut), "add a door")


def _hands(view: View) -> Iterator[Diagnostic]:
    holders: dict[int, set[int]] = defaultdict(set)
    for hand in HANDS:
        for agent, things in view.targets[hand].items():
            if view.nodes[agent].class_name != CHARACTER_CLASS:
                yield _fault(Code.BAD_GRAPH, f"{view.label(agent)} has no hands to hold with", (agent, *things))
            if len(things) > 1:
                held = ", ".join(map(view.label, things))
                yield _fault(
                    Code.CONFLICT, f"one hand of {view.label(agent)} holds {held}", (agent, *things), "keep one"
                )
            for thing in things:
                holders[thing].add(agent)
    for thing, agents in holders.items():
        if len(agents) > 1:
            names = " and ".join(view.label(agent) for agent in sorted(agents))
            message = f"{view.label(thing)} is held by {names}"
            yield _fault(Code.CONFLICT, message, (thing, *sorted(agents)), "one of them has to let go")


def _close(view: View) -> Iterator[Diagnostic]:
    near = view.targets["CLOSE"]
    pairs = {(one, other) for one, others in near.items() for other in others}
    for one, others in near.items():
        for other in others:
            if one != other and (other, one) not in pairs:
                message = f"{view.label(one)} is CLOSE to {view.label(other)}, but not the other way round"
                yield _fault(Code.BAD_GRAPH, message, (one, other), f"add {other} CLOSE {one}")


def _on_foot(view: View) -> Iterator[Diagnostic]:
    """Return the things and characters on the floor that the largest free region of it does not come near."""
    if not has_geometry(view.graph):
        return
    layout = measured(view.graph, "", view.knowledge)
    floor, numbers = layout.floor, {room.name: number for number, room in enumerate(layout.plan.rooms)}
    for thing in layout.things:
        shaped = form(thing.class_name, view.knowledge)
        far = floor.distance(thing.box, numbers.get(thing.room, -1))
        if shaped is not None and shaped.mount == "floor" and far > REACH:
            message = f"nobody gets nearer than {far:.2f} m to {view.label(int(thing.name))}"
            yield _fault(Code.NO_PATH, message, (int(thing.name),), f"free the way to within {REACH:g} m of it")
    for node in view.graph.nodes:
        if node.class_name == CHARACTER_CLASS and node.box is not None and floor.distance(node.box) > 0:
            message = f"{view.label(node.id)} does not stand in the main region of the floor"
            yield _fault(Code.NO_PATH, message, (node.id,), "move it to where all rooms can be walked to")


def unusable(graph: EnvironmentGraph, knowledge: Knowledge) -> tuple[str, ...]:
    """Return the things that a program can only walk to and look at, because the graph gives them no properties while
    their class has some: a sentence for each class.

    Examples:
        >>> from hearth.homes.lint import unusable
        >>> unusable(graph, known)
        ()
    """
    found: dict[str, list[int]] = defaultdict(list)
    for node in graph.nodes:
        known = knowledge.object_class(node.class_name)
        if not node.properties and known is not None and known.properties and node.class_name != CHARACTER_CLASS:
            found[node.class_name].append(node.id)
    return tuple(_unusable(name, ids, knowledge) for name, ids in found.items())


def _unusable(name: str, ids: list[int], knowledge: Knowledge) -> str:
    known = knowledge.object_class(name)
    properties = " ".join(sorted(known.properties)) if known else ""
    shown = ", ".join(map(str, ids[:MOST_NAMED])) + (", ..." if len(ids) > MOST_NAMED else "")
    return f"{name} ({shown}): nothing can be done with it, as its `properties` are empty; the class has {properties}"


MOST_NAMED = 5
"""Nodes of a class that a sentence names."""


CHECKS: dict[str, Callable[[View], Iterator[Diagnostic]]] = {
    "ids": _ids,
    "names": _names,
    "edges": _edges,
    "states": _states,
    "rooms": _rooms,
    "containers": _containers,
    "seats": _seats,
    "circles": _circles,
    "doors": _doors,
    "hands": _hands,
    "close": _close,
    "on foot": _on_foot,
}
"""Every check of a graph."""
