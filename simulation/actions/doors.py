"""Rooms that a character can walk between, through open doors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.schemas.failures import Code, Failure
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.states import CLOSED

if TYPE_CHECKING:
    from hearth.simulation.world.home import Home
    from hearth.simulation.world.world import World


MOST_KNOWN = 1_000
"""Pairs of a room and closed doors whose open rooms a home keeps."""


def blocking(world: World, agent: Agent, room: int) -> Failure | None:
    """Return a DOOR_CLOSED failure when every way from the character's room to `room` leads through a closed door.

    A home whose doors do not say what they part, or parts no one can walk between even with every door open, stops
    nobody: the graph does not have the way. Doorways without a door are always open.
    """
    home = world.home
    start = edge_rows.agent_room(world, agent)
    closed = home.doors & world.states[CLOSED]
    if start < 0 or start == room or not closed:
        return None
    reached = _reached(home, start, closed)
    if reached >> room & 1 or not _reached(home, start, 0) >> room & 1:
        return None
    door = next(d for d in indices(closed) if home.between[d] & reached and home.between[d] & ~reached)
    return Failure(
        Code.DOOR_CLOSED,
        objects=(home.ids[door], home.ids[room]),
        names=(home.classes[door], home.classes[room]),
        expected=f"an open way from {home.classes[start]}",
        actual="the door CLOSED",
    )


def open_rooms(world: World, agent: Agent) -> int:
    """Return the rooms that no closed door keeps from a character: those for which `blocking` finds nothing."""
    home = world.home
    start = edge_rows.agent_room(world, agent)
    closed = home.doors & world.states[CLOSED]
    if start < 0 or not closed:
        return home.rooms
    return home.rooms & (_reached(home, start, closed) | ~_reached(home, start, 0))


def reached_rooms(world: World, agent: Agent) -> int:
    """Return the rooms that a character, which is in one, reaches through open doors; its own, too."""
    start = edge_rows.agent_room(world, agent)
    return _reached(world.home, start, world.home.doors & world.states[CLOSED])


def side(world: World, agent: Agent, door: int, room: int) -> int:
    """Index of the room from which a character comes to a door: `room`, which it is in, if that can be reached; else
    one that it is BETWEEN and that can be, the character's own before others; else `room` again.
    """
    start = edge_rows.agent_room(world, agent)
    if start < 0:
        return room
    reached = reached_rooms(world, agent)
    if room >= 0 and reached >> room & 1:
        return room
    within = world.home.between[door] & world.home.rooms & reached
    if within >> start & 1:
        return start
    return lowest(within) if within else room


def _reached(home: Home, start: int, closed: int) -> int:
    """Return the rooms that are reached from one while some doors are closed."""
    known = home.open_rooms
    found = known.get((start, closed))
    if found is None:
        if len(known) >= MOST_KNOWN:
            known.clear()
        found = known[start, closed] = _flood(home, start, home.doors & ~closed)
    return found


def _flood(home: Home, start: int, doors: int) -> int:
    """Return the rooms reached from `start` through these doors."""
    reached = 1 << start
    rest = doors
    grown = True
    while grown:
        grown = False
        for door in indices(rest):
            parts = home.between[door]
            if parts & reached:
                reached |= parts
                rest &= ~(1 << door)
                grown = True
    return reached
