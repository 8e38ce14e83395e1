"""Worlds of action set 3: further states, and the rows in which processes count their ticks, behind the ten of all.

They stand in `World.states`, so that every action hands them on without knowing them: a row for each further state, and
last the `Ticks` of all processes.
"""

from typing import Any, TypeVar

from hearth.schemas.vocabulary import EVERY_STATE, STATES
from hearth.simulation.world.process_ticks import Ticks
from hearth.simulation.world.state import WorldState

W = TypeVar("W", bound=WorldState)


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


def wide_start(world: W, counts: int) -> W:
    """Return a home's start with the further states, and as many rows of counts, all at 0."""
    rows: tuple[Any, ...] = (*world.home.states, *world.home.further, Ticks((0,) * counts))
    return type(world)(world.home, rows, world.agents, world.moved)


def without_node(world: WorldState, bit: int) -> tuple[int, ...]:
    """Return the rows of states and of counts without one node."""
    rows: list[Any] = [row & ~bit for row in world.states[:WIDTH]]
    if is_wide(world):
        rows.append(Ticks(tuple(row & ~bit for row in counts_of(world))))
    return tuple(rows)


def with_counts(world: WorldState, counts: tuple[int, ...]) -> tuple[int, ...]:
    """Return the rows of a world's further states at the start, its own of the ten, and given rows of counts."""
    rows: tuple[Any, ...] = (*world.states[: len(STATES)], *world.home.further, Ticks(counts))
    return rows
