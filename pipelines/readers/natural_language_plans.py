"""Natural-language steps: numbered text as language models write it, and planning papers' JSON lists of such texts."""

import itertools
from collections.abc import Iterator
from typing import Any

from hearth.kb.language.forms.code_calls import CODE
from hearth.kb.language.forms.code_functions import plan_of
from hearth.kb.language.forms.form import Form
from hearth.kb.language.line_decorations import bare, raw_of
from hearth.kb.language.plan_lines import META, RULE, PlanLine, is_answer, is_aside, level_of, plan_line
from hearth.kb.language.program_lines import Titles, header, is_unmarked, reading_of, titled, titles_of
from hearth.kb.language.step_like_lines import are_steps, is_order, is_sure_step, names_task
from hearth.pipelines.readers.document_titles import without_document_titles
from hearth.pipelines.readers.json_elements import located_entries
from hearth.pipelines.readers.reader_items import Item, fault_of, lines, record, refused
from hearth.pipelines.readers.texts_with_positions import Text
from hearth.pipelines.readers.unmarked_plans import unmarked_blocks
from hearth.schemas.failures import Code
from hearth.schemas.program_boundaries import is_sentence
from hearth.schemas.stage_rows import IngestedRow
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "spoken"
"""This reader's name in ids of records and in the column `origin`."""

LONGEST_PLAN = 100_000
"""Characters of a program in words."""

_LOOKED_AT = 60


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each program of a text, or for each text of a JSON list."""
    numbered = ((number, line) for number, (line, _) in enumerate(lines(path), 1))
    found = without_document_titles(_programs(numbered))
    start = list(itertools.islice(found, 2))
    for number, block in itertools.chain(start, found):
        text = "\n".join(map(raw_of, block))
        text = _as_title(text) if len(start) > 1 else text
        record_id = f"{NAME}:{place}" if number == 1 else f"{NAME}:{place}:{number}"
        yield checked(text, number, record_id, place)


def _as_title(text: str) -> str:
    """Return a program of one line next to others, marked as a title: alone it would be read as a step."""
    line = text.strip()
    return f"Task: {line}" if "\n" not in line and is_sure_step(line) else text


def starts_of(text: str) -> list[int]:
    """Return the first line of each program of a text."""
    return [number for number, _ in without_document_titles(_programs(enumerate(text.split("\n"), 1)))]


def scan_list(path: Place, place: str) -> Iterator[Item]:
    """One item for each text of a JSON list of texts."""
    for number, (line, found) in enumerate(located_entries(path, place), 1):
        name = f"{place}[{number}]"
        text = found if isinstance(found, Reject) else found.value
        if isinstance(text, str):
            yield checked(text, line, f"{NAME}:{name}", place)
        elif isinstance(text, Reject):
            yield refused(place, text, name, line)
        else:
            message = f"entry {number} of the list is not text"
            fault = Reject.of(
                Code.BAD_JSON, message, file=place, line=line, suggestion="a list of texts, or of records"
            )
            yield refused(place, fault, name, line)


def checked(text: str, first: int, record_id: str, place: str) -> Item:
    """Return the item of a text that begins at line `first`, refused if it is not text or too long."""
    fault = fault_of(text, place, first)
    if fault:
        return refused(place, Reject((fault,)), record_id, first)
    if len(text) > LONGEST_PLAN:
        message = f"a program of {len(text):,} characters"
        reject = Reject.of(Code.LINE_TOO_LONG, message, file=place, line=first, suggestion=f"at most {LONGEST_PLAN:,}")
        return refused(place, reject, record_id, first)
    value: dict[str, Any] = {"text": text.rstrip("\n") + "\n", "line": first - 1}
    if isinstance(text, Text):
        value["places"] = text.places()
    return Item(record_id, NAME, place, value, line=first)


def read(item: Item) -> IngestedRow:
    """Return the record of an item with its text unchanged; `validate` maps it to steps."""
    top = header(item.value["text"])
    line, places = item.value["line"], item.value.get("places")
    return record(item, "program", top.title, top.description, text=item.value["text"], line=line, places=places)


def _programs(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, list[str]]]:
    """Split a text into its programs, in the form that its first lines are written in."""
    first = list(itertools.islice(lines, _LOOKED_AT))
    unwrap, form = reading_of([line for _, line in first])
    rest = ((number, bare(line, unwrap)) for number, line in itertools.chain(first, lines))
    looked_at = [bare(line, unwrap) for _, line in first]
    if form is CODE:
        return _blocks_of_code(rest)
    if form:
        return _blocks_of(form, rest)
    if is_unmarked(looked_at):
        return unmarked_blocks(rest)
    return blocks(rest, titles=titles_of(looked_at, list(map(plan_line, looked_at))))


def _blocks_of(form: Form, lines: Iterator[tuple[int, str]], most: int = 1_000_000) -> Iterator[tuple[int, list[str]]]:
    """Split a text of a form before each line that begins a program."""
    block: list[str] = []
    first = size = 0
    has_steps, begun = False, set[str]()
    for number, raw in lines:
        begins = form.begins.match(raw)
        key = next(filter(None, begins.groups()), "").lower() if begins else ""
        if begins and (has_steps or key in begun):
            yield first, block
            block, size, has_steps, begun = [], 0, False, set()
        begun |= {key} if begins else set()
        if raw.strip() or block:
            first = number if not block else first
            block += [raw] if size <= most else []
            size += len(raw) + 1
        has_steps = has_steps or form.is_step(raw)
    if block:
        yield first, block


def _blocks_of_code(lines: Iterator[tuple[int, str]], most: int = 1_000_000) -> Iterator[tuple[int, list[str]]]:
    """Split code before each function, unless one calls another: then no function alone is a plan."""
    first: list[tuple[int, str]] = []
    size = 0
    for each in lines:
        first.append(each)
        size += len(each[1])
        if size > most:
            return _blocks_of(CODE, itertools.chain(first, lines))
    plan = plan_of([raw for _, raw in first])
    if plan.called and any(raw.strip() for _, raw in first):
        start = next(n for n, (_, raw) in enumerate(first) if raw.strip())
        return iter([(first[start][0], [raw for _, raw in first[start:]])])
    return _blocks_of(CODE, iter([(number, raw) for (number, _), raw in zip(first, plan.lines, strict=True)]))


def blocks(
    lines: Iterator[tuple[int, str]], most: int = 1_000_000, *, titles: Titles = Titles.NONE
) -> Iterator[tuple[int, list[str]]]:
    """Split a text into its programs: (number of the first line, lines), cut after `most` characters.

    A program begins where the numbers begin again, or with a line below the steps that is not one of them; not if the
    numbers go on after it, or if it is a remark at the end. A title, a heading of the level of the one before, or a
    rule ends a program that has no steps, too.
    """
    block = _Block()
    for number, raw in lines:
        line = plan_line(raw)
        line = next(titled([line], titles)) if titles != Titles.NONE else line
        if line.number is not None and not block.holds(line):
            if block.ends_before(line):
                rest = block.split()
                yield block.first, block.lines
                block = rest
            if block.begins_again():
                rest = block.split()
                yield block.first, block.lines
                block = rest
        elif line.number is None and block.is_without_steps(raw, line):
            if block.has_steps:
                rest = block.split()
                yield block.first, block.lines
                block = rest
            yield block.first, block.lines
            block = _Block()
        block.add(number, raw, line, most)
    if block.has_title_below:
        rest = block.split()
        yield block.first, block.lines
        block = rest
    if block.lines:
        yield block.first, block.lines


class _Block:
    """The lines of a program so far; `_below` is the index of the first line below its steps, if any."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.numbers: list[int] = []
        self.has_title_below = False
        self._last, self._below, self._size = 0, 0, 0
        self._bulleted, self._by_headings = True, False
        self._level = self._deepest = self._number = self._indent = 0
        self._texts: list[PlanLine] = []
        self._has_heading_below = self._is_titled = self._has_top = self._bracketed = False

    @property
    def first(self) -> int:
        return self.numbers[0]

    def add(self, number: int, raw: str, line: PlanLine, most: int) -> None:
        """Add a line, unless the block is blank or full."""
        if self._is_comment(line):
            line = line._replace(text="", heading=False)
        if line.number is not None:
            self._has_top = self._has_top or (not self._last and bool(self._texts))
            self._bracketed = line.bracketed and (self._bracketed or not self._last) and not self._is_titled
            self._bulleted = self._bulleted and not line.numbered
            self._number = line.number if line.numbered and not self.holds(line) else self._number
            self._by_headings = self._by_headings or line.heading
            is_nested = (self._by_headings and not line.heading) or self.holds(line)
            self._indent = self._indent if self._last else line.indent
            self._last = self._last if is_nested else max(line.number or self._last, 1)
            self._below, self.has_title_below = 0, False
            self._level, self._deepest, self._texts, self._has_heading_below = 0, 0, [], False
        elif line.text and self._last and not self._below and self._may_be_below(line):
            self._below = len(self.lines)
            is_apart = bool(self.lines) and not self.lines[-1].strip()
            is_remark = is_sentence(line.text) or META.match(line.text) is not None
            self.has_title_below = line.heading or (is_apart and not is_remark)
        if line.heading and line.number is None and self._last and not is_aside(line.text):
            self._has_heading_below = True
        self._is_titled = self._is_titled or line.heading
        if line.number is None and line.text:
            self._deepest = level_of(raw) if line.heading else self._deepest
            self._level = self._level or self._deepest
            self._texts.append(line)
        self.has_title_below = self.has_title_below or (self._below > 0 and line.heading)
        if (raw.strip() or self.lines) and self._size <= most:
            self.lines.append(raw)
            self.numbers.append(number)
            self._size += len(raw) + 1

    def _is_comment(self, line: PlanLine) -> bool:
        """Return whether a line is a comment below a step in brackets, in a program without a heading as title."""
        if not line.heading or line.number is not None or not self._bracketed or not self._has_top:
            return False
        return bool(self.lines[-1].strip())

    def holds(self, step: PlanLine) -> bool:
        """Return whether a numbered step is an item of the one above, with numbers of its own."""
        return step.numbered and self._last > 0 and not self._below and step.indent > self._indent + 1

    def _may_be_below(self, line: PlanLine) -> bool:
        """Return whether a line stands below the steps, and is none that only lacks its mark."""
        is_apart = bool(self.lines) and not self.lines[-1].strip()
        if line.heading or is_apart:
            return True
        is_likely_step = self._is_titled or self._is_untitled_list or line.text.endswith(".")
        return not line.indent and not (is_likely_step and is_order(line.text))

    @property
    def _is_untitled_list(self) -> bool:
        """Return whether a list began without a title, so that a line between its entries hardly is one."""
        return self._bulleted and not self._has_top

    @property
    def has_steps(self) -> bool:
        """Return whether the program has steps, and lines below them."""
        return self._below > 0

    def is_without_steps(self, raw: str, line: PlanLine) -> bool:
        """Return whether a line ends the text since the last step, which then is a program that has no steps."""
        if self._last and not self._below:
            return False
        if RULE.match(raw):
            is_apart = bool(self.lines) and not self.lines[-1].strip()
            return not self._last and is_apart and len(self._texts) > 1 and not is_answer(self._texts[0])
        if not line.heading or not self._level or is_aside(line.text):
            return False
        if level_of(raw) == self._deepest and all(each.heading for each in self._texts):
            return True
        return level_of(raw) <= self._level or are_steps([each.text for each in self._texts if not each.heading])

    def ends_before(self, step: PlanLine) -> bool:
        """Return whether a step belongs to the next program."""
        if self._by_headings and not step.heading and not self._below:
            return False
        if self._has_heading_below and (not step.number or step.number <= self._number):
            return True
        if step.number:
            return step.number <= 1 and (self._last > 1 or self._below > 0)
        if step.numbered and self._number > 0:
            return True
        return self._below > 0 and (self._bulleted or step.bracketed)

    def begins_again(self) -> bool:
        """Return whether the text above a first step holds a title, perhaps with a description, and another title."""
        if self._last or len(self._texts) < 2:
            return False
        at = max(n for n, raw in enumerate(self.lines) if raw.strip())
        if len(self._texts) == 2:
            self._below = at if not self.lines[at - 1].strip() and all(map(names_task, self._texts)) else 0
            return self._below > 0
        first, *middle, last = self._texts
        is_apart = not self.lines[at - 1].strip()
        names = [line for line in (first, last) if not is_sentence(line.text) and not META.match(line.text)]
        if len(names) < 2 or not is_apart or last.heading or is_aside(last.text) or is_answer(first):
            return False
        self._below = at if all(is_sentence(line.text) for line in middle) else 0
        return self._below > 0

    def split(self) -> "_Block":
        """Cut off the lines below the steps, which begin the next program."""
        rest, at = _Block(), self._below or len(self.lines)
        rest.lines, rest.numbers = self.lines[at:], self.numbers[at:]
        self.lines, self.numbers = self.lines[:at], self.numbers[:at]
        rest._is_titled = any(plan_line(raw).heading for raw in rest.lines)
        rest._size = sum(map(len, rest.lines))
        rest._deepest = self._deepest
        rest._level, rest._texts = self._level, self._texts if self._last else self._texts[-1:]
        return rest
