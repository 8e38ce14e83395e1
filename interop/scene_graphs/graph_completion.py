"""Everything that a home of ours has and a file does not say, filled into its graph, with a count of each kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from hearth.homes.from_graph.layout_from_boxes import has_geometry
from hearth.homes.geometry import bottom
from hearth.homes.object_shapes import form
from hearth.interop.scene_graphs import completion
from hearth.interop.scene_graphs.fillings import Filling
from hearth.interop.scene_graphs.room_doors import with_doors
from hearth.interop.scene_graphs.room_extents import with_boxes
from hearth.interop.scene_graphs.single_holders import with_single_holders
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import ROOM_CATEGORY

RAISED = 0.3
"""Metres above the floor from which a thing stands on something else."""


@dataclass
class GraphCompletion:
    """The completion of the graph of one file.

    Attributes:
        knowledge: for classes.
        file: its name.
        keeps_boxes: whether boxes of rooms stay as they are.
        notes: what was understood, filled in or changed.
        left_out: entries and relations that are not in the graph.
        floors: boxes of the floors of the file.
        paths: where nodes stand in the file.
    """

    knowledge: Knowledge
    file: str
    keeps_boxes: bool = False
    notes: list[Filling] = field(default_factory=list)
    left_out: list[Diagnostic] = field(default_factory=list)
    floors: list[Box] = field(default_factory=list)
    paths: dict[int, str] = field(default_factory=dict)

    def counted(self) -> tuple[Filling, ...]:
        """Return what was noted, in its order."""
        return tuple(note for note in self.notes if note.number)

    def note(self, what: str, examples: Sequence[str]) -> None:
        """Note what was understood, filled in or changed, with a word for each case."""
        self.notes.append(Filling(what, len(examples), tuple(dict.fromkeys(examples))[:4]))

    def _leave(self, code: Code, message: str, path: str, suggestion: str = "") -> None:
        self.left_out.append(Diagnostic(code, f"{path}: {message}", self.file, suggestion=suggestion))

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

    def completed(self, graph: EnvironmentGraph) -> EnvironmentGraph:
        """Return the graph with everything that a home of ours has and the file does not say."""
        graph = self._placed(graph)
        graph = self._housed(graph)
        person = completion.with_person(graph, completion.next_id(graph))
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
        steady = [node for node in things if not self.knowledge.has(node.class_name, "GRABBABLE")]
        for node in things:
            shaped = form(node.class_name, self.knowledge)
            small = shaped is not None and (shaped.mount in ("item", "sunk") or self._is_raised(node, floor))
            if node.id in held or (node.id in housed and not (small and node.box)):
                continue
            # Furniture stands on furniture, and never on a thing that a person picks up.
            under = steady if shaped is not None and shaped.mount == "floor" else things
            place, how = completion.held_by_box(node, under, self.knowledge) if small else None, "box"
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
