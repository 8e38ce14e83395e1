"""LookAt, PointAt, Watch, Read, Touch, Greet: what changes nothing but must be possible."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import (
    Action,
    Masks,
    able,
    checked,
    close,
    facing,
    held,
    need_able,
    need_facing,
    reachable,
    refuse,
    some,
)
from hearth.simulation.actions.situation import Situation
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.states import LYING, ON, SITTING
from hearth.simulation.world.world import World


def watch(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Watch what is in the room and faced; by `rules.watch_needs_on`, what has a switch must be on."""
    agent = world.agents[number]
    failure = need_able(world, agent, o, "Watch")
    if failure is None and edge_rows.room_of(world, o) != edge_rows.agent_room(world, agent):
        failure = refuse(world, Code.NOT_IN_ROOM, "in the character's room", "in another", o)
    if failure is None:
        failure = _need_view(world, agent, o)
    if failure is None and rules.watch_needs_on:
        off = world.home.properties["HAS_SWITCH"] & ~world.states[ON]
        if off >> o & 1:
            failure = refuse(world, Code.IS_OFF, "ON", "OFF", o)
    return world if failure is None else failure


def _need_view(world: World, agent: Agent, o: int) -> Failure | None:
    """Return a sitting or lying character must face a thing itself; a computer may also be faced by one hop."""
    resting = (world.states[SITTING] | world.states[LYING]) & agent.bit
    if resting and world.home.classes[o] != "computer" and not agent.facing >> o & 1:
        return refuse(world, Code.NOT_FACING, "the seat facing it", "no direct FACING edge", o)
    return need_facing(world, agent, o)


def _watchable(s: Situation) -> Masks:
    mask = s.able("Watch") & s.facing
    if s.resting:
        mask &= s.me.facing | s.home.by_class.get("computer", 0)
    if s.rules.watch_needs_on:
        mask &= ~s.home.properties["HAS_SWITCH"] | s.states[ON]
    if mask:
        room = edge_rows.agent_room(s.world, s.me)
        mask = mask_of(i for i in indices(mask) if edge_rows.room_of(s.world, i) == room)
    return some(mask)


ACTIONS = (
    checked("LookAt", facing),
    checked("PointAt", facing),
    Action("Watch", watch, _watchable),
    checked("Read", able, held),
    checked("Touch", close, reachable),
    checked("Greet", able),
)
