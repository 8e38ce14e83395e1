"""Wipe, Wash, Rinse, Scrub, Squeeze."""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import (
    CLEAN,
    need_able,
    need_close,
    need_free_hand,
    refuse,
    with_state,
)
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def wipe(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Wipe o clean with whatever a hand holds."""
    agent = world.agents[number]
    failure = need_close(world, agent, o)
    if failure is None and not agent.right | agent.left:
        failure = refuse(world, Code.NOT_HOLDING, "something in a hand", "empty hands", o)
    return _cleaned(world, o) if failure is None else failure


def wash(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Wash o clean; Rinse and Scrub are the same."""
    failure = need_close(world, world.agents[number], o)
    return _cleaned(world, o) if failure is None else failure


def squeeze(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Squeeze something soft."""
    agent = world.agents[number]
    failure = need_free_hand(world, agent, o) or need_close(world, agent, o) or need_able(world, "Squeeze", o)
    return world if failure is None else failure


def _cleaned(world: World, o: int) -> World:
    return World(world.home, with_state(world.states, CLEAN, 1 << o), world.agents, world.moved)
