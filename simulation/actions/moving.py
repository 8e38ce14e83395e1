"""Push, Pull, Move: shifting things without taking them."""

from __future__ import annotations

from hearth.schemas.failures import Failure
from hearth.simulation.actions.common import Action, need_able, need_close, need_free_hand, need_reachable
from hearth.simulation.rules import Rules
from hearth.simulation.world import World


def shifting(action: str) -> Action:
    """The function of an action that shifts what the knowledge allows for it."""

    def shift(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
        agent = world.agents[number]
        failure = (
            need_able(world, action, o)
            or need_close(world, agent, o)
            or need_reachable(world, o)
            or need_free_hand(world, agent, o)
        )
        return world if failure is None else failure

    return shift


push = shifting("Push")
pull = shifting("Pull")
move = shifting("Move")
