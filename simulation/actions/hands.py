"""Grab, PutBack, PutIn, PutObjBack, Drop, Release: what the hands hold and where they leave it."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions import origins
from hearth.simulation.actions.common import (
    Action,
    Check,
    Masks,
    able,
    by_rule,
    checked,
    close,
    free_hand,
    held,
    need_another,
    need_close,
    need_free_hand,
    need_holding,
    need_open,
    reachable,
    refuse,
    some,
)
from hearth.simulation.actions.situation import Situation
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world import moved_edges as kinds
from hearth.simulation.world.agent import Agent, made
from hearth.simulation.world.moved_edges import add, lift
from hearth.simulation.world.states import LYING, OPEN, SITTING
from hearth.simulation.world.world import World


def _need_nobody_else(world: World, agent: Agent, o: int, action: str) -> Failure | None:
    """Refuse what another character holds."""
    if len(world.agents) > 1:
        for number, other in enumerate(world.agents):
            if other.index != agent.index and other.held >> o & 1:
                return refuse(world, Code.HELD_BY_OTHER, "in nobody's hands", f"held by char{number}", o, other.index)
    return None


def _grab(world: World, number: int, o: int, rules: Rules) -> World:
    """Take o into the free hand, right first, and remember where it came from."""
    agent = world.agents[number]
    place, kind = origins.remembered(world, agent, o, rules)
    bit = 1 << o
    room = edge_rows.agent_room(world, agent)
    close = agent.close | bit
    memory = agent.origins
    if place >= 0:
        close |= 1 << place
        memory = (*_forgotten(agent, o), (o, place, kind))
    right, left = agent.right, agent.left
    if right:
        left |= bit
    else:
        right |= bit
    taken = Agent(
        agent.index, agent.bit, close, agent.facing, agent.faced, agent.inside & ~bit, agent.contents & ~bit,
        agent.on & ~bit, agent.worn & ~bit, right, left, memory, agent.pose, agent.stride,
    )  # fmt: skip
    agents: tuple[Agent, ...] = (taken,)
    if len(world.agents) > 1:
        agents = tuple(taken if i == number else other.parted(bit) for i, other in enumerate(world.agents))
    return World(world.home, world.states, agents, lift(world.moved, o, room))


def put_back(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
    """Put o on s; on another character, who needs a free hand, it is handed over."""
    agent = world.agents[number]
    failure = (
        need_another(world, o, s)
        or need_holding(world, agent, o)
        or need_close(world, agent, s, near_hands=rules.near_hands)
    )
    if failure is not None:
        return failure
    if world.home.characters >> s & 1 and s != agent.index:
        return _hand_over(world, number, o, s)
    return _put(world, number, (o, kinds.ON, s), agent.origins)


def put_in(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
    """Put o into s, which must be open if it can be."""
    agent = world.agents[number]
    failure = (
        need_another(world, o, s)
        or need_holding(world, agent, o)
        or need_close(world, agent, s, near_hands=rules.near_hands)
        or need_open(world, s)
    )
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
    failure = need_holding(world, agent, o) or need_close(world, agent, place, near_hands=rules.near_hands)
    if failure is None and kind == kinds.INSIDE:
        failure = need_open(world, place)
    if failure is not None:
        return failure
    return _put(world, number, (o, kind, place), _forgotten(agent, o))


def _drop(world: World, number: int, o: int, rules: Rules) -> World:
    """Let go of o where the character stands."""
    agent = world.agents[number]
    room = edge_rows.agent_room(world, agent)
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
    number, agent = next((number, agent) for number, agent in enumerate(world.agents) if agent.index == s)
    worn = agent.worn | bit if kind == kinds.ON else agent.worn
    contents = agent.contents | bit if kind == kinds.INSIDE else agent.contents
    return world.with_agent(number, agent._replace(close=agent.close | bit, worn=worn, contents=contents))


def _freed(agent: Agent, o: int, close: int, worn: int, memory: tuple[tuple[int, int, int], ...]) -> Agent:
    rest = ~(1 << o)
    right, left = agent.right & rest, agent.left & rest
    return made((agent.index, agent.bit, close, *agent[3:8], worn, right, left, memory, *agent[12:]))


def _forgotten(agent: Agent, o: int) -> tuple[tuple[int, int, int], ...]:
    return tuple(entry for entry in agent.origins if entry[0] != o)


def _hand_over(world: World, number: int, o: int, s: int) -> World | Failure:
    receiver = next(i for i, agent in enumerate(world.agents) if agent.index == s)
    failure = need_free_hand(world, world.agents[receiver], o)
    if failure is not None:
        return failure
    giver, taker = world.agents[number], world.agents[receiver]
    bit = 1 << o
    right, left = (taker.right, taker.left | bit) if taker.right else (taker.right | bit, taker.left)
    given = _freed(giver, o, giver.close | 1 << s, giver.worn, _forgotten(giver, o))
    taken = taker._replace(close=taker.close | bit | giver.bit, right=right, left=left)
    return world.with_agent(number, given).with_agent(receiver, taken)


def _putable_on(s: Situation) -> Masks:
    return (s.held, s.close & ~s.full_handed) if s.held else None


def _putable_in(s: Situation) -> Masks:
    return (s.held, s.close & (~s.home.properties["CAN_OPEN"] | s.states[OPEN])) if s.held else None


def _returnable(s: Situation) -> Masks:
    closed = s.home.properties["CAN_OPEN"] & ~s.states[OPEN]
    mask = 0
    for o, place, kind in s.me.origins:
        if s.held >> o & 1 and s.close >> place & 1 and not (kind == kinds.INSIDE and closed >> place & 1):
            mask |= 1 << o
    return some(mask)


def _need_another_grip(world: World, agent: Agent, o: int, action: str) -> Failure | None:
    """Refuse what a hand holds already."""
    if not agent.held >> o & 1:
        return None
    return refuse(world, Code.HELD_ALREADY, "in neither hand", "held already", o)


def _need_nobody_resting(world: World, agent: Agent, o: int, action: str) -> Failure | None:
    """Refuse a seat that the character itself, or another, sits or lies on."""
    resting = world.states[SITTING] | world.states[LYING]
    for other in world.agents:
        if other.on >> o & 1 and resting & other.bit:
            lying = bool(world.states[LYING] & other.bit)
            if other.index != agent.index:
                return refuse(world, Code.OCCUPIED, "nobody on it", "somebody", o, other.index)
            code, posture = (Code.LYING, "lying") if lying else (Code.SITTING, "sitting")
            return refuse(world, code, "not on it", f"{posture} on it", o)
    return None


_nobody_resting = Check(_need_nobody_resting, lambda s, _: ~s.in_use)

_nobody_else = Check(_need_nobody_else, lambda s, _: ~s.held_by_others)

_another_grip = Check(_need_another_grip, lambda s, _: ~s.held)

_GRAB = (able, close, reachable, free_hand, _nobody_else)


def _grabbing(*more: Check) -> Action:
    """Grab, with more checks at its end: by the rule `one_grip` not again what is held."""
    checks = (*_GRAB, *more)
    return by_rule(
        "one_grip",
        checked("Grab", _another_grip, *checks, effect=_grab),
        checked("Grab", *checks, effect=_grab),
    )


ACTIONS = (
    by_rule("leaves_seat", _grabbing(_nobody_resting), _grabbing()),
    Action("PutBack", put_back, _putable_on),
    Action("PutIn", put_in, _putable_in),
    Action("PutObjBack", put_obj_back, _returnable),
    checked("Drop", held, effect=_drop),
    checked("Release", held, effect=_drop),
)
