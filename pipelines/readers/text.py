"""Plain program text: a title, a description, then one step a line; several programs a file, files in folders."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from hearth.pipelines.readers.item import Item, Place, fault_of, lines, refused, size_of
from hearth.pipelines.rejects import Reject
from hearth.schemas.blocks import STEP, Splitter
from hearth.schemas.failures import Code
from hearth.schemas.syntax import MAX_LINE

NAME = "text"


_FIRST_STEP = re.compile(rf"^(?:{STEP.pattern})", re.MULTILINE)


@dataclass(slots=True)
class _Block:
    first: int
    lines: list[str] = field(default_factory=list)
    longest: int = 0


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each program of a file.

    What begins the next program is told by `hearth.schemas.blocks`; a title without steps is a record of its own.
    """
    found = False
    for number, block in enumerate(_blocks(path), 1):
        found = True
        record_id = f"{NAME}:{place}" if number == 1 else f"{NAME}:{place}#{number}"
        yield _item(block, record_id, place)
    if not found:
        reason = "nothing to read" if size_of(path) else "an empty file"
        suggestion = "write a title, a blank line, then one [Step] a line"
        yield refused(place, Reject.of(Code.EMPTY, reason, file=place, suggestion=suggestion))


def _item(block: _Block, record_id: str, place: str) -> Item:
    text = "\n".join(block.lines)
    fault = fault_of(text, place, block.first)
    if fault:
        return refused(place, Reject((fault,)), record_id, block.first)
    if block.longest > MAX_LINE:
        long = next(number for number, line in enumerate(block.lines) if len(line) > MAX_LINE)
        reject = Reject.of(
            Code.LINE_TOO_LONG,
            f"a line of {block.longest:,} characters",
            file=place,
            line=block.first + long,
            found=block.lines[long][:60],
            suggestion=f"at most {MAX_LINE:,}",
        )
        return refused(place, reject, record_id, block.first)
    return Item(record_id, NAME, place, {"text": text + "\n", "line": block.first - 1})


def _blocks(path: Place) -> Iterator[_Block]:
    block: _Block | None = None
    splitter = Splitter()
    for number, (line, length) in enumerate(lines(path), 1):
        if not line or line.isspace():
            splitter.blank()
            if block:
                block.lines.append("")
            continue
        if splitter.begins(line, length > MAX_LINE or STEP.match(line) is not None):
            if block:
                yield block
            block = _Block(number)
        assert block is not None
        block.lines.append(line)
        block.longest = max(block.longest, length)
    if block:
        yield block


def header(text: str) -> tuple[str, str]:
    """Title and description of a program's text: the lines before its first step."""
    first = _FIRST_STEP.search(text)
    found = [line for raw in text[: first.start() if first else len(text)].split("\n") if (line := raw.strip())]
    return (found[0] if found else "", "\n".join(found[1:]))


def read(item: Item) -> dict[str, Any]:
    """The record of an item."""
    title, description = header(item.value["text"])
    return {
        "kind": "program",
        "program_id": item.record_id,
        "origin": NAME,
        "place": item.place,
        "description_id": item.record_id,
        "title": title,
        "description": description,
        "text": item.value["text"],
        "line": item.value["line"],
    }
