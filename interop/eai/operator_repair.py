"""Operators of models as planners of 2024 read them: later ones refuse names and variables that are not declared.

Fast Downward of the interface's time took an undeclared name for an object of the problem. A fact about an undeclared
variable was never true in a condition, and an effect on one did nothing.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from hearth.interop.eai.transition_modelling import MOST_DEEP

Expression = str | list[Any]
"""A word, or a bracketed list."""

JOINS = frozenset({"and", "or", "not", "when", "imply", "forall", "exists", "="})
NEVER = "hearth-never"
"""A predicate that is never true."""

_OBJECTS = re.compile(r"\(:objects(.*?)\)", re.DOTALL)


def read(text: str) -> Expression:
    """Return the expression of a text.

    Raises:
        ValueError: it is not bracketed rightly, or too deep.
    """
    stack: list[list[Any]] = [[]]
    for word in re.findall(r"[()]|[^\s()]+", text.lower()):
        if word == "(":
            stack.append([])
            if len(stack) > MOST_DEEP:
                raise ValueError("too deep")
        elif word == ")" and len(stack) > 1:
            done = stack.pop()
            stack[-1].append(done)
        elif word == ")":
            raise ValueError("brackets")
        else:
            stack[-1].append(word)
    if len(stack) != 1 or len(stack[0]) != 1:
        raise ValueError("brackets")
    found: Expression = stack[0][0]
    return found


def written(expression: Expression) -> str:
    """Return an expression as text."""
    return expression if isinstance(expression, str) else f"({' '.join(map(written, expression))})"


def repaired(parameters: str, precondition: str, effect: str) -> tuple[str, str, str]:
    """Return the three parts of an operator so that later planners read them as earlier ones did.

    Parts that cannot be read stay as they are, for the planner to refuse.
    """
    try:
        declared, before, after = read(parameters), read(precondition), read(effect)
    except ValueError:
        return parameters, precondition, effect
    known = {word for word in declared if isinstance(word, str) and word.startswith("?")}
    return written(declared), written(_condition(before, known)), written(_effect(after, known) or ["and"])


def _bound(expression: list[Any]) -> set[str]:
    """Return the variables that a quantifier binds."""
    if expression and expression[0] in ("forall", "exists") and len(expression) > 1:
        return {word for word in expression[1] if isinstance(word, str) and word.startswith("?")}
    return set()


def _free(literal: list[Any], known: set[str]) -> bool:
    """Return whether a literal has a variable that is not declared.

    A list with a type, `(inside ?c ?room - object)`, is no literal; it stays as it is, for the planner to refuse.
    """
    if "-" in literal:
        return False
    return any(isinstance(word, str) and word.startswith("?") and word not in known for word in literal)


def _condition(expression: Expression, known: set[str]) -> Expression:
    """Return a condition in which facts about undeclared variables are never true.

    A list that begins with a list is no condition; it stays as it is, for the planner to refuse.
    """
    if isinstance(expression, str) or not expression or not isinstance(expression[0], str):
        return expression
    if expression[0] not in JOINS:
        return [NEVER] if _free(expression, known) else expression
    inner = known | _bound(expression)
    quantified = expression[0] in ("forall", "exists")
    return [part if quantified and place == 1 else _condition(part, inner) for place, part in enumerate(expression)]


def _effect(expression: Expression, known: set[str]) -> Expression:
    """Return an effect without its facts about undeclared variables; `` where nothing is left."""
    if isinstance(expression, str) or not expression:
        return expression
    inner = known | _bound(expression)
    if expression[0] == "and":
        return ["and", *(part for part in (_effect(each, inner) for each in expression[1:]) if part)]
    if expression[0] == "not":
        return expression if _effect(expression[-1], known) else ""
    if expression[0] in ("when", "forall"):
        last = _effect(expression[-1], inner)
        given = [_condition(part, inner) if expression[0] == "when" else part for part in expression[1:-1]]
        return [expression[0], *given, last] if last else ""
    return "" if _free(expression, known) else expression


def names_in(expression: Expression) -> Iterator[str]:
    """Yield the constants of an expression, without variables, joins and predicates."""
    if isinstance(expression, str):
        return
    quantified = expression and expression[0] in ("forall", "exists")
    for place, part in enumerate(expression):
        if isinstance(part, list):
            yield from names_in(part) if not (quantified and place == 1) else ()
        elif place and part not in JOINS and not part.startswith("?"):
            yield part


def with_constants(domain: str, problem: str, names: Iterable[str]) -> tuple[str, str]:
    """Return a domain that declares a problem's objects and further names, and the problem without its objects."""
    found = _OBJECTS.search(problem)
    objects = found[1].strip() if found else ""
    there = set(objects.lower().split())
    others = " ".join(sorted(set(names) - there - {"-"}))
    constants = f"(:constants {objects}{f' {others} - object' if others else ''})\n    "
    return domain.replace("(:predicates", f"{constants}(:predicates ({NEVER})", 1), _OBJECTS.sub(
        "(:objects)", problem, count=1
    )
