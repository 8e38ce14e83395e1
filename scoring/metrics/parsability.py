"""Parsability: whether a program is well formed, independent of its environment (thesis 5.6.1, A.3)."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.scoring.line_sequences import Line, Lines, Refused
from hearth.scoring.signature import signature

SIGNATURE = signature("parsable", 2, level="program", empty=0)


@dataclass(frozen=True, slots=True)
class Fault:
    """The fault of one line.

    Attributes:
        line: number of the line, from 0.
        code: SYNTAX, UNKNOWN_ACTION, WRONG_ARITY or UNKNOWN_OBJECT.
        found: the words at fault.
    """

    line: int
    code: Code
    found: str


@dataclass(frozen=True, slots=True)
class Parsability:
    """Well-formed lines of a program. A program without lines is not well formed: nothing was answered.

    Attributes:
        lines: number of lines.
        arity: number of steps of a known action with the right number of objects (A.3).
        names: number of those that also name only known objects.
        faults: at most one per line, the gravest.
    """

    lines: int
    arity: int
    names: int
    faults: tuple[Fault, ...] = ()

    @property
    def parsable(self) -> bool:
        """Return whether every line has the right number of arguments, as published."""
        return 0 < self.arity == self.lines

    @property
    def named(self) -> bool:
        """Ours: every name is also known."""
        return 0 < self.names == self.lines


def parsability(lines: Lines, knowledge: Knowledge) -> Parsability:
    """Check each line: a step, of a known action, with the number of objects it takes, that are known."""
    faults = tuple(fault for number, line in enumerate(lines) for fault in _first(line, number, knowledge))
    unnamed = sum(fault.code is Code.UNKNOWN_OBJECT for fault in faults)
    return Parsability(len(lines), len(lines) - len(faults) + unnamed, len(lines) - len(faults), faults)


def _first(line: Line, number: int, knowledge: Knowledge) -> Iterator[Fault]:
    """Yield the gravest fault of a line, if any."""
    if isinstance(line, str):
        yield Fault(number, line.code if isinstance(line, Refused) else Code.SYNTAX, line[:200])
        return
    fault = _fault(line.action, tuple([ref.name for ref in line.objects]), knowledge)
    if fault:
        yield Fault(number, *fault)
    elif twice := _given_twice(line, knowledge):
        yield Fault(number, Code.WRONG_ARITY, f"{twice.name} ({twice.instance}) twice")


def _given_twice(step: Step, knowledge: Knowledge) -> ObjectRef | None:
    """Return the object that a step names twice, which `grammar.check` refuses too; None if there is none."""
    if len(step.objects) < 2:
        return None
    seen = [(knowledge.object_class(ref.name), ref.instance, ref.node) for ref in step.objects]
    return next((ref for n, ref in enumerate(step.objects) if seen[n] in seen[:n]), None)


@lru_cache(maxsize=65_536)
def _fault(name: str, objects: tuple[str, ...], knowledge: Knowledge) -> tuple[Code, str] | None:
    """Return the gravest fault of a step without instances, cached because steps recur in a corpus."""
    action = knowledge.action(name)
    if action is None:
        return Code.UNKNOWN_ACTION, name
    if len(objects) != action.arity:
        return Code.WRONG_ARITY, f"{len(objects)} of {action.arity}"
    unknown = next((name for name in objects if knowledge.object_class(name) is None), "")
    return (Code.UNKNOWN_OBJECT, unknown) if unknown else None
