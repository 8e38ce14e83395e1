"""What a scorer asks of a final graph: the tuples about some nodes. Made from a graph, or straight from a world."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY, STATE_ID
from hearth.simulation import rows
from hearth.simulation.agent import Agent
from hearth.simulation.bits import indices, mask_of
from hearth.simulation.home import Home
from hearth.simulation.nodes import with_states
from hearth.simulation.world import World

DOORS_CATEGORY = "Doors"
DOOR = "door"

StateTuple = tuple[int, str]

Label = int | str | tuple[str, int]
"""What a node is compared by: its counterpart's id, its own id, or its class."""

Tuples = Counter[object]


@dataclass(frozen=True, slots=True)
class Nodes:
    """The nodes of a graph, as far as scoring tells them apart.

    Attributes:
        classes: class name by id.
        instances: ids by class name, ascending.
        left_out: rooms and doors (a door's parts too, such as `doorjamb`), which are not scored.
        characters: who acts.
    """

    classes: Mapping[int, str]
    instances: Mapping[str, tuple[int, ...]]
    left_out: frozenset[int]
    characters: frozenset[int]

    def label(self, node: int) -> Label:
        """What a node is compared by as long as it does not move: rooms, doors, characters by id, else by class."""
        fixed = node in self.characters or node in self.left_out
        return node if fixed else self.classes.get(node, "?")

    def extended(self, nodes: Iterable[Node]) -> Nodes:
        """The table with more nodes, whose ids are above all that it has."""
        more = Nodes.of(nodes)
        joined = {name: self.instances.get(name, ()) + ids for name, ids in more.instances.items()}
        return Nodes(
            {**self.classes, **more.classes},
            {**self.instances, **joined},
            self.left_out | more.left_out,
            self.characters | more.characters,
        )

    @classmethod
    def of(cls, nodes: Iterable[Node]) -> Nodes:
        """The table of some nodes."""
        nodes = sorted(nodes, key=lambda node: node.id)
        instances: dict[str, list[int]] = {}
        for node in nodes:
            instances.setdefault(node.class_name, []).append(node.id)
        return cls(
            classes={node.id: node.class_name for node in nodes},
            instances={name: tuple(ids) for name, ids in instances.items()},
            left_out=frozenset(node.id for node in nodes if _is_room_or_door(node)),
            characters=frozenset(instances.get(CHARACTER_CLASS, ())),
        )


class SortedEdges:
    """Edges by what an alignment of movable nodes can change about them.

    Rooms, doors and characters are told by id, of other nodes that do not move only the class.

    Attributes:
        single: (relation, `to` or `from`, the other end) of each movable node, where the other end does not move.
        to_characters: of these, the ones whose other end is a character.
        between: edges from movable to movable nodes.
        still: (relation, source, target) where neither end moves.
    """

    def __init__(self, movable: Set[int]) -> None:
        self.single: dict[int, Tuples] = {node: Counter() for node in movable}
        self.to_characters: dict[int, Tuples] = {}
        self.between: list[Edge] = []
        self.still: Tuples = Counter()

    def add(self, edge: Edge, nodes: Nodes) -> None:
        """Sort one edge in."""
        source, relation, target = edge
        if source in self.single and target in self.single:
            self.between.append(edge)
        elif source in self.single:
            self.count(source, (relation, "to", nodes.label(target)), target in nodes.characters)
        elif target in self.single:
            self.count(target, (relation, "from", nodes.label(source)), source in nodes.characters)
        else:
            self.still[relation, nodes.label(source), nodes.label(target)] += 1

    def count(self, node: int, item: object, to_character: bool) -> None:
        """Add a tuple about one movable node."""
        self.single[node][item] += 1
        if to_character:
            self.to_characters.setdefault(node, Counter())[item] += 1


class View(Protocol):
    """A final graph as a scorer reads it."""

    @property
    def nodes(self) -> Nodes:
        """The table of its nodes."""

    def states(self, nodes: Collection[int]) -> Iterator[StateTuple]:
        """The states of some nodes, as (id, state), each once."""

    def in_state(self, state: str, nodes: Collection[int]) -> set[int]:
        """Those of some nodes that are in a state."""

    def edges(self, nodes: Collection[int]) -> set[Edge]:
        """Every edge with an end in some nodes."""

    def out(self, relation: str, nodes: Collection[int]) -> set[Edge]:
        """The edges of a relation that go out from some nodes."""

    def sorted_edges(self, movable: Set[int]) -> SortedEdges:
        """The edges of some nodes and of the characters, as an alignment counts them."""


class GraphView:
    """A view of an `EnvironmentGraph`; looks through all its edges at each call."""

    def __init__(self, graph: EnvironmentGraph) -> None:
        self.nodes = Nodes.of(graph.nodes)
        self._graph = graph

    def states(self, nodes: Collection[int]) -> Iterator[StateTuple]:
        """The states of some nodes, as (id, state), each once."""
        wanted = frozenset(nodes)
        return ((node.id, state) for node in self._graph.nodes if node.id in wanted for state in {*node.states})

    def in_state(self, state: str, nodes: Collection[int]) -> set[int]:
        """Those of some nodes that are in a state."""
        return {node for node, name in self.states(nodes) if name == state}

    def out(self, relation: str, nodes: Collection[int]) -> set[Edge]:
        """The edges of a relation that go out from some nodes."""
        wanted = frozenset(nodes)
        return {edge for edge in self._graph.edges if edge.relation == relation and edge.source in wanted}

    def edges(self, nodes: Collection[int]) -> set[Edge]:
        """Every edge with an end in some nodes."""
        wanted = frozenset(nodes)
        return {edge for edge in self._graph.edges if edge.source in wanted or edge.target in wanted}

    def sorted_edges(self, movable: Set[int]) -> SortedEdges:
        """The edges of some nodes and of the characters, as an alignment counts them."""
        return _sorted(self, movable)


class WorldView:
    """A view of a world, equal to that of its graph, which reads only the rows of the nodes asked for."""

    def __init__(self, world: World) -> None:
        self.nodes = nodes_of(world.home)
        self._world = world

    def states(self, nodes: Collection[int]) -> Iterator[StateTuple]:
        """The states of some nodes, as (id, state), each once."""
        world = self._world
        home = world.home
        for node in nodes:
            i = home.index.get(node)
            if i is not None:
                yield from ((node, state) for state in with_states(home.node(i), i, world.states).states)

    def in_state(self, state: str, nodes: Collection[int]) -> set[int]:
        """Those of some nodes that are in a state."""
        number = STATE_ID.get(state)
        if number is None:
            return {node for node, name in self.states(nodes) if name == state}
        row, index = self._world.states[number], self._world.home.index
        return {node for node in nodes if node in index and row >> index[node] & 1}

    def out(self, relation: str, nodes: Collection[int]) -> set[Edge]:
        """The edges of a relation that go out from some nodes."""
        world, read = self._world, _READ.get(relation)
        if world.home.others or (read is None and relation not in _HELD):
            return {edge for edge in self.edges(nodes) if edge.relation == relation and edge.source in nodes}
        ids, index = world.home.ids, world.home.index
        wanted = [index[node] for node in nodes if node in index]
        found = {Edge(ids[i], relation, ids[j]) for i in wanted for j in indices(read(world, i))} if read else set()
        for agent in world.agents:
            mine = ((i, j) for i, name, j in rows.agent_edges(agent) if name == relation and ids[i] in nodes)
            found.update(Edge(ids[i], relation, ids[j]) for i, j in mine)
        return found

    def edges(self, nodes: Collection[int]) -> set[Edge]:
        """Every edge with an end in some nodes."""
        world = self._world
        ids, index = world.home.ids, world.home.index
        wanted = {index[node] for node in nodes if node in index}
        found = {Edge(ids[i], name, ids[j]) for n in wanted for i, name, j in _thing_edges(world, n)}
        for agent in world.agents:
            every = agent.index in wanted
            mine = (edge for edge in rows.agent_edges(agent) if every or edge[0] in wanted or edge[2] in wanted)
            found.update(Edge(ids[i], name, ids[j]) for i, name, j in mine)
        others = (edge for edge in world.home.others if edge[0] in index and edge[2] in index)
        found.update(Edge(*edge) for edge in others if index[edge[0]] in wanted or index[edge[2]] in wanted)
        return found

    def sorted_edges(self, movable: Set[int]) -> SortedEdges:
        """The edges of some nodes and of the characters, as an alignment counts them; read a row at a time."""
        world = self._world
        home = world.home
        if len(world.agents) != 1 or home.others or movable & self.nodes.characters:
            return _sorted(self, movable)
        moving = mask_of(home.index[node] for node in movable)
        found = SortedEdges(movable)
        for i in indices(moving):
            _sort_rows(world, i, moving, found)
        _sort_agent(world.agents[0], home, moving, found)
        return found


_READ = {"ON": rows.on, "INSIDE": rows.inside, "CLOSE": rows.close, "FACING": rows.facing}
_HELD = ("HOLDS_RH", "HOLDS_LH")
"""Relations whose edges between things are rows, and those that only a character's go out by."""

_OUT = (("ON", rows.on), ("INSIDE", rows.inside), ("CLOSE", rows.close), ("FACING", rows.facing))
_INTO = (("ON", rows.bears), ("INSIDE", rows.contents), ("CLOSE", rows.close), ("FACING", rows.faced))


def _sort_rows(world: World, i: int, moving: int, found: SortedEdges) -> None:
    """A movable thing's edges with other things."""
    home = world.home
    ids, labels = home.ids, labels_of(home)
    node = ids[i]
    mine = found.single[node]
    for relation, read in _OUT:
        row = read(world, i)
        found.between.extend([Edge(node, relation, ids[j]) for j in indices(row & moving)])
        for j in indices(row & ~moving):
            mine[relation, "to", labels[j]] += 1
    for relation, read in _INTO:
        for j in indices(read(world, i) & ~moving):
            mine[relation, "from", labels[j]] += 1
    for j in indices(home.between[i]):
        found.add(Edge(node, "BETWEEN", ids[j]), nodes_of(home))


def _sort_agent(agent: Agent, home: Home, moving: int, found: SortedEdges) -> None:
    """The only character's edges."""
    ids, labels = home.ids, labels_of(home)
    me = ids[agent.index]
    out = (("ON", agent.on), ("INSIDE", agent.inside), ("CLOSE", agent.close), ("FACING", agent.facing))
    for relation, row in (*out, ("HOLDS_RH", agent.right), ("HOLDS_LH", agent.left)):
        for j in indices(row & moving):
            found.count(ids[j], (relation, "from", me), to_character=True)
        for j in indices(row & ~moving):
            found.still[relation, me, labels[j]] += 1
    into = (("ON", agent.worn), ("INSIDE", agent.contents), ("CLOSE", agent.close), ("FACING", agent.faced))
    for relation, row in into:
        for j in indices(row & moving):
            found.count(ids[j], (relation, "to", me), to_character=True)
        # An edge from the character to itself is the one that it already has.
        for j in indices(row & ~moving & ~agent.bit):
            found.still[relation, labels[j], me] += 1


def _sorted(view: View, movable: Set[int]) -> SortedEdges:
    found, nodes = SortedEdges(movable), view.nodes
    for edge in view.edges(movable | nodes.characters):
        found.add(edge, nodes)
    return found


def view_of(final: EnvironmentGraph | World) -> View:
    """A graph or world as a view."""
    return WorldView(final) if isinstance(final, World) else GraphView(final)


def _is_room_or_door(node: Node) -> bool:
    return node.category in (ROOM_CATEGORY, DOORS_CATEGORY) or DOOR in node.class_name


@lru_cache(maxsize=64)
def nodes_of(home: Home) -> Nodes:
    """The table of a home: a prediction and its reference end in worlds of the same one.

    Of a home that was made from another by adding nodes, only these are read.
    """
    base = home.base[0] if home.base else None
    if base is None or home.absent or base.absent or home.ids[: len(base)] != base.ids:
        return Nodes.of(home.node(i) for i in indices(home.everything))
    known, new = nodes_of(base), [home.node(i) for i in range(len(base), len(home))]
    return known.extended(new) if new else known


@lru_cache(maxsize=64)
def labels_of(home: Home) -> list[Label]:
    """What each node is compared by as long as it does not move, by index."""
    nodes = nodes_of(home)
    base = home.base[0] if home.base else None
    if base is not None and home.ids[: len(base)] == base.ids:
        return labels_of(base) + [nodes.label(node) for node in home.ids[len(base) :]]
    return [nodes.label(node) for node in home.ids]


def _thing_edges(world: World, i: int) -> Iterator[tuple[int, str, int]]:
    """The edges of a thing to and from other things."""
    out = (("ON", rows.on(world, i)), ("INSIDE", rows.inside(world, i)), ("CLOSE", rows.close(world, i)))
    for relation, row in (*out, ("FACING", rows.facing(world, i)), ("BETWEEN", world.home.between[i])):
        yield from ((i, relation, j) for j in indices(row))
    into = (("ON", rows.bears(world, i)), ("INSIDE", rows.contents(world, i)), ("CLOSE", rows.close(world, i)))
    for relation, row in (*into, ("FACING", rows.faced(world, i))):
        yield from ((j, relation, i) for j in indices(row))
