"""Operators of models as planners of 2024 read them: later ones refuse names and variables that are not declared.

Fast Downward of the interface's time took an undeclared name for an object of the problem, an undeclared variable of a
precondition for one that some object fulfills, and passed over effects with such a variable.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

from hearth.interop.eai.transition_modelling import MOST_DEEP

Expression = str | list[Any]
"""A word, or a bracketed list."""

JOINS = frozenset({"and", "or", "not", "when", "imply", "forall", "exists", "="})
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
    free = sorted(set(_free(before, known)))
    kept = _without_free(after, known)
    more = "".join(f" {name}" for name in free)
    # Parameters without a type end the list: those before may share a type that is written last.
    text = f"({written(declared)[1:-1]}{more})"
    renamed = {name: f"{name}-some" for name in free}
    if more:
        text = f"({written(declared)[1:-1]} {' '.join(renamed.values())} - object)"
    return text, written(_renamed(before, renamed)), written(kept) if kept else "(and)"


def _bound(expression: list[Any]) -> set[str]:
    """Return the variables that a quantifier binds."""
    if expression and expression[0] in ("forall", "exists") and len(expression) > 1:
        return {word for word in expression[1] if isinstance(word, str) and word.startswith("?")}
    return set()


def _free(expression: Expression, known: set[str]) -> Iterator[str]:
    if isinstance(expression, str):
        if expression.startswith("?") and expression not in known:
            yield expression
        return
    inner = known | _bound(expression)
    for part in expression:
        yield from _free(part, inner)


def _renamed(expression: Expression, names: dict[str, str]) -> Expression:
    if isinstance(expression, str):
        return names.get(expression, expression)
    left = {name: new for name, new in names.items() if name not in _bound(expression)}
    return [_renamed(part, left) for part in expression]


def _without_free(expression: Expression, known: set[str]) -> Expression:
    """Return an effect without its literals about variables that are not declared; `` where nothing is left."""
    if isinstance(expression, str):
        return expression
    if not expression or expression[0] not in ("and", "when", "forall"):
        return "" if any(_free(expression, known)) else expression
    inner = known | _bound(expression)
    if expression[0] == "and":
        return ["and", *(part for part in (_without_free(each, inner) for each in expression[1:]) if part)]
    last = _without_free(expression[-1], inner)
    return [*expression[:-1], last] if last else ""


def names_in(expression: Expression) -> Iterator[str]:
    """Yield the constants of an expression: what is no variable, no join and no predicate."""
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
    return domain.replace("(:predicates", f"{constants}(:predicates", 1), _OBJECTS.sub("(:objects)", problem, count=1)
