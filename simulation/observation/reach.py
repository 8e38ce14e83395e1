"""Sets of nodes as bit sets: close, faced, in closed containers, in a room, within reach."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.simulation.actions import doors
from hearth.simulation.world import rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.moved_edges import BEARS, CLOSE, CONTENTS, NOTHING
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
    room = rows.agent_room(world, agent)
    return sure | mask_of(i for i in indices(every & ~sure) if rows.room_of(world, i) == room)


def close_to(world: World, agent: Agent) -> int:
    """Everything that a character is close to, by its own edges or by one hop (see `rows.is_close`)."""
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
    upon = home.borne_by[places & ~moved.on]
    found = beside & ~moved.close | upon & ~moved.on
    for key, row in moved.extra.items():
        if key & 7 in (BEARS, CLOSE) and places >> (key >> 3) & 1:
            found |= row
    return found


def faced_by(world: World, agent: Agent) -> int:
    """Everything that a character faces, by its own edge or by one hop (see `rows.is_facing`)."""
    mine = agent.facing
    found = mine
    for i in indices(mine & ~world.home.characters):
        found |= rows.facing(world, i)
    for other in world.agents:
        if mine & other.bit:
            found |= other.facing
        if mine & other.faced:
            found |= other.bit
    return found


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


def hidden(world: World) -> int:
    """Everything directly INSIDE something closed that is not a room; it cannot be grabbed or touched."""
    return contained(world, world.states[CLOSED] & ~world.home.rooms)


def out_of_sight(world: World) -> int:
    """Return everything inside something closed, directly or not, and the things on it."""
    found = frontier = hidden(world)
    while frontier:
        frontier = (contained(world, frontier) | upon(world, frontier)) & ~found
        found |= frontier
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


def visible(world: World, agent: Agent) -> int:
    """Return the nodes that a character sees.

    Those in its room and not inside something closed, those that it and visible characters hold and wear, and itself.

    It also knows which other rooms there are, or it could never ask to go to one.
    """
    for known, whose, seen in _LAST:
        if known is world and whose is agent:
            return seen
    seen = _visible(world, agent)
    _LAST[:] = (world, agent, seen), *_LAST[:3]
    return seen


_LAST: list[tuple[World, Agent, int]] = []
"""The last view: an agent's observation and its legal instructions ask for the same one."""


def _visible(world: World, agent: Agent) -> int:
    seen = agent.bit | world.home.rooms
    room = rows.agent_room(world, agent)
    if room >= 0:
        seen |= in_room(world, room) & ~out_of_sight(world)
    for other in world.agents:
        if seen & other.bit:
            seen |= other.held | other.worn
    return seen


def walkable(world: World, agent: Agent, through_doors: bool) -> int:
    """Everything a standing character can walk to: what has a room, and no closed door in the way if doors count."""
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
        room = rows.room_of(world, i)
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
