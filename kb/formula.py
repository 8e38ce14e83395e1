"""The literals in which preconditions and effects are written, as values and as text.

A formula is one of

    NAME(term, ...)            a literal: `CLOSE(a, o)`, `state(o, OPEN)`, `close(a, o)`
    not F, F & F, F | F, (F)   as usual; `not` binds tightest, then `&`, then `|`
    some x: F                  for at least one thing x; reaches as far right as it can
    count x: F < limit(o)      fewer things than a number known of o

and an effect is

    NAME(term, ...)            becomes true
    not NAME(term, ...)        becomes false
    F -> E                     only if F held before
    for x, y: F -> E           for all things x, y for which F held before; F may be left out

A term is a variable (`a` the acting character, `o` and `s` the first and second object, or one bound by `some`,
`count`, `for`), a thing found from one (`room(o)`), or a name in capitals or letters (`OPEN`, `knife`).
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.literals import Literal

FUNCTIONS = frozenset({"room", "origin", "place"})
"""Terms that find a thing from a thing; they may find nothing."""

BUILT_IN = frozenset(
    {"affords", "came_from", "class", "class_contains", "is_room", "property", "REMEMBERS", "same", "state"}
)
"""Predicates that are neither relations nor derived."""

NAMED = frozenset({"state", "property", "class", "class_contains", "came_from"})
"""Predicates whose second argument is a name, not a thing."""


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

    def __str__(self) -> str:
        return f"not {_grouped(self.part)}"


@dataclass(frozen=True, slots=True)
class And:
    """Holds when all parts hold; of no parts, always."""

    parts: tuple[Formula, ...]

    def __str__(self) -> str:
        return " & ".join(_grouped(part) for part in self.parts)


@dataclass(frozen=True, slots=True)
class Or:
    """Holds when a part holds."""

    parts: tuple[Formula, ...]

    def __str__(self) -> str:
        return " | ".join(_grouped(part) if isinstance(part, Or | Some | Count) else str(part) for part in self.parts)


@dataclass(frozen=True, slots=True)
class Some:
    """Holds when some thing makes its part hold."""

    variable: str
    part: Formula

    def __str__(self) -> str:
        return f"some {self.variable}: {self.part}"


@dataclass(frozen=True, slots=True)
class Count:
    """Holds when fewer things than `limit` allows make its part hold."""

    variable: str
    part: Formula
    limit: Term

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

    def __str__(self) -> str:
        text = str(self.literal) if self.condition == TRUE else f"{self.condition} -> {self.literal}"
        return f"for {', '.join(self.variables)}: {text}" if self.variables else text


def free(formula: Formula) -> set[str]:
    """The variables a formula mentions and does not bind itself; names (of states, classes) are none."""
    if isinstance(formula, Literal):
        terms = formula.terms[:1] if formula.name in NAMED else formula.terms
        return {term.name for term in terms}
    if isinstance(formula, Not):
        return free(formula.part)
    if isinstance(formula, And | Or):
        return {name for part in formula.parts for name in free(part)}
    limit = {formula.limit.name} if isinstance(formula, Count) else set()
    return (free(formula.part) | limit) - {formula.variable}


def predicates(formula: Formula) -> set[str]:
    """The names of the predicates it uses."""
    if isinstance(formula, Literal):
        return {formula.name}
    parts = formula.parts if isinstance(formula, And | Or) else (formula.part,)
    return {name for part in parts for name in predicates(part)}


def _grouped(part: Formula) -> str:
    return str(part) if isinstance(part, Literal | Not) else f"({part})"


T = TypeVar("T")

_TOKEN = re.compile(r"\s*(?:(->|[()&|:,<])|([A-Za-z_][A-Za-z_0-9]*))")


@lru_cache(maxsize=4096)
def parse_formula(text: str) -> Formula:
    """Read a formula.

    Raises:
        HearthError: SYNTAX, saying what was expected where.
    """
    return _read(text, _Parser.alternatives)


@lru_cache(maxsize=4096)
def parse_effect(text: str) -> Effect:
    """Read an effect.

    Raises:
        HearthError: SYNTAX, saying what was expected where.
    """
    return _read(text, _Parser.effect)


@lru_cache(maxsize=512)
def parse_atom(text: str) -> Literal[Term]:
    """Read a single predicate of terms, such as the head of a definition.

    Raises:
        HearthError: SYNTAX.
    """
    return _read(text, _Parser.atom)


def _read(text: str, rule: Callable[[_Parser], T]) -> T:
    """What a rule makes of a whole text."""
    parser = _Parser(text)
    result = rule(parser)
    if parser.peek():
        raise parser.fault(f"`{parser.peek()}` is too much")
    return result


class _Parser:
    """Recursive descent over the tokens of one line."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.tokens: list[str] = []
        position = 0
        while position < len(text.rstrip()):
            found = _TOKEN.match(text, position)
            if not found:
                raise self.fault(f"cannot read `{text[position:].strip()[:20]}`")
            self.tokens.append(found[1] or found[2])
            position = found.end()
        self.next = 0

    def fault(self, message: str) -> HearthError:
        return HearthError.of(Code.SYNTAX, f"in `{self.text}`: {message}")

    def peek(self, ahead: int = 0) -> str:
        return self.tokens[self.next + ahead] if self.next + ahead < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.peek()
        if not token or (wanted and token != wanted):
            raise self.fault(f"expected {wanted or 'a name'} but found `{token or 'the end'}`")
        self.next += 1
        return token

    def name(self) -> str:
        token = self.take()
        if not (token[0].isalpha() or token[0] == "_"):
            raise self.fault(f"expected a name but found `{token}`")
        return token

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
                inner = self.effect()
                return Effect(inner.literal, _both(condition, inner.condition), (*variables, *inner.variables))
        negated = self.peek() == "not"
        if negated:
            self.take()
        return Effect(self.atom()._replace(negated=negated), condition, variables)

    def several(self, rule: Callable[[], T], mark: str) -> tuple[T, ...]:
        """What a rule makes of parts with a mark between them."""
        parts = [rule()]
        while self.peek() == mark:
            self.take()
            parts.append(rule())
        return tuple(parts)

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
            part = self.unit()
            return part._replace(negated=True) if isinstance(part, Literal) and not part.negated else Not(part)
        if token == "(":
            self.take()
            inner = self.alternatives()
            self.take(")")
            return inner
        if token in ("some", "count") and self.peek(1) != "(":
            return self.quantified()
        return self.atom()

    def quantified(self) -> Formula:
        kind, variable = self.take(), self.name()
        self.take(":")
        part = self.alternatives()
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
