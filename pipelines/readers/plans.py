"""Natural-language steps: numbered text as language models write it, and planning papers' JSON lists of such texts."""

import re
from collections.abc import Iterator

from hearth.kb.language.plans import NUMBERED, TITLE, header
from hearth.pipelines.readers.elements import entries
from hearth.pipelines.readers.item import Item, fault_of, lines, record, refused
from hearth.schemas.failures import Code
from hearth.schemas.rows import IngestedRow
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
    for number, (line, text) in enumerate(entries(path, place), 1):
        where = f"{place}[{number}]"
        if isinstance(text, str):
            yield checked(text, 1, f"{NAME}:{where}", where)
        elif isinstance(text, Reject):
            yield refused(where, text, line=line)
        else:
            message = f"entry {number} of the list is not text"
            fault = Reject.of(
                Code.BAD_JSON, message, file=where, line=line, suggestion="a list of texts, or of records"
            )
            yield refused(where, fault)


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
    return Item(record_id, NAME, place, {"text": text.rstrip("\n") + "\n", "line": first - 1}, line=first)


def read(item: Item) -> IngestedRow:
    """The record of an item with its text unchanged; `validate` maps it to steps."""
    top = header(item.value["text"])
    return record(item, "program", top.title, top.description, text=item.value["text"], line=item.value["line"])


def has_numbered_steps(lines: list[str]) -> bool:
    """Whether a text's first lines are natural-language steps: numbered lines, none of them in brackets."""
    numbered = [line for line in lines if NUMBERED.match(line)]
    bracketed = any(re.match(r"\s*(?:\[|<[^<>]*>\s*\[)", line) for line in lines)
    return bool(numbered) and not bracketed and (len(numbered) > 1 or bool(TITLE.match(lines[0])))


def blocks(lines: Iterator[tuple[int, str]], most: int = 1_000_000) -> Iterator[tuple[int, list[str]]]:
    """Split a text into its programs: (number of the first line, lines), cut after `most` characters.

    A program begins with a line that is not numbered after a step, or where the numbers begin again.
    """
    block: list[str] = []
    first, last, size = 0, 0, 0
    for number, line in lines:
        match = NUMBERED.match(line)
        digits = re.search(r"\d+", match[0]) if match else None
        count = int(digits[0]) if digits else last + 1
        new = bool(line.strip()) and (last > 0 if not match else count <= 1 < last)
        if new and block:
            yield first, block
            first, block, last, size = 0, [], 0, 0
        if (line.strip() or block) and size <= most:
            first = first or number
            block.append(line)
            size += len(line) + 1
        if match:
            last = max(count, 1)
    if block:
        yield first, block
