"""What was added to a home, and changed in it, before a program ran there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from hearth.schemas.graph import EnvironmentGraph, Node

_QUIET = frozenset({"CLOSE", "FACING"})
"""Relations that follow from places; they are not listed."""


class NewObject(NamedTuple):
    """An object that was added, and where: `fridge (137)`."""

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

        added = (f"{name} ({number}) in {place}" for number, name, place in self.objects)
        for word, noun, items in (
            ("added", "object", tuple(added)),
            ("changed", "state", self.states),
            ("changed", "relation", self.moved),
        ):
            if items:
                yield f"{word} {output.counted(len(items), noun)}: {', '.join(items)}"


def additions(before: EnvironmentGraph, after: EnvironmentGraph) -> Additions:
    """Return what `after` has more than `before`, and otherwise."""
    from hearth.schemas.change import encode
    from hearth.schemas.vocabulary import OPPOSITE

    change = encode(before, after)
    nodes = {node.id: node for node in (*before.nodes, *after.nodes)}
    new = {node.id for node in change.added_nodes}
    states = [f"{_name(nodes, node)} is {state}" for node, state in change.set_states]
    now = set(change.set_states)
    states += [
        f"{_name(nodes, node)} is not {state}"
        for node, state in change.cleared_states
        if (node, OPPOSITE.get(state, "")) not in now
    ]
    moved = [edge for edge in change.added if edge.source not in new and edge.relation not in _QUIET]
    places: dict[int, str] = {}
    for edge in change.added:
        if edge.source in new and edge.relation in ("ON", "INSIDE"):
            is_room = nodes[edge.target].category == "Rooms"
            if edge.source not in places or not is_room:
                places[edge.source] = _name(nodes, edge.target)
    return Additions(
        tuple(NewObject(node.id, node.class_name, places.get(node.id, "no place")) for node in change.added_nodes),
        tuple(states),
        tuple(f"{_name(nodes, e.source)} {e.relation} {_name(nodes, e.target)}" for e in moved),
    )


def _name(nodes: dict[int, Node], node: int) -> str:
    return f"{nodes[node].class_name} ({node})"
