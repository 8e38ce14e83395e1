"""What a scorer asks of a final graph: the tuples about some nodes. Made from a graph, or straight from a world."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from functools import cached_property
from typing import Protocol

from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY
from hearth.simulation import rows
from hearth.simulation.bits import indices
from hearth.simulation.nodes import states_of
from hearth.simulation.world import World

DOORS_CATEGORY = "Doors"
DOOR = "door"


class View(Protocol):
    """A final graph as its scorer reads it. `classes` are the class names by node id."""

    @property
    def classes(self) -> dict[int, str]: ...

    @property
    def left_out(self) -> frozenset[int]:
        """Rooms and doors, which are not scored."""

    @property
    def characters(self) -> frozenset[int]: ...

    def instances(self, class_name: str) -> tuple[int, ...]:
        """The nodes of a class, ascending."""

    def states(self, nodes: Collection[int]) -> Iterable[tuple[int, str]]:
        """The states of some nodes, as (id, state)."""

    def edges(self, nodes: Collection[int]) -> Iterable[Edge]:
        """Every edge with an end in some nodes, each once."""


def view_of(final: EnvironmentGraph | World) -> View:
    """A graph or world as a view."""
    return WorldView(final) if isinstance(final, World) else GraphView(final)


def is_door(class_name: str, category: str) -> bool:
    """Whether a node is a door, or part of one (`doorjamb`)."""
    return category == DOORS_CATEGORY or DOOR in class_name


class _Classes:
    """Which nodes are of which class; read from `_nodes`, (id, class, category) of each."""

    @cached_property
    def _nodes(self) -> list[tuple[int, str, str]]:
        raise NotImplementedError

    @cached_property
    def classes(self) -> dict[int, str]:
        return {node: class_name for node, class_name, _ in self._nodes}

    @cached_property
    def left_out(self) -> frozenset[int]:
        return frozenset(n for n, name, category in self._nodes if category == ROOM_CATEGORY or is_door(name, category))

    @cached_property
    def characters(self) -> frozenset[int]:
        return frozenset(node for node, class_name, _ in self._nodes if class_name == CHARACTER_CLASS)

    def instances(self, class_name: str) -> tuple[int, ...]:
        return self._by_class.get(class_name, ())

    @cached_property
    def _by_class(self) -> dict[str, tuple[int, ...]]:
        found: dict[str, list[int]] = {}
        for node, class_name, _ in sorted(self._nodes):
            found.setdefault(class_name, []).append(node)
        return {name: tuple(nodes) for name, nodes in found.items()}


class GraphView(_Classes):
    """A view of an `EnvironmentGraph`; looks through all its edges once a call."""

    def __init__(self, graph: EnvironmentGraph) -> None:
        self._graph = graph

    @cached_property
    def _nodes(self) -> list[tuple[int, str, str]]:
        return [(node.id, node.class_name, node.category) for node in self._graph.nodes]

    def states(self, nodes: Collection[int]) -> Iterator[tuple[int, str]]:
        wanted = frozenset(nodes)
        return ((node.id, state) for node in self._graph.nodes if node.id in wanted for state in set(node.states))

    def edges(self, nodes: Collection[int]) -> set[Edge]:
        wanted = frozenset(nodes)
        return {edge for edge in self._graph.edges if edge.source in wanted or edge.target in wanted}


class WorldView(_Classes):
    """A view of a world, which reads only the rows of the nodes asked for: a hundredth of rebuilding the graph."""

    def __init__(self, world: World) -> None:
        self._world = world

    @cached_property
    def _nodes(self) -> list[tuple[int, str, str]]:
        home = self._world.home
        return [(node.id, node.class_name, node.category) for node in map(home.node, range(len(home)))]

    def states(self, nodes: Collection[int]) -> Iterator[tuple[int, str]]:
        world = self._world
        index = world.home.index
        for node in nodes:
            if node in index:
                yield from ((node, state) for state in states_of(index[node], world.states))

    def edges(self, nodes: Collection[int]) -> set[Edge]:
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


def _thing_edges(world: World, i: int) -> Iterator[tuple[int, str, int]]:
    """The edges of a thing to and from other things."""
    out = (("ON", rows.on(world, i)), ("INSIDE", rows.inside(world, i)), ("CLOSE", rows.close(world, i)))
    for relation, row in (*out, ("FACING", rows.facing(world, i)), ("BETWEEN", world.home.between[i])):
        yield from ((i, relation, j) for j in indices(row))
    into = (("ON", rows.bears(world, i)), ("INSIDE", rows.contents(world, i)), ("CLOSE", rows.close(world, i)))
    for relation, row in (*into, ("FACING", rows.faced(world, i))):
        yield from ((j, relation, i) for j in indices(row))
