"""Origins of grabbed things, to which PutObjBack brings them back."""

from __future__ import annotations

from operator import attrgetter
from typing import TYPE_CHECKING

from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world import moved_edges as kinds
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, lowest

if TYPE_CHECKING:
    from hearth.simulation.world.world import World


_RELATIONS = (
    (kinds.ON, edge_rows.on, attrgetter("worn")),
    (kinds.INSIDE, edge_rows.inside, attrgetter("contents")),
    (kinds.CLOSE, edge_rows.close, attrgetter("close")),
)
"""Relations of an origin in the order of search: ON, INSIDE, CLOSE; among things, then among characters."""


def remembered(world: World, agent: Agent, o: int, rules: Rules) -> tuple[int, int]:
    """(index of the place, kind of relation) that Grab remembers, or (-1, 0)."""
    choose = _by_hash_order if rules.origin == "release" else _nearest
    bit = 1 << o
    rooms = world.home.rooms
    for kind, things, characters in _RELATIONS:
        row = things(world, o)
        for other in world.agents:
            if characters(other) & bit:
                row |= other.bit
        place = choose(world, row & ~rooms, row, kind)
        if place >= 0:
            return place, kind
    return -1, 0


def _by_hash_order(world: World, places: int, row: int, kind: int) -> int:
    """Return the first place in the order in which a Python set built from the ascending ids of the whole row iterates:
    the accident by which the release was made.
    """
    if not places:
        return -1
    if not places & (places - 1):
        return lowest(places)
    home = world.home
    for node_id in set([home.ids[i] for i in indices(row)]):  # noqa: C403 - built from a list, as it was
        index = home.index[node_id]
        if places >> index & 1:
            return index
    return -1


def _nearest(world: World, places: int, row: int, kind: int) -> int:
    """Return the lowest id; never a character, and among what it was merely close to only furniture."""
    places &= ~world.home.characters
    if kind == kinds.CLOSE:
        places &= world.home.furniture
    return lowest(places)
