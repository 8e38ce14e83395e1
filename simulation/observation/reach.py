"""Sets of the nodes that a character is close to, faces, can walk to or can reach, as bit sets."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.simulation.actions import doors
from hearth.simulation.observation.containment import contained, in_room, upon  # noqa: F401 - two were here in 0.2
from hearth.simulation.observation.visible_nodes import hidden, out_of_sight, visible  # noqa: F401 - two were here in 0.2
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.moved_edges import BEARS, CLOSE, NOTHING
from hearth.simulation.world.states import CLOSED

if TYPE_CHECKING:
    from hearth.simulation.world.world import World


def near_to(world: World, agent: Agent, near_hands: bool) -> int:
    """`close_to`; by the rule `near_hands` the character's body parts count only in its own room."""
    parts = world.home.properties["BODY_PART"] & agent.close if near_hands else 0
    every = close_to(world, agent)
    if not parts:
        return every
    sure = agent.close | close_to(world, agent._replace(close=agent.close & ~parts))
    room = edge_rows.agent_room(world, agent)
    return sure | mask_of(i for i in indices(every & ~sure) if edge_rows.room_of(world, i) == room)


def close_to(world: World, agent: Agent) -> int:
    """Everything that a character is close to, by its own edges or by one hop (see `edge_rows.is_close`)."""
    mine = agent.close
    found = _around(world, mine & ~world.home.characters)
    for other in world.agents:
        if mine & other.bit:
            found |= other.close | other.worn
        if mine & (other.close | other.on):
            found |= other.bit
    return mine | found


def _around(world: World, places: int) -> int:
    """Return the things CLOSE to, or ON, one of these things."""
    home, moved = world.home, world.moved
    if moved is NOTHING:
        beside = 0
        for i in indices(places):
            beside |= home.around[i]
        return beside
    beside = home.close_to[places & ~moved.close]
    borne = home.borne_by[places & ~moved.on]
    found = beside & ~moved.close | borne & ~moved.on
    for key, row in moved.extra.items():
        if key & 7 in (BEARS, CLOSE) and places >> (key >> 3) & 1:
            found |= row
    return found


def faced_by(world: World, agent: Agent) -> int:
    """Everything that a character faces, by its own edge or by one hop (see `edge_rows.is_facing`)."""
    mine = agent.facing
    found = mine
    for i in indices(mine & ~world.home.characters):
        found |= edge_rows.facing(world, i)
    for other in world.agents:
        if mine & other.bit:
            found |= other.facing
        if mine & other.faced:
            found |= other.bit
    return found


def walkable(world: World, agent: Agent, through_doors: bool) -> int:
    """Everything a standing character can walk to: what has a room, and no closed door in the way if doors count."""
    home = world.home
    closed = home.doors & world.states[CLOSED] if through_doors else -1
    places = tuple([(other.bit, other.inside, other.contents) for other in world.agents])
    key = agent.index, agent.inside, closed, places
    found = home.walkable.find(world.moved, key)
    return home.walkable.keep(world.moved, key, _walkable(world, agent, through_doors)) if found is None else found


def _walkable(world: World, agent: Agent, through_doors: bool) -> int:
    home = world.home
    direct = home.rooms | contained(world, home.rooms)
    found = direct
    open_rooms = doors.open_rooms(world, agent) if through_doors else -1
    closed = home.rooms & ~open_rooms
    rest = home.everything & ~direct
    if closed:
        rest |= closed | contained(world, closed)
    if through_doors:
        rest |= home.doors
    for i in indices(rest):
        room = edge_rows.room_of(world, i)
        if through_doors and home.between[i]:
            room = doors.side(world, agent, i, room)
        if room >= 0 and open_rooms >> room & 1:
            found |= 1 << i
        else:
            found &= ~(1 << i)
    return found


def reachable(world: World, agent: Agent) -> int:
    """Return the nodes that no closed door and no closed container keeps from a character."""
    return walkable(world, agent, True) & ~hidden(world) | agent.held | agent.worn
