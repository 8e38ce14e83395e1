"""The world of the plain engine: dicts of sets, changed in place."""

from __future__ import annotations

from collections import defaultdict

from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph

OPPOSITE = {
    "OPEN": "CLOSED", "ON": "OFF", "CLEAN": "DIRTY", "PLUGGED_IN": "PLUGGED_OUT", "SITTING": "LYING",
    "CLOSED": "OPEN", "OFF": "ON", "DIRTY": "CLEAN", "PLUGGED_OUT": "PLUGGED_IN", "LYING": "SITTING",
}  # fmt: skip
RELATIONS = ("ON", "INSIDE", "CLOSE", "FACING", "BETWEEN", "HOLDS_RH", "HOLDS_LH")


class RefusedError(Exception):
    """An instruction that cannot be done."""

    def __init__(self, code: Code) -> None:
        super().__init__(code)
        self.code = code


def need(condition: object, code: Code) -> None:
    if not condition:
        raise RefusedError(code)


class World:
    """Nodes and relations, changed in place."""

    def __init__(self, graph: EnvironmentGraph, release: bool = False) -> None:
        self.release = release
        self.ids = sorted(node.id for node in graph.nodes)
        self.name = {node.id: node.class_name for node in graph.nodes}
        self.properties = {node.id: set(node.properties) for node in graph.nodes}
        self.body = {node.id for node in graph.nodes if "BODY_PART" in node.properties}
        self.furniture = {node.id for node in graph.nodes if node.category == "Furniture"}
        self.rooms = {node.id for node in graph.nodes if node.category == "Rooms"}
        self.me = next(node.id for node in graph.nodes if node.class_name == "character")
        self.states: dict[int, set[str]] = {}
        for node in graph.nodes:
            self.states[node.id] = set()
            for state in node.states:
                if OPPOSITE.get(state) not in self.states[node.id]:
                    self.states[node.id].add(state)
        self.to: dict[str, dict[int, set[int]]] = {r: defaultdict(set) for r in RELATIONS}
        self.back: dict[str, dict[int, set[int]]] = {r: defaultdict(set) for r in RELATIONS}
        for edge in graph.edges:
            self.link(edge.source, edge.relation, edge.target)
        self.origins: dict[int, tuple[int, str]] = {}

    def copy(self) -> World:
        other = object.__new__(World)
        other.__dict__.update(self.__dict__)
        other.states = {node: set(states) for node, states in self.states.items()}
        other.to, other.back = _copied(self.to), _copied(self.back)
        other.origins = dict(self.origins)
        return other

    def link(self, a: int, relation: str, b: int) -> None:
        self.to[relation][a].add(b)
        self.back[relation][b].add(a)
        if relation == "CLOSE":
            self.to[relation][b].add(a)
            self.back[relation][a].add(b)

    def unlink(self, a: int, relation: str, b: int) -> None:
        self.to[relation][a].discard(b)
        self.back[relation][b].discard(a)
        if relation == "CLOSE":
            self.to[relation][b].discard(a)
            self.back[relation][a].discard(b)

    def isolate(self, x: int, *relations: str) -> None:
        """Take away every edge of x of these relations, in both directions."""
        for relation in relations:
            for y in list(self.to[relation][x]):
                self.unlink(x, relation, y)
            for y in list(self.back[relation][x]):
                self.unlink(y, relation, x)

    def has(self, x: int, *properties: str) -> bool:
        return not self.properties[x].isdisjoint(properties)

    def is_(self, x: int, state: str) -> bool:
        return state in self.states[x]

    def enter(self, x: int, state: str) -> None:
        self.states[x].discard(OPPOSITE[state])
        self.states[x].add(state)

    def room(self, x: int) -> int | None:
        """x itself, or the room reached along INSIDE; the lowest id of several at one distance."""
        if x in self.rooms:
            return x
        seen, frontier = {x}, set(self.to["INSIDE"][x])
        while frontier:
            if frontier & self.rooms:
                return min(frontier & self.rooms)
            seen |= frontier
            frontier = {y for x in frontier for y in self.to["INSIDE"][x]} - seen
        return None

    def hidden(self, x: int) -> bool:
        return any(y not in self.rooms and self.is_(y, "CLOSED") for y in self.to["INSIDE"][x])

    def close(self, x: int, options: Options) -> bool:
        mine = self.to["CLOSE"][self.me]
        if options.near_hands and x not in mine and self.room(x) != self.room(self.me):
            mine = mine - self.body
        return x in mine or any(y in self.to["CLOSE"][x] or y in self.to["ON"][x] for y in mine)

    def facing(self, x: int) -> bool:
        mine = self.to["FACING"][self.me]
        return x in mine or any(x in self.to["FACING"][y] for y in mine)

    def held(self) -> set[int]:
        return self.to["HOLDS_RH"][self.me] | self.to["HOLDS_LH"][self.me]

    def free_hand(self) -> str | None:
        for hand in ("HOLDS_RH", "HOLDS_LH"):
            if not self.to[hand][self.me]:
                return hand
        return None

    def let_go(self, x: int) -> None:
        self.unlink(self.me, "HOLDS_RH", x)
        self.unlink(self.me, "HOLDS_LH", x)

    def resting(self) -> bool:
        return self.is_(self.me, "SITTING") or self.is_(self.me, "LYING")

    def edges(self) -> set[tuple[int, str, int]]:
        return {(a, r, b) for r, rows in self.to.items() for a, row in rows.items() for b in row}

    def state_pairs(self) -> set[tuple[int, str]]:
        return {(x, state) for x, states in self.states.items() for state in states}


class Options:
    """Rules of the plain engine: doors stop walks, things that are off are not watched, bedding takes no room, hands
    reach into no other room, walks are those of `evolving_graph`, held things are not grabbed again, a seat is left.
    """

    def __init__(
        self,
        doors: bool = True,
        watch_needs_on: bool = True,
        made_bed: bool = True,
        near_hands: bool = True,
        today: bool = False,
        one_grip: bool = False,
        leaves_seat: bool = True,
    ) -> None:
        self.doors = doors
        self.watch_needs_on = watch_needs_on
        self.made_bed = made_bed
        self.near_hands = near_hands
        self.today = today
        self.one_grip = one_grip
        self.leaves_seat = leaves_seat


def _copied(relations: dict[str, dict[int, set[int]]]) -> dict[str, dict[int, set[int]]]:
    return {
        name: defaultdict(set, {node: set(others) for node, others in rows.items()}) for name, rows in relations.items()
    }
