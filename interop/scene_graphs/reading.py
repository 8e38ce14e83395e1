"""A scene graph of any project, read as a home of ours, with a count of everything that was filled in or left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from typing import Any

from hearth.homes.node_defaults import filled
from hearth.homes.object_shapes import form
from hearth.interop.scene_graphs import completion, hydra, omnigibson, urdf_scenes
from hearth.interop.scene_graphs.class_names import ClassOf, class_of, is_number_only
from hearth.interop.scene_graphs.entities import Entity, entities_of, values_of
from hearth.interop.scene_graphs.entries import Entry, Units, entry_of, turned_size, units_of, unknown_states
from hearth.interop.scene_graphs.fillings import CLASSES_BY, ReadGraph
from hearth.interop.scene_graphs.foot_places import raised_from_feet
from hearth.interop.scene_graphs.geometry_faults import geometry_faults
from hearth.interop.scene_graphs.graph_completion import GraphCompletion
from hearth.interop.scene_graphs.links import Ties, holders, ties_of
from hearth.interop.scene_graphs.map_adjustments import straightened, with_middles
from hearth.interop.scene_graphs.room_extents import HEIGHT
from hearth.interop.scene_graphs.room_kinds import classes_of
from hearth.interop.scene_graphs.shape import Shape, usual
from hearth.interop.scene_graphs.units_of_length import unit_word
from hearth.interop.scene_graphs.vectors import Vector
from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node, from_release
from hearth.schemas.numbers import FARTHEST, LONGEST_HOME
from hearth.schemas.vocabulary import FIRST_ADDED_ID, ROOM_CATEGORY

LOWEST_ROOM = 1.0
"""Metres: a room that is lower is its floor."""

MOST_ENTRIES = 20_000
"""Things and rooms of a file that are read."""

MOST_SHOWN = 20
"""Faults that are named where nothing of a file was understood; the others are counted."""


def read_scene(data: Any, shape: Shape, knowledge: Knowledge, file: str = "") -> ReadGraph:
    """Return the home that a JSON value of another project describes.

    Raises:
        HearthError: BAD_GRAPH: it lists no things; FILE_TOO_LARGE: it lists more than are read.

    Examples:
        >>> from hearth.interop.scene_graphs.reading import read_scene
        >>> from hearth.interop.scene_graphs.shape import usual
        >>> scan = [{"name": "fridge", "room": "kitchen"}, {"name": "milk", "in": "fridge"}]
        >>> home = read_scene(scan, usual(), known)
        >>> [node.class_name for node in home.graph.nodes]
        ['kitchen', 'fridge', 'milk', 'character']
    """
    found = entities_of(hydra.labelled(urdf_scenes.joined(omnigibson.joined(data))), shape, MOST_ENTRIES)
    if not found.entities:
        raise HearthError.of(Code.BAD_GRAPH, "no list of things with a class, label or name is in it", file=file,
                             suggestion="name the fields by `--mapping FILE`")  # fmt: skip
    if found.is_full or len(found.entities) > MOST_ENTRIES:
        message = f"more than {MOST_ENTRIES:,} things and rooms"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, file=file, suggestion="write a file for each floor or room")
    return _Reading(knowledge, file, shape=shape, unit_word=unit_word(data, shape)).read(
        found.entities, ties_of(found, shape)
    )


def complete(graph: EnvironmentGraph, knowledge: Knowledge, file: str = "") -> ReadGraph:
    """Return a graph in the release's layout, with the parts of a home that it leaves out.

    Its nodes, relations and boxes stay. A graph with a CLOSE edge keeps its own nearness.

    Raises:
        HearthError: as `lay_out`; FILE_TOO_LARGE: it has more nodes than are filled in; DUPLICATE: nodes share an id.
    """
    if len(graph.nodes) > MOST_ENTRIES:
        message = f"{len(graph.nodes):,} nodes, where {MOST_ENTRIES:,} are filled in"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, file=file, suggestion="write a file for each floor or room")
    if faults := completion.repeated_ids(graph, file):
        raise HearthError(faults)
    reading = _Reading(knowledge, file, keeps_boxes=True)
    if not any(node.category == ROOM_CATEGORY for node in graph.nodes):
        name = completion.room_for([node.class_name for node in graph.nodes], knowledge)
        room = Node(completion.next_id(graph), name, ROOM_CATEGORY)
        graph = replace(graph, nodes=(*graph.nodes, room))
        reading.note("rooms made, as no room of the file is known", [name])
    nodes = [completion.with_usual_fields(node, knowledge) for node in graph.nodes]
    changed = [new.class_name for new, old in zip(nodes, graph.nodes, strict=True) if new is not old]
    reading.note("things with properties or states from the knowledge", changed)
    made = reading.completed(replace(graph, nodes=tuple(nodes)))
    return ReadGraph(made, reading.counted(), (), {})


@dataclass
class _Reading(GraphCompletion):
    """The reading of one file, step by step."""

    shape: Shape = field(default_factory=usual)
    unit_word: str = ""

    def read(self, entities: Sequence[Entity], ties: Ties) -> ReadGraph:
        """Return the home of some entries and their relations."""
        classes = classes_of(entities, ties, self.shape, self.knowledge)
        kept = [entity for entity in entities if classes[id(entity)].name]
        self._note_classes(entities, classes)
        self._name_shared_ids(entities)
        for entity in kept:
            for message, remedy in geometry_faults(entity, self.shape):
                self._leave(Code.BAD_GRAPH, message, entity.path, remedy)
        if not kept:
            raise HearthError(self._first_left_out())
        names = [classes[id(entity)].name for entity in kept]
        shapes = [None if self.knowledge.is_room(name) else form(name, self.knowledge) for name in names]
        units = units_of(kept, shapes, self.shape, self.unit_word)
        entries = [entry_of(entity, classes[id(entity)].name, self.shape, units) for entity in kept]
        entries, angle = straightened(entries)
        if angle:
            placed = [entry.class_name for entry in entries if entry.place is not None]
            self.note(f"places turned by {angle:g} degrees, as most things stand so", placed)
        entries, cornered = with_middles(entries, units, self.knowledge)
        self.note("rooms whose places are their corners, as more things are in them so", cornered)
        entries, raised = raised_from_feet(entries, self.knowledge)
        self.note("places at the foot of things, as all stand on one level", raised)
        self.floors = self._floors(entities, units)
        rooms = self._named_rooms(ties, entries)
        numbers = _numbers([*rooms.values(), *entries])
        self.paths = {numbers[id(entry)]: entry.entity.path for entry in entries}
        edges = self._edges(ties, entries, rooms, numbers)
        graph = self._graph([*rooms.values(), *entries], numbers, edges)
        self._note_units(entries, units)
        unknown = [
            f"{word} of {entry.class_name}" for entry in entries for word in unknown_states(entry.entity, self.shape)
        ]
        self.note("words for states that mean none, left out", unknown)
        graph = self.completed(self._singly_held(graph))
        ids = {numbers[id(entry)]: entry.entity.keys[0] for entry in entries if entry.entity.keys}
        return ReadGraph(graph, self.counted(), tuple(self.left_out), ids)

    def _first_left_out(self) -> list[Diagnostic]:
        """Return the first entries that were left out, and the number of the others."""
        more = len(self.left_out) - MOST_SHOWN
        rest = [Diagnostic(Code.BAD_GRAPH, f"and {more:,} more such faults", self.file)] if more > 0 else []
        return [*self.left_out[:MOST_SHOWN], *rest]

    def _floors(self, entities: Sequence[Entity], units: Units) -> list[Box]:
        """Return the boxes of the floors that a file has."""
        found = (entry_of(each, "floor", self.shape, units) for each in entities if key_of(each.label) == "floor")
        boxes = [Box(floor.place, floor.size) for floor in found if floor.place and floor.size]
        return [box for box in boxes if min(box.size[::2]) > 0 and max(box.size) <= LONGEST_HOME]

    def _note_classes(self, entities: Sequence[Entity], classes: Mapping[int, ClassOf]) -> None:
        ways: dict[str, list[str]] = {}
        for entity in entities:
            found = classes[id(entity)]
            ways.setdefault(found.by, []).append(f"{entity.label} = {found.name}" if found.name else entity.label)
            if not found.by:
                near = self.knowledge.suggest(entity.label)
                called = f"`{entity.label}`"
                if is_number_only(entity.label) and not is_number_only(entity.name):
                    called = f"`{entity.name}`, whose number is {entity.label}"
                hint = f"did you mean `{near[0]}`? " if near else ""
                hint += "`classes:` of a mapping file names the class, or null to leave it out without a word"
                self._leave(Code.UNKNOWN_OBJECT, f"no class is called {called}", entity.path, hint)
        for by, what in CLASSES_BY.items():
            self.note(what, ways.get(by, []))

    def _name_shared_ids(self, entities: Sequence[Entity]) -> None:
        """Name the entries of a list whose id is that of another entry of the list."""
        seen: dict[tuple[str, str], str] = {}
        for entity in entities:
            for value in values_of(entity, self.shape.fields["id"])[:1]:
                first = seen.setdefault((entity.path.rpartition("[")[0], str(value)), entity.path)
                if first != entity.path:
                    message = f"its id `{str(value)[:60]}` is that of {first}, too"
                    self._leave(Code.DUPLICATE, message, entity.path, "give each an id of its own")

    def _named_rooms(self, ties: Ties, entries: Sequence[Entry]) -> dict[str, Entry]:
        """Return an entry for each room that entries only name; a room for all where there is none."""
        kept = {id(entry.entity) for entry in entries}
        found: dict[str, Entry] = {}
        for entity, text in ties.rooms:
            name = class_of(text, self.shape, self.knowledge).name
            if id(entity) in kept and self.knowledge.is_room(name):
                found.setdefault(text, Entry(Entity("", (), text, text, {}), name))
            elif id(entity) in kept and class_of(text, self.shape, self.knowledge).by != "building":
                rooms = ", ".join(sorted(filter(self.knowledge.is_room, self.knowledge.objects)))
                message = f"it stands in or on `{text}`, which is nothing in the file and no room of ours"
                self._leave(Code.UNKNOWN_OBJECT, message, entity.path,
                            f"`classes:` of a mapping file names one of {rooms}")  # fmt: skip
        self.note("rooms that things only name", list(found))
        if not found and not any(self.knowledge.is_room(entry.class_name) for entry in entries):
            name = completion.room_for([entry.class_name for entry in entries], self.knowledge)
            found[""] = Entry(Entity("", (), name, name, {}), name)
            self.note("rooms made, as no room of the file is known", [name])
        return found

    def _edges(
        self, ties: Ties, entries: Sequence[Entry], rooms: Mapping[str, Entry], numbers: Mapping[int, int]
    ) -> list[Edge]:
        """Return the file's own relations, each thing on or in one thing at most."""
        by_entity = {id(entry.entity): entry for entry in entries}
        above = holders(ties.ties, lambda entity: id(entity) in by_entity)
        edges: list[Edge] = []
        between: list[str] = []
        second: list[str] = []
        for entry in entries:
            me = numbers[id(entry)]
            in_room = False
            for relation, entity in above.get(id(entry.entity), []):
                other = by_entity[id(entity)]
                if self.knowledge.is_room(entry.class_name):
                    between.append(f"{entry.class_name} and {other.class_name}")
                    continue
                if self.knowledge.is_room(other.class_name):
                    if in_room:
                        second.append(f"{entry.class_name} in {other.class_name}")
                        continue
                    in_room = True
                edges.append(Edge(me, self._held(entry, relation, other), numbers[id(other)]))
        for entity, text in ties.rooms:
            if id(entity) in by_entity and text in rooms:
                edges.append(Edge(numbers[id(by_entity[id(entity)])], "INSIDE", numbers[id(rooms[text])]))
        for tie in ties.ties:
            if tie.relation not in ("ON", "INSIDE", "") and {id(tie.source), id(tie.target)} <= by_entity.keys():
                pair = (numbers[id(by_entity[id(end)])] for end in (tie.source, tie.target))
                edges.append(Edge(next(pair), tie.relation, next(pair)))
        self.note("relations of the file", [edge.relation for edge in edges])
        self.note("rooms in rooms or next to them, left out", between)
        self.note("second rooms of a thing, left out", second)
        self.note("relations without a counterpart, left out", [word for _, word in ties.unknown_words])
        for path, text in ties.dangling:
            self._leave(Code.BAD_GRAPH, f"a relation names `{text}`, which is nothing in the file", path)
        for path, text in dict.fromkeys(ties.selves):
            self._leave(Code.LOOP, f"`{text}` is on or in itself", path, "name another holder, or none")
        for path, text in ties.ambiguous:
            message = f"a relation names `{text}`, and several things are called so"
            self._leave(Code.DUPLICATE, message, path, "give each thing an id of its own")
        return list(dict.fromkeys(edges))

    def _held(self, entry: Entry, relation: str, other: Entry) -> str:
        """Return the relation to a holder; where the file does not say which, that which is usual."""
        if self.knowledge.is_room(other.class_name):
            return "INSIDE"
        return relation or _by_height(entry, other) or completion.usual_relation(
            entry.class_name, other.class_name, self.knowledge)  # fmt: skip

    def _graph(self, entries: Sequence[Entry], numbers: Mapping[int, int], edges: Sequence[Edge]) -> EnvironmentGraph:
        rooms = {numbers[id(entry)] for entry in entries if self.knowledge.is_room(entry.class_name)}
        held = {edge.source for edge in edges if edge.relation in ("ON", "INSIDE") and edge.target not in rooms}
        flat = [entry for entry in entries if entry.is_flat and entry.place is not None]
        self.note("places without a height, on the floor or on the holder of the thing", [e.class_name for e in flat])
        nodes = [self._node(entry, numbers[id(entry)], held) for entry in entries]
        rows = [{"from_id": one, "relation_type": relation, "to_id": other} for one, relation, other in edges]
        return from_release(filled({"nodes": nodes, "edges": rows}, self.knowledge).data, self.file)

    def _node(self, entry: Entry, number: int, held: Set[int]) -> dict[str, Any]:
        node: dict[str, Any] = {"id": number, "class_name": entry.class_name}
        states = completion.states_with(entry.states, entry.class_name, self.knowledge)
        if states:
            node["states"] = states
        is_room = self.knowledge.is_room(entry.class_name)
        shaped = None if is_room else form(entry.class_name, self.knowledge)
        own = entry.size if entry.size is not None and min(entry.size) > 0 else None
        size = own or (shaped and turned_size(shaped.size, entry.yaw, turns=True))
        place = entry.place
        if is_room and place is not None and entry.size is not None and _is_outline(entry.size):
            low = place[1] + entry.size[1] / 2
            place, size = (place[0], low + HEIGHT / 2, place[2]), (entry.size[0], HEIGHT, entry.size[2])
        elif entry.is_flat and place is not None and size:
            place = None if number in held else (place[0], size[1] / 2, place[2])
        if place is not None and size and self._is_of_a_home(entry, size):
            node["bounding_box"] = {"center": list(place), "size": list(size)}
            node["yaw"] = entry.yaw
        return node

    def _is_of_a_home(self, entry: Entry, size: Vector) -> bool:
        """Return whether a thing with a place may have it in a home; a place or size that none has is noted."""
        assert entry.place is not None
        if max(map(abs, entry.place)) <= FARTHEST and max(size) <= LONGEST_HOME:
            return True
        message = f"{entry.class_name} lies {max(map(abs, entry.place)):g} m off or is {max(size):g} m long"
        self._leave(Code.BAD_GRAPH, message, entry.entity.path, "`scale:` of a mapping file: metres of a unit")
        return False

    def _note_units(self, entries: Sequence[Entry], units: Units) -> None:
        placed = [entry for entry in entries if entry.place is not None]
        self.note(f"places, {units.up} upwards ({units.up_reason})", [entry.class_name for entry in placed])
        if units.scale != 1.0:
            self.note(f"places in units of {units.scale:g} m, {units.scale_reason}", [e.class_name for e in placed])
        if units.scale_fault:
            self._leave(Code.BAD_GRAPH, units.scale_fault, placed[0].entity.path if placed else "units",
                        "`scale:` of a mapping file: metres of a unit")  # fmt: skip
        bare = [each for each in placed if each.size is None or min(each.size) <= 0]
        sized = [each.class_name for each in bare if not self.knowledge.is_room(each.class_name)]
        self.note("sizes from the knowledge", sized)


def _is_outline(size: Vector) -> bool:
    """Return whether a room has an outline, or a floor, and no height."""
    return size[1] < LOWEST_ROOM and min(size[0], size[2]) > 0


def _by_height(entry: Entry, other: Entry) -> str:
    """Return ON where the sizes and places of the file put a thing on top of its holder; "" where they do not say."""
    if entry.place is None or entry.size is None or other.place is None or other.size is None:
        return ""
    low, high = entry.place[1] - entry.size[1] / 2, other.place[1] + other.size[1] / 2
    return "ON" if abs(low - high) <= completion.TOUCHING / 2 else ""


def _numbers(entries: Sequence[Entry]) -> dict[int, int]:
    """Return a node id for each entry, by its `id()`: the file's, where all are numbers; else from 1 in its order."""
    own = [entry.entity.keys[0] if entry.entity.keys else "" for entry in entries]
    ids = [int(text) for text in own if text.isdecimal() and 0 < int(text) < FIRST_ADDED_ID and text[0] != "0"]
    if len(ids) == len(set(ids)) == len(entries):
        return {id(entry): number for entry, number in zip(entries, ids, strict=True)}
    return {id(entry): number for number, entry in enumerate(entries, 1)}
