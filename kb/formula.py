"""The literals in which preconditions and effects are written, as values and as text.

A formula is one of

    NAME(term, ...)            a literal: `CLOSE(a, o)`, `state(o, OPEN)`, `close(a, o)`
    not F, F & F, F | F, (F)   as usual; `not` binds tightest, then `&`, then `|`
    some x: F                  for at least one thing x; reaches as far right as it can
    count x: F < limit(o)      fewer things than a number known of o
    option(name)               the engine uses the rule of that name

and an effect is

    NAME(term, ...)            becomes true
    not NAME(term, ...)        becomes false
    gone(term)                 is used up: in no place and no hand, close to nothing, and GONE
    F -> E                     only if F held before
    for x, y: F -> E           for all things x, y for which F held before; F may be left out

A term is a variable (`a` the acting character, `o` and `s` the first and second object, or one bound by `some`,
`count`, `for`), a thing found from one (`room(o)`), or a name in capitals or letters (`OPEN`, `knife`).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache

from hearth.schemas.literals import Literal
from hearth.schemas.short_repr import brief
from hearth.schemas.tokens import Tokens

FUNCTIONS = frozenset({"room", "origin", "place"})
"""Terms that find a thing from a thing; they may find nothing."""

BUILT_IN = frozenset(
    {"affords", "came_from", "class", "class_contains", "is_room", "option", "property", "REMEMBERS", "same", "state"}
)
"""Predicates that are neither relations nor derived."""

NAMED = frozenset({"state", "property", "class", "class_contains", "came_from"})
"""Predicates whose second argument is a name, not a thing."""

GONE = "gone"
"""The effect by which a thing ceases to be anywhere; no formula asks for it (the state GONE is asked for)."""

OPTION = "option"
"""The predicate whose only argument is the name of a rule."""


@dataclass(frozen=True, slots=True)
class Term:
    """A variable or name (`function` empty), or the thing a function finds from a variable."""

    name: str
    function: str = ""

    def __str__(self) -> str:
        return f"{self.function}({self.name})" if self.function else self.name


@dataclass(frozen=True, slots=True)
class Not:
    """Holds when its part does not; a literal says so itself."""

    part: Formula

    __repr__ = brief

    def __str__(self) -> str:
        return f"not {_grouped(self.part)}"


@dataclass(frozen=True, slots=True)
class And:
    """Holds when all parts hold; of no parts, always."""

    parts: tuple[Formula, ...]

    __repr__ = brief

    def __str__(self) -> str:
        return " & ".join(_grouped(part) for part in self.parts)


@dataclass(frozen=True, slots=True)
class Or:
    """Holds when a part holds."""

    parts: tuple[Formula, ...]

    __repr__ = brief

    def __str__(self) -> str:
        return " | ".join(_grouped(part) if isinstance(part, Or | Some | Count) else str(part) for part in self.parts)


@dataclass(frozen=True, slots=True)
class Some:
    """Holds when some thing makes its part hold."""

    variable: str
    part: Formula

    __repr__ = brief

    def __str__(self) -> str:
        return f"some {self.variable}: {self.part}"


@dataclass(frozen=True, slots=True)
class Count:
    """Holds when fewer things than `limit` allows make its part hold."""

    variable: str
    part: Formula
    limit: Term

    __repr__ = brief

    def __str__(self) -> str:
        return f"count {self.variable}: {self.part} < {self.limit}"


Formula = Literal[Term] | Not | And | Or | Some | Count

TRUE = And(())


@dataclass(frozen=True, slots=True)
class Effect:
    """A change: `literal` becomes true, for all `variables` for which `condition` held before."""

    literal: Literal[Term]
    condition: Formula = TRUE
    variables: tuple[str, ...] = ()

    __repr__ = brief

    def __str__(self) -> str:
        text = str(self.literal) if self.condition == TRUE else f"{self.condition} -> {self.literal}"
        return f"for {', '.join(self.variables)}: {text}" if self.variables else text


def free(formula: Formula) -> set[str]:
    """Return the variables a formula mentions and does not bind itself; names (of states, classes) are none."""
    if isinstance(formula, Literal):
        terms = () if formula.name == OPTION else formula.terms[:1] if formula.name in NAMED else formula.terms
        return {term.name for term in terms}
    if isinstance(formula, Not):
        return free(formula.part)
    if isinstance(formula, And | Or):
        return {name for part in formula.parts for name in free(part)}
    limit = {formula.limit.name} if isinstance(formula, Count) else set()
    return (free(formula.part) | limit) - {formula.variable}


def predicates(formula: Formula) -> set[str]:
    """Return the names of the predicates it uses."""
    if isinstance(formula, Literal):
        return {formula.name}
    parts = formula.parts if isinstance(formula, And | Or) else (formula.part,)
    return {name for part in parts for name in predicates(part)}


def _grouped(part: Formula) -> str:
    return str(part) if isinstance(part, Literal | Not) else f"({part})"


@lru_cache(maxsize=4096)
def parse_formula(text: str) -> Formula:
    """Read a formula.

    Raises:
        HearthError: SYNTAX, saying what was expected where.
    """
    return _Parser(text).whole(_Parser.alternatives)


@lru_cache(maxsize=4096)
def parse_effect(text: str) -> Effect:
    """Read an effect.

    Raises:
        HearthError: SYNTAX, saying what was expected where.
    """
    return _Parser(text).whole(_Parser.effect)


@lru_cache(maxsize=512)
def parse_atom(text: str) -> Literal[Term]:
    """Read a single predicate of terms, such as the head of a definition.

    Raises:
        HearthError: SYNTAX.
    """
    return _Parser(text).whole(_Parser.atom)


class _Parser(Tokens):
    """Recursive descent over the tokens of one line."""

    PATTERN = re.compile(r"->|[()&|:,<]|[A-Za-z_][A-Za-z_0-9]*")

    def effect(self) -> Effect:
        variables: tuple[str, ...] = ()
        if self.peek() == "for":
            self.take()
            variables = self.several(self.name, ",")
            self.take(":")
        condition: Formula = TRUE
        if "->" in self.tokens[self.next :]:
            condition = self.alternatives()
            self.take("->")
            if self.peek() == "for":
                inner = self.deeper(self.effect)
                return Effect(inner.literal, _both(condition, inner.condition), (*variables, *inner.variables))
        negated = self.peek() == "not"
        if negated:
            self.take()
        return Effect(self.atom()._replace(negated=negated), condition, variables)

    def alternatives(self) -> Formula:
        parts = self.several(self.conjunction, "|")
        return parts[0] if len(parts) == 1 else Or(parts)

    def conjunction(self) -> Formula:
        parts = self.several(self.unit, "&")
        return parts[0] if len(parts) == 1 else And(parts)

    def unit(self) -> Formula:
        token = self.peek()
        if token == "not":
            self.take()
            part = self.deeper(self.unit)
            return part._replace(negated=True) if isinstance(part, Literal) and not part.negated else Not(part)
        if token == "(":
            self.take()
            inner = self.deeper(self.alternatives)
            self.take(")")
            return inner
        if token in ("some", "count") and self.peek(1) != "(":
            return self.quantified()
        return self.atom()

    def quantified(self) -> Formula:
        kind, variable = self.take(), self.name()
        self.take(":")
        part = self.deeper(self.alternatives)
        if kind == "some":
            return Some(variable, part)
        self.take("<")
        function = self.name()
        return Count(variable, part, Term(self.arguments()[0].name, function))

    def atom(self) -> Literal[Term]:
        return Literal(self.name(), self.arguments())

    def arguments(self) -> tuple[Term, ...]:
        self.take("(")
        terms = self.several(self.term, ",")
        self.take(")")
        return terms

    def term(self) -> Term:
        name = self.name()
        if name in FUNCTIONS and self.peek() == "(":
            self.take()
            inner = self.name()
            self.take(")")
            return Term(inner, name)
        return Term(name)


def _both(first: Formula, second: Formula) -> Formula:
    return first if second == TRUE else second if first == TRUE else And((first, second))
