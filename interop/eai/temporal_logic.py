"""The interface's temporal logic: facts and acts joined by `and`, `or`, `then`, `not` and `exists`, on a run."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from hearth.schemas.literals import Literal
from hearth.simulation.literal_truth import holds
from hearth.simulation.world.world import World

JOINS = ("then", "or", "and")
"""Words that join formulas, the loosest first."""

MOST_DEEP = 50
"""Brackets within one another."""

RELATIONS = {"ONTOP": "ON", "INSIDE": "INSIDE", "BETWEEN": "BETWEEN", "NEXT_TO": "CLOSE", "FACING": "FACING",
             "HOLDS_RH": "HOLDS_RH", "HOLDS_LH": "HOLDS_LH"}  # fmt: skip
STATES = ("CLOSED", "OPEN", "ON", "OFF", "SITTING", "DIRTY", "CLEAN", "LYING", "PLUGGED_IN", "PLUGGED_OUT")
"""The facts of the logic: relations with VirtualHome's names for them, and states."""

Act = tuple[str, tuple[str, ...]]
"""An action in capitals, and its arguments, `fridge.234`."""


class Atom(NamedTuple):
    """A fact or an act: its name, and its arguments as they are written."""

    name: str
    terms: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Compound:
    """A formula with parts.

    Attributes:
        join: `then`, `or`, `and`, `not` or `exists`.
        parts: the formulas.
        variable: of `exists`.
    """

    join: str
    parts: tuple[Formula, ...]
    variable: str = ""


Formula = Atom | Compound


class Run(NamedTuple):
    """The worlds of a run, and the acts that were done in all but the last."""

    worlds: Sequence[World]
    acts: Sequence[Act]

    def after(self, count: int) -> Run:
        """Return the run without its first worlds."""
        return Run(self.worlds[count:], self.acts[count:])


_WORDS = re.compile(r"\s*([a-zA-Z_-][\w-]*(?:\.[0-9]+)?|[(),.])")


def read_formula(text: str) -> Formula:
    """Return the formula of a text.

    Raises:
        ValueError: it cannot be read.
    """
    words, place = [], 0
    text = text.rstrip()
    while place < len(text):
        found = _WORDS.match(text, place)
        if found is None:
            raise ValueError(f"unexpected `{text[place : place + 10]}`")
        words.append(found[1])
        place = found.end()
    reader = _Reader(words)
    formula = reader.joined(0, 0)
    if reader.at < len(words):
        raise ValueError(f"unexpected `{words[reader.at]}`")
    return formula


class _Reader:
    def __init__(self, words: list[str]) -> None:
        self.words, self.at = words, 0

    def take(self, wanted: str = "") -> str:
        word = self.words[self.at] if self.at < len(self.words) else ""
        if not word or (wanted and word != wanted):
            raise ValueError(f"expected `{wanted or 'a name'}`")
        self.at += 1
        return word

    def peek(self) -> str:
        return self.words[self.at] if self.at < len(self.words) else ""

    def joined(self, level: int, depth: int) -> Formula:
        """Read formulas joined by a word of `JOINS`, or one alone."""
        if level == len(JOINS):
            return self.single(depth + 1)
        parts = [self.joined(level + 1, depth)]
        while self.peek() == JOINS[level]:
            self.take()
            parts.append(self.joined(level + 1, depth))
        return parts[0] if len(parts) == 1 else Compound(JOINS[level], tuple(parts))

    def single(self, depth: int) -> Formula:
        if depth > MOST_DEEP:
            raise ValueError("too deep")
        word = self.take()
        if word == "not":
            return Compound("not", (self.single(depth + 1),))
        if word == "exists":
            name = self.take()
            self.take(".")
            self.take("(")
            inner = Compound("exists", (self.joined(0, depth),), name)
            self.take(")")
            return inner
        if word == "(":
            formula = self.joined(0, depth)
            self.take(")")
            return formula
        self.take("(")
        terms: list[str] = []
        while self.peek() != ")":
            if terms:
                self.take(",")
            terms.append(self.take())
        self.take(")")
        return Atom(word, tuple(terms))


def atoms_of(formula: Formula) -> list[Atom]:
    """Return the facts and acts of a formula."""
    if isinstance(formula, Atom):
        return [formula]
    return [atom for part in formula.parts for atom in atoms_of(part)]


def fulfilled(formula: Formula, run: Run) -> int:
    """Return the number of worlds of the shortest beginning of a run that fulfils a formula; 0 where none does.

    A formula without `then` is fulfilled in one world, together with the act that is done there.
    """
    if not _is_ordered(formula):
        moments = range(len(run.worlds))
        return next((at + 1 for at in moments if _true(formula, run, at, {})), 0)
    assert isinstance(formula, Compound)
    if formula.join == "then":
        used = 0
        for part in formula.parts:
            found = fulfilled(part, run.after(used))
            if not found:
                return 0
            used += found
        return len(run.worlds)
    found_of_parts = [fulfilled(part, run) for part in formula.parts]
    if formula.join == "or":
        return min((found for found in found_of_parts if found), default=0)
    return max(found_of_parts) if all(found_of_parts) and formula.join == "and" else 0


def _is_ordered(formula: Formula) -> bool:
    if isinstance(formula, Atom):
        return False
    return formula.join == "then" or any(_is_ordered(part) for part in formula.parts)


def _true(formula: Formula, run: Run, at: int, bound: dict[str, str]) -> bool:
    if isinstance(formula, Atom):
        return _atom_true(formula, run, at, bound)
    if formula.join == "not":
        return not _true(formula.parts[0], run, at, bound)
    if formula.join == "exists":
        # Quantified variables occur in acts alone: the things of the act that is done are all candidates.
        done = run.acts[at][1] if at < len(run.acts) else ()
        return any(_true(formula.parts[0], run, at, {**bound, formula.variable: thing}) for thing in done)
    truths = (_true(part, run, at, bound) for part in formula.parts)
    return all(truths) if formula.join == "and" else any(truths)


def _atom_true(atom: Atom, run: Run, at: int, bound: dict[str, str]) -> bool:
    terms = tuple(bound.get(term, term) for term in atom.terms)
    relation = RELATIONS.get(atom.name)
    if relation is None and not (atom.name in STATES and len(terms) == 1):
        return at < len(run.acts) and run.acts[at] == (atom.name, terms)
    return fact_true(relation or atom.name, terms, run.worlds[at])


def fact_true(name: str, terms: Sequence[str], world: World) -> bool:
    """Return whether a fact of VirtualHome holds between things that are written as `class.id`."""
    home = world.home
    nodes = []
    for term in terms:
        class_name, _, number = term.rpartition(".")
        node = int(number) if number.isdecimal() else -1
        if node not in home.index or home.classes[home.index[node]] != class_name:
            return False
        nodes.append(node)
    if len(nodes) == 1:
        return world.has_state(nodes[0], name)
    return len(nodes) == 2 and holds(Literal.of(name, *nodes), world)
