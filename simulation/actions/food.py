"""Drink, Eat, Cut, Pour."""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation import rows
from hearth.simulation.actions.common import need_able, need_close, need_free_hand, need_holding, refuse
from hearth.simulation.agent import Agent
from hearth.simulation.moved import INSIDE, add
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def drink(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Drink from what a hand holds."""
    failure = need_able(world, "Drink", o) or need_holding(world, world.agents[number], o)
    return world if failure is None else failure


def eat(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Eat o, or what is on it."""
    failure = need_close(world, world.agents[number], o)
    if failure is None:
        eatable = world.home.properties["EATABLE"]
        if not eatable >> o & 1 and not rows.bearing(world, o) & eatable:
            failure = refuse(world, Code.NOTHING_TO_EAT, "EATABLE, or something EATABLE on it", "neither", o)
    return world if failure is None else failure


def cut(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Cut food with a knife in the other hand."""
    agent = world.agents[number]
    failure = need_free_hand(world, agent, o) or need_close(world, agent, o) or need_able(world, "Cut", o)
    if failure is None and not _holds_knife(world, agent):
        failure = refuse(world, Code.NOT_HOLDING, "a knife in a hand", "none", o)
    return world if failure is None else failure


def pour(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
    """Pour o into s; water leaves the hand, other things stay in it."""
    agent = world.agents[number]
    failure = (
        need_able(world, "Pour", o)
        or need_able(world, "Pour", s, 1)
        or need_holding(world, agent, o)
        or need_close(world, agent, s)
    )
    if failure is not None:
        return failure
    agents = world.agents
    if world.home.classes[o] == "water":
        rest = ~(1 << o)
        emptied = Agent(*agent[:9], agent.right & rest, agent.left & rest, agent.origins)
        agents = world.with_agent(number, emptied).agents
    return World(world.home, world.states, agents, add(world.moved, (o, INSIDE, s)))


def _holds_knife(world: World, agent: Agent) -> bool:
    return any("knife" in world.home.classes[i] for i in rows.held_indices(agent))
