"""Sets of the nodes that a character sees, and of those that are hidden in closed containers, as bit sets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.simulation.observation.containment import contained, in_room, upon
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.states import CLOSED

if TYPE_CHECKING:
    from hearth.simulation.world.world import World


def hidden(world: World) -> int:
    """Everything directly INSIDE something closed that is not a room; it cannot be grabbed or touched."""
    known, moved = world.home.hidden, world.moved
    key = world.states[CLOSED], tuple([(agent.bit, agent.inside, agent.contents) for agent in world.agents])
    found = known.find(moved, key)
    return known.keep(moved, key, contained(world, key[0] & ~world.home.rooms)) if found is None else found


def out_of_sight(world: World) -> int:
    """Return everything inside something closed, directly or not, and the things on it."""
    found = frontier = hidden(world)
    while frontier:
        frontier = (contained(world, frontier) | upon(world, frontier)) & ~found
        found |= frontier
    return found


def visible(world: World, agent: Agent) -> int:
    """Return the nodes that a character sees.

    Those in its room and not inside something closed, those that it and visible characters hold and wear, and itself.

    It also knows which other rooms there are, or it could never ask to go to one.
    """
    for known, whose, seen in _LAST:
        if known is world and whose is agent:
            return seen
    home, moved = world.home, world.moved
    key = agent.index, agent.inside, world.states[CLOSED], tuple([(a[0], a[5:11]) for a in world.agents])
    found = home.seen.find(moved, key)
    seen = home.seen.keep(moved, key, _visible(world, agent)) if found is None else found
    _LAST[:] = (world, agent, seen), *_LAST[:3]
    return seen


_LAST: list[tuple[World, Agent, int]] = []
"""The last view: an agent's observation and its legal instructions ask for the same one."""


def _visible(world: World, agent: Agent) -> int:
    seen = agent.bit | world.home.rooms
    room = edge_rows.agent_room(world, agent)
    if room >= 0:
        seen |= in_room(world, room) & ~out_of_sight(world)
    for other in world.agents:
        if seen & other.bit:
            seen |= other.held | other.worn
    return seen
