"""The literals of action set 3 read in a world: whether a formula holds of an act, and for which things.

What acts ask most often (`close`, `holds`, `hidden`, `room`) is read by the functions of set 2, the rest from the rows
of the world. `tests/oracles/formulas.py` reads the same formulas plainly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from hearth.kb.formula import And, Count, Formula, Not, Or, Some, Term, free
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE_ID, RELATIONS
from hearth.simulation.literal_truth import RELATED
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.affordance import of_kind
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Bound = Mapping[str, int]
"""Variable -> index: `a` the acting character, `o` and `s` the first and second object."""

_OF_KIND = ("class", "class_contains", "property")


class Reading(NamedTuple):
    """A world as one act of one character sees it."""

    world: World
    agent: Agent
    rules: Rules
    action: str = ""

    def thing(self, term: Term, bound: Bound) -> int:
        """Return the index of the thing that a term names, or -1."""
        index = bound[term.name]
        if not term.function:
            return index
        if term.function == "room":
            return edge_rows.room_of(self.world, index)
        return next((place for thing, place, _ in self.agent.origins if thing == index), -1)

    def holds(self, formula: Formula, bound: Bound) -> bool:
        """Return whether a formula holds under a binding of its variables."""
        if isinstance(formula, Literal):
            return self._atom(formula, bound) != formula.negated
        if isinstance(formula, Not):
            return not self.holds(formula.part, bound)
        if isinstance(formula, And):
            return all(self.holds(part, bound) for part in formula.parts)
        if isinstance(formula, Or):
            return any(self.holds(part, bound) for part in formula.parts)
        those = indices(candidates(self, formula.variable, (formula.part,), bound))
        hits = (i for i in those if self.holds(formula.part, {**bound, formula.variable: i}))
        if isinstance(formula, Some):
            return next(hits, None) is not None
        return sum(1 for _ in hits) < self._limit(formula, bound)

    def _limit(self, formula: Count, bound: Bound) -> int:
        return self.world.home.limit(bound[formula.limit.name], formula.limit.function == "bed_limit")

    def _atom(self, atom: Literal[Term], bound: Bound) -> bool:
        name, terms = atom.name, atom.terms
        if name == "option":
            return bool(getattr(self.rules, terms[0].name, False))
        first = self.thing(terms[0], bound)
        if name in _ASKED:
            return first >= 0 and _ASKED[name](self, first, terms[-1].name)
        second = self.thing(terms[1], bound) if len(terms) > 1 else -1
        if first < 0 or (second < 0 and len(terms) > 1):
            return False
        if name == "same":
            return first == second
        if name in RELATED:
            return bool(RELATED[name](self.world, first, 1 << second))
        if name in _FAST:
            return _FAST[name](self, second if len(terms) > 1 else first)
        head, body = self.world.home.knowledge.derived[name]
        return self.holds(body, {term.name: i for term, i in zip(head.terms, (first, second), strict=False)})


def candidates(reading: Reading, variable: str, parts: Iterable[Formula], bound: Bound) -> int:
    """Return the nodes worth trying for a variable, by the literals that are joined in some parts of a condition."""
    home = reading.world.home
    found = home.everything
    every = list(_flat(parts))
    for part in every:
        if isinstance(part, Literal) and is_narrow(part):
            found &= _NEAR[part.name](reading, part, variable, bound)
    for part in every if found else ():
        if is_of_kind(part) and free(part) == {variable}:
            found &= kind_of(home, part)
    return found


def flat_parts(parts: Iterable[Formula]) -> tuple[Formula, ...]:
    """Return joined parts, none of which is a conjunction."""
    return tuple(_flat(parts))


def is_narrow(part: Formula) -> bool:
    """Return whether a part says which few nodes a variable may be."""
    return isinstance(part, Literal) and not part.negated and part.name in _NEAR


def _flat(parts: Iterable[Formula]) -> Iterator[Formula]:
    for part in parts:
        if isinstance(part, And):
            yield from _flat(part.parts)
        else:
            yield part


def kind_of(home: Home, formula: Formula) -> int:
    """Return the nodes of a kind.

    Found once for a home and a formula, which is kept with them, so that its identity is.
    """
    known = home.kinds.get(id(formula))
    if known is not None:
        return int(known[1])
    if isinstance(formula, Literal) and formula.name in ("class", "property") and not formula.negated:
        rows_of = home.by_class if formula.name == "class" else home.properties
        found = rows_of.get(formula.terms[1].name, 0)
    else:
        found = of_kind(formula, home.properties, home.by_class, home.everything)
    home.kinds[id(formula)] = (formula, found)
    return found


def is_of_kind(formula: Formula) -> bool:
    """Return whether a formula asks for classes and properties alone, which never change."""
    if isinstance(formula, Literal):
        return formula.name in _OF_KIND
    parts = formula.parts if isinstance(formula, And | Or) else (formula.part,) if isinstance(formula, Not) else ()
    return bool(parts) and all(map(is_of_kind, parts))


def _state(reading: Reading, i: int, name: str) -> bool:
    return bool(reading.world.states[EVERY_STATE_ID[name]] >> i & 1)


def _affords(reading: Reading, i: int, variable: str) -> bool:
    return bool(reading.world.home.able(reading.action, "os".index(variable)) >> i & 1)


_ASKED: dict[str, Callable[[Reading, int, str], bool]] = {
    "state": _state,
    "property": lambda r, i, name: bool(r.world.home.properties.get(name, 0) >> i & 1),
    "class": lambda r, i, name: r.world.home.classes[i] == name,
    "class_contains": lambda r, i, name: name in r.world.home.classes[i],
    "is_room": lambda r, i, _: bool(r.world.home.rooms >> i & 1),
    "affords": _affords,
}
"""Built-in predicates of one thing and a name."""


def _same_room(reading: Reading, i: int) -> bool:
    room = edge_rows.room_of(reading.world, i)
    return room >= 0 and room == edge_rows.agent_room(reading.world, reading.agent)


_FAST: dict[str, Callable[[Reading, int], bool]] = {
    "close": lambda r, i: edge_rows.is_near(r.world, r.agent, i, r.rules.near_hands),
    "facing": lambda r, i: edge_rows.is_facing(r.world, r.agent, i),
    "free_hand": lambda r, i: not (r.agent.right and r.agent.left),
    "hidden": lambda r, i: edge_rows.closed_container(r.world, i) >= 0,
    "holds": lambda r, i: bool(r.agent.held >> i & 1),
    "same_room": _same_room,
}
"""Derived predicates of the acting character and a thing that set 2 has functions for."""


def _held(reading: Reading, part: Literal[Term], variable: str, bound: Bound) -> int:
    return reading.agent.held if part.terms[1].name == variable else -1


_Row = Callable[[World, int], int]

_ROWS: dict[str, tuple[_Row, _Row, str]] = {
    "ON": (edge_rows.on, edge_rows.bearing, "on"),
    "INSIDE": (edge_rows.inside, edge_rows.contents, "inside"),
    "CLOSE": (edge_rows.close, edge_rows.close, "close"),
    "FACING": (edge_rows.facing, edge_rows.faced, "facing"),
}
"""Readers of a relation: the targets of a thing, its sources, and the field of a character's own targets."""


def _related(reading: Reading, part: Literal[Term], variable: str, bound: Bound) -> int:
    """Return the nodes to which a relation may lead from, or to, what is bound."""
    world, (first, second) = reading.world, part.terms
    outwards = second.name == variable and not second.function and first.name in bound
    known = first if outwards else second
    if variable not in (first.name, second.name) or known.name not in bound or known.function or part.name not in _ROWS:
        return -1
    i = bound[known.name]
    to, of, field = _ROWS[part.name]
    if world.home.characters >> i & 1:
        return int(getattr(edge_rows.character(world, i), field)) if outwards else -1
    return (to if outwards else of)(world, i) | world.home.characters


def _in_state(reading: Reading, part: Literal[Term], variable: str, bound: Bound) -> int:
    thing, state = part.terms
    if thing.name != variable or thing.function:
        return -1
    rows_known, number = reading.world.states, EVERY_STATE_ID[state.name]
    return rows_known[number] if number < len(rows_known) else -1


_NEAR = {"holds": _held, "state": _in_state, **dict.fromkeys(RELATIONS, _related)}
"""The predicates that narrow which nodes a variable may be."""


def row_of(part: Formula, variable: str) -> Callable[[Reading, Bound], int] | None:
    """Return a reader of the very things for which a literal holds: what is held, or is in or on another thing.

    None for every other part; `candidates` narrows these.
    """
    if not isinstance(part, Literal) or part.negated or len(part.terms) != 2 or any(t.function for t in part.terms):
        return None
    first, second = part.terms
    if part.name == "holds" and second.name == variable and first.name == "a":
        return lambda reading, bound: reading.agent.held
    if part.name == "ON" and first.name == variable != second.name:
        return lambda reading, bound: edge_rows.bearing(reading.world, bound[second.name])
    if part.name == "INSIDE" and first.name == variable != second.name:
        return lambda reading, bound: _contents(reading.world, bound[second.name])
    return None


def _contents(world: World, i: int) -> int:
    """Return everything INSIDE i, characters included, and whether or not it is a character itself."""
    found = edge_rows.character(world, i).contents if world.home.characters >> i & 1 else edge_rows.contents(world, i)
    for agent in world.agents:
        if agent.inside >> i & 1:
            found |= agent.bit
    return found
