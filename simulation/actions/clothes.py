"""PutOn, PutOff: what the character wears."""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import need_able, need_holding, refuse
from hearth.simulation.agent import Agent
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def put_on(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Put on what a hand holds."""
    agent = world.agents[number]
    failure = need_holding(world, agent, o) or need_able(world, "PutOn", o)
    if failure is not None:
        return failure
    bit = 1 << o
    dressed = Agent(*agent[:8], agent.worn | bit, agent.right & ~bit, agent.left & ~bit, agent.origins)
    return world.with_agent(number, dressed)


def put_off(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Take off what the character wears."""
    agent = world.agents[number]
    failure = None
    if not agent.worn >> o & 1:
        failure = refuse(world, Code.NOT_WORN, "ON the character", "not worn", o)
    failure = failure or need_able(world, "PutOff", o)
    if failure is not None:
        return failure
    return world.with_agent(number, Agent(*agent[:8], agent.worn & ~(1 << o), *agent[9:]))
