"""Hazards of an execution: the rows of `hazards.yaml` that become true while people act (consequences of acts).

What a home has at the start is nobody's doing: a hazard counts from the tick at which it has come, and, where its row
asks for a number of ticks, once it has lasted so long or the program ends in it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

from hearth.kb.formula import And, Formula, Or, free
from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Hazard
from hearth.simulation.actions.formula_evaluation import (
    Bound,
    Reading,
    candidates,
    flat_parts,
    is_narrow,
    is_of_kind,
    kind_of,
)
from hearth.simulation.engine import Execution
from hearth.simulation.processes import widened
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.states import LYING
from hearth.simulation.world.world import World

Place = tuple[str, tuple[int, ...]]
"""A hazard by name, and the indices of its things."""


class Found(NamedTuple):
    """A hazard of an execution.

    Attributes:
        hazard: its row.
        things: the ids of x, and of y where the row names one.
        classes: the class names of these.
        step: the step after which it was there, from 1.
        lasted: the ticks for which it was so.
        at_end: whether the program ended in it.
    """

    hazard: Hazard
    things: tuple[int, ...]
    classes: tuple[str, ...]
    step: int
    lasted: int
    at_end: bool

    def sentence(self) -> str:
        """Return the hazard in words."""
        names = (f"{name.replace('_', ' ')}" for name in self.classes)
        return self.hazard.say.format(**dict(zip("xy", names, strict=False)))


def hazards(execution: Execution) -> tuple[Found, ...]:
    """Return the hazards that an execution brought, in the order in which they came.

    Examples:
        >>> [found.sentence() for found in hearth.hazards(execution)]
        ['the fridge stands open']
    """
    return hazards_among(execution.worlds)


def hazards_among(worlds: Sequence[World], *, ends: bool = True) -> tuple[Found, ...]:
    """Return the hazards that came while some worlds followed each other; the first is the start.

    Args:
        worlds: the first is the start.
        ends: whether nothing is done after the last world. An episode ends in the tick in which its goal is reached,
            while agents still act: there a hazard counts only once it has lasted as long as its row says.
    """
    first, *later = worlds
    known = first.home.knowledge
    given, since, over = set(dict(present(first))), dict[Place, _Spell](), list[Found]()
    before = first
    for number, world in enumerate(later, 1):
        now = dict(present(world))
        given = given & now.keys()
        for place in [place for place in since if not now.get(place)]:
            over += _over(known, world, place, since.pop(place), number, at_end=False)
        for place, is_one in now.items():
            if is_one and place not in given:
                spell = since.setdefault(place, _Spell(number))
                if known.hazards[place[0]].unused and _is_used(before, world, place[1][0]):
                    spell.use(number)
        before = world
    last = worlds[-1]
    for place, spell in since.items():
        over += _over(known, last, place, spell, len(worlds), at_end=True, counts=ends)
    return tuple(sorted(over, key=lambda found: (found.step, found.hazard.name, found.things)))


class _Spell:
    """The time for which a hazard lasts: its first step, and its longest part in which its thing was not used."""

    def __init__(self, step: int) -> None:
        self.step, self._used, self._longest = step, step, 0

    def use(self, step: int) -> None:
        """Count anew from a step."""
        self._longest, self._used = self.longest(step), step

    def longest(self, end: int) -> int:
        """Return the ticks of the longest part without use, up to a step."""
        return max(self._longest, end - self._used)


def _is_used(before: World, world: World, i: int) -> bool:
    """Return whether a thing came into another or out of it in a tick."""
    return edge_rows.contents(before, i) != edge_rows.contents(world, i)


def _over(
    known: Knowledge, world: World, place: Place, spell: _Spell, end: int, *, at_end: bool, counts: bool = False
) -> Iterator[Found]:
    """Yield a hazard that is over, or in which the program ended, if it `counts` or lasted long enough."""
    name, things = place
    hazard = known.hazards[name]
    if counts or spell.longest(end) >= max(1, hazard.after):
        home = world.home
        ids, classes = tuple(home.ids[i] for i in things), tuple(home.classes[i] for i in things)
        yield Found(hazard, ids, classes, spell.step, end - spell.step, at_end)


def present(world: World) -> Iterator[tuple[Place, bool]]:
    """Yield the conditions that hold in a world, however long they last, and whether each is a hazard at this moment.

    One that asks that nobody is there, or that everybody lies down, is none otherwise.
    """
    world = widened(world)
    if not world.agents:
        return
    reading = Reading(world, world.agents[0], CONSEQUENCES)
    for hazard, variables, cases in _plan(world.home.knowledge):
        awake = hazard.asleep and not _everybody_lies(world)
        for case in cases:
            for things in _matches(reading, case, variables):
                yield (hazard.name, things), not (awake or (hazard.alone and _attended(world, things[0])))


class _Case(NamedTuple):
    """The joined parts of one alternative of a condition, by the variables that they mention.

    Attributes:
        closed: parts without a variable.
        kinds: of each variable, the parts that ask for its class and properties alone.
        narrow: literals that say which few things a variable may be.
        single: of each variable, the further parts that mention it alone.
        joint: parts that mention both.
    """

    closed: tuple[Formula, ...]
    kinds: dict[str, tuple[Formula, ...]]
    narrow: tuple[Formula, ...]
    single: dict[str, tuple[Formula, ...]]
    joint: tuple[Formula, ...]


@lru_cache(maxsize=16)
def _plan(known: Knowledge) -> tuple[tuple[Hazard, tuple[str, ...], tuple[_Case, ...]], ...]:
    """Return each hazard with its variables, and its condition as alternatives by which candidates are found fast."""
    found = []
    for hazard in known.hazards.values():
        variables = tuple(sorted(free(hazard.condition)))
        cases = (_case(flat_parts(parts), variables) for parts in _alternatives(hazard.condition))
        found.append((hazard, variables, tuple(cases)))
    return tuple(found)


def _case(parts: tuple[Formula, ...], variables: tuple[str, ...]) -> _Case:
    names = {id(part): free(part) for part in parts}
    alone = {name: tuple(part for part in parts if names[id(part)] == {name}) for name in variables}
    return _Case(
        tuple(part for part in parts if not names[id(part)]),
        {name: tuple(filter(is_of_kind, those)) for name, those in alone.items()},
        tuple(filter(is_narrow, parts)),
        {name: tuple(part for part in those if not is_of_kind(part)) for name, those in alone.items()},
        tuple(part for part in parts if len(names[id(part)]) > 1),
    )


def _alternatives(formula: Formula) -> list[tuple[Formula, ...]]:
    if isinstance(formula, Or) and any("INSIDE" in str(part) or "ON(" in str(part) for part in formula.parts):
        return [case for part in formula.parts for case in _alternatives(part)]
    if isinstance(formula, And):
        found: list[tuple[Formula, ...]] = [()]
        for part in formula.parts:
            found = [(*head, *tail) for head in found for tail in _alternatives(part)]
        return found
    return [(formula,)]


def _tried(reading: Reading, case: _Case, name: str, bound: Bound) -> int:
    """Return the things that a variable may be."""
    found = candidates(reading, name, case.narrow, bound)
    for part in case.kinds[name] if found else ():
        found &= kind_of(reading.world.home, part)
    return found


def _matches(reading: Reading, case: _Case, variables: tuple[str, ...]) -> Iterator[tuple[int, ...]]:
    """Yield the things of which all parts hold; the variable that fewer things may be is looked for first."""
    among: dict[str, int] = {}
    for name in variables:
        among[name] = _tried(reading, case, name, {})
        if not among[name]:
            return
    if not all(reading.holds(part, {}) for part in case.closed):
        return
    first, *rest = sorted(variables, key=lambda name: among[name].bit_count())
    for i in indices(among[first]):
        bound = {first: i}
        if not all(reading.holds(part, bound) for part in case.single[first]):
            continue
        if not rest:
            yield (i,)
        for j in indices(_tried(reading, case, rest[0], bound)) if rest else ():
            both = {**bound, rest[0]: j}
            if all(reading.holds(part, both) for part in (*case.single[rest[0]], *case.joint)):
                yield tuple(both[name] for name in variables)


def _attended(world: World, i: int) -> bool:
    """Return whether a character or a grown person is in the room of a thing, or a character in reach of it."""
    room = edge_rows.room_of(world, i)
    if room >= 0 and any(edge_rows.agent_room(world, agent) == room for agent in world.agents):
        return True
    if any(edge_rows.is_near(world, agent, i, near_hands=True) for agent in world.agents):
        return True
    return room >= 0 and any(edge_rows.room_of(world, person) == room for person in indices(_grown(world.home)))


def _grown(home: Home) -> int:
    """Return the grown people of a home who are no characters."""
    grown: int | None = home.worked_out.get("grown")
    if grown is None:
        people = home.properties["PERSON"] & ~home.characters
        grown = mask_of(i for i in indices(people) if home.classes[i] != CHILD)
        home.worked_out["grown"] = grown
    return grown


CHILD = "child"


def _everybody_lies(world: World) -> bool:
    return all(world.states[LYING] >> agent.index & 1 for agent in world.agents)
