"""Sit, Lie, StandUp, Sleep, WakeUp."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import Action, Check, Effect, Masks, able, by_rule, checked, close, refuse
from hearth.simulation.actions.situation import Situation
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent, made
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import LYING, SITTING, with_state
from hearth.simulation.world.world import World


def _sit(world: World, number: int, o: int, rules: Rules) -> World:
    """Return the character then faces what the seat faces."""
    ahead = edge_rows.facing(world, o)
    for other in world.agents:
        if other.faced >> o & 1:
            ahead |= other.bit
    return _settle(world, number, o, SITTING, world.agents[number].facing | ahead, rules)


def _lie(world: World, number: int, o: int, rules: Rules) -> World:
    return _settle(world, number, o, LYING, world.agents[number].facing, rules)


def stand_up(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Get up from the seat or bed; in the release one stays ON it, wherever one walks."""
    agent = world.agents[number]
    failure = _need_rest(world, agent)
    if failure is not None:
        return failure
    states = list(world.states)
    states[SITTING] &= ~agent.bit
    states[LYING] &= ~agent.bit
    agents = world.agents
    if rules.leaves_seat:
        left = agent.on & ~edge_rows.seats(world.home)
        agents = world.with_agent(number, made((*agent[:7], left, *agent[8:]))).agents
    return World(world.home, tuple(states), agents, world.moved)


def sleep(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Sleep, or wake up: needs a seat or a bed, changes nothing."""
    failure = _need_rest(world, world.agents[number])
    return world if failure is None else failure


def _resting(s: Situation) -> Masks:
    return () if s.resting else None


def _need_rest(world: World, agent: Agent) -> Failure | None:
    if (world.states[SITTING] | world.states[LYING]) & agent.bit:
        return None
    return refuse(world, Code.NOT_SITTING_OR_LYING, "sitting or lying", "standing")


def _not_already(state: int, code: Code, name: str) -> Check:
    """Return the character is not in the posture yet."""

    def refusal(world: World, agent: Agent, o: int, action: str) -> Failure | None:
        return refuse(world, code, f"not {name}", name, o) if world.states[state] & agent.bit else None

    return Check(refusal, lambda s, _: 0 if s.states[state] & s.me.bit else -1)


def _unoccupied(lying: bool, made_bed: bool) -> Check:
    """Fewer things are on the seat or bed than its limit; by the rule `made_bed`, bedding of a bed aside."""

    def refusal(world: World, agent: Agent, o: int, action: str) -> Failure | None:
        taken = edge_rows.taking_room(world, o, made_bed)
        limit = world.home.limit(o, lying)
        if taken.bit_count() < limit:
            return None
        fewer = f"fewer than {limit} on it{' besides bedding' if made_bed and edge_rows.turned_back(world, o) else ''}"
        return refuse(world, Code.OCCUPIED, fewer, str(taken.bit_count()), o, *indices(taken))

    return Check(refusal, lambda s, action: s.with_room(s.able(action) & s.close, lying, made_bed))


def _resting_on(name: str, lying: bool, already: Check, effect: Effect) -> Action:
    """Sit or Lie: both need room, which the bedding of a made bed takes only in the release."""
    made, counted = (
        checked(name, close, already, able, _unoccupied(lying, made_bed), effect=effect) for made_bed in (True, False)
    )
    return by_rule("made_bed", made, counted)


def _settle(world: World, number: int, o: int, state: int, facing: int, rules: Rules) -> World:
    agent = world.agents[number]
    before = agent.on & ~edge_rows.seats(world.home) if rules.leaves_seat else agent.on
    on = before | 1 << o
    settled = made((*agent[:3], facing, *agent[4:7], on, *agent[8:]))
    agents = (settled,) if len(world.agents) == 1 else world.with_agent(number, settled).agents
    return World(world.home, with_state(world.states, state, agent.bit), agents, world.moved)


ACTIONS = (
    _resting_on("Sit", False, _not_already(SITTING, Code.SITTING, "sitting"), _sit),
    _resting_on("Lie", True, _not_already(LYING, Code.LYING, "lying"), _lie),
    Action("StandUp", stand_up, _resting),
    Action("Sleep", sleep, _resting),
    Action("WakeUp", sleep, _resting),
)
