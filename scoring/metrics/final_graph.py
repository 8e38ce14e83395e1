"""A final graph as scorers read it, whether it is a world or a graph from a file: node by node, edges as rows of bits.

Two graphs that are compared number their nodes alike, so that their common edges are counted on the rows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache, partial

from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY, STATE_ID
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.node_states import states_of
from hearth.simulation.world.world import World

DOORS_CATEGORY = "Doors"
DOOR = "door"

Final = EnvironmentGraph | World

Label = int | str | tuple[str, int]
"""The key by which a node is compared: its counterpart's id, its own id, or its class."""

Direction = tuple[str, bool]
"""A relation, and whether its edges go out from the node that is asked about."""

EdgeRows = Mapping[Direction, int]
"""The nodes that a node has edges with, by number; an edge of two asked nodes stands in the rows of both."""


@dataclass(frozen=True, slots=True)
class Nodes:
    """The nodes of a graph, as far as scoring distinguishes them.

    Attributes:
        classes: class name by id.
        instances: ids by class name, ascending.
        left_out: rooms and doors (a door's parts too, such as `doorjamb`), which are not scored.
        characters: the acting characters.
        labels: the key of each as long as it does not move: rooms, doors, characters by id, else by class.
    """

    classes: Mapping[int, str]
    instances: Mapping[str, tuple[int, ...]]
    left_out: frozenset[int]
    characters: frozenset[int]
    labels: Mapping[int, Label]

    def scored(self, nodes: Iterable[int]) -> frozenset[int]:
        """Return the nodes that can be scored, among some nodes."""
        return frozenset(node for node in nodes if isinstance(self.labels.get(node), str))

    def extended(self, nodes: Iterable[Node]) -> Nodes:
        """Return the table with more nodes, whose ids are above all that it has."""
        more = Nodes.of(nodes)
        joined = {name: self.instances.get(name, ()) + ids for name, ids in more.instances.items()}
        return Nodes(
            {**self.classes, **more.classes},
            {**self.instances, **joined},
            self.left_out | more.left_out,
            self.characters | more.characters,
            {**self.labels, **more.labels},
        )

    @classmethod
    def of(cls, nodes: Iterable[Node]) -> Nodes:
        """Return the table of some nodes."""
        nodes = sorted(nodes, key=lambda node: node.id)
        instances: dict[str, list[int]] = {}
        for node in nodes:
            instances.setdefault(node.class_name, []).append(node.id)
        classes = {node.id: node.class_name for node in nodes}
        left_out = frozenset(node.id for node in nodes if _is_room_or_door(node))
        characters = frozenset(instances.get(CHARACTER_CLASS, ()))
        labels = {node: node if node in left_out or node in characters else name for node, name in classes.items()}
        return cls(classes, {name: tuple(ids) for name, ids in instances.items()}, left_out, characters, labels)


@dataclass(frozen=True, slots=True)
class View:
    """A final graph; each fact about a node is read once.

    Attributes:
        nodes: the table of its nodes.
        ids: node ids by number; those of edges' ends that are no nodes of it, too.
        index: their numbers.
        states: the states of the node of a number.
        rows: its edges, in both directions.
    """

    nodes: Nodes
    ids: list[int]
    index: Mapping[int, int]
    states: Callable[[int], frozenset[str]]
    rows: Callable[[int], EdgeRows]

    def mask(self, nodes: Iterable[int]) -> int:
        """Return some nodes as a set of numbers."""
        return mask_of(map(self.index.__getitem__, nodes))


def views_of(one: Final, other: Final) -> tuple[View, View]:
    """Two graphs or worlds, their nodes numbered alike."""
    if isinstance(one, World) and isinstance(other, World) and one.home is other.home:
        return _of_world(one), _of_world(other)
    first, second = (final.graph() if isinstance(final, World) else final for final in (one, other))
    ids = sorted({*_ids(first), *_ids(second)})
    return _of_graph(first, ids), _of_graph(second, ids)


def _ids(graph: EnvironmentGraph) -> list[int]:
    ends = (end for edge in graph.edges for end in (edge.source, edge.target))
    return sorted({*(node.id for node in graph.nodes), *ends})


def _of_graph(graph: EnvironmentGraph, ids: list[int]) -> View:
    index = {node: i for i, node in enumerate(ids)}
    found: list[dict[Direction, int]] = [{} for _ in ids]
    for source, relation, target in graph.edges:
        i, j = index[source], index[target]
        _add(found[i], (relation, True), 1 << j)
        _add(found[j], (relation, False), 1 << i)
    states = {index[node.id]: frozenset(node.states) for node in graph.nodes}
    return View(Nodes.of(graph.nodes), ids, index, lambda i: states.get(i, frozenset()), found.__getitem__)


def _of_world(world: World) -> View:
    home = world.home

    def states(i: int) -> frozenset[str]:
        fixed = (name for name in home.node(i).states if name not in STATE_ID)
        return frozenset((*states_of(i, world.states), *fixed))

    return View(nodes_of(home), home.ids, home.index, cache(states), cache(partial(_world_rows, world)))


_READ: tuple[tuple[Direction, Callable[[World, int], int], str, str], ...] = (
    (("ON", True), edge_rows.on, "on", "worn"),
    (("ON", False), edge_rows.bears, "worn", "on"),
    (("INSIDE", True), edge_rows.inside, "inside", "contents"),
    (("INSIDE", False), edge_rows.contents, "contents", "inside"),
    (("CLOSE", True), edge_rows.close, "close", "close"),
    (("CLOSE", False), edge_rows.close, "close", "close"),
    (("FACING", True), edge_rows.facing, "facing", "faced"),
    (("FACING", False), edge_rows.faced, "faced", "facing"),
)
"""Readers of edges: of edges between things, of a character's own, and of those of characters with the node."""


def _world_rows(world: World, i: int) -> EdgeRows:
    home = world.home
    found: dict[Direction, int] = {}
    for direction, read, own, other in _READ:
        row = read(world, i)
        for agent in world.agents:
            if agent.index == i:
                row |= getattr(agent, own)
            if getattr(agent, other) >> i & 1:
                row |= agent.bit
        if row:
            found[direction] = row
    for agent in world.agents:
        for relation, held in (("HOLDS_RH", agent.right), ("HOLDS_LH", agent.left)):
            if agent.index == i:
                _add(found, (relation, True), held)
            elif held >> i & 1:
                _add(found, (relation, False), agent.bit)
    _add(found, ("BETWEEN", True), home.between[i])
    for source, relation, target in home.others:
        if home.index.get(source) == i and target in home.index:
            _add(found, (relation, True), 1 << home.index[target])
        if home.index.get(target) == i and source in home.index:
            _add(found, (relation, False), 1 << home.index[source])
    return found


def _add(found: dict[Direction, int], direction: Direction, row: int) -> None:
    if row:
        found[direction] = found.get(direction, 0) | row


def _is_room_or_door(node: Node) -> bool:
    return node.category in (ROOM_CATEGORY, DOORS_CATEGORY) or DOOR in node.class_name


@lru_cache(maxsize=64)
def nodes_of(home: Home) -> Nodes:
    """Return the table of a home: a prediction and its reference end in worlds of the same one.

    Of a home that was made from another by adding nodes, only these are read.
    """
    base = home.base[0] if home.base else None
    if base is None or home.absent or base.absent or home.ids[: len(base)] != base.ids:
        return Nodes.of(home.node(i) for i in indices(home.everything))
    known, new = nodes_of(base), [home.node(i) for i in range(len(base), len(home))]
    return known.extended(new) if new else known
