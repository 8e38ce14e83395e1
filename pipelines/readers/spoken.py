"""Steps in words: numbered text as language models write it, and planning papers' JSON lists of such texts."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from hearth.pipelines import spoken
from hearth.pipelines.readers.elements import entries
from hearth.pipelines.readers.item import Item, Place, fault_of, lines, refused
from hearth.pipelines.rejects import Reject
from hearth.schemas.failures import Code

NAME = "spoken"

_LONGEST_PROGRAM = 100_000


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each program of a text, or for each text of a JSON list."""
    for number, block in spoken.blocks((number, line) for number, (line, _) in enumerate(lines(path), 1)):
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
            message = f"entry {number} of the list is no text"
            fault = Reject.of(
                Code.BAD_JSON, message, file=where, line=line, suggestion="a list of texts, or of records"
            )
            yield refused(where, fault)


def checked(text: str, first: int, record_id: str, place: str) -> Item:
    """The item of a text that begins at line `first`, refused where it is no text or too long."""
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


def read(item: Item) -> dict[str, Any]:
    """The record of an item: the words as they are; `validate` maps them to steps."""
    top = spoken.header(item.value["text"])
    return {
        "kind": "program",
        "program_id": item.record_id,
        "origin": NAME,
        "place": item.place,
        "description_id": item.record_id,
        "title": top.title,
        "description": top.description,
        "text": item.value["text"],
        "line": item.value["line"],
    }
