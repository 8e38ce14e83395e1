"""A BDDL problem: the instances of its synsets, the facts at the start, and the goal."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from hearth.interop.bddl.expressions import Expression, read_expression
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code

MOST_INSTANCES = 2_000
"""Instances of a problem that are read."""


class Fact(NamedTuple):
    """A predicate of some instances that holds at the start, or does not."""

    predicate: str
    terms: tuple[str, ...]
    negated: bool
    line: int


@dataclass(frozen=True)
class Problem:
    """An activity.

    Attributes:
        name: `assembling_gift_baskets-0`.
        instances: the synset of each instance, `candle.n.01_1` -> `candle.n.01`; those with `*` are left out.
        facts: at the start.
        goal: to reach.
        file: for faults.
    """

    name: str
    instances: Mapping[str, str]
    facts: tuple[Fact, ...]
    goal: Expression
    file: str = ""

    def of_synset(self, synset: str) -> tuple[str, ...]:
        """Return the instances of a synset, in the order of the problem."""
        return tuple(name for name, kind in self.instances.items() if kind == synset)


def read_problem(text: str, file: str = "") -> Problem:
    """Return the problem of a text.

    Raises:
        HearthError: SYNTAX, DUPLICATE, UNDECLARED or FILE_TOO_LARGE, with the line.

    Examples:
        >>> from hearth.interop.bddl.problem import read_problem
        >>> problem = read_problem(
        ...     "(define (problem p-0) (:domain omnigibson) (:objects mug.n.04_1 - mug.n.04) (:init) (:goal (and)))"
        ... )
        >>> problem.name, dict(problem.instances)
        ('p-0', {'mug.n.04_1': 'mug.n.04'})
    """
    whole = read_expression(text, file)
    parts = {part.head: part for part in whole.parts}
    for name in ("problem", ":objects", ":goal"):
        if name not in parts:
            raise _fault(Code.SYNTAX, f"the problem has no `{name}`", file, whole.line, "as BEHAVIOR's problems")
    instances = _instances(parts[":objects"], file)
    facts = []
    for each in parts[":init"].parts if ":init" in parts else ():
        inner = each.parts[0] if each.head == "not" and each.parts else each
        unknown = [word for word in inner.words[: 1 if inner.head == "inroom" else None]
                   if word not in instances and not word.endswith("*")]  # fmt: skip
        if unknown:
            raise _fault(Code.UNDECLARED, f"`{unknown[0]}` is no object", file, inner.line, "list it in `:objects`")
        if not any(word.endswith("*") for word in inner.words):
            facts.append(Fact(inner.head, inner.words, each.head == "not", inner.line))
    goals = parts[":goal"].parts
    if len(goals) != 1:
        raise _fault(Code.SYNTAX, "the goal is not one expression", file, parts[":goal"].line, "join it by `and`")
    return Problem((parts["problem"].words or ("",))[0], instances, tuple(facts), goals[0], file)


def _instances(objects: Expression, file: str) -> dict[str, str]:
    found: dict[str, str] = {}
    waiting: list[str] = []
    words = list(objects.words)
    for number, word in enumerate(words):
        if word != "-" and (number == 0 or words[number - 1] != "-"):
            waiting.append(word)
        elif word != "-":
            for name in waiting:
                if name in found:
                    raise _fault(Code.DUPLICATE, f"`{name}` is listed twice", file, objects.line, "list it once")
                if not name.endswith("*"):
                    found[name] = word
            waiting = []
    if waiting:
        raise _fault(Code.SYNTAX, f"`{waiting[0]}` has no synset", file, objects.line, f"`{waiting[0]} - SYNSET`")
    if len(found) > MOST_INSTANCES:
        raise _fault(Code.FILE_TOO_LARGE, f"{len(found):,} objects, where {MOST_INSTANCES:,} are read", file,
                     objects.line, "fewer objects")  # fmt: skip
    return found


def _fault(code: Code, message: str, file: str, line: int, suggestion: str) -> HearthError:
    return HearthError(Diagnostic(code, message, file, line, suggestion=suggestion))
