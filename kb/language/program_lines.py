"""The lines of a program: one function that `check`, `run`, `build` and `score` all read a text with."""

import re
from collections.abc import Iterator, Sequence
from enum import StrEnum
from typing import NamedTuple

from hearth.kb.language.forms import form_of
from hearth.kb.language.forms.form import Placed
from hearth.kb.language.plan_lines import CHAIN, META, Header, PlanLine, header_of, is_step, ordered, plan_line
from hearth.kb.language.plan_lines import is_plan as is_list
from hearth.schemas.blocks import is_sentence

_JOINT = re.compile(rf"{CHAIN.pattern}|;\s+")
_END = re.compile(
    r"(?:\[?(?:all )?(?:done(?: task)?|end(?: of (?:plan|task))?|finished|task (?:is )?(?:complete|done)d?)\]?)\W*",
    re.I,
)
"""Words that end a plan and are no step."""

_NEXT = re.compile(r"\s[(\[]?(\d{1,4})[.):\]]\s+(?=\S)")
_SEVERAL = re.compile(r"[>→⟶➔➡;]|\d[.):\]]")
"""What a line of several steps has in any case."""

_THOUGHT = re.compile(r"\s*<(/?)think(?:ing)?>\s*$", re.IGNORECASE)


class Kind(StrEnum):
    """What a line of a program is.

    A detail is a line that may explain the step above: an item below a step, or a line without a number. It is a step
    if it reads exactly as one, else a note. A missing step is a line between numbered ones that is no sentence.
    """

    TEXT = "text"
    STEP = "step"
    DETAIL = "detail"
    MISSING = "missing"


class ProgramLine(NamedTuple):
    """A line, or one of the steps on it, with the index of the line of the text that it stands on."""

    row: int
    line: PlanLine
    kind: Kind


def lines_of_program(text: str) -> list[ProgramLine]:
    """Return the lines of a program's text in order; each step of a line of several is one."""
    raw = _without_thoughts(text.split("\n"))
    form = form_of(raw)
    if form:
        return [ProgramLine(*each, _kind(each.line)) for each in form.lines(raw) if not _ends(each)]
    return list(_kinds([Placed(row, plan_line(line)) for row, line in enumerate(raw)]))


def header(text: str) -> Header:
    """Return title and description of a program's text."""
    raw = _without_thoughts(text.split("\n"))
    form = form_of(raw)
    return header_of([line for _, line in form.lines(raw)] if form else list(map(plan_line, raw)))


def is_plan(lines: Sequence[str]) -> bool:
    """Return whether a text's first lines are a plan in any form but that of program text."""
    return any(map(_THOUGHT.match, lines)) or form_of(lines) is not None or is_list(lines) or _is_joined(lines)


def _is_joined(lines: Sequence[str]) -> bool:
    """Return whether a line holds several steps, `Plan: 1. walk to kitchen 2. open fridge`."""
    read = map(plan_line, lines)
    return any(len(list(_parts(line))) > 1 for line in read if line.number is not None and not line.bracketed)


def _without_thoughts(lines: list[str]) -> list[str]:
    """Empty the lines between `<think>` and `</think>`, which a model wrote to itself."""
    if not any(map(_THOUGHT.match, lines)):
        return lines
    thinks, found = False, []
    for line in lines:
        mark = _THOUGHT.match(line)
        thinks = not mark[1] if mark else thinks
        found.append("" if mark or thinks else line)
    return found


def _ends(placed: Placed) -> bool:
    return placed.line.number is not None and _END.fullmatch(placed.line.text) is not None


def _kind(line: PlanLine) -> Kind:
    if line.number is None:
        return Kind.TEXT
    return Kind.STEP if line.numbered or line.bracketed else Kind.DETAIL


def _kinds(placed: list[Placed]) -> Iterator[ProgramLine]:
    lines = [line for _, line in placed]
    is_ordered = ordered(lines)
    own = [is_step(line, is_ordered) for line in lines]
    first = next((n for n, is_own in enumerate(own) if is_own), len(own))
    last = max((n for n, is_own in enumerate(own) if is_own), default=-1)
    indent: int | None = None
    by_headings = False
    for number, each in enumerate(placed):
        line = each.line
        if number < first and line.number is not None:
            yield ProgramLine(*each, Kind.TEXT)
            continue
        if line.number is None:
            yield ProgramLine(*each, _between(line, number < last) if indent is not None else Kind.TEXT)
            continue
        if _ends(each):
            continue
        indent = line.indent if indent is None else indent
        by_headings = by_headings or line.heading
        is_own = own[number] and (line.heading or line.bracketed or not by_headings)
        is_own = is_own and (line.numbered or line.bracketed or line.indent <= indent)
        for part in _parts(line):
            if not _ends(placed_part := Placed(each.row, part)):
                yield ProgramLine(*placed_part, Kind.STEP if is_own else Kind.DETAIL)


def _between(line: PlanLine, steps_follow: bool) -> Kind:
    """Return the kind of a line without a number below the first step."""
    if not line.text or line.heading or META.match(line.text):
        return Kind.TEXT
    is_missing = steps_follow and not line.indent and not is_sentence(line.text)
    return Kind.MISSING if is_missing else Kind.DETAIL


def _parts(line: PlanLine) -> Iterator[PlanLine]:
    """Part a line of several steps: `walk to kitchen 2. open fridge`, or `walk to kitchen -> open fridge`."""
    if not _SEVERAL.search(line.text):
        yield line
        return
    pieces = [line.text]
    if line.numbered:
        pieces = list(_numbered(line.text, line.number or 0))
    for piece in pieces:
        for part in _JOINT.split(piece) if not piece.startswith("[") else CHAIN.split(piece):
            if part.strip():
                yield line._replace(text=part.strip())


def _numbered(text: str, number: int) -> Iterator[str]:
    """Part a text before each next number."""
    start = 0
    for found in _NEXT.finditer(text):
        if int(found[1]) == number + 1:
            yield text[start : found.start()]
            start, number = found.end(), number + 1
    yield text[start:]
