"""Effects of action set 3, prepared once so that an act reads only what they need (see `literal_effects`).

Most acts of set 3 have nothing to add to those of set 2: a walker mostly carries no full
box and sits on nothing. A guard says so from a row or two; only where it does not are the conditions read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache
from typing import NamedTuple

from hearth.kb.formula import TRUE, And, Effect, Formula, Term, free
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.actions.formula_evaluation import Bound, Reading, candidates, is_of_kind, kind_of, row_of
from hearth.simulation.actions.literal_effects import Change, excluded, made
from hearth.simulation.rules import Rules
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.moved_edges import BEARS, CONTENTS
from hearth.simulation.world.world import World

ReadRow = Callable[[Reading, Bound], int]
"""A reader of the things for which a literal holds, by the other variables."""

Guard = Callable[[World, Agent, int, int], bool]
"""A test of whether effects may take place, by a world, a character, and the indices of the objects."""


class _Level(NamedTuple):
    """A variable, the parts by which it is looked for, and those that are read once it is bound.

    Attributes:
        variable: its name.
        sought: the parts that narrow which things are tried.
        checks: the parts that are read for each of these.
        rows: readers of the things for which other parts hold; where there are any, `sought` has only kinds.
    """

    variable: str
    sought: tuple[Formula, ...]
    checks: tuple[Formula, ...]
    rows: tuple[ReadRow, ...] = ()

    def things(self, reading: Reading, bound: Bound) -> int:
        """Return the things that are tried for the variable."""
        if not self.rows:
            return candidates(reading, self.variable, self.sought, bound)
        found = -1
        for row in self.rows:
            found &= row(reading, bound)
        for part in self.sought if found else ():
            found &= kind_of(reading.world.home, part)
        return found


class _Group(NamedTuple):
    """Effects of one condition and the same variables, with a guard that has to say yes before it is read."""

    guard: Guard
    literals: tuple[Literal[Term], ...]
    checks: tuple[Formula, ...]
    levels: tuple[_Level, ...]

    def solutions(self, reading: Reading, bound: Bound, level: int = 0) -> Iterator[Bound]:
        """Yield the bindings under which the condition holds."""
        if level == len(self.levels):
            yield bound
            return
        this = self.levels[level]
        variable, checks = this.variable, this.checks
        for i in indices(this.things(reading, bound)):
            extended = {**bound, variable: i}
            if all(reading.holds(part, extended) for part in checks):
                yield from self.solutions(reading, extended, level + 1)

    def changes(self, reading: Reading, bound: Bound) -> Iterator[Change]:
        """Yield what changes by the effects."""
        if not all(reading.holds(part, bound) for part in self.checks):
            return
        for each in self.solutions(reading, bound):
            for literal in self.literals:
                terms = literal.terms[:1] if literal.name == "state" else literal.terms
                nodes = tuple(reading.thing(term, each) for term in terms)
                if min(nodes) >= 0:
                    yield literal, nodes


class _Mark(NamedTuple):
    """A state that the character or an object enters or leaves, whatever else is so.

    Attributes:
        whose: 0 for the character, 1 and 2 for the first and second object.
        number: the row of the state.
        begins: whether it is entered.
        excludes: the rows of the states that are left then.
        kind: the kind of which it has to be; TRUE for any.
    """

    whose: int
    number: int
    begins: bool
    excludes: tuple[int, ...]
    kind: Formula


class Prepared(NamedTuple):
    """All effects of an act, and guards of which one has to say yes if any of the groups' effects takes place."""

    groups: tuple[_Group, ...]
    guards: tuple[Guard, ...]
    marks: tuple[_Mark, ...] = ()

    def after(self, before: World, world: World, agent: Agent, o: int, s: int, rules: Rules, action: str = "") -> World:
        """Return a world after the effects.

        Args:
            before: the world in which conditions are read.
            world: what is changed: the world before, or what the act has made of it by itself.
            agent: the character in the world before.
            o, s: the indices of its objects; -1 for none.
            rules: how actions are read.
            action: its name, for `affords`.
        """
        if self.marks:
            world = _marked(world, self.marks, (agent.index, o, s))
        for guard in self.guards:
            if guard(before, agent, o, s):
                break
        else:
            return world
        reading, bound = Reading(before, agent, rules, action), bound_to(agent, o, s)
        groups = self.groups
        if len(groups) > 1:
            groups = tuple([group for group in groups if group.guard(before, agent, o, s)])
        found = [change for group in groups for change in group.changes(reading, bound)]
        return made(found, world) if found else world


def _marked(world: World, marks: tuple[_Mark, ...], nodes: tuple[int, int, int]) -> World:
    """Return the world after states that are entered and left; the marks that end something stand first."""
    states: list[int] | None = None
    for whose, number, begins, excludes, kind in marks:
        i = nodes[whose]
        now = world.states if states is None else states
        if (now[number] >> i & 1) == begins or not (kind == TRUE or kind_of(world.home, kind) >> i & 1):
            continue
        states = list(now)
        states[number] ^= 1 << i
        for other in excludes if begins else ():
            states[other] &= ~(1 << i)
    return world if states is None else World(world.home, tuple(states), world.agents, world.moved)


def bound_to(agent: Agent, o: int, s: int) -> Bound:
    """Return the binding of a character and its objects."""
    found = {"a": agent.index}
    if o >= 0:
        found["o"] = o
    if s >= 0:
        found["s"] = s
    return found


def prepared(effects: Iterable[Effect], knowledge: Knowledge) -> Prepared:
    """Return effects prepared: those of one condition and the same variables together."""
    together: dict[tuple[object, ...], list[Effect]] = {}
    every = list(effects)
    states = [effect for effect in every if effect.literal.name == "state"]
    marks = [mark for effect in states if (mark := _mark(effect, knowledge)) is not None]
    if len(marks) < len(states):
        marks = []  # endings come before beginnings, among all of them
    for effect in every:
        if marks and effect.literal.name == "state":
            continue
        helpful = effect.literal if effect.literal.negated and effect.variables else None
        together.setdefault((effect.condition, effect.variables, helpful), []).append(effect)
    groups = [_group(each) for each in together.values()]
    marks.sort(key=lambda mark: mark.begins)
    return Prepared(tuple(groups), _guards(each[0] for each in together.values()), tuple(marks))


def _mark(effect: Effect, knowledge: Knowledge) -> _Mark | None:
    """Return an effect as a mark, or None where its condition asks for more than the kind of the thing itself."""
    thing, state = effect.literal.terms
    whose = "aos".find(thing.name)
    plain = effect.condition == TRUE or (is_of_kind(effect.condition) and free(effect.condition) == {thing.name})
    if thing.function or whose < 0 or effect.variables or not plain:
        return None
    number = EVERY_STATE_ID[state.name]
    return _Mark(whose, number, not effect.literal.negated, excluded(knowledge)[number], effect.condition)


def _group(effects: Sequence[Effect]) -> _Group:
    first = effects[0]
    waiting = [] if first.condition == TRUE else _parts(first.condition)
    helpful = [*waiting, first.literal.atom] if first.literal.negated else waiting
    known = {"a", "o", "s"}
    checks = tuple(part for part in waiting if free(part) <= known)
    waiting = [part for part in waiting if part not in checks]
    levels = []
    for variable in first.variables:
        sought = tuple(part for part in helpful if variable in free(part))
        known.add(variable)
        ripe = [part for part in waiting if free(part) <= known]
        waiting = [part for part in waiting if part not in ripe]
        levels.append(_level(variable, sought, ripe))
    return _Group(_guard(first), tuple(each.literal for each in effects), checks, tuple(levels))


def _level(variable: str, sought: tuple[Formula, ...], ripe: Iterable[Formula]) -> _Level:
    checks = [part for part in ripe if not _is_sure(part, variable)]
    rows = [(part, row) for part in checks if (row := row_of(part, variable)) is not None]
    if rows:
        sought = tuple(part for part in sought if _is_sure(part, variable))
        read = [part for part, _ in rows]
        checks = [part for part in checks if part not in read]
    return _Level(variable, sought, tuple(checks), tuple(row for _, row in rows))


def _parts(formula: Formula) -> list[Formula]:
    return [each for part in formula.parts for each in _parts(part)] if isinstance(formula, And) else [formula]


def _is_sure(part: Formula, variable: str) -> bool:
    """Return whether every candidate for a variable fulfils a part."""
    return is_of_kind(part) and free(part) == {variable}


def _guards(effects: Iterable[Effect]) -> tuple[Guard, ...]:
    found = tuple(dict.fromkeys(map(_guard, effects)))
    if _always in found:
        return (_always,)
    if _is_on in found and _carries in found and len(found) == 2:
        return (_is_on_or_carries,)
    return found


def _guard(effect: Effect) -> Guard:
    """Return a necessary condition of an effect that is read fast."""
    texts = [str(part) for part in _parts(effect.condition)]
    if str(effect.literal) == "not ON(a, x)" and "x" in effect.variables:
        return _is_on
    if "holds(a, h)" in texts and ("INSIDE(x, h)" in texts or "ON(x, h)" in texts):
        return _carries
    if "x" in effect.variables and ("INSIDE(x, o)" in texts or "ON(x, o)" in texts):
        return _is_full_or_laden
    if effect.literal.name == "state" and effect.literal.negated:
        return _somewhere(EVERY_STATE_ID[effect.literal.terms[1].name])
    if not effect.variables and is_of_kind(effect.condition) and free(effect.condition) == {"o"}:
        return _of_kind(effect.condition)
    return _always


def _always(world: World, agent: Agent, o: int, s: int) -> bool:
    return True


def _is_on(world: World, agent: Agent, o: int, s: int) -> bool:
    return agent.on != 0


def _carries(world: World, agent: Agent, o: int, s: int) -> bool:
    """Return whether something may be in or on a thing that the character holds."""
    held = rest = agent.right | agent.left
    if not held:
        return False
    home, moved = world.home, world.moved
    extra = moved.extra
    while rest:  # `indices` takes three times as long for the one or two
        i = rest.bit_length() - 1
        key = 8 * i
        if key + CONTENTS in extra or key + BEARS in extra:
            return True
        inside, on = home.contents[i], home.bears[i]
        if (inside and inside & ~moved.inside) or (on and on & ~moved.on):
            return True
        rest ^= 1 << i
    return _anybody_there(world, held)


def _is_on_or_carries(world: World, agent: Agent, o: int, s: int) -> bool:
    return agent.on != 0 or _carries(world, agent, o, s)


def _is_full_or_laden(world: World, agent: Agent, o: int, s: int) -> bool:
    moved = world.moved
    if 8 * o + BEARS in moved.extra:
        return True
    on = world.home.bears[o]
    return bool(on and on & ~moved.on) or _is_full(world, agent, o, s)


def _is_full(world: World, agent: Agent, o: int, s: int) -> bool:
    moved = world.moved
    inside = world.home.contents[o]
    if 8 * o + CONTENTS in moved.extra or (inside and inside & ~moved.inside and not moved.inside >> o & 1):
        return True
    return _anybody_there(world, 1 << o)


def _anybody_there(world: World, things: int) -> bool:
    """Return whether a character is in or on some things, or they are characters with contents."""
    for each in world.agents:  # noqa: SIM110 - `any` takes three times as long
        if (each.inside | each.on) & things or (each.bit & things and each.contents):
            return True
    return False


@cache  # so that guards of one state are one
def _somewhere(state: int) -> Guard:
    """Return the guard of an effect that ends a state: something is in it."""

    def guard(world: World, agent: Agent, o: int, s: int) -> bool:
        return world.states[state] != 0

    return guard


def _of_kind(condition: Formula) -> Guard:
    def guard(world: World, agent: Agent, o: int, s: int) -> bool:
        things = kind_of(world.home, condition)
        return bool(things and things >> o & 1)

    return guard
