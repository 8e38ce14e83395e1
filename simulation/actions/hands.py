"""Grab, PutBack, PutIn, PutObjBack, Drop, Release: what the hands hold and where they leave it."""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation import moved as kinds
from hearth.simulation import origins, rows
from hearth.simulation.actions.common import (
    OPEN,
    need_able,
    need_close,
    need_free_hand,
    need_holding,
    need_reachable,
    refuse,
)
from hearth.simulation.agent import Agent
from hearth.simulation.moved import add, lift
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def grab(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Take o into the free hand, right first, and remember where it came from."""
    agent = world.agents[number]
    failure = (
        need_able(world, "Grab", o)
        or need_close(world, agent, o)
        or need_reachable(world, o)
        or need_free_hand(world, agent, o)
    )
    if failure is None and len(world.agents) > 1:
        failure = _need_nobody_holding(world, number, o)
    if failure is not None:
        return failure
    place, kind = origins.remembered(world, agent, o, rules)
    bit = 1 << o
    room = rows.agent_room(world, agent)
    close = agent.close | bit
    memory = agent.origins
    if place >= 0:
        close |= 1 << place
        memory = (*(entry for entry in memory if entry[0] != o), (o, place, kind))
    right, left = agent.right, agent.left
    if right:
        left |= bit
    else:
        right |= bit
    taken = Agent(
        agent.index, agent.bit, close, agent.facing, agent.faced, agent.inside & ~bit, agent.contents & ~bit,
        agent.on & ~bit, agent.worn & ~bit, right, left, memory,
    )  # fmt: skip
    agents = (taken,) if len(world.agents) == 1 else _taken_from_others(world.agents, number, taken, bit)
    return World(world.home, world.states, agents, lift(world.moved, o, room))


def put_back(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
    """Put o on s; on another character, who needs a free hand, it is handed over."""
    agent = world.agents[number]
    failure = need_holding(world, agent, o) or need_close(world, agent, s)
    if failure is not None:
        return failure
    if world.home.characters >> s & 1 and s != agent.index:
        return _hand_over(world, number, o, s)
    return _put(world, number, (o, kinds.ON, s), agent.origins)


def put_in(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
    """Put o into s, which must be open if it can be."""
    agent = world.agents[number]
    failure = need_holding(world, agent, o) or need_close(world, agent, s) or _need_open(world, s)
    if failure is not None:
        return failure
    return _put(world, number, (o, kinds.INSIDE, s), agent.origins)


def put_obj_back(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Put o back where it was grabbed from."""
    agent = world.agents[number]
    entry = next((entry for entry in agent.origins if entry[0] == o), None)
    if entry is None:
        return refuse(world, Code.NO_ORIGIN, "an object grabbed earlier", "never grabbed, or put back since", o)
    place, kind = entry[1:]
    failure = need_holding(world, agent, o) or need_close(world, agent, place)
    if failure is None and kind == kinds.INSIDE:
        failure = _need_open(world, place)
    if failure is not None:
        return failure
    return _put(world, number, (o, kind, place), _forgotten(agent, o))


def drop(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Let go of o where the character stands; Release is the same."""
    agent = world.agents[number]
    failure = need_holding(world, agent, o)
    if failure is not None:
        return failure
    room = rows.agent_room(world, agent)
    after = add(world.moved, (o, kinds.INSIDE, room)) if room >= 0 else world.moved
    freed = _freed(agent, o, agent.close, agent.worn, _forgotten(agent, o))
    return World(world.home, world.states, world.with_agent(number, freed).agents, after)


def _put(
    world: World, number: int, edge: tuple[int, int, int], memory: tuple[tuple[int, int, int], ...]
) -> World | Failure:
    o, kind, s = edge
    agent = world.agents[number]
    close = agent.close | 1 << s
    freed = _freed(agent, o, close, agent.worn, memory)
    if world.home.characters >> s & 1:
        return _put_at_character(world.with_agent(number, freed), edge)
    edges = (edge,) if kind == kinds.CLOSE else ((o, kinds.CLOSE, s), edge)
    agents = (freed,) if len(world.agents) == 1 else world.with_agent(number, freed).agents
    return World(world.home, world.states, agents, add(world.moved, *edges))


def _put_at_character(world: World, edge: tuple[int, int, int]) -> World:
    """Leave a thing with a character, oneself or another: its edges stand in the character's rows."""
    o, kind, s = edge
    bit = 1 << o
    number, (index, me, close, facing, faced, inside, contents, on, worn, right, left, memory) = next(
        (number, agent) for number, agent in enumerate(world.agents) if agent.index == s
    )
    worn |= bit if kind == kinds.ON else 0
    contents |= bit if kind == kinds.INSIDE else 0
    agent = Agent(index, me, close | bit, facing, faced, inside, contents, on, worn, right, left, memory)
    return world.with_agent(number, agent)


def _freed(agent: Agent, o: int, close: int, worn: int, memory: tuple[tuple[int, int, int], ...]) -> Agent:
    rest = ~(1 << o)
    index, bit, _close, facing, faced, inside, contents, on, _worn, right, left, _origins = agent
    return Agent(index, bit, close, facing, faced, inside, contents, on, worn, right & rest, left & rest, memory)


def _forgotten(agent: Agent, o: int) -> tuple[tuple[int, int, int], ...]:
    return tuple(entry for entry in agent.origins if entry[0] != o)


def _need_open(world: World, s: int) -> Failure | None:
    if not world.home.properties["CAN_OPEN"] >> s & 1 or world.states[OPEN] >> s & 1:
        return None
    return refuse(world, Code.IS_CLOSED, "OPEN", "CLOSED", s)


def _need_nobody_holding(world: World, number: int, o: int) -> Failure | None:
    for other, agent in enumerate(world.agents):
        if other != number and agent.held >> o & 1:
            return refuse(world, Code.HELD_BY_OTHER, "in nobody's hands", f"held by char{other}", o, agent.index)
    return None


def _taken_from_others(agents: tuple[Agent, ...], number: int, taken: Agent, bit: int) -> tuple[Agent, ...]:
    """Void the other characters' edges to a thing that one has grabbed."""
    rest = ~bit
    return tuple(
        taken
        if i == number
        else Agent(
            other.index, other.bit, other.close & rest, other.facing, other.faced, other.inside & rest,
            other.contents & rest, other.on & rest, other.worn & rest, other.right, other.left, other.origins,
        )
        for i, other in enumerate(agents)
    )  # fmt: skip


def _hand_over(world: World, number: int, o: int, s: int) -> World | Failure:
    receiver = next(i for i, agent in enumerate(world.agents) if agent.index == s)
    failure = need_free_hand(world, world.agents[receiver], o)
    if failure is not None:
        return failure
    giver, taker = world.agents[number], world.agents[receiver]
    bit = 1 << o
    right, left = (taker.right, taker.left | bit) if taker.right else (taker.right | bit, taker.left)
    given = _freed(giver, o, giver.close | 1 << s, giver.worn, _forgotten(giver, o))
    taken = Agent(*taker[:2], taker.close | bit | giver.bit, *taker[3:9], right, left, taker.origins)
    return world.with_agent(number, given).with_agent(receiver, taken)
