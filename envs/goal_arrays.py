"""A goal as rows of numbers: one for each literal, and one for each word that joins goals."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.envs.node_slots import Slots
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.vocabulary import CHARACTER_CLASS, RELATION_ID, RELATIONS, STATE_ID
from hearth.simulation.goals import Progress
from hearth.simulation.observation.views import View

GOAL_COLUMNS = (
    "kind", "predicate", "negated", "subject_class", "subject", "target_class", "target", "wanted", "seen", "part",
    "branch",
)  # fmt: skip
"""Columns of `goal`: kind 1 is a state, 2 a relation, 3 a word that joins goals, 4 an action; predicate the id of the
state, relation (that of HOLDS after those of all relations) or action, or the number of the word in `JOINS` from 1;
classes as in `classes`; subject and target slot + 1 where the literal names a node, the number of slots + the number of
its row where it is a variable of that row, else 0; how often it is wanted (of `within` the ticks, of `forn`
the things), and how often the agent
sees it hold, 0 in goals of joined parts or actions, which look back; the number of the row, from 1, whose word joins
it, 0 for the goal itself; and which of the joined goals it is in, from 1."""

STATE, RELATION, JOIN, ACTION = 1, 2, 3, 4

JOINS = ("or", "then", "not", "exists", "forall", "always", "never", "within", "forn", "forpairs")

UNKNOWN_CLASS = 1
"""Number of classes that the knowledge does not have."""


class _Row(NamedTuple):
    """A literal with how often it is wanted, or a word; the row that joins it, the branch, and the variables' rows."""

    of: Literal[Name] | Joined
    wanted: int
    part: int
    branch: int
    variables: dict[str, int]


def _rows(goal: Goal) -> list[_Row]:
    """Return the rows of a goal, those of a part after the row of its word."""
    found: list[_Row] = []

    def add(one: Goal, part: int, branch: int, variables: dict[str, int]) -> None:
        found.extend(_Row(literal, count, part, branch, variables) for literal, count in one)
        for each in one.parts:
            found.append(_Row(each, each.ticks or each.number or 1, part, branch, variables))
            number = len(found)
            known = {**variables, **{name: number for name in (each.variable, each.other[0]) if name}}
            for place, goals in enumerate(each.goals, 1):
                add(goals, number, place, known)

    add(goal, 0, 0, {})
    return found


def check(goal: Goal, most: int) -> None:
    """Refuse a goal that has more rows than there are.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    number = len(_rows(goal))
    if number > most:
        remedy = f"Sizes(literals={number})"
        raise HearthError.of(Code.BAD_ARGUMENT, f"{number} literals for {most} rows", suggestion=remedy)


def goal_array(view: View, slots: Slots, progress: Progress | None, most: int) -> NDArray[np.int16]:
    """Return the rows of an agent's known goal, padded with zeros; zeros alone where it knows no goal.

    Raises:
        HearthError: BAD_ARGUMENT (see `check`).
    """
    found = np.zeros((most, len(GOAL_COLUMNS)), np.int16)
    if progress is None:
        return found
    check(progress.goal, most)
    seen = [(watch.wanted, sum((mask & view.mask).bit_count() for mask in watch.met)) for watch in progress.watches]
    for number, (row, each) in enumerate(zip(found, _rows(progress.goal), strict=False)):
        wanted, counted = seen[number] if number < len(seen) else (each.wanted, 0)
        row[:] = (*_named(each, slots), wanted, counted, each.part, each.branch)
    return found


def _named(row: _Row, slots: Slots) -> tuple[int, ...]:
    """Return the first seven columns."""
    if isinstance(row.of, Joined):
        kinds = (class_number(kind, slots.home.knowledge) if kind else 0 for kind in (row.of.kind, row.of.other[1]))
        return (JOIN, JOINS.index(row.of.join) + 1, 0, next(kinds), 0, next(kinds), 0)
    literal, known = row.of, slots.home.knowledge
    kind, predicate = RELATION, RELATION_ID.get(literal.name, len(RELATIONS))
    if literal.name in known.actions:
        kind, predicate = ACTION, known.actions[literal.name].id
    elif len(literal.terms) == 1:
        kind, predicate = STATE, STATE_ID[literal.name]
    terms = [number for term in literal.terms for number in _term(term, row, slots)]
    return (kind, predicate, literal.negated, *terms[:4], *[0] * (4 - len(terms)))


def _term(term: Name, row: _Row, slots: Slots) -> Iterator[int]:
    """Yield (class, slot + 1) of a term of a goal."""
    home = slots.home
    if isinstance(term, int):
        i = home.index[term]
        yield from (class_number(home.classes[i], home.knowledge), int(slots.by_index[i]) + 1)
    elif term in row.variables:
        yield from (0, slots.size + row.variables[term])
    elif (parts := term.partition(":"))[0] != AGENT:
        yield from (class_number(term, home.knowledge), 0)
    else:
        i = home.agents[int(parts[2])] if parts[2] else -1
        yield from (class_number(CHARACTER_CLASS, home.knowledge), int(slots.by_index[i]) + 1 if i >= 0 else 0)


def class_number(name: str, knowledge: Knowledge) -> int:
    """Return the number of a class: 2 + its published id; 1 where the knowledge has none of that name."""
    known = knowledge.object_class(name)
    return UNKNOWN_CLASS if known is None else 2 + known.id
