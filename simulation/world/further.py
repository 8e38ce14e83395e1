"""Worlds of action set 3: further states, and the rows in which processes count their ticks, behind the ten of all.

They stand in `World.states`, so that every action hands them on without knowing them: a row for each further state, and
last the `Ticks` of all processes.
"""

from hearth.schemas.vocabulary import EVERY_STATE, STATES
from hearth.simulation.world.state import WorldState


def is_wide(world: WorldState) -> bool:
    """Return whether a world has the further states."""
    return len(world.states) > len(STATES)


def rows_with_further(world: WorldState) -> tuple[int, ...]:
    """Return the rows of all states: those that a world does not simulate are as the home has them."""
    return world.states if is_wide(world) else world.states + world.home.further


def rows_at_start(world: WorldState) -> tuple[int, ...]:
    """Return the rows of the states that a world has, as its home has them."""
    return world.home.states + world.home.further if is_wide(world) else world.home.states


WIDTH = len(EVERY_STATE)
"""The rows of states; the counts follow."""


def counts_of(world: WorldState) -> tuple[int, ...]:
    """Return the rows in which processes count (see `processes`); none of a world of another set."""
    return world.states[WIDTH].counted() if is_wide(world) else ()  # type: ignore[attr-defined]


def canonical_states(world: WorldState) -> tuple[object, ...]:
    """Return the rows of states and of counts, equal for worlds in which the same is so."""
    return (*world.states[:WIDTH], counts_of(world)) if is_wide(world) else world.states
