"""Worlds of action set 3: further states, and rows in which processes count their ticks, behind the ten of all worlds.

The rows stand behind the others in `World.states`, so that every action hands them on without knowing them.
"""

from hearth.schemas.vocabulary import EVERY_STATE, STATES
from hearth.simulation.world.state import WorldState


def is_wide(world: WorldState) -> bool:
    """Whether a world has the further states."""
    return len(world.states) > len(STATES)


def rows_with_further(world: WorldState) -> tuple[int, ...]:
    """The rows of all states: those that a world does not simulate are as the home has them."""
    return world.states if is_wide(world) else world.states + world.home.further


def rows_at_start(world: WorldState) -> tuple[int, ...]:
    """The rows of the states that a world has, as its home has them."""
    return world.home.states + world.home.further if is_wide(world) else world.home.states


WIDTH = len(EVERY_STATE)
"""The rows of states; those of counters follow."""
