"""Open, Close, SwitchOn, SwitchOff, PlugIn, PlugOut, Type."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import (
    Becomes,
    Check,
    able,
    checked,
    close,
    free_hand,
    in_state,
    need_state,
    not_in_state,
)
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.states import CLOSED, OFF, ON, OPEN, PLUGGED_IN, PLUGGED_OUT
from hearth.simulation.world.world import World


def _of_pair(state: int, code: Code) -> Check:
    """Return the object is in a state; `code` where it is in the opposite, another where it is in neither."""

    def refusal(world: World, agent: Agent, o: int, action: str) -> Failure | None:
        either = (world.states[OPEN] | world.states[CLOSED]) >> o & 1
        return need_state(world, code if either else Code.NOT_OPENABLE_STATE, state, o)

    return Check(refusal, lambda s, _: s.states[state])


_not_on = not_in_state(ON, Code.IS_ON)
_not_unplugged = not_in_state(PLUGGED_OUT, Code.IS_UNPLUGGED)

ACTIONS = (
    checked("Open", able, close, free_hand, _of_pair(CLOSED, Code.IS_OPEN), _not_on, effect=Becomes(OPEN)),
    checked("Close", able, close, _of_pair(OPEN, Code.IS_CLOSED), effect=Becomes(CLOSED)),
    checked("SwitchOn", able, close, in_state(OFF, Code.IS_ON), _not_unplugged, effect=Becomes(ON)),
    checked("SwitchOff", able, close, in_state(ON, Code.IS_OFF), effect=Becomes(OFF)),
    checked("PlugIn", able, close, free_hand, in_state(PLUGGED_OUT, Code.IS_PLUGGED), effect=Becomes(PLUGGED_IN)),
    # The plug of a running device may be pulled, as the release allows.
    checked("PlugOut", able, close, free_hand, in_state(PLUGGED_IN, Code.IS_UNPLUGGED), effect=Becomes(PLUGGED_OUT)),
    checked("Type", close, able),
)
