"""A house of ProcTHOR, read as a home of ours, with a count of everything that was understood, changed or left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from hearth.homes.geometry import Rect, box_over
from hearth.homes.object_shapes import form
from hearth.homes.plans import home_shell
from hearth.homes.plans.home_shell import Shell, Thing
from hearth.homes.plans.layout import PERSON, Layout, standing
from hearth.homes.plans.plan import Doorway, Plan, Room, Window
from hearth.homes.scene_graph import every_thing, node_ids, scene
from hearth.interop.procthor import wall_holes
from hearth.interop.procthor.floor_rectangles import rectangles
from hearth.interop.procthor.house import Hole, House, HouseObject
from hearth.interop.procthor.wall_holes import Piece
from hearth.interop.scene_graphs import completion
from hearth.interop.scene_graphs.class_names import class_of
from hearth.interop.scene_graphs.entities import Entity
from hearth.interop.scene_graphs.entries import states_of
from hearth.interop.scene_graphs.fillings import CLASSES_BY, Filling, ReadGraph
from hearth.interop.scene_graphs.shape import Shape
from hearth.interop.scene_graphs.vectors import Vector, vector
from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.numbers import LONGEST_HOME
from hearth.schemas.vocabulary import CHARACTER_CLASS, FIRST_ADDED_ID, STATE_ID, STATES
from hearth.schemas.yaml_fields import Faults

HEIGHT = 2.5
"""Metres from floor to ceiling of a house without walls."""


def read_house_home(
    house: House, shape: Shape, knowledge: Knowledge, sizes: Mapping[str, Vector], file: str = ""
) -> ReadGraph:
    """Return the home that a house describes.

    Args:
        house: of a file.
        shape: the meaning of its words: its classes and its flags.
        knowledge: for classes.
        sizes: width, height and depth of models, by their ids; other objects have the size of their class.
        file: for faults.

    Raises:
        HearthError: BAD_GRAPH or UNKNOWN_OBJECT: none of its rooms can be a room of ours.
    """
    return _Reading(house, shape, knowledge, sizes, file).read()


@dataclass
class _Reading:
    """The reading of one house, step by step."""

    house: House
    shape: Shape
    knowledge: Knowledge
    sizes: Mapping[str, Vector]
    file: str
    notes: list[Filling] = field(default_factory=list)
    left_out: list[Diagnostic] = field(default_factory=list)

    def read(self) -> ReadGraph:
        self.left_out += self.house.faults
        pieces = self._pieces()
        if not pieces:
            raise HearthError(self.left_out[:20])
        doors = list(self._doors(pieces))
        pieces = self._with_windows(pieces)
        height = max((wall.height for wall in self.house.walls.values()), default=HEIGHT)
        plan = Plan(
            "house", tuple(piece.room for piece in pieces), tuple(doors), height=round(height, 4), file=self.file
        )
        faults = Faults(self.file)
        shell = home_shell.build(plan, faults)
        self.left_out += [replace(fault, line=0) for fault in faults]
        things = self._things(pieces, shell)
        plan = replace(plan, ids=self._ids(plan, shell, things))
        layout = Layout(plan, shell, (*shell.things, *things.values()), self._person(pieces))
        ids = node_ids((thing.name for thing in every_thing(layout)), plan.ids, self.file)
        graph = self._with_states(scene(layout, self.knowledge), things, shell.things, ids)
        own = {ids[name]: name for name in things}
        return ReadGraph(graph, tuple(note for note in self.notes if note.number), tuple(self.left_out), own)

    def _note(self, what: str, examples: Sequence[str]) -> None:
        self.notes.append(Filling(what, len(examples), tuple(dict.fromkeys(examples))[:4]))

    def _leave(self, path: str, message: str, suggestion: str, code: Code = Code.BAD_GRAPH) -> None:
        self.left_out.append(Diagnostic(code, f"{path}: {message}", self.file, suggestion=suggestion))

    def _pieces(self) -> list[Piece]:
        """Return the rectangles of all rooms, each room's largest one first."""
        found: list[Piece] = []
        cornered: list[str] = []
        for number, room in enumerate(self.house.rooms):
            name = room.own.get("class", "")
            name = name if self.knowledge.is_room(str(name)) else class_of(room.label, self.shape, self.knowledge).name
            if not self.knowledge.is_room(name):
                rooms = ", ".join(sorted(filter(self.knowledge.is_room, self.knowledge.objects)))
                self._leave(room.path, f"no room of ours is called `{room.label}`",
                            f"`classes:` of a mapping file names one of {rooms}", Code.UNKNOWN_OBJECT)  # fmt: skip
                continue
            rects = [rect for rect in rectangles(room.corners) if min(rect.width, rect.depth) > 4 * home_shell.WALL]
            if not rects or max(*Rect.over(rects)[2:], Rect.over(rects).width) > LONGEST_HOME * 20:
                self._leave(room.path, "its floor is not made of right angles", "a `floorPolygon` along x and z")
                continue
            cornered += [name] * (len(rects) > 1)
            for part, rect in enumerate(rects, 1):
                own = room.id if part == 1 else f"{room.id}.{part}"
                found.append(Piece(number, Room(own, name, rect, line=number)))
        self._note("rooms", [piece.room.class_name for piece in found if "." not in piece.room.name])
        self._note("rooms with more than four corners, as several rooms without a wall between them", cornered)
        return found

    def _of_room(self, name: str, pieces: Sequence[Piece]) -> list[Piece]:
        return [piece for piece in pieces if self.house.rooms[piece.number].id == name]

    def _doors(self, pieces: Sequence[Piece]) -> Iterator[Doorway]:
        for line, hole in enumerate(self.house.doors, 1):
            where = self._where(hole)
            joined = [self._of_room(name, pieces) for name in dict.fromkeys(hole.rooms)]
            found = where and wall_holes.doorway(hole, where, joined, line) if all(joined) else None
            if found:
                yield found
            else:
                self._leave(hole.path, "no wall of its rooms has place for it", "`wall0`, and a hole within that wall")
        lines = len(self.house.doors)
        gaps = list(wall_holes.open_sides(pieces, self.house.walls))
        for number, (one, other, at, width) in enumerate(gaps, lines + 1):
            yield Doorway((one.room.name, other.room.name), at=at, width=width, leaf=False, line=number)
        self._note("doors and windows", [hole.id for hole in (*self.house.doors, *self.house.windows)])

    def _where(self, hole: Hole) -> wall_holes.Stretch | None:
        wall = self.house.walls.get(hole.wall)
        return None if wall is None else wall_holes.stretch(hole, wall)

    def _with_windows(self, pieces: Sequence[Piece]) -> list[Piece]:
        windows: dict[str, list[Window]] = {}
        for line, hole in enumerate(self.house.windows, 1):
            where = self._where(hole)
            rooms = [piece for name in dict.fromkeys(hole.rooms) for piece in self._of_room(name, pieces)]
            found = None if where is None else wall_holes.window(hole, where, rooms, line)
            if found is None:
                self._leave(hole.path, "no wall of its room has place for it", "`wall0`, and a hole within that wall")
            else:
                windows.setdefault(found[0].room.name, []).append(found[1])
        return [
            replace(piece, room=replace(piece.room, windows=tuple(windows.get(piece.room.name, ()))))
            for piece in pieces
        ]

    def _things(self, pieces: Sequence[Piece], shell: Shell) -> dict[str, Thing]:
        """Return the objects with a class of ours, by their ids, each behind its holder."""
        found: dict[str, Thing] = {}
        ways: dict[str, list[str]] = {}
        unsized: list[str] = []
        gone: dict[str, str] = {}
        for each in self._holders_first():
            name = str(each.own.get("class", ""))
            known = name in self.knowledge.objects and not self.knowledge.is_room(name)
            meant = None if known else class_of(each.label, self.shape, self.knowledge)
            name = name if meant is None else meant.name
            by = "name" if meant is None else meant.by
            if not by and key_of(each.label) not in self.shape.classes:
                near = self.knowledge.suggest(each.label)
                hint = f"did you mean `{near[0]}`? " if near else ""
                self._leave(each.path, f"no class is called `{each.label}`",
                            f"{hint}`classes:` of a mapping file names the class", Code.UNKNOWN_OBJECT)  # fmt: skip
            ways.setdefault(by, []).append(f"{each.label} = {name}" if name else each.label)
            holder = gone.get(each.holder, each.holder)
            if not name or self.knowledge.is_room(name):
                gone[each.id] = holder
                continue
            unsized += [name] * (self._own_size(each) is None)
            found[each.id] = self._thing(replace(each, holder=holder), name, pieces, found, shell)
        for by, what in CLASSES_BY.items():
            self._note(what, ways.get(by, []))
        self._note("sizes from the knowledge", unsized)
        return found

    def _holders_first(self) -> list[HouseObject]:
        """Return the objects, each behind its holder; one that holds itself, by others or not, is named and free."""
        waiting = {each.id: each for each in self.house.objects}
        held: dict[str, list[HouseObject]] = {}
        for each in self.house.objects:
            held.setdefault(each.holder if each.holder in waiting else "", []).append(each)
        found: list[HouseObject] = []
        ready = list(reversed(held.get("", [])))
        while waiting:
            while ready:
                each = ready.pop()
                if waiting.pop(each.id, None) is not None:
                    found.append(each)
                    ready += reversed(held.get(each.id, []))
            for each in list(waiting.values())[:1]:
                self._leave(each.path, f"`{each.id}` holds itself, by others or not", "another `holder`", Code.LOOP)
                ready.append(replace(each, holder=""))
        return found

    def _own_size(self, each: HouseObject) -> Vector | None:
        size: Vector | None = vector(each.own.get("size")) or self.sizes.get(each.asset)
        return size if size is not None and min(size) > 0 and max(size) <= LONGEST_HOME else None

    def _thing(
        self, each: HouseObject, name: str, pieces: Sequence[Piece], others: Mapping[str, Thing], shell: Shell
    ) -> Thing:
        shaped = form(name, self.knowledge)
        size = self._own_size(each) or (shaped.size if shaped is not None else (0.1, 0.1, 0.1))
        box = Box(each.place, turned(size, each.yaw))
        holder = others.get(each.holder)
        room = holder.room if holder is not None else self._room(each, pieces)
        relation = each.own.get("relation")
        if holder is not None and relation not in ("ON", "INSIDE"):
            relation = completion.usual_relation(name, holder.class_name, self.knowledge)
        yaw = None if each.own.get("front") is False else each.yaw
        mount = shaped.mount if shaped is not None and holder is None else "item"
        thing = Thing(each.id, name, room, box, yaw, mount)
        if holder is not None:
            return replace(thing, on=holder.name) if relation == "ON" else replace(thing, inside=holder.name)
        return standing(thing, shell)

    def _room(self, each: HouseObject, pieces: Sequence[Piece]) -> str:
        """Return the room whose floor an object is over, or else the nearest one."""
        own = each.own.get("room")
        named = next((piece.room.name for piece in pieces if piece.room.name == own), None)
        return named or room_at(each.place, pieces)

    def _person(self, pieces: Sequence[Piece]) -> Thing | None:
        if self.house.agent is None:
            return None
        (x, _, z), yaw = self.house.agent
        box = box_over(Rect.around(x, z, PERSON[0], PERSON[2]), 0.0, PERSON[1])
        return Thing(CHARACTER_CLASS, CHARACTER_CLASS, room_at((x, 0.0, z), pieces), box, yaw, "character")

    def _ids(self, plan: Plan, shell: Shell, things: Mapping[str, Thing]) -> dict[str, int]:
        """Return the node ids that a house of ours has: {} where two are one."""
        own: dict[str, Any] = {room.id: room.own.get("id") for room in self.house.rooms}
        own |= {each.id: each.own.get("id") for each in self.house.objects if each.id in things}
        own[CHARACTER_CLASS] = self.house.own.get("character")
        panels = self.house.own.get("panels")
        by_place = {str(place): number for place, number in panels.items()} if isinstance(panels, Mapping) else {}
        for thing in shell.things:
            if thing.mount == "shell":
                own[thing.name] = by_place.get(panel_key(thing.class_name, thing.box))
            elif thing.class_name == "window":
                own[thing.name] = self.house.windows[thing.line - 1].own.get("id")
            elif thing.line <= len(self.house.doors):
                given = self.house.doors[thing.line - 1].own
                own[thing.name] = given.get("jamb" if thing.class_name == "doorjamb" else "id")
        ids = {name: int(str(number)) for name, number in own.items() if str(number).isdecimal()}
        ids = {name: number for name, number in ids.items() if 0 < number < FIRST_ADDED_ID}
        return ids if len(set(ids.values())) == len(ids) else {}

    def _with_states(
        self, graph: EnvironmentGraph, things: Mapping[str, Thing], doors: Sequence[Thing], ids: Mapping[str, int]
    ) -> EnvironmentGraph:
        """Return the graph with the states that the house gives its objects, doors and windows."""
        states = {ids[each.id]: self._states(each) for each in self.house.objects if each.id in things}
        for thing in doors:
            holes = self.house.windows if thing.class_name == "window" else self.house.doors
            if thing.line <= len(holes) and thing.class_name in ("door", "maindoor", "window"):
                states[ids[thing.name]] = _states_of_hole(holes[thing.line - 1], thing.class_name)
        nodes = tuple(self._in_states(node, states.get(node.id, ())) for node in graph.nodes)
        self._note("states of the file", [n.class_name for n in graph.nodes if states.get(n.id)])
        return replace(graph, nodes=nodes)

    def _states(self, each: HouseObject) -> Sequence[str]:
        if isinstance(each.own.get("states"), list):
            return [state for state in each.own["states"] if state in STATES]
        fields = {key_of(str(key)): value for key, value in each.fields.items()}
        openness = fields.get("openness")
        opened = [("OPEN" if openness > 0 else "CLOSED")] if isinstance(openness, int | float) else []
        return [*opened, *states_of(Entity(each.path, (), each.label, each.label, fields), self.shape)]

    def _in_states(self, node: Node, states: Sequence[str]) -> Node:
        found = completion.states_with(states, node.class_name, self.knowledge)
        return replace(node, states=tuple(sorted(found, key=STATE_ID.__getitem__))) if found else node


def _states_of_hole(hole: Hole, class_name: str) -> Sequence[str]:
    own = hole.own.get("states")
    if isinstance(own, list):
        return [state for state in own if state in STATES]
    return () if class_name == "window" else ("OPEN" if hole.is_open else "CLOSED",)


def turned(size: Vector, yaw: float) -> Vector:
    """Return the size of the box around a thing that is turned by quarters; other turns count as none."""
    w, h, d = size
    return (d, h, w) if round(yaw / 90.0, 3) % 2 == 1 else (w, h, d)


def panel_key(class_name: str, box: Box) -> str:
    """Return the name of a part of the building by its place."""
    return f"{class_name} {' '.join(f'{value:.3f}' for value in box.center)}"


def room_at(place: Vector, pieces: Sequence[Piece]) -> str:
    """Return the name of the rectangle that a place is in, or else of the nearest one."""

    def distance(piece: Piece) -> float:
        rect = piece.room.rect
        x, z = place[0], place[2]
        return max(rect.x0 - x, x - rect.x1, rect.z0 - z, z - rect.z1, 0.0)

    return min(pieces, key=distance).room.name
