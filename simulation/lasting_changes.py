"""Changes of an execution that last: states that no act or process ends, and things that are left on or open."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.formula import Effect
from hearth.kb.knowledge import Knowledge
from hearth.schemas.vocabulary import EVERY_STATE, EVERY_STATE_ID
from hearth.simulation.actions.literal_effects import excluded
from hearth.simulation.engine import Execution
from hearth.simulation.process_plan import here
from hearth.simulation.processes import widened
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

LEFT = ("ON", "OPEN")
"""States in which things are left: somebody else has to end them."""


class Lasting(NamedTuple):
    """A state that a thing is in at the end and was not at the start.

    Attributes:
        thing, name: the id and the class of the thing.
        state: its name.
        step: the step, from 1, after which the thing was in it for good.
    """

    thing: int
    name: str
    state: str
    step: int


def irreversible(execution: Execution) -> tuple[Lasting, ...]:
    """Return the things that were harmed or used up, and that no act or process makes whole, in the order of steps."""
    return irreversible_among(execution.worlds)


def irreversible_among(worlds: Sequence[World]) -> tuple[Lasting, ...]:
    """Return the same for worlds that follow each other; the first is the start."""
    home = worlds[0].home
    groups = home.knowledge.state_groups.values()
    numbers = [EVERY_STATE_ID[name] for each in groups for name in each.harm if name in EVERY_STATE_ID]
    found = (
        each
        for number in numbers
        for each in _entered(worlds, number)
        if not undone(home, number) >> home.index[each.thing] & 1
    )
    return tuple(sorted(found, key=lambda each: (each.step, each.thing, each.state)))


def left(execution: Execution) -> tuple[Lasting, ...]:
    """Return the things that were switched on or opened and are so at the end."""
    return left_among(execution.worlds)


def left_among(worlds: Sequence[World]) -> tuple[Lasting, ...]:
    """Return the same for worlds that follow each other; the first is the start."""
    found = (each for name in LEFT for each in _entered(worlds, EVERY_STATE_ID[name]))
    return tuple(sorted(found, key=lambda each: (each.step, each.thing, each.state)))


def _entered(worlds: Sequence[World], number: int) -> Iterator[Lasting]:
    home, last = worlds[0].home, widened(worlds[-1])
    came = last.states[number] & ~widened(worlds[0]).states[number]
    rows = [widened(world).states[number] for world in worlds] if came else []
    for i in indices(came):
        step = max(k for k, row in enumerate(rows) if not row >> i & 1) + 1
        yield Lasting(home.ids[i], home.classes[i], EVERY_STATE[number], step)


def lasting_rows(world: World) -> tuple[int, ...]:
    """Return the rows of all states of a world of action set 3, without the things that leave them by themselves.

    Hot food cools, and a kettle that boils switches itself off: their state a few ticks later does not follow from the
    steps that were done.
    """
    return tuple(row & ~left for row, left in zip(world.states, passing(world.home), strict=False))


def passing(home: Home) -> tuple[int, ...]:
    """Return for each state the things that a process takes out of it although nothing else is done to them."""
    known: dict[str, tuple[int, ...]] = home.worked_out
    found = known.get("passing")
    if found is None:
        place, rows = here(home), [0] * len(EVERY_STATE)
        for each in place.plan.processes:
            thing = each.part.thing
            for number in thing.has if each.part.devices is None else ():
                if any(_ends(effect, number, home.knowledge) for effect in each.process.effects):
                    rows[number] |= place.kind(home, thing.number)
        found = known["passing"] = tuple(rows)
    return found


def undone(home: Home, number: int) -> int:
    """Return the things that some act or process brings out of a state, by its row."""
    found, place = 0, here(home)
    for name, effect in _effects(home.knowledge):
        if _ends(effect, number, home.knowledge):
            position = "os".find(effect.literal.terms[0].name)
            found |= home.everything if position < 0 else home.able(name, position)
    for each in place.plan.processes:
        asked = number not in each.part.thing.lacks  # a process that waits for its absence does not end it
        if asked and any(_ends(effect, number, home.knowledge) for effect in each.process.effects):
            found |= place.kind(home, each.part.thing.number)
    return found


@lru_cache(maxsize=8)
def _effects(knowledge: Knowledge) -> tuple[tuple[str, Effect], ...]:
    """Return the effects of acts on states, each with the action's name."""
    return tuple(
        (action.name, effect)
        for action in knowledge.actions.values()
        for effect in (*action.effects, *(action.later.effects if action.later else ()))
        if effect.literal.name == "state"
    )


def _ends(effect: Effect, number: int, knowledge: Knowledge) -> bool:
    """Return whether an effect ends a state: it denies it, or makes one that excludes it."""
    literal = effect.literal
    if literal.name != "state":
        return False
    other = EVERY_STATE_ID[literal.terms[1].name]
    return other == number if literal.negated else number in excluded(knowledge)[other]
