"""A partial environment: nodes and edges added and removed, states set, and the binding of objects to nodes."""

from collections.abc import Iterable
from random import Random

from hearth.grounding.environments.default_state import Base
from hearth.schemas.graph import Edge, Node
from hearth.schemas.graph_change import State
from hearth.schemas.literals import Key
from hearth.schemas.vocabulary import FIRST_ADDED_ID, OPPOSITE
from hearth.simulation.world.bits import indices
from hearth.simulation.world.derived_homes import restate_further
from hearth.simulation.world.edit import Movable, extended
from hearth.simulation.world.home import Home
from hearth.simulation.world.node_states import states_of


class PartialEnvironment:
    """Grows while one environment is sampled, then becomes a home; the only mutable thing here.

    Attributes:
        base: the home it starts from.
        rng: all its choices.
        nodes: new nodes.
        added, removed: edges.
        states: changed states by node id.
        entered, left: pairs of a node id and one of the further states of action set 3, which it enters or leaves.
        binding: the program's objects.
        room: room's node id by node id, for nodes that are not where the base has them.
        where: (relation, node id) a node stands ON or INSIDE, for nodes placed here.
        movable: the random things, which come last.
        first_id: the first new node's; those after it are numbered on.
        made_bed: whether beds stay made, as by the rule of that name.
        sparing: whether things of the home are moved to where they are needed before others are added. New things
            then stand in usual places.
    """

    def __init__(self, base: Base, rng: Random, made_bed: bool = True, sparing: bool = False) -> None:
        self.base = base
        self.rng = rng
        self.made_bed = made_bed
        self.sparing = sparing
        self.nodes: list[Node] = []
        self.added: list[Edge] = []
        self.removed: list[Edge] = []
        self.states: dict[int, tuple[str, ...]] = {}
        self.entered: list[State] = []
        self.left: list[State] = []
        self.binding: dict[Key, int] = {}
        self.room: dict[int, int] = {}
        self.where: dict[int, tuple[str, int]] = {}
        self.new: dict[int, Node] = {}
        self.taken: set[int] = set()
        self.load: dict[int, int] = {}
        self.movable: list[Movable] = []
        # Homes with added things, and the release's graphs, have ids beyond 1000 of their own.
        self.first_id = max(FIRST_ADDED_ID, base.whole.ids[-1] + 1)

    def home(self) -> Home:
        """Return the home with all changes."""
        new = extended(self.base.home, self.nodes, self.added, self.removed, self.states, self.movable)
        if self.entered or self.left:
            restate_further(new, self.left, self.entered)
        return new

    def room_of(self, node_id: int) -> int:
        """Id of the room a node is in, or -1."""
        known = self.room.get(node_id)
        if known is not None:
            return known
        index = self.base.home.index.get(node_id, -1)
        room = self.base.room[index] if index >= 0 else -1
        return self.base.home.ids[room] if room >= 0 else -1

    def add(self, name: str, room: int) -> int:
        """Return a new node of a class in a room, in its default states; gives its id."""
        node_id = self.first_id + len(self.nodes)
        category, properties, states = self.base.kind(name)
        node = Node(node_id, name, category, properties, states)
        self.nodes.append(node)
        self.new[node_id] = node
        self.settle(node_id, room)
        return node_id

    def settle(self, node_id: int, room: int) -> None:
        """Set the room of a new or lifted node."""
        self.room[node_id] = room
        if room >= 0:
            self.added.append(Edge(node_id, "INSIDE", room))

    def lift(self, node_id: int) -> None:
        """Take a node of the base out of where it is: it loses ON, INSIDE and CLOSE."""
        home = self.base.home
        i = home.index[node_id]
        ids = home.ids
        self.removed.extend(Edge(node_id, "ON", ids[j]) for j in indices(home.on[i]))
        self.removed.extend(Edge(node_id, "INSIDE", ids[j]) for j in indices(home.inside[i]))
        self.removed.extend(Edge(node_id, "CLOSE", ids[j]) for j in indices(home.close[i]))

    def put(self, node_id: int, relation: str, place: int) -> None:
        """Put a node ON or INSIDE another: it is CLOSE to it and to its other contents."""
        self.where[node_id] = (relation, place)
        self.load[place] = self.load.get(place, 0) + 1
        self.added.append(Edge(node_id, relation, place))
        for other in self._around(node_id, relation, place):
            self.close(node_id, other)

    def _around(self, node_id: int, relation: str, place: int) -> list[int]:
        """Return a place and its other contents in the base."""
        home = self.base.home
        i = home.index.get(place)
        contents = 0 if i is None else home.bears[i] if relation == "ON" else home.contents[i]
        return [place, *(home.ids[j] for j in indices(contents) if home.ids[j] != node_id)]

    def take_up(self, node_id: int) -> None:
        """Take a node off the place where it was put, or where the base has it: it is in its room only, as after Grab.

        Clothes stay on the character: PutOff needs them there, and leaves them in the hand that has them.
        """
        if node_id in self.where:
            relation, place = self.where.pop(node_id)
            self.load[place] -= 1
            gone = {("CLOSE", other) for other in self._around(node_id, relation, place)} | {(relation, place)}
            self.added = [e for e in self.added if e.source != node_id or (e.relation, e.target) not in gone]
        elif node_id not in self.room:
            room = self.room_of(node_id)
            self.lift(node_id)
            self.settle(node_id, room)

    def close(self, one: int, other: int) -> None:
        """Make two nodes CLOSE to each other."""
        self.added.append(Edge(one, "CLOSE", other))

    def set_state(self, node_id: int, state: str) -> None:
        """Put a node into a state and out of the opposite."""
        now = self.states_now(node_id)
        excluded = (state, *self.base.knowledge.excludes(state), OPPOSITE.get(state))
        self.states[node_id] = (*(name for name in now if name not in excluded), state)

    def set_further(self, node_id: int, states: Iterable[str], instead: Iterable[str]) -> None:
        """Put a node into further states of action set 3, and out of others."""
        self.left += ((node_id, name) for name in instead)
        self.entered += ((node_id, name) for name in states)

    def states_now(self, node_id: int) -> tuple[str, ...]:
        """Return the states of a node so far."""
        known = self.states.get(node_id)
        if known is not None:
            return known
        if node_id in self.new:
            return self.new[node_id].states
        return states_of(self.base.home.index[node_id], self.base.home.states)

    def places(self, node_id: int) -> tuple[int, ...]:
        """Return the ids of a node's supports and containers, rooms left out."""
        if node_id in self.where:
            return (self.where[node_id][1],)
        home = self.base.home
        i = home.index.get(node_id)
        if i is None or node_id in self.room:
            return ()
        return tuple(home.ids[j] for j in indices((home.on[i] | home.inside[i]) & ~home.rooms))

    def crowd(self, node_id: int) -> int:
        """Return how many things are ON a node."""
        i = self.base.home.index.get(node_id)
        standing = self.base.home.bears[i].bit_count() if i is not None else 0
        return standing + self.load.get(node_id, 0)

    def classes_on(self, node_id: int) -> list[str]:
        """Return the classes of the nodes that `crowd` counts."""
        home, new = self.base.home, self.new
        i = home.index.get(node_id)
        put = [other for other, place in self.where.items() if place == ("ON", node_id)]
        found = [new[other].class_name if other in new else home.classes[home.index[other]] for other in put]
        return found + ([home.classes[j] for j in indices(home.bears[i])] if i is not None else [])

    def turned_back(self, i: int) -> int:
        """Return the bedding of the base's beds and couches: it takes no room there."""
        home = self.base.home
        return home.bears[i] & home.bedding if home.properties["LIEABLE"] >> i & 1 else 0
