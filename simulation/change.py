"""What one world has that another has not: the unit that traces, environments and reports are stored in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hearth.schemas.graph import Edge
from hearth.schemas.vocabulary import STATES
from hearth.simulation import rows
from hearth.simulation.bits import indices

if TYPE_CHECKING:
    from hearth.simulation.world import World

State = tuple[int, str]


@dataclass(frozen=True, slots=True)
class Change:
    """Sorted edges and (node id, state) pairs that came and went."""

    added: tuple[Edge, ...] = ()
    removed: tuple[Edge, ...] = ()
    set_states: tuple[State, ...] = ()
    cleared_states: tuple[State, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.added or self.removed or self.set_states or self.cleared_states)


def between(before: World, after: World) -> Change:
    """What must be done to `before` to get `after`; both are worlds of one home."""
    added: set[Edge] = set()
    removed: set[Edge] = set()
    ids = before.home.ids
    for i, relation, j, came in _edge_changes(before, after):
        (added if came else removed).add(Edge(ids[i], relation, ids[j]))
    came, went = _state_changes(before, after)
    return Change(tuple(sorted(added)), tuple(sorted(removed)), tuple(sorted(came)), tuple(sorted(went)))


def _state_changes(before: World, after: World) -> tuple[list[State], list[State]]:
    came: list[State] = []
    went: list[State] = []
    ids = before.home.ids
    for name, old, new in zip(STATES, before.states, after.states, strict=True):
        if old != new:
            came.extend((ids[i], name) for i in indices(new & ~old))
            went.extend((ids[i], name) for i in indices(old & ~new))
    return came, went


def _edge_changes(before: World, after: World) -> Iterator[tuple[int, str, int, bool]]:
    for old, new in zip(before.agents, after.agents, strict=True):
        if old is not new:
            past = set(rows.agent_edges(old))
            now = set(rows.agent_edges(new))
            yield from ((*edge, True) for edge in now - past)
            yield from ((*edge, False) for edge in past - now)
    if before.moved is not after.moved:
        for i in _touched(before, after):
            yield from _row_changes(before, after, i)


def _touched(before: World, after: World) -> set[int]:
    """Nodes of which some row may differ."""
    old, new = before.moved, after.moved
    gone = (old.on ^ new.on) | (old.inside ^ new.inside) | (old.close ^ new.close) | (old.facing ^ new.facing)
    keys = {key for key, row in new.extra.items() if old.extra.get(key) != row} | (old.extra.keys() - new.extra.keys())
    return {key >> 3 for key in keys} | set(indices(gone))


def _row_changes(before: World, after: World, i: int) -> Iterator[tuple[int, str, int, bool]]:
    for relation, forward, backward in (
        ("ON", rows.on, rows.bears),
        ("INSIDE", rows.inside, rows.contents),
        ("CLOSE", rows.close, rows.close),
        ("FACING", rows.facing, rows.faced),
    ):
        old, new = forward(before, i), forward(after, i)
        if old != new:
            yield from ((i, relation, j, True) for j in indices(new & ~old))
            yield from ((i, relation, j, False) for j in indices(old & ~new))
        old, new = backward(before, i), backward(after, i)
        if old != new:
            yield from ((j, relation, i, True) for j in indices(new & ~old))
            yield from ((j, relation, i, False) for j in indices(old & ~new))
