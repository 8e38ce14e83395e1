"""Input of scorers: a program, a text or a list of steps, read as a sequence of lines."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence

from hearth.kb.language.plan_lines import plan_line, unexplained
from hearth.kb.language.program_lines import Kind, ProgramLine, is_plan, is_unmarked, lines_of_program
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import Program, Step
from hearth.schemas.syntax import parse_steps


class Refused(str):
    """A line that another reader refused, with the code of its fault."""

    __slots__ = ("code",)

    code: Code

    def __new__(cls, text: str, code: Code) -> Refused:
        """Return the line with its code."""
        line = super().__new__(cls, text)
        line.code = code
        return line


Line = Step | str
"""A step, or text that does not parse."""

Lines = tuple[Line, ...]

Source = Program | str | Sequence["str | Step"]
"""A program, its text, or its steps one by one."""

Reader = Callable[[str], "tuple[Step, ...] | Diagnostic"]
"""Reads the instructions of one line of text; `hearth.schemas.syntax.parse_steps` is the usual one."""


class PlanReader(ABC):
    """Reader of lines that also reads whole plans."""

    @abstractmethod
    def __call__(self, line: str) -> tuple[Step, ...] | Diagnostic:
        """Read the instructions of one line."""

    @abstractmethod
    def plan(self, text: str) -> Lines:
        """Read a plan: its steps and refused lines, in order."""


_MARKS = ("[", "<", "(", "|")


def read(source: Source, reader: Reader = parse_steps) -> Lines:
    """Return the steps of a program in order; text that does not parse is kept, so that it counts towards the length.

    In a text, the lines before the first step are title and description; in a text without steps, every line counts as
    a step that does not parse. Blank lines are ignored; a line of several agents (`... | ...`) gives a step for each.
    A plan, with Markdown or in another form than that of programs, is read as `check` reads it.
    """
    if isinstance(source, Program):
        return source.steps
    if isinstance(source, str):
        lines = source.split("\n")
        if is_plan(lines) and isinstance(reader, PlanReader):
            return reader.plan(source)
        if is_plan(lines):
            found = lines_of_program(source)
            return tuple(_read_plan(_begun(found, reader) if is_unmarked(lines) else found, reader))
        return tuple(_read_lines(_body(source, reader), reader))
    return tuple(_read_lines(source, reader))


def steps_of(lines: Iterable[Line]) -> tuple[Step, ...]:
    """Only the lines that are steps."""
    return tuple(line for line in lines if isinstance(line, Step))


def _body(text: str, reader: Reader) -> list[str]:
    """Return the lines from the first step on, or all lines of a text without steps.

    Text before a bracketed or numbered step is title and description, even if it reads like a natural-language step.
    """
    lines = [stripped for line in text.splitlines() if (stripped := line.strip())]
    begins = (n for n, line in enumerate(lines) if line.startswith(_MARKS) or plan_line(line).number is not None)
    written = next(begins, None)
    if written is not None:
        return lines[written:]
    first = next((n for n, line in enumerate(lines) if not isinstance(reader(line), Diagnostic)), 0)
    return lines[first:]


def _begun(lines: Sequence[ProgramLine], reader: Reader) -> Sequence[ProgramLine]:
    """Return the lines from the first that reads as a step; all where none does, as nothing marks the steps."""
    steps = (n for n, (_, line, kind) in enumerate(lines) if kind != Kind.TEXT)
    first = next((n for n in steps if not isinstance(reader(lines[n].line.text), Diagnostic)), 0)
    return lines[first:]


def _read_plan(lines: Sequence[ProgramLine], reader: Reader) -> Iterator[Line]:
    """Read the lines of a plan: one that may explain the step above counts only where it is a step."""
    for _, line, kind in lines:
        if kind in (Kind.TEXT, Kind.HEAD):
            continue
        found = reader(line.text)
        found = reader(unexplained(line.text)) if isinstance(found, Diagnostic) else found
        if not isinstance(found, Diagnostic):
            yield from found
        elif kind != Kind.DETAIL:
            yield line.text


def _read_lines(lines: Iterable[str | Step], reader: Reader) -> Iterator[Line]:
    for line in lines:
        if isinstance(line, Step):
            yield line
            continue
        words = line.strip()
        if not words:
            continue
        found = reader(words)
        if isinstance(found, Diagnostic):
            yield " ".join(words.split())
        else:
            yield from found
