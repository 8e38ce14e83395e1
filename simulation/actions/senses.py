"""LookAt, PointAt, Watch, Read, Touch, Greet: what changes nothing but must be possible."""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation import rows
from hearth.simulation.actions.common import (
    LYING,
    ON,
    SITTING,
    need_able,
    need_close,
    need_holding,
    need_reachable,
    refuse,
)
from hearth.simulation.agent import Agent
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def look_at(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Look at, or point at, what the character faces."""
    failure = _need_facing(world, world.agents[number], o)
    return world if failure is None else failure


def watch(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Watch what is in the room and faced; by `rules.watch_needs_on`, what has a switch must be on."""
    agent = world.agents[number]
    failure = need_able(world, "Watch", o)
    if failure is None and rows.room_of(world, o) != rows.agent_room(world, agent):
        failure = refuse(world, Code.NOT_IN_ROOM, "in the character's room", "in another", o)
    if failure is None:
        failure = _need_view(world, agent, o)
    if failure is None and rules.watch_needs_on:
        off = world.home.properties["HAS_SWITCH"] & ~world.states[ON]
        if off >> o & 1:
            failure = refuse(world, Code.IS_OFF, "ON", "OFF", o)
    return world if failure is None else failure


def read(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Read what a hand holds."""
    failure = need_able(world, "Read", o) or need_holding(world, world.agents[number], o)
    return world if failure is None else failure


def touch(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Touch what is close and not shut away."""
    failure = need_close(world, world.agents[number], o) or need_reachable(world, o)
    return world if failure is None else failure


def greet(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Greet a person."""
    failure = need_able(world, "Greet", o)
    return world if failure is None else failure


def _need_facing(world: World, agent: Agent, o: int) -> Failure | None:
    if rows.is_facing(world, agent, o):
        return None
    return refuse(world, Code.NOT_FACING, "the character facing it", "no FACING edge, direct or by one hop", o)


def _need_view(world: World, agent: Agent, o: int) -> Failure | None:
    """Who sits or lies must face a thing itself; a computer may also be faced by one hop."""
    resting = (world.states[SITTING] | world.states[LYING]) & agent.bit
    if resting and world.home.classes[o] != "computer" and not agent.facing >> o & 1:
        return refuse(world, Code.NOT_FACING, "the seat facing it", "no direct FACING edge", o)
    return _need_facing(world, agent, o)
