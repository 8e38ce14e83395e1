"""Push, Pull, Move: shifting things without taking them."""

from hearth.simulation.actions.common import able, checked, close, free_hand, reachable

ACTIONS = tuple(checked(name, able, close, reachable, free_hand) for name in ("Push", "Pull", "Move"))
