"""The lines of a program: one function that `check`, `run`, `build` and `score` all read a text with."""

import itertools
import re
from collections.abc import Iterable, Iterator, Sequence
from enum import StrEnum
from typing import NamedTuple

from hearth.kb.language.forms.code_calls import calls_of
from hearth.kb.language.forms.form import Form, Placed
from hearth.kb.language.forms.form_registry import form_of, form_of_line
from hearth.kb.language.line_decorations import Unwrap, unwrapped, unwrapping
from hearth.kb.language.nested_items import is_head
from hearth.kb.language.operator_step_syntax import operator_step
from hearth.kb.language.plain_lines_as_steps import marked
from hearth.kb.language.plan_lines import CHAIN, META, Header, PlanLine, header_of, is_step, ordered, plan_line
from hearth.kb.language.plan_lines import is_plan as is_list
from hearth.kb.language.recognition_knowledge import recognized_cache
from hearth.kb.language.step_like_lines import (
    are_steps,
    chained,
    chained_strongly,
    is_like_step,
    is_order,
    is_sure_step,
)
from hearth.kb.language.steps_in_a_line import listed
from hearth.kb.language.title_marks import is_part
from hearth.schemas.program_boundaries import is_sentence

_JOINT = re.compile(rf"{CHAIN.pattern}|\s*;\s*|\s*>>\s*|\s+>\s+")
_END = re.compile(
    r"(?:\[?(?:all )?(?:done(?: task)?|end(?: of (?:plan|task))?|finished|task (?:is )?(?:complete|done)d?)\]?)\W*",
    re.I,
)
"""Words that end a plan and are no step."""

_NEXT = re.compile(r"\s[(\[]?(\d{1,4})[.):\]]\s+(?=\S)")
_SEVERAL = re.compile(r"[>→⟶➔➡⇒⟹➜➝;•·∧|/]|\d[.):\]]| [-–—]{1,2} ")
"""A mark that every line of several steps has."""

_OWNER = re.compile(r"[A-Z][a-z]{1,20}:\s+(?=\S)")
"""The owner or the subject of a step, in a word before it."""

_THOUGHT = re.compile(r"\s*<(/?)think(?:ing)?>", re.IGNORECASE)
_THOUGHT_END = re.compile(r"</think(?:ing)?>", re.IGNORECASE)


class Kind(StrEnum):
    """The kind of a line of a program.

    A head names the items below it. A detail is a line that may explain the step above: an item below a step, or a line
    without a number. It is a step if it reads exactly as one, else a note. A missing step is a line between numbered
    ones that is not a sentence.
    """

    TEXT = "text"
    STEP = "step"
    DETAIL = "detail"
    HEAD = "head"
    MISSING = "missing"


class ProgramLine(NamedTuple):
    """A line, or one of the steps on it, with the index of the line of the text that it stands on."""

    row: int
    line: PlanLine
    kind: Kind


def lines_of_program(text: str) -> list[ProgramLine]:
    """Return the lines of a program's text in order; each step of a line of several is one."""
    if PLAIN.fullmatch(text) and not form_of_line(text.partition("\n")[0]):
        return _plain_lines(text)
    raw, form = formed(text.split("\n"))
    if form:
        return [ProgramLine(*each, _kind(each.line)) for each in map(_operated, form.lines(raw)) if not _ends(each)]
    return list(_kinds(marked(_read(raw))))


PLAIN = re.compile(
    r"(?![^\n]*[<|])(?!\s*+[#*+>-]++\W*+\d)[^\n]*"
    r"(?:\n(?:[Ss]tep )?+\d{1,4}[.:)] ++[A-Za-z][a-z][A-Za-z ,.'-]*+(?<!\bcharacter))++\n*+"
)
"""A line above numbered steps of plain words, as most plans are: no form has to be tried."""


def _plain_lines(text: str) -> list[ProgramLine]:
    """Return the lines of a plain plan."""
    return [
        ProgramLine(row, line, kind)
        for row, raw in enumerate(text.split("\n"))
        for line, kind in (_short_plain(raw) if len(raw) <= _SHORT else _plain(raw))
    ]


_SHORT = 200
"""Characters of a line that is remembered, as plans say the same again and again."""


def _plain(raw: str) -> tuple[tuple[PlanLine, Kind], ...]:
    """Return the steps of a line of a plain plan, or the line if it is none."""
    line = plan_line(raw)
    if line.number is None:
        return ((line, Kind.TEXT),)
    return tuple((part, Kind.STEP) for part in _parts(line) if not _END.fullmatch(part.text))


_short_plain = recognized_cache(maxsize=16_384)(_plain)


def header(text: str) -> Header:
    """Return title and description of a program's text."""
    top = text.partition("\n")[0]
    if PLAIN.fullmatch(text) and not form_of_line(top):
        line = plan_line(top)
        return header_of([line]) if line.number is None else Header("", "")
    raw, form = formed(text.split("\n"))
    placed = form.lines(raw) if form else marked(_read(raw))
    return header_of([line for _, line in placed])


def formed(lines: Sequence[str]) -> tuple[list[str], Form | None]:
    """Return the lines of a text without thoughts and wrappings, and the form that they have then."""
    unwrap, form = reading_of(lines)
    found = _without_thoughts(list(unwrapped(lines, unwrap)))
    return found, form


def reading_of(lines: Sequence[str]) -> tuple[Unwrap | None, Form | None]:
    """Return what unwraps the lines of a text, by its first lines, and the form of the lines then.

    Nothing unwraps lines that have a form of their own.
    """
    first = tuple(lines[:_LOOKED_AT])
    return _short_reading(first) if sum(map(len, first)) <= _FEW else _reading(first)


def _reading(lines: tuple[str, ...]) -> tuple[Unwrap | None, Form | None]:
    first = list(unwrapped(_without_thoughts(list(lines)), None))
    if form := form_of(first):
        return None, form
    unwrap = unwrapping(first)
    return unwrap, form_of([unwrap(line) for line in first]) if unwrap else None


_short_reading = recognized_cache(maxsize=512)(_reading)

_FEW = 8_000
"""Characters of first lines that are remembered: a file is recognized, parted, titled and read, each by its form."""

_LOOKED_AT = 60


def is_plan(lines: Sequence[str]) -> bool:
    """Return whether a text's first lines are a plan in any form but that of program text."""
    if any(map(_THOUGHT.match, lines)):
        return True
    lines, form = formed(lines)
    return form is not None or is_list(lines) or _is_joined(lines) or is_unmarked(lines) or _has_one_item(lines)


def _has_one_item(lines: Sequence[str]) -> bool:
    """Return whether a list has one step, alone or below a title."""
    texts = [line for line in map(plan_line, lines) if line.text]
    if len(texts) == 1 and texts[0].number is not None:
        return is_sure_step(texts[0].text)
    return len(texts) == _TITLED and texts[0].number is None and texts[1].number == 0 and is_order(texts[1].text)


_TITLED = 2


def is_unmarked(lines: Sequence[str]) -> bool:
    """Return whether a text's first lines hold a plan of plain lines, which nothing marks as steps."""
    if any(_is_numbered(line) for line in lines[:_FIRST]):
        return False
    read = _read(lines)
    if any(line.number is not None for _, line in read):
        return False
    return any(any(line.number is not None for _, line in marked(part)) for part in _sections(read))


def _read(raw: Sequence[str]) -> list[Placed]:
    lines = list(map(plan_line, raw))
    lines = list(titled(lines, titles_of(raw, lines)))
    return [Placed(row, line) for row, line in enumerate(lines)]


class Titles(StrEnum):
    """Marks of steps that stand before titles in a text: `# 1. Find the remote`, or bullets above bullets."""

    NONE = "none"
    HEADINGS = "headings"
    BULLETS = "bullets"


def titled(lines: Iterable[PlanLine], titles: Titles) -> Iterator[PlanLine]:
    """Yield the lines, those that are titles without their marks."""
    for line in lines:
        is_bullet = line.number is not None and not line.numbered and not line.indent
        is_title = line.heading if titles == Titles.HEADINGS else titles == Titles.BULLETS and is_bullet
        yield line._replace(number=None, numbered=False, heading=True) if is_title else line


def titles_of(raw: Sequence[str], lines: Sequence[PlanLine]) -> Titles:
    """Return which marks stand before titles in a text, by its first lines."""
    if lines and lines[0].numbered and not lines[0].heading:
        return Titles.NONE
    if any(line.heading and line.numbered for line in lines) and titles_are_numbered(raw, lines):
        return Titles.HEADINGS
    return Titles.BULLETS if _are_bullets(lines) else Titles.NONE


def _are_bullets(lines: Sequence[PlanLine]) -> bool:
    """Return whether two steps at least stand below each bullet, and everything is a bullet."""
    texts = [line for line in lines if line.text]
    if not texts or texts[0].indent or any(line.number is None or line.bracketed for line in texts):
        return False
    if any(line.numbered and not line.indent for line in texts):
        return False
    tops = [n for n, line in enumerate(texts) if not line.indent]
    if all(is_part(texts[n].text) for n in tops):
        return False
    return all(
        sum(is_order(line.text) for line in texts[start + 1 : end]) > 1
        for start, end in itertools.pairwise([*tops, len(texts)])
    )


_OF_STEP = re.compile(r"[\s#*]*step\b", re.IGNORECASE)


def titles_are_numbered(raw: Sequence[str], lines: Sequence[PlanLine]) -> bool:
    """Return whether headings with numbers are titles, as steps stand below most of them."""
    at = [n for n, line in enumerate(lines) if line.heading and line.numbered and not _OF_STEP.match(raw[n])]
    sections = [lines[start + 1 : end] for start, end in itertools.pairwise([*at, len(lines)])]
    filled = [section for section in sections if any(line.text for line in section)]
    return len(filled) > 0 and 2 * sum(map(_has_steps, filled)) > len(filled)


def _has_steps(section: Sequence[PlanLine]) -> bool:
    steps = [line for line in section if line.number is not None and not line.heading]
    if any(line.numbered for line in steps) or sum(is_like_step(line.text) for line in steps) > 1:
        return True
    texts = [line.text for line in section if line.text and not line.heading]
    return not steps and (any(map(chained, texts)) or are_steps(texts))


_FIRST = 4

_NUMBERED = re.compile(r"(?:step )?\d{1,4}[.:)] ", re.IGNORECASE)


def _is_numbered(raw: str) -> bool:
    return _NUMBERED.match(raw) is not None


def _sections(placed: list[Placed]) -> Iterator[list[Placed]]:
    """Part lines before each heading."""
    part: list[Placed] = []
    for each in placed:
        if each.line.heading and part:
            yield part
            part = []
        part.append(each)
    if part:
        yield part


def _is_joined(lines: Sequence[str]) -> bool:
    """Return whether a line holds several steps, `Plan: 1. walk to kitchen 2. open fridge`."""
    read = map(plan_line, lines)
    return any(len(list(_parts(line))) > 1 for line in read if line.number is not None and not line.bracketed)


def _without_thoughts(lines: list[str]) -> list[str]:
    """Empty the text between `<think>` and `</think>`, which a model wrote to itself."""
    if not any(map(_THOUGHT.match, lines)):
        return lines
    thinks, found = False, []
    for line in lines:
        mark = _THOUGHT.match(line)
        thinks = not mark[1] if mark else thinks
        ended = _THOUGHT_END.search(line) if thinks else None
        thinks = thinks and not ended
        found.append(line[ended.end() :] if ended else "" if mark or thinks else line)
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
        if own[number] and is_head(line, lines[number + 1 :]):
            yield ProgramLine(*each, Kind.HEAD)
            continue
        by_headings = by_headings or line.heading
        is_own = own[number] and (line.heading or line.bracketed or not by_headings)
        is_own = is_own and (line.numbered or line.bracketed or line.indent <= indent)
        for part in _parts(line):
            if not _ends(placed_part := Placed(each.row, part)):
                yield ProgramLine(*placed_part, Kind.STEP if is_own or part.bracketed else Kind.DETAIL)


def _between(line: PlanLine, steps_follow: bool) -> Kind:
    """Return the kind of a line without a number below the first step."""
    if not line.text or line.heading or META.match(line.text):
        return Kind.TEXT
    is_missing = steps_follow and not line.indent and (not is_sentence(line.text) or is_order(line.text))
    return Kind.MISSING if is_missing else Kind.DETAIL


def _operated(placed: Placed) -> Placed:
    """Return a step of a form in the syntax of programs where an operator writes it."""
    line = placed.line
    step = operator_step(line.text) if line.number is not None and not line.bracketed else ""
    return placed._replace(line=line._replace(text=step)) if step else placed


def _parts(line: PlanLine) -> Iterator[PlanLine]:
    """Part a line of several steps: `walk to kitchen 2. open fridge`, or `walk to kitchen -> open fridge`."""
    if calls := calls_of(line.text) or listed(line.text):
        yield from (line._replace(text=call) for call in calls)
        return
    if not line.bracketed and (step := operator_step(line.text)):
        yield line._replace(text=step)
        return
    if (owner := _OWNER.match(line.text)) and _is_of_steps(owned := line.text[owner.end() :]):
        line = line._replace(text=owned)
    if not _SEVERAL.search(line.text) and " then " not in line.text:
        yield line
        return
    pieces = list(_numbered(line.text, line.number or 0)) if line.numbered else [line.text]
    for piece in pieces:
        parts = CHAIN.split(piece) if piece.startswith("[") else chained_strongly(piece) or _JOINT.split(piece)
        for part in parts:
            if part.strip():
                yield line._replace(text=operator_step(part.strip()) or part.strip())


def _is_of_steps(text: str) -> bool:
    return " " in text and (is_like_step(text) or bool(operator_step(CHAIN.split(text, maxsplit=1)[0])))


def _numbered(text: str, number: int) -> Iterator[str]:
    """Part a text before each next number."""
    start = 0
    for found in _NEXT.finditer(text):
        if int(found[1]) == number + 1:
            yield text[start : found.start()]
            start, number = found.end(), number + 1
    yield text[start:]
