"""Additions to a home, and changes in it, before a program ran there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

from hearth.schemas.literals import HANDS
from hearth.schemas.vocabulary import OPPOSITE, ROOM_CATEGORY

if TYPE_CHECKING:
    from hearth.schemas.graph import EnvironmentGraph, Node
    from hearth.schemas.graph_change import Change

_QUIET = frozenset({"CLOSE", "FACING"})
"""Relations that follow from places; they are not listed."""


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
    """

    objects: tuple[NewObject, ...] = ()
    states: tuple[str, ...] = ()
    moved: tuple[str, ...] = ()

    def lines(self) -> Iterator[str]:
        """Yield one line for each kind of change: its number, and all of it."""
        from hearth.commands import output

        added = (f"{name} ({number}) {place}" for number, name, place in self.objects)
        for word, noun, items in (
            ("added", "object", tuple(added)),
            ("changed", "state", self.states),
            ("changed", "relation", self.moved),
        ):
            if items:
                yield f"{word} {output.counted(len(items), noun)}: {', '.join(items)}"


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
    )


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
