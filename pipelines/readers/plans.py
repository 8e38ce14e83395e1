"""Natural-language steps: numbered text as language models write it, and planning papers' JSON lists of such texts."""

from collections.abc import Iterator
from typing import Any

from hearth.kb.language.plan_lines import PlanLine, header, plan_line
from hearth.pipelines.readers.elements import located_entries
from hearth.pipelines.readers.item import Item, fault_of, lines, record, refused
from hearth.pipelines.readers.located import Text
from hearth.schemas.blocks import is_sentence
from hearth.schemas.failures import Code
from hearth.schemas.stage_rows import IngestedRow
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "spoken"
"""This reader's name in ids of records and in the column `origin`."""

_LONGEST_PROGRAM = 100_000


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each program of a text, or for each text of a JSON list."""
    for number, block in blocks((number, line) for number, (line, _) in enumerate(lines(path), 1)):
        text = "\n".join(block)
        record_id = f"{NAME}:{place}" if number == 1 else f"{NAME}:{place}:{number}"
        yield checked(text, number, record_id, place)


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
    """The item of a text that begins at line `first`, refused if it is not text or too long."""
    fault = fault_of(text, place, first)
    if fault:
        return refused(place, Reject((fault,)), record_id, first)
    if len(text) > _LONGEST_PROGRAM:
        message = f"a program of {len(text):,} characters"
        reject = Reject.of(
            Code.LINE_TOO_LONG, message, file=place, line=first, suggestion=f"at most {_LONGEST_PROGRAM:,}"
        )
        return refused(place, reject, record_id, first)
    value: dict[str, Any] = {"text": text.rstrip("\n") + "\n", "line": first - 1}
    if isinstance(text, Text):
        value["places"] = text.places()
    return Item(record_id, NAME, place, value, line=first)


def read(item: Item) -> IngestedRow:
    """The record of an item with its text unchanged; `validate` maps it to steps."""
    top = header(item.value["text"])
    line, places = item.value["line"], item.value.get("places")
    return record(item, "program", top.title, top.description, text=item.value["text"], line=line, places=places)


def blocks(lines: Iterator[tuple[int, str]], most: int = 1_000_000) -> Iterator[tuple[int, list[str]]]:
    """Split a text into its programs: (number of the first line, lines), cut after `most` characters.

    A program begins where the numbers begin again, or with a line below the steps that is not one of them; not if the
    numbers go on after it, or if it is a remark at the end.
    """
    block = _Block()
    for number, raw in lines:
        line = plan_line(raw)
        if line.number is not None and block.ends_before(line):
            rest = block.split()
            yield block.first, block.lines
            block = rest
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

    @property
    def first(self) -> int:
        return self.numbers[0]

    def add(self, number: int, raw: str, line: PlanLine, most: int) -> None:
        """Add a line, unless the block is blank or full."""
        if line.number is not None:
            self._bulleted = self._bulleted and not line.number
            self._by_headings = self._by_headings or line.heading
            is_nested = self._by_headings and not line.heading
            self._last = self._last if is_nested else max(line.number or self._last, 1)
            self._below, self.has_title_below = 0, False
        elif line.text and self._last and not self._below and (line.heading or not line.indent):
            self._below = len(self.lines)
            self.has_title_below = line.heading or not is_sentence(line.text)
        self.has_title_below = self.has_title_below or (self._below > 0 and line.heading)
        if (raw.strip() or self.lines) and self._size <= most:
            self.lines.append(raw)
            self.numbers.append(number)
            self._size += len(raw) + 1

    def ends_before(self, step: PlanLine) -> bool:
        """Whether a step belongs to the next program."""
        if self._by_headings and not step.heading and not self._below:
            return False
        if step.number:
            return step.number <= 1 and (self._last > 1 or self._below > 0)
        return self._below > 0 and (self._bulleted or step.bracketed)

    def split(self) -> "_Block":
        """Cut off the lines below the steps, which begin the next program."""
        rest, at = _Block(), self._below or len(self.lines)
        rest.lines, rest.numbers = self.lines[at:], self.numbers[at:]
        self.lines, self.numbers = self.lines[:at], self.numbers[:at]
        rest._size = sum(map(len, rest.lines))
        return rest
