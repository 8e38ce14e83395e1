"""Open, Close, SwitchOn, SwitchOff, PlugIn, PlugOut, Type."""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import (
    CLOSED,
    OFF,
    ON,
    OPEN,
    PLUGGED_IN,
    PLUGGED_OUT,
    need_able,
    need_close,
    need_free_hand,
    need_state,
    refuse,
    with_state,
)
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def open_(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Open what is closed and not running."""
    agent = world.agents[number]
    failure = (
        need_able(world, "Open", o)
        or need_close(world, agent, o)
        or need_free_hand(world, agent, o)
        or _need_pair(world, Code.IS_OPEN, CLOSED, o)
    )
    if failure is None and world.states[ON] >> o & 1:
        failure = refuse(world, Code.IS_ON, "not ON", "ON", o)
    return _set(world, OPEN, o) if failure is None else failure


def close(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Close what is open."""
    agent = world.agents[number]
    failure = need_able(world, "Close", o) or need_close(world, agent, o) or _need_pair(world, Code.IS_CLOSED, OPEN, o)
    return _set(world, CLOSED, o) if failure is None else failure


def switch_on(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Switch on what is off and not unplugged."""
    agent = world.agents[number]
    failure = need_able(world, "SwitchOn", o) or need_close(world, agent, o) or need_state(world, Code.IS_ON, OFF, o)
    if failure is None and world.states[PLUGGED_OUT] >> o & 1:
        failure = refuse(world, Code.IS_UNPLUGGED, "not PLUGGED_OUT", "PLUGGED_OUT", o)
    return _set(world, ON, o) if failure is None else failure


def switch_off(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Switch off what is on."""
    agent = world.agents[number]
    failure = need_able(world, "SwitchOff", o) or need_close(world, agent, o) or need_state(world, Code.IS_OFF, ON, o)
    return _set(world, OFF, o) if failure is None else failure


def plug_in(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Put the plug of o into its socket."""
    failure = _need_plug(world, number, o, "PlugIn") or need_state(world, Code.IS_PLUGGED, PLUGGED_OUT, o)
    return _set(world, PLUGGED_IN, o) if failure is None else failure


def plug_out(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Pull the plug of o, even while it is on (as the release allows)."""
    failure = _need_plug(world, number, o, "PlugOut") or need_state(world, Code.IS_UNPLUGGED, PLUGGED_IN, o)
    return _set(world, PLUGGED_OUT, o) if failure is None else failure


def type_(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Type on a keyboard or anything with buttons."""
    agent = world.agents[number]
    failure = need_close(world, agent, o) or need_able(world, "Type", o)
    return world if failure is None else failure


def _need_pair(world: World, code: Code, state: int, o: int) -> Failure | None:
    """Refuse what is already open or closed with `code`, what is neither with one of its own."""
    either = (world.states[OPEN] | world.states[CLOSED]) >> o & 1
    return need_state(world, code if either else Code.NOT_OPENABLE_STATE, state, o)


def _need_plug(world: World, number: int, o: int, action: str) -> Failure | None:
    agent = world.agents[number]
    return need_able(world, action, o) or need_close(world, agent, o) or need_free_hand(world, agent, o)


def _set(world: World, state: int, o: int) -> World:
    return World(world.home, with_state(world.states, state, 1 << o), world.agents, world.moved)
