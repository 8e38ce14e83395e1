"""Wipe, Wash, Rinse, Scrub, Squeeze."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import Becomes, Check, able, checked, close, free_hand, refuse
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.states import CLEAN
from hearth.simulation.world.world import World


def _need_tool(world: World, agent: Agent, o: int, action: str) -> Failure | None:
    """Refuse when the hands are empty; whatever they hold will do."""
    if agent.right | agent.left:
        return None
    return refuse(world, Code.NOT_HOLDING, "something in a hand", "empty hands", o)


_tool = Check(_need_tool, lambda s, _: -1 if s.held else 0)

ACTIONS = (
    checked("Wipe", close, _tool, effect=Becomes(CLEAN)),
    checked("Wash", close, effect=Becomes(CLEAN)),
    checked("Rinse", close, effect=Becomes(CLEAN)),
    checked("Scrub", close, effect=Becomes(CLEAN)),
    checked("Squeeze", free_hand, close, able),
)
