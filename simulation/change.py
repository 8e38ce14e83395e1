"""What one world has that another has not: the unit that traces, environments and reports are stored in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hearth.schemas.graph import Edge
from hearth.schemas.vocabulary import STATES
from hearth.simulation import rows
from hearth.simulation.bits import indices

if TYPE_CHECKING:
    from hearth.simulation.home import Home
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
    """What must be done to `before` to get `after`.

    Nodes that only one of them has are not told, but their edges and states are. Cost follows what differs between
    worlds of one home and of homes derived from one another (see `edit`); other homes are compared whole.
    """
    ids = before.home.ids
    extra = 0
    if before.home is not after.home:
        ids, other = sorted((ids, after.home.ids), key=len, reverse=True)
        if ids[: len(other)] != other:
            return _of_sets(before, after)
        extra = _home_differences(before.home, after.home)
    added: set[Edge] = set()
    removed: set[Edge] = set()
    for i, relation, j, came in _edge_changes(before, after, extra):
        (added if came else removed).add(Edge(ids[i], relation, ids[j]))
    if before.home.others is not after.home.others:
        past, now = before.home.others, after.home.others
        added.update(Edge(*edge) for edge in now if edge not in past)
        removed.update(Edge(*edge) for edge in past if edge not in now)
    entered, left = _state_changes(before, after, ids)
    return Change(tuple(sorted(added)), tuple(sorted(removed)), tuple(sorted(entered)), tuple(sorted(left)))


def _of_sets(before: World, after: World) -> Change:
    past, now = set(before.edges()), set(after.edges())
    left, entered = (
        {(world.home.ids[i], name) for name, row in zip(STATES, world.states, strict=True) for i in indices(row)}
        for world in (before, after)
    )
    return Change(
        tuple(sorted(now - past)),
        tuple(sorted(past - now)),
        tuple(sorted(entered - left)),
        tuple(sorted(left - entered)),
    )


def _home_differences(one: Home, other: Home) -> int:
    """Nodes whose rows at the start may differ."""
    for base, derived in ((one, other), (other, one)):
        touched = 0
        home = derived
        while home is not base and home.base is not None:
            home, more = home.base
            touched |= more
        if home is base:
            return touched
    differing = -1 << min(len(one), len(other)) & (1 << max(len(one), len(other))) - 1
    for a, b in zip(one.rows, other.rows, strict=True):
        for i, (row, now) in enumerate(zip(a, b, strict=False)):
            if row != now:
                differing |= 1 << i
    return differing


def _state_changes(before: World, after: World, ids: list[int]) -> tuple[list[State], list[State]]:
    came: list[State] = []
    went: list[State] = []
    for name, old, new in zip(STATES, before.states, after.states, strict=True):
        if old != new:
            came.extend((ids[i], name) for i in indices(new & ~old))
            went.extend((ids[i], name) for i in indices(old & ~new))
    return came, went


def _edge_changes(before: World, after: World, extra: int) -> Iterator[tuple[int, str, int, bool]]:
    olds = {agent.index: agent for agent in before.agents}
    news = {agent.index: agent for agent in after.agents}
    for i in olds | news:
        old, new = olds.get(i), news.get(i)
        if old is not new:
            past = set(rows.agent_edges(old)) if old else set()
            now = set(rows.agent_edges(new)) if new else set()
            yield from ((*edge, True) for edge in now - past)
            yield from ((*edge, False) for edge in past - now)
    if extra or before.moved is not after.moved:
        for i in _touched(before, after) | set(indices(extra)):
            yield from _row_changes(before, after, i)


def _touched(before: World, after: World) -> set[int]:
    """Nodes of which some row may differ because something moved."""
    old, new = before.moved, after.moved
    gone = (old.on ^ new.on) | (old.inside ^ new.inside) | (old.close ^ new.close) | (old.facing ^ new.facing)
    keys = {key for key, row in new.extra.items() if old.extra.get(key) != row} | (old.extra.keys() - new.extra.keys())
    return {key >> 3 for key in keys} | set(indices(gone))


Reader = Callable[["World", int], int]

_READERS: tuple[tuple[str, Reader, Reader], ...] = (
    ("ON", rows.on, rows.bears),
    ("INSIDE", rows.inside, rows.contents),
    ("CLOSE", rows.close, rows.close),
    ("FACING", rows.facing, rows.faced),
)


def _row_changes(before: World, after: World, i: int) -> Iterator[tuple[int, str, int, bool]]:
    new_here, gone_here = i >= len(before.home), i >= len(after.home)
    for relation, forward, backward in _READERS:
        old = 0 if new_here else forward(before, i)
        new = 0 if gone_here else forward(after, i)
        if old != new:
            yield from ((i, relation, j, True) for j in indices(new & ~old))
            yield from ((i, relation, j, False) for j in indices(old & ~new))
        old = 0 if new_here else backward(before, i)
        new = 0 if gone_here else backward(after, i)
        if old != new:
            yield from ((j, relation, i, True) for j in indices(new & ~old))
            yield from ((j, relation, i, False) for j in indices(old & ~new))
    if before.home is not after.home:
        old = 0 if new_here else before.home.between[i]
        new = 0 if gone_here else after.home.between[i]
        yield from ((i, "BETWEEN", j, True) for j in indices(new & ~old))
        yield from ((i, "BETWEEN", j, False) for j in indices(old & ~new))
