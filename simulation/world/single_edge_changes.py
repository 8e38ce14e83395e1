"""Adding and taking away single edges in the middle of an execution, whichever kind of node they join."""

from collections.abc import Callable, Iterable
from operator import or_

from hearth.simulation.world import edge_rows
from hearth.simulation.world import moved_edges as kinds
from hearth.simulation.world.agent import change_characters
from hearth.simulation.world.bits import cleared, indices
from hearth.simulation.world.edge_rows import Numbered
from hearth.simulation.world.moved_edges import Moved, link, unlink
from hearth.simulation.world.world import World

_KINDS = {"ON": kinds.ON, "INSIDE": kinds.INSIDE, "CLOSE": kinds.CLOSE, "FACING": kinds.FACING}

_READ: dict[str, tuple[Callable[[World, int], int], Callable[[World, int], int]]] = {
    "ON": (edge_rows.on, edge_rows.bears),
    "INSIDE": (edge_rows.inside, edge_rows.contents),
    "CLOSE": (edge_rows.close, edge_rows.close),
    "FACING": (edge_rows.facing, edge_rows.faced),
}


def linked(world: World, edges: Iterable[Numbered]) -> World:
    """Add edges, given by indices; BETWEEN and nodes outside the simulation are not for this."""
    extra = dict(world.moved.extra)
    agents = list(world.agents)
    for i, relation, j in edges:
        if not change_characters(agents, (i, relation, j), or_) and relation in _KINDS:
            link(extra, i, _KINDS[relation], j)
    return World(world.home, world.states, tuple(agents), world.moved._replace(extra=extra))


def unlinked(world: World, edges: Iterable[Numbered]) -> World:
    """With fewer edges; missing ones are ignored.

    A home's own edge can't be taken out of its shared row. The end of it that has fewer edges of the relation is
    removed from the relation, and its other edges become extra.
    """
    for i, relation, j in edges:
        agents = list(world.agents)
        if change_characters(agents, (i, relation, j), cleared):
            world = World(world.home, world.states, tuple(agents), world.moved)
        elif relation in _KINDS:
            moved = _without(world, i, relation, j)
            world = World(world.home, world.states, world.agents, moved)
    return world


def _without(world: World, i: int, relation: str, j: int) -> Moved:
    forward, backward = _READ[relation]
    if not forward(world, i) >> j & 1:
        return world.moved
    kind = _KINDS[relation]
    moved = world.moved
    extra = dict(moved.extra)
    field = relation.lower()
    removed = getattr(moved, field)
    if not (removed >> i | removed >> j) & 1:
        out = {k: (forward(world, k), backward(world, k)) for k in (i, j)}
        k = min(out, key=lambda end: (out[end][0] | out[end][1]).bit_count())
        for other in indices(out[k][0]):
            link(extra, k, kind, other)
        for other in indices(out[k][1]):
            link(extra, other, kind, k)
        moved = moved._replace(**{field: removed | 1 << k})
    unlink(extra, i, kind, j)
    return moved._replace(extra=extra)
