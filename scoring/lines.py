"""What a scorer is given - a program, a text, a list of steps - as a sequence of lines: steps, or text that is none."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.program import Program, Step
from hearth.schemas.syntax import parse_steps

Line = Step | str
"""A step, or the words of one that does not parse."""

Lines = tuple[Line, ...]

Source = Program | str | Sequence["str | Step"]
"""A program, its text, or its steps one by one."""

Reader = Callable[[str], "tuple[Step, ...] | Diagnostic"]
"""Reads the instructions of one line of text; `hearth.schemas.syntax.parse_steps` is the usual one."""

_MARKS = ("[", "<", "(", "|")


def read(source: Source, reader: Reader = parse_steps) -> Lines:
    """The steps of a program in order; what does not parse stays as text, so that nothing is lost from its length.

    In a text, the lines before the first step are title and description. A text without any step has no title either:
    each of its lines is a step that does not parse. A blank line is nothing; a line of several agents (`... | ...`) is
    as many steps.
    """
    if isinstance(source, Program):
        return source.steps
    if isinstance(source, str):
        return tuple(_read_lines(_body(source, reader), reader))
    return tuple(_read_lines(source, reader))


def steps_of(lines: Iterable[Line]) -> tuple[Step, ...]:
    """Only the lines that are steps."""
    return tuple(line for line in lines if isinstance(line, Step))


def _body(text: str, reader: Reader) -> list[str]:
    """The lines from the first step on, or all of them when there is none.

    Where any line is written as a step, words before it are title and description, though they may read like steps.
    """
    lines = [stripped for line in text.splitlines() if (stripped := line.strip())]
    written = next((n for n, line in enumerate(lines) if line.startswith(_MARKS)), None)
    if written is not None:
        return lines[written:]
    spoken = next((n for n, line in enumerate(lines) if not isinstance(reader(line), Diagnostic)), 0)
    return lines[spoken:]


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
