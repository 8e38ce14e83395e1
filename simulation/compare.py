"""Whether two worlds of different homes show the same graph, and where they do not."""

from __future__ import annotations

from dataclasses import dataclass

from hearth.schemas.graph import Edge
from hearth.simulation import rows
from hearth.simulation.nodes import states_of
from hearth.simulation.world import World

_ROWS = (rows.on, rows.inside, rows.close, rows.facing)


@dataclass(frozen=True, slots=True)
class Mismatch:
    """How a world differs from the one expected: sorted edges and (node id, state) pairs."""

    missing: tuple[Edge, ...] = ()
    surplus: tuple[Edge, ...] = ()
    missing_states: tuple[tuple[int, str], ...] = ()
    surplus_states: tuple[tuple[int, str], ...] = ()

    def __bool__(self) -> bool:
        return bool(self.missing or self.surplus or self.missing_states or self.surplus_states)


def mismatch(world: World, expected: World) -> Mismatch:
    """What `expected` has that `world` lacks, and the other way round; node by id."""
    if world.home.ids == expected.home.ids and _same(world, expected):
        return Mismatch()
    have, want = set(world.edges()), set(expected.edges())
    states, wanted = _states(world), _states(expected)
    return Mismatch(
        tuple(sorted(want - have)),
        tuple(sorted(have - want)),
        tuple(sorted(wanted - states)),
        tuple(sorted(states - wanted)),
    )


def _same(world: World, expected: World) -> bool:
    """Row by row, which is much cheaper than listing edges."""
    if world.states != expected.states or any(
        a[:-1] != b[:-1] for a, b in zip(world.agents, expected.agents, strict=True)
    ):
        return False
    nodes = range(len(world.home))
    return all(row(world, i) == row(expected, i) for row in _ROWS for i in nodes)


def _states(world: World) -> set[tuple[int, str]]:
    return {(node_id, name) for i, node_id in enumerate(world.home.ids) for name in states_of(i, world.states)}
