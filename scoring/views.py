"""What a scorer asks of a final graph: the tuples about some nodes. Made from a graph, or straight from a world."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY
from hearth.simulation import rows
from hearth.simulation.bits import indices
from hearth.simulation.home import Home
from hearth.simulation.nodes import with_states
from hearth.simulation.world import World

DOORS_CATEGORY = "Doors"
DOOR = "door"

StateTuple = tuple[int, str]


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


class View(Protocol):
    """A final graph as a scorer reads it."""

    @property
    def nodes(self) -> Nodes:
        """The table of its nodes."""

    def states(self, nodes: Collection[int]) -> Iterator[StateTuple]:
        """The states of some nodes, as (id, state), each once."""

    def edges(self, nodes: Collection[int]) -> set[Edge]:
        """Every edge with an end in some nodes."""


class GraphView:
    """A view of an `EnvironmentGraph`; looks through all its edges at each call."""

    def __init__(self, graph: EnvironmentGraph) -> None:
        self.nodes = Nodes.of(graph.nodes)
        self._graph = graph

    def states(self, nodes: Collection[int]) -> Iterator[StateTuple]:
        """The states of some nodes, as (id, state), each once."""
        wanted = frozenset(nodes)
        return ((node.id, state) for node in self._graph.nodes if node.id in wanted for state in {*node.states})

    def edges(self, nodes: Collection[int]) -> set[Edge]:
        """Every edge with an end in some nodes."""
        wanted = frozenset(nodes)
        return {edge for edge in self._graph.edges if edge.source in wanted or edge.target in wanted}


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


def view_of(final: EnvironmentGraph | World) -> View:
    """A graph or world as a view."""
    return WorldView(final) if isinstance(final, World) else GraphView(final)


def _is_room_or_door(node: Node) -> bool:
    return node.category in (ROOM_CATEGORY, DOORS_CATEGORY) or DOOR in node.class_name


@lru_cache(maxsize=4)
def nodes_of(home: Home) -> Nodes:
    """The table of a home: a prediction and its reference end in worlds of the same one."""
    return Nodes.of(home.node(i) for i in range(len(home)))


def _thing_edges(world: World, i: int) -> Iterator[tuple[int, str, int]]:
    """The edges of a thing to and from other things."""
    out = (("ON", rows.on(world, i)), ("INSIDE", rows.inside(world, i)), ("CLOSE", rows.close(world, i)))
    for relation, row in (*out, ("FACING", rows.facing(world, i)), ("BETWEEN", world.home.between[i])):
        yield from ((i, relation, j) for j in indices(row))
    into = (("ON", rows.bears(world, i)), ("INSIDE", rows.contents(world, i)), ("CLOSE", rows.close(world, i)))
    for relation, row in (*into, ("FACING", rows.faced(world, i))):
        yield from ((j, relation, i) for j in indices(row))
