"""Places by a scene graph's relations: rooms, doors, and for each thing its support or container."""

from collections import defaultdict

from hearth.homes.object_shapes import form
from hearth.homes.plans.plan import Piece
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY

SHELL = frozenset({"wall", "floor", "ceiling", "window", "door", "doorjamb", "maindoor", "curtain"})
"""Classes that the rooms themselves bring."""
DOORS = frozenset({"door", "doorjamb", "maindoor"})


class Parts:
    """A graph, read for its layout.

    Attributes:
        nodes: by id.
        rooms: ids of the rooms.
        room: id of the room of each node that has one.
        parent: (id, `on` or `inside`) of the thing's support or container, shell and rooms left out.
        children: ids of the things on or in a thing.
        over: what else a thing is ON: rugs, the floor.
        between: the two rooms of each door.
        under: what is ON a rug, a tile or a wall, by that.
        near, faces: CLOSE and FACING, by source.
        relations: ON, CLOSE (by source only) and FACING of each node, as (relation, other, whether it is the source);
            of INSIDE only what the shell is in (a curtain in a shower).
    """

    def __init__(self, graph: EnvironmentGraph, knowledge: Knowledge) -> None:
        self.knowledge = knowledge
        self.nodes: dict[int, Node] = {node.id: node for node in graph.nodes}
        self.rooms = [node.id for node in graph.nodes if node.category == ROOM_CATEGORY]
        targets: dict[str, dict[int, list[int]]] = defaultdict(lambda: defaultdict(list))
        for edge in graph.edges:
            if edge.source in self.nodes and edge.target in self.nodes and edge.source != edge.target:
                targets[edge.relation][edge.source].append(edge.target)
        self.near, self.faces = targets["CLOSE"], targets["FACING"]
        self.relations: dict[int, list[tuple[str, int, bool]]] = defaultdict(list)
        for relation in ("ON", "CLOSE", "FACING", "INSIDE"):
            for source, found in targets[relation].items():
                for target in found:
                    if relation == "INSIDE" and (target in self.rooms or self.nodes[source].class_name not in SHELL):
                        continue
                    self.relations[source].append((relation, target, True))
                    if relation != "CLOSE":
                        self.relations[target].append((relation, source, False))
        self.between = {
            door: (pair[0], pair[1])
            for door, found in targets["BETWEEN"].items()
            if len(pair := sorted(set(found) & set(self.rooms))) == 2
        }
        self._places = {"ON": targets["ON"], "INSIDE": targets["INSIDE"]}
        self.parent: dict[int, tuple[int, str]] = {}
        for relation, word in (("INSIDE", "inside"), ("ON", "on"), ("INSIDE", "within")):
            for child, places in sorted(targets[relation].items()):
                self._settle(child, word, places)
        self.over = {child: places for child, places in targets["ON"].items() if child not in self.parent}
        self.under: dict[int, list[int]] = defaultdict(list)
        for child, places in self.over.items():
            for place in places:
                self.under[place].append(child)
        self.children: dict[int, list[int]] = defaultdict(list)
        for child, (parent, _) in self.parent.items():
            self.children[parent].append(child)
        self.room = {node: room for node in self.nodes if (room := self._room(node, targets["INSIDE"])) >= 0}

    def _settle(self, child: int, word: str, places: list[int]) -> None:
        """Note what a thing stands on or in: the smallest of several, never what stands on or in itself."""
        if child in self.parent or not self._is_thing(child):
            return
        able = [place for place in places if self._bears(place, word) and child not in self._line(place)]
        if able and not (word == "within" and self._stands(child)):
            place = min(able, key=lambda place: (self._volume(place), place))
            self.parent[child] = (place, self._within(child) if word == "within" else word)

    def _within(self, child: int) -> str:
        """Return the word for a place in furniture without a container: sinks are let in, pillows lie on top."""
        shaped = form(self.nodes[child].class_name, self.knowledge)
        return "inside" if shaped is None or shaped.mount == "sunk" else "on"

    def _is_thing(self, node: int) -> bool:
        known = self.nodes[node]
        plain = known.category == ROOM_CATEGORY or known.class_name == CHARACTER_CLASS
        return not plain and known.class_name not in SHELL

    def _bears(self, place: int, word: str) -> bool:
        """Return whether things are put there: what is on a rug stands on the floor."""
        shaped = form(self.nodes[place].class_name, self.knowledge)
        if word == "inside" and not {"CONTAINERS", "CAN_OPEN"} & set(self.nodes[place].properties):
            return False
        return self._is_thing(place) and shaped is not None and not (word == "on" and shaped.mount == "flat")

    def _stands(self, child: int) -> bool:
        """Return whether a thing stands on the floor by its nature.

        VirtualHome's boxes make a table INSIDE the couch whose corner it fills, and chairs INSIDE a counter.
        """
        shaped = form(self.nodes[child].class_name, self.knowledge)
        return shaped is not None and shaped.mount in ("floor", "wall")

    def _line(self, node: int) -> list[int]:
        """Return a thing and all it stands on or in."""
        line = [node]
        while line[-1] in self.parent:
            line.append(self.parent[line[-1]][0])
        return line

    def _volume(self, node: int) -> float:
        shaped = form(self.nodes[node].class_name, self.knowledge)
        return shaped.size[0] * shaped.size[1] * shaped.size[2] if shaped else 0.0

    def _room(self, node: int, inside: dict[int, list[int]]) -> int:
        for place in self._line(node):
            found = [target for target in inside.get(place, ()) if target in self.rooms]
            if found:
                return min(found)
        return -1

    def both_ways(self, one: int, other: int) -> tuple[str, ...]:
        """Return which of ON and INSIDE two things have in both directions."""
        return tuple(name for name, places in self._places.items()
                     if other in places.get(one, ()) and one in places.get(other, ()))  # fmt: skip

    def roots(self, room: int) -> list[int]:
        """Return the things that stand in a room on nothing else, the largest first."""
        found = [n for n, r in self.room.items() if r == room and n not in self.parent and self._is_thing(n)]
        return sorted(found, key=lambda node: (-self._footprint(node), node))

    def _footprint(self, node: int) -> float:
        shaped = form(self.nodes[node].class_name, self.knowledge)
        return round(shaped.size[0] * shaped.size[2], 4) if shaped else 0.0

    def of_class(self, room: int, class_name: str) -> list[int]:
        """Return the nodes of a class in a room, by id."""
        return sorted(n for n, r in self.room.items() if r == room and self.nodes[n].class_name == class_name)

    def area(self, room: int) -> float:
        """Return the floor that a room's things take, in square metres."""
        kinds = ((node, form(self.nodes[node].class_name, self.knowledge)) for node in self.roots(room))
        return sum(self._footprint(node) for node, shaped in kinds if shaped and shaped.mount in ("floor", "item"))

    def piece(self, node: int) -> Piece:
        """Return a thing with the things on and in it, as a plan's entry that is called by the node's id."""
        shaped = self._shaped_family(node)
        pieces: dict[int, Piece] = {}
        for each in reversed(shaped):  # what is on and in a thing comes before it
            under: dict[str, list[Piece]] = {"on": [], "inside": []}
            for child in sorted(self.children.get(each, ())):
                if child in pieces:
                    under[self.parent[child][1]].append(pieces[child])
            on, inside = tuple(under["on"]), tuple(under["inside"])
            pieces[each] = Piece(self.nodes[each].class_name, str(each), on=on, inside=inside, line=each)
        return pieces[node]

    def _shaped_family(self, node: int) -> list[int]:
        """Return a thing and everything with a form on and in it, each after its support or container."""
        found = [node]
        for each in found:  # it grows meanwhile: containers may be in each other a thousand deep
            children = self.children.get(each, ())
            found += [child for child in children if form(self.nodes[child].class_name, self.knowledge) is not None]
        return found

    def family(self, node: int) -> set[int]:
        """Return a thing and everything on and in it."""
        found = [node]
        for each in found:
            found += self.children.get(each, ())
        return set(found)
