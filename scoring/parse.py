"""Parsability: whether a program could be a program at all, wherever it is to run (thesis 5.6.1, A.3)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.program import Step
from hearth.scoring.reading import Line, Lines
from hearth.scoring.signature import signature

SIGNATURE = signature("parsable", level="program")


@dataclass(frozen=True, slots=True)
class Fault:
    """What is wrong with one line.

    Attributes:
        line: which of the program's lines, from 0.
        code: SYNTAX, UNKNOWN_ACTION, WRONG_ARITY or UNKNOWN_OBJECT.
        found: the words at fault.
    """

    line: int
    code: Code
    found: str


@dataclass(frozen=True, slots=True)
class Parsability:
    """How much of a program is well formed. A program without lines is: it is counted apart.

    Attributes:
        lines: how many there are.
        arity: how many are steps of a known action with the right number of objects (A.3).
        names: how many of those also name only known objects.
        faults: at most one a line, the gravest.
    """

    lines: int
    arity: int
    names: int
    faults: tuple[Fault, ...] = ()

    @property
    def parsable(self) -> bool:
        """As published: every line's number of arguments is right."""
        return self.arity == self.lines

    @property
    def named(self) -> bool:
        """Ours: also every name is known."""
        return self.names == self.lines


def parsability(lines: Lines, knowledge: Knowledge) -> Parsability:
    """Check each line: a step, of a known action, with the number of objects it takes, that are known."""
    faults = tuple(fault for number, line in enumerate(lines) for fault in _first(line, number, knowledge))
    unnamed = sum(fault.code is Code.UNKNOWN_OBJECT for fault in faults)
    return Parsability(len(lines), len(lines) - len(faults) + unnamed, len(lines) - len(faults), faults)


def _first(line: Line, number: int, knowledge: Knowledge) -> Iterator[Fault]:
    """The gravest fault of a line, if any."""
    if isinstance(line, str):
        yield Fault(number, Code.SYNTAX, line[:200])
        return
    action = knowledge.action(line.action)
    if action is None:
        yield Fault(number, Code.UNKNOWN_ACTION, line.action)
    elif len(line.objects) != action.arity:
        yield Fault(number, Code.WRONG_ARITY, f"{len(line.objects)} of {action.arity}")
    elif unknown := _unknown_object(line, knowledge):
        yield Fault(number, Code.UNKNOWN_OBJECT, unknown)


def _unknown_object(step: Step, knowledge: Knowledge) -> str:
    return next((ref.name for ref in step.objects if knowledge.object_class(ref.name) is None), "")
