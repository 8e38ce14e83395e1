"""Additions to a home, and changes in it, before a program ran there."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from hearth.schemas.graph import Edge
from hearth.schemas.literals import HANDS
from hearth.schemas.vocabulary import OPPOSITE, ROOM_CATEGORY

if TYPE_CHECKING:
    from hearth.schemas.graph import EnvironmentGraph, Node
    from hearth.schemas.graph_change import Change

_QUIET = frozenset({"CLOSE", "FACING"})
"""Relations that follow from places; `moved` has none of them."""

_MUTUAL = "CLOSE"
"""A relation that graphs have in both directions; lines name such a pair once."""


class NewObject(NamedTuple):
    """An object that was added, and where: `INSIDE fridge (137)`."""

    id: int
    class_name: str
    place: str


class Additions(NamedTuple):
    """The difference between a home as it is and the start of a run.

    Attributes:
        objects: added, by id.
        states: of objects that were there: `fridge (137) is OPEN`.
        moved: relations of objects that were there, to where they are now: `character (367) INSIDE bedroom (74)`.
        edges: every edge that was added, also those of added objects: a source, a relation, a target.
        removed_edges: every edge that was removed.
    """

    objects: tuple[NewObject, ...] = ()
    states: tuple[str, ...] = ()
    moved: tuple[str, ...] = ()
    edges: tuple[Edge, ...] = ()
    removed_edges: tuple[Edge, ...] = ()

    def lines(self, names: dict[int, str]) -> Iterator[str]:
        """Yield the number of each kind of change, and all of it: edges on a line for each object.

        Args:
            names: of the nodes of both graphs, as `fridge (137)`.
        """
        from hearth.commands import output

        added = (f"{name} ({number}) {place}" for number, name, place in self.objects)
        for word, noun, items in (
            ("added", "object", tuple(added)),
            ("changed", "state", self.states),
            ("changed", "relation", self.moved),
        ):
            if items:
                yield f"{word} {output.counted(len(items), noun)}: {', '.join(items)}"
        for word, edges in (("added", self.edges), ("removed", self.removed_edges)):
            if edges:
                yield f"{word} {output.counted(len(edges), 'edge')}: {_by_relation(edges)}"
                yield from (f"  {line}" for line in _by_source(edges, names))


def additions(before: EnvironmentGraph, after: EnvironmentGraph) -> Additions:
    """Return the additions of `after` to `before`, and the other changes."""
    from hearth.schemas.graph_change import encode

    change = encode(before, after)
    nodes = {node.id: node for node in (*before.nodes, *after.nodes)}
    states = [f"{_name(nodes, node)} is {state}" for node, state in change.set_states]
    now = set(change.set_states)
    states += [
        f"{_name(nodes, node)} is not {state}"
        for node, state in change.cleared_states
        if (node, OPPOSITE.get(state, "")) not in now
    ]
    return Additions(
        tuple(NewObject(node.id, node.class_name, _place(node.id, change, nodes)) for node in change.added_nodes),
        tuple(states),
        tuple(_relations(change, nodes, {node.id for node in change.added_nodes})),
        tuple(sorted(change.added)),
        tuple(sorted(change.removed)),
    )


def names_of(*graphs: EnvironmentGraph) -> dict[int, str]:
    """Return the names of the nodes of some graphs, as `fridge (137)`."""
    return {node.id: f"{node.class_name} ({node.id})" for graph in graphs for node in graph.nodes}


def _by_relation(edges: Sequence[Edge]) -> str:
    """Return the counts of edges: `8 CLOSE, 1 ON`; the most frequent first."""
    counts = Counter(edge.relation for edge in edges)
    return ", ".join(f"{count} {name}" for name, count in sorted(counts.items(), key=lambda each: (-each[1], each[0])))


def _by_source(edges: Sequence[Edge], names: dict[int, str]) -> Iterator[str]:
    """Yield a line for each object: `milk (1000): CLOSE cup (41), plate (42); ON table (40)`."""
    both = {edge for edge in edges if edge.relation == _MUTUAL and _turned(edge) in edges}
    weight = Counter(node for edge in edges for node in (edge.source, edge.target))
    found: dict[int, dict[str, list[str]]] = {}
    for edge in edges:
        # A pair stands with the object that has more edges: that which was added or moved, and not its neighbors.
        first = max((edge.source, edge.target), key=lambda node: (weight[node], node))
        if edge not in both or edge.source == first:
            found.setdefault(edge.source, {}).setdefault(edge.relation, []).append(names[edge.target])
    for source, relations in found.items():
        yield f"{names[source]}: " + "; ".join(f"{name} {', '.join(others)}" for name, others in relations.items())


def _turned(edge: Edge) -> Edge:
    return Edge(edge.target, edge.relation, edge.source)


def _relations(change: Change, nodes: dict[int, Node], new: set[int]) -> Iterator[str]:
    """Yield where objects that were there are now; for those that are nowhere else, where they are no more."""
    moved = {edge.source for edge in change.added if edge.relation not in _QUIET}
    for edge in change.added:
        if edge.source not in new and edge.target not in new and edge.relation not in _QUIET:
            yield f"{_name(nodes, edge.source)} {edge.relation} {_name(nodes, edge.target)}"
    for edge in change.removed:
        if edge.source not in moved and edge.relation not in _QUIET:
            yield f"{_name(nodes, edge.source)} no longer {edge.relation} {_name(nodes, edge.target)}"


def _place(new: int, change: Change, nodes: dict[int, Node]) -> str:
    """Return the place of an added object: the hand that holds it, the thing it is on or in, or else its room."""
    held = (e for e in change.added if e.target == new and e.relation in HANDS)
    placed = [e for e in change.added if e.source == new and e.relation in ("ON", "INSIDE")]
    thing = (e for e in placed if nodes[e.target].category != ROOM_CATEGORY)
    edge = next(held, None) or next(thing, None) or next(iter(placed), None)
    if edge is None:
        return "in no room"
    return (
        f"held by {_name(nodes, edge.source)}" if edge.target == new else f"{edge.relation} {_name(nodes, edge.target)}"
    )


def _name(nodes: dict[int, Node], node: int) -> str:
    return f"{nodes[node].class_name} ({node})"
