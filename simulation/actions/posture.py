"""Sit, Lie, StandUp, Sleep, WakeUp."""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation import rows
from hearth.simulation.actions.common import LYING, SITTING, need_able, need_close, refuse, with_state
from hearth.simulation.agent import Agent
from hearth.simulation.bits import indices
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def sit(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Sit down on o, then face what o faces."""
    agent = world.agents[number]
    failure = need_close(world, agent, o)
    if failure is None and world.states[SITTING] & agent.bit:
        failure = refuse(world, Code.SITTING, "not sitting", "sitting", o)
    failure = failure or need_able(world, "Sit", o) or _need_room_on(world, o, lying=False)
    if failure is not None:
        return failure
    ahead = rows.facing(world, o)
    for other in world.agents:
        if other.faced >> o & 1:
            ahead |= other.bit
    return _settle(world, number, o, SITTING, agent.facing | ahead)


def lie(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Lie down on o."""
    agent = world.agents[number]
    failure = need_close(world, agent, o)
    if failure is None and world.states[LYING] & agent.bit:
        failure = refuse(world, Code.LYING, "not lying", "lying", o)
    failure = failure or need_able(world, "Lie", o) or _need_room_on(world, o, lying=True)
    if failure is not None:
        return failure
    return _settle(world, number, o, LYING, agent.facing)


def stand_up(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Get up; the character stays ON the seat's row until it walks to something (as the release has it)."""
    agent = world.agents[number]
    failure = _need_rest(world, agent)
    if failure is not None:
        return failure
    states = list(world.states)
    states[SITTING] &= ~agent.bit
    states[LYING] &= ~agent.bit
    return World(world.home, tuple(states), world.agents, world.moved)


def sleep(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Sleep, or wake up: needs a seat or a bed, changes nothing."""
    failure = _need_rest(world, world.agents[number])
    return world if failure is None else failure


def _need_rest(world: World, agent: Agent) -> Failure | None:
    if (world.states[SITTING] | world.states[LYING]) & agent.bit:
        return None
    return refuse(world, Code.NOT_SITTING_OR_LYING, "sitting or lying", "standing")


def _need_room_on(world: World, o: int, lying: bool) -> Failure | None:
    taken = rows.bearing(world, o)
    limit = world.home.limit(o, lying)
    if taken.bit_count() < limit:
        return None
    return refuse(world, Code.OCCUPIED, f"fewer than {limit} on it", str(taken.bit_count()), o, *indices(taken))


def _settle(world: World, number: int, o: int, state: int, facing: int) -> World:
    agent = world.agents[number]
    index, bit, close, _facing, faced, inside, contents, on, worn, right, left, origins = agent
    settled = Agent(index, bit, close, facing, faced, inside, contents, on | 1 << o, worn, right, left, origins)
    agents = (settled,) if len(world.agents) == 1 else world.with_agent(number, settled).agents
    return World(world.home, with_state(world.states, state, bit), agents, world.moved)
