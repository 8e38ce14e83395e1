"""PutOn, PutOff: what the character wears."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import Check, able, checked, held, refuse
from hearth.simulation.rules import Rules
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.world import World


def _need_worn(world: World, agent: Agent, o: int, action: str) -> Failure | None:
    if agent.worn >> o & 1:
        return None
    return refuse(world, Code.NOT_WORN, "ON the character", "not worn", o)


def _put_on(world: World, number: int, o: int, rules: Rules) -> World:
    agent, bit = world.agents[number], 1 << o
    dressed = agent._replace(worn=agent.worn | bit, right=agent.right & ~bit, left=agent.left & ~bit)
    return world.with_agent(number, dressed)


def _put_off(world: World, number: int, o: int, rules: Rules) -> World:
    agent = world.agents[number]
    return world.with_agent(number, agent._replace(worn=agent.worn & ~(1 << o)))


_worn = Check(_need_worn, lambda s, _: s.me.worn)

ACTIONS = (checked("PutOn", held, able, effect=_put_on), checked("PutOff", _worn, able, effect=_put_off))
