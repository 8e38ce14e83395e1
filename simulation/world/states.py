"""The sets of `World.states` by number, and entering a state."""

from hearth.schemas.vocabulary import STATES

CLOSED, OPEN, OFF, ON, DIRTY, CLEAN, PLUGGED_OUT, PLUGGED_IN, SITTING, LYING = range(len(STATES))


def with_state(states: tuple[int, ...], state: int, bit: int) -> tuple[int, ...]:
    """Return the states after a node enters one; it leaves the opposite."""
    new = list(states)
    new[state] |= bit
    new[state ^ 1] &= ~bit
    return tuple(new)
