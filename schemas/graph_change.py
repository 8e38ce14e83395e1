"""The difference of two graphs: the form in which ticks, environments and final graphs are published.

`encode` compares two graphs, and `apply` makes the later one from the earlier one. Worlds are compared faster, by their
movements (`simulation.world.world_change`), with the same result; `datasets.format.row_conversion` reads and writes
rows of tables.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping, Set
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import EVERY_STATE_ID, STATE_ID

State = tuple[int, str]
"""A node's id and a state it is in."""


@dataclass(frozen=True, slots=True)
class Change:
    """Added and removed nodes, edges and states; all sorted.

    A removed node takes its edges and states with it, and an added one brings its states; one that is both gives way to
    another of its id. What is removed and cleared is so before anything is added and set.

    Attributes:
        added, removed: edges.
        set_states, cleared_states: states of nodes that are there before and after.
        added_nodes: in the order of their ids.
        removed_nodes: ids.
    """

    added: tuple[Edge, ...] = ()
    removed: tuple[Edge, ...] = ()
    set_states: tuple[State, ...] = ()
    cleared_states: tuple[State, ...] = ()
    added_nodes: tuple[Node, ...] = ()
    removed_nodes: tuple[int, ...] = ()

    __repr__ = brief

    def __bool__(self) -> bool:
        edges, states = self.added or self.removed, self.set_states or self.cleared_states
        return bool(edges or states or self.added_nodes or self.removed_nodes)

    def where(
        self, edge: Callable[[Edge], bool] = lambda edge: True, node: Callable[[int], bool] = lambda node_id: True
    ) -> Change:
        """Return the part of it that is about some edges and the states of some nodes.

        Removed nodes, whose edges are not listed, stay in it.
        """
        return Change(
            tuple(filter(edge, self.added)),
            tuple(filter(edge, self.removed)),
            tuple(state for state in self.set_states if node(state[0])),
            tuple(state for state in self.cleared_states if node(state[0])),
            tuple(new for new in self.added_nodes if node(new.id)),
            self.removed_nodes,
        )


_NO_NODES: Mapping[int, Node] = {}


class Parts(NamedTuple):
    """A graph in the form that is compared.

    Attributes:
        edges: its edges.
        states: the simulated states that its nodes are in.
        nodes: by id; none where it is known that both graphs have the same.
    """

    edges: Set[Edge]
    states: Set[State]
    nodes: Mapping[int, Node] = _NO_NODES

    def __repr__(self) -> str:
        return brief(self)


def encode(before: EnvironmentGraph, after: EnvironmentGraph) -> Change:
    """Return the change from `before` to `after`; order and repetitions make no difference."""
    return difference(_parts(before), _parts(after), EVERY_STATE_ID)


def difference(before: Parts, after: Parts, simulated: Container[str] = STATE_ID) -> Change:
    """Return the change from `before` to `after`.

    Args:
        before, after: the graphs.
        simulated: the states that are compared as states; nodes that differ in others give way to each other.
    """
    removed = {i for i, node in before.nodes.items() if not _same(node, after.nodes.get(i), simulated)}
    new = sorted(i for i in after.nodes if i in removed or i not in before.nodes)
    edges, past, now = before.edges, before.states, after.states
    if removed:
        edges = {edge for edge in edges if edge.source not in removed and edge.target not in removed}
        past = {state for state in past if state[0] not in removed}
    if new:
        fresh = set(new)
        now = {state for state in now if state[0] not in fresh}
    return Change(
        tuple(sorted(after.edges - edges)),
        tuple(sorted(edges - after.edges)),
        tuple(sorted(now - past)),
        tuple(sorted(past - now)),
        tuple(after.nodes[i] for i in new),
        tuple(sorted(removed)),
    )


def states_of(nodes: Iterable[Node]) -> set[State]:
    """Return the states that nodes are in and that worlds of some action set simulate."""
    return {(node.id, state) for node in nodes for state in node.states if state in EVERY_STATE_ID}


def _parts(graph: EnvironmentGraph) -> Parts:
    return Parts(set(graph.edges), states_of(graph.nodes), {node.id: node for node in graph.nodes})


def _same(one: Node, other: Node | None, simulated: Container[str]) -> bool:
    """Return whether two nodes are equal, simulated states aside."""
    return other is not None and (one == other or _still(one, simulated) == _still(other, simulated))


def _still(node: Node, simulated: Container[str]) -> Node:
    return replace(node, states=tuple(sorted({name for name in node.states if name not in simulated})))


def apply(graph: EnvironmentGraph, *changes: Change) -> EnvironmentGraph:
    """Return the graph after changes, one after the other.

    Nodes by id, edges sorted, and sorted the states that changed.

    Raises:
        KeyError: a change is about the state of a node that there is not.
    """
    return WorkingGraph(graph.nodes, graph.edges).apply(*changes).graph()


class WorkingGraph:
    """A graph to which changes are made in place, at a cost that follows what they change.

    Attributes:
        nodes: by id, with the states they are in.
        edges: in the order in which they came: nearly sorted edges are sorted ten times as fast as those of a set.
    """

    __slots__ = ("edges", "nodes")

    def __init__(self, nodes: Iterable[Node] = (), edges: Iterable[Edge] = ()) -> None:
        self.nodes = {node.id: node for node in nodes}
        self.edges = dict.fromkeys(edges)

    def copy(self) -> WorkingGraph:
        """Another one of the same content."""
        new = WorkingGraph()
        new.nodes, new.edges = self.nodes.copy(), self.edges.copy()
        return new

    def apply(self, *changes: Change) -> Self:
        """Make changes, one after the other.

        Raises:
            KeyError: a change is about the state of a node that there is not.
        """
        for change in changes:
            self._apply(change)
        return self

    def _apply(self, change: Change) -> None:
        nodes = self.nodes
        if change.removed_nodes:
            removed = set(change.removed_nodes)
            self.edges = {edge: None for edge in self.edges if removed.isdisjoint((edge.source, edge.target))}
            for node_id in removed:
                nodes.pop(node_id, None)
        nodes.update((node.id, node) for node in change.added_nodes)
        for edge in change.removed:
            self.edges.pop(edge, None)
        self.edges.update(dict.fromkeys(change.added))
        for node_id, names in restated(change, lambda node_id: nodes[node_id].states).items():
            nodes[node_id] = in_states(nodes[node_id], names)

    def graph(self) -> EnvironmentGraph:
        """Return the graph as it is now: nodes by id, edges sorted."""
        return EnvironmentGraph(tuple(map(self.nodes.__getitem__, sorted(self.nodes))), tuple(sorted(self.edges)))


def restated(change: Change, before: Callable[[int], Iterable[str]]) -> dict[int, set[str]]:
    """Every state of the nodes whose states change, afterwards.

    Args:
        change: of which only states are looked at.
        before: node id -> the states it was in.
    """
    found: dict[int, set[str]] = {}
    for node_id, name in change.cleared_states:
        (found.get(node_id) or found.setdefault(node_id, set(before(node_id)))).discard(name)
    for node_id, name in change.set_states:
        (found.get(node_id) or found.setdefault(node_id, set(before(node_id)))).add(name)
    return found


def in_states(node: Node, names: Iterable[str]) -> Node:
    """Return the node in these states, which are sorted, each once."""
    states = tuple(sorted(set(names)))
    return node if states == node.states else replace(node, states=states)


def compose(changes: Iterable[Change]) -> Change:
    """Return the sum of successive changes; an addition and its removal cancel out.

    They add and remove no nodes: ticks.
    """
    edges: dict[Edge, tuple[bool, bool]] = {}
    states: dict[State, tuple[bool, bool]] = {}
    for change in changes:
        for came, moved, entered in (
            (False, change.removed, change.cleared_states),
            (True, change.added, change.set_states),
        ):
            for edge in moved:
                edges[edge] = (edges.get(edge, (came, came))[0], came)
            for state in entered:
                states[state] = (states.get(state, (came, came))[0], came)
    return Change(
        tuple(sorted(edge for edge, turns in edges.items() if turns == (True, True))),
        tuple(sorted(edge for edge, turns in edges.items() if turns == (False, False))),
        tuple(sorted(state for state, turns in states.items() if turns == (True, True))),
        tuple(sorted(state for state, turns in states.items() if turns == (False, False))),
    )
