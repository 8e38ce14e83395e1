"""Sets of nodes inside others, on others or in a room, as bit sets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.simulation.world.bits import indices
from hearth.simulation.world.moved_edges import BEARS, CONTENTS

if TYPE_CHECKING:
    from hearth.simulation.world.world import World


def contained(world: World, containers: int) -> int:
    """Everything directly INSIDE one of these, characters included."""
    home, moved = world.home, world.moved
    found = home.contents_of[containers & home.containing & ~moved.inside] & ~moved.inside
    for key, row in moved.extra.items():
        if key & 7 == CONTENTS and containers >> (key >> 3) & 1:
            found |= row
    for agent in world.agents:
        if agent.inside & containers:
            found |= agent.bit
        if agent.bit & containers:
            found |= agent.contents
    return found


def upon(world: World, places: int) -> int:
    """Everything ON one of these, characters included."""
    home, moved = world.home, world.moved
    found = home.borne_by[places & home.bearing & ~moved.on] & ~moved.on
    for key, row in moved.extra.items():
        if key & 7 == BEARS and places >> (key >> 3) & 1:
            found |= row
    for agent in world.agents:
        if agent.on & places:
            found |= agent.bit
        if agent.bit & places:
            found |= agent.worn
    return found


def in_room(world: World, room: int) -> int:
    """Return the room, everything INSIDE it, directly or not, what is ON that, and the doors BETWEEN it and others."""
    found = frontier = 1 << room
    while frontier:
        frontier = (contained(world, frontier) | upon(world, frontier)) & ~found
        found |= frontier
    for door in indices(world.home.doors):
        if world.home.between[door] >> room & 1:
            found |= 1 << door
    return found
