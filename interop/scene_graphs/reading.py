"""A scene graph of any project, read as a home of ours, with a count of everything that was filled in or left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from typing import Any

from hearth.homes.from_graph.layout_from_boxes import has_geometry
from hearth.homes.geometry import bottom
from hearth.homes.node_defaults import filled
from hearth.homes.object_shapes import form
from hearth.interop.scene_graphs import completion, hydra, omnigibson, urdf_scenes
from hearth.interop.scene_graphs.class_names import ClassOf, class_of
from hearth.interop.scene_graphs.entities import Entity, entities_of, values_of
from hearth.interop.scene_graphs.entries import Entry, Units, entry_of, units_of, unknown_states
from hearth.interop.scene_graphs.fillings import CLASSES_BY, Filling, ReadGraph
from hearth.interop.scene_graphs.foot_places import raised_from_feet
from hearth.interop.scene_graphs.geometry_faults import geometry_faults
from hearth.interop.scene_graphs.links import Ties, holders, ties_of
from hearth.interop.scene_graphs.map_adjustments import straightened, with_middles
from hearth.interop.scene_graphs.room_doors import with_doors
from hearth.interop.scene_graphs.room_extents import HEIGHT, with_boxes
from hearth.interop.scene_graphs.room_kinds import classes_of
from hearth.interop.scene_graphs.shape import Shape, usual
from hearth.interop.scene_graphs.single_holders import with_single_holders
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

RAISED = 0.3
"""Metres above the floor from which a thing stands on something else."""

MOST_ENTRIES = 20_000
"""Things and rooms of a file that are read."""


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
    return _Reading(shape, knowledge, file, unit_word=unit_word(data, shape)).read(
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
    reading = _Reading(usual(), knowledge, file, keeps_boxes=True)
    if not any(node.category == ROOM_CATEGORY for node in graph.nodes):
        name = completion.room_for([node.class_name for node in graph.nodes], knowledge)
        room = Node(_next(graph), name, ROOM_CATEGORY)
        graph = replace(graph, nodes=(*graph.nodes, room))
        reading.note("rooms made, as no room of the file is known", [name])
    nodes = [completion.with_usual_fields(node, knowledge) for node in graph.nodes]
    changed = [new.class_name for new, old in zip(nodes, graph.nodes, strict=True) if new is not old]
    reading.note("things with properties or states from the knowledge", changed)
    made = reading.completed(replace(graph, nodes=tuple(nodes)))
    return ReadGraph(made, reading.counted(), (), {})


@dataclass
class _Reading:
    """The reading of one file, step by step."""

    shape: Shape
    knowledge: Knowledge
    file: str
    keeps_boxes: bool = False
    notes: list[Filling] = field(default_factory=list)
    left_out: list[Diagnostic] = field(default_factory=list)
    floors: list[Box] = field(default_factory=list)
    paths: dict[int, str] = field(default_factory=dict)
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
            raise HearthError(self.left_out[:20])
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

    def _floors(self, entities: Sequence[Entity], units: Units) -> list[Box]:
        """Return the boxes of the floors that a file has."""
        found = (entry_of(each, "floor", self.shape, units) for each in entities if key_of(each.label) == "floor")
        boxes = [Box(floor.place, floor.size) for floor in found if floor.place and floor.size]
        return [box for box in boxes if min(box.size[::2]) > 0 and max(box.size) <= LONGEST_HOME]

    def counted(self) -> tuple[Filling, ...]:
        """Return what was noted, in its order."""
        return tuple(note for note in self.notes if note.number)

    def note(self, what: str, examples: Sequence[str]) -> None:
        """Note what was understood, filled in or changed, with a word for each case."""
        self.notes.append(Filling(what, len(examples), tuple(dict.fromkeys(examples))[:4]))

    def _leave(self, code: Code, message: str, path: str, suggestion: str = "") -> None:
        self.left_out.append(Diagnostic(code, f"{path}: {message}", self.file, suggestion=suggestion))

    def _note_classes(self, entities: Sequence[Entity], classes: Mapping[int, ClassOf]) -> None:
        ways: dict[str, list[str]] = {}
        for entity in entities:
            found = classes[id(entity)]
            ways.setdefault(found.by, []).append(f"{entity.label} = {found.name}" if found.name else entity.label)
            if not found.by:
                near = self.knowledge.suggest(entity.label)
                hint = f"did you mean `{near[0]}`? " if near else ""
                hint += "`classes:` of a mapping file names the class, or null to leave it out without a word"
                self._leave(Code.UNKNOWN_OBJECT, f"no class is called `{entity.label}`", entity.path, hint)
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

    def _singly_held(self, graph: EnvironmentGraph) -> EnvironmentGraph:
        found = with_single_holders(graph, self.knowledge)
        names = {node.id: f"{node.class_name} ({node.id})" for node in graph.nodes}
        words = [f"{names[edge.source]} {edge.relation} {names[edge.target]}" for edge in found.second]
        self.note("second holders, left out", words)
        for circle in found.circles:
            way = " ".join(f"{names[edge.source]} {edge.relation}" for edge in circle)
            message = f"a circle of holders: {way} {names[circle[0].source]}; the last relation is left out"
            self._leave(Code.LOOP, message, self.paths.get(circle[-1].source, ""), "name another holder, or none")
        return replace(graph, edges=tuple(found.edges))

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
        size = entry.size if entry.size is not None and min(entry.size) > 0 else shaped and shaped.size
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

    def completed(self, graph: EnvironmentGraph) -> EnvironmentGraph:
        """Return the graph with everything that a home of ours has and the file does not say."""
        graph = self._placed(graph)
        graph = self._housed(graph)
        person = completion.with_person(graph, _next(graph))
        self.note("person, in the first room", ["character"] if person is not graph else [])
        graph = self._both_ways(self._measured(person))
        close = sum(edge.relation == "CLOSE" for edge in graph.edges)
        if self.keeps_boxes and close >= len(graph.nodes):
            return graph
        near = completion.nearness(graph, self.knowledge)
        for relation in ("CLOSE", "FACING"):
            self.note(f"{relation} from the boxes", [relation for edge in near if edge.relation == relation])
        return replace(graph, edges=(*graph.edges, *near))

    def _both_ways(self, graph: EnvironmentGraph) -> EnvironmentGraph:
        """Return the graph with nearness in both directions."""
        had = set(graph.edges)
        back = {Edge(edge.target, "CLOSE", edge.source) for edge in graph.edges if edge.relation == "CLOSE"} - had
        return replace(graph, edges=(*graph.edges, *sorted(back)))

    def _placed(self, graph: EnvironmentGraph) -> EnvironmentGraph:
        """Return the graph with a place for each thing that the file puts nowhere: by its box, or its usual one."""
        rooms = {node.id: node for node in graph.nodes if node.category == ROOM_CATEGORY}
        held = {edge.source for edge in graph.edges if edge.relation in ("ON", "INSIDE") and edge.target not in rooms}
        housed = {edge.source for edge in graph.edges if edge.relation == "INSIDE"}
        things = [node for node in graph.nodes if node.id not in rooms]
        floor = min((bottom(node.box) for node in things if node.box is not None), default=0.0)
        between = {e.source: e.target for e in graph.edges if e.relation == "BETWEEN" and e.target in rooms}
        by: dict[str, list[str]] = {"box": [], "usual": [], "room": []}
        new: list[Edge] = []
        for node in things:
            shaped = form(node.class_name, self.knowledge)
            small = shaped is not None and (shaped.mount in ("item", "sunk") or self._is_raised(node, floor))
            if node.id in held or (node.id in housed and not (small and node.box)):
                continue
            place, how = completion.held_by_box(node, things, self.knowledge) if small else None, "box"
            if place is None and node.id not in housed and node.box is None:
                place, how = completion.usual_place(node, graph.nodes, self.knowledge), "usual"
            if place is None and node.id in between:
                place, how = ("INSIDE", rooms[between[node.id]]), "room"
            elif place is None and node.id not in housed:
                place, how = ("INSIDE", self._room_of(node.box, list(rooms.values()))), "room"
            if place is not None:
                new.append(Edge(node.id, place[0], place[1].id))
                by[how].append(f"{node.class_name} ({node.id}) {place[0]} {place[1].class_name} ({place[1].id})")
        self.note("things on or in others by their boxes", by["box"])
        self.note("things where they usually are, as the file does not say", by["usual"])
        self.note("things in a room that the file does not name", by["room"])
        placed = replace(graph, edges=(*graph.edges, *new))
        return placed if self.keeps_boxes else self._singly_held(placed)

    def _is_raised(self, node: Node, floor: float) -> bool:
        """Return whether a thing that usually stands on the floor is well above it."""
        shaped = form(node.class_name, self.knowledge)
        return shaped is not None and shaped.mount == "floor" and node.box is not None and (
            bottom(node.box) > floor + RAISED)  # fmt: skip

    def _room_of(self, box: Box | None, rooms: Sequence[Node]) -> Node:
        """Return the room whose box is nearest to a box's center; else the first room."""
        known = [(room, room.box) for room in rooms if room.box is not None]
        if box is None or not known:
            return rooms[0]
        near = box

        def outside(held: Box) -> float:
            gaps = (abs(near.center[axis] - held.center[axis]) - held.size[axis] / 2 for axis in (0, 2))
            return max(0.0, *gaps)

        return min(known, key=lambda each: outside(each[1]))[0]

    def _housed(self, graph: EnvironmentGraph) -> EnvironmentGraph:
        """Return the graph in which everything that is on or in something is INSIDE the room of that as well."""
        rooms = [node for node in graph.nodes if node.category == ROOM_CATEGORY]
        below = completion.below(graph)
        above = completion.rooms_above(rooms, below)
        had = set(graph.edges)
        new: list[Edge] = []
        for node in graph.nodes:
            if node.category != ROOM_CATEGORY:
                if node.id not in above:
                    above[node.id] = self._room_of(node.box, rooms).id
                    completion.spread(above, [node.id], below)
                new.append(Edge(node.id, "INSIDE", above[node.id]))
        return replace(graph, edges=(*graph.edges, *(edge for edge in new if edge not in had)))

    def _measured(self, graph: EnvironmentGraph) -> EnvironmentGraph:
        """Return the graph with boxes: the file's, if a person can walk to everything; else those of a layout."""
        if self.keeps_boxes and has_geometry(graph):
            joined, own, doors = with_doors(graph, self.knowledge)
            self.note("doors of the file, by their boxes", own)
            self.note("doors that the file leaves out", doors)
            return joined
        found, notes = with_boxes(graph, self.floors, self.file, self.knowledge)
        for what, examples in notes:
            self.note(what, examples)
        return found


def _is_outline(size: Vector) -> bool:
    """Return whether a room has an outline, or a floor, and no height."""
    return size[1] < LOWEST_ROOM and min(size[0], size[2]) > 0


def _by_height(entry: Entry, other: Entry) -> str:
    """Return ON where the sizes and places of the file put a thing on top of its holder; "" where they do not say."""
    if entry.place is None or entry.size is None or other.place is None or other.size is None:
        return ""
    low, high = entry.place[1] - entry.size[1] / 2, other.place[1] + other.size[1] / 2
    return "ON" if abs(low - high) <= completion.TOUCHING / 2 else ""


def _next(graph: EnvironmentGraph) -> int:
    return max(node.id for node in graph.nodes) + 1


def _numbers(entries: Sequence[Entry]) -> dict[int, int]:
    """Return a node id for each entry, by its `id()`: the file's, where all are numbers; else from 1 in its order."""
    own = [entry.entity.keys[0] if entry.entity.keys else "" for entry in entries]
    ids = [int(text) for text in own if text.isdecimal() and 0 < int(text) < FIRST_ADDED_ID and text[0] != "0"]
    if len(ids) == len(set(ids)) == len(entries):
        return {id(entry): number for entry, number in zip(entries, ids, strict=True)}
    return {id(entry): number for number, entry in enumerate(entries, 1)}
