"""Sketches: which steps of a program a person kept as its gist (thesis 4.2), in the release's annotation file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from hearth.pipelines.readers import release
from hearth.pipelines.readers.document import document
from hearth.pipelines.readers.item import Item, Place, refused
from hearth.pipelines.rejects import Reject
from hearth.schemas.failures import Code

NAME = "sketches"

COLUMNS = ("answer", "input")
"""What tells the file from other JSON: columns of equal length."""


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each sketch."""
    value = document(path, place)
    if isinstance(value, Reject):
        yield refused(place, value)
        return
    answers, inputs = (value.get(name) for name in COLUMNS)
    if not isinstance(answers, list) or not isinstance(inputs, list) or len(answers) != len(inputs):
        message = "no sketches: `answer` and `input` are not lists of one length"
        yield refused(place, Reject.of(Code.BAD_JSON, message, file=place))
        return
    represent = value.get("represent")
    represent = represent if isinstance(represent, list) and len(represent) == len(answers) else [1] * len(answers)
    for number, (keep, given, fits) in enumerate(zip(answers, inputs, represent, strict=True), 1):
        told = {"keep": keep, "input": given, "represent": fits}
        yield Item(f"{NAME}:{place}[{number}]", NAME, f"{place}[{number}]", told)


def read(item: Item) -> dict[str, Any] | Reject:
    """The record of a sketch: the program it is of, which of its steps it keeps, and these steps."""
    keep, given = item.value["keep"], item.value["input"]
    try:
        flags = [bool(flag) for flag in keep]
        text = "".join(f"{step.strip()}\n" for step in given["prog"])
        program_id, title, description = str(given["prefix"]), str(given["title"]), str(given["descr"])
    except (TypeError, KeyError, AttributeError) as error:
        message = f"not a sketch: {type(error).__name__} {error}"
        return Reject.of(Code.BAD_JSON, message, file=item.place, suggestion="it needs title, descr, prog and prefix")
    if not flags:
        return Reject.of(Code.EMPTY, "a sketch of no steps", file=item.place)
    return {
        "kind": "sketch",
        "program_id": item.record_id,
        "origin": NAME,
        "place": item.place,
        "description_id": f"{release.NAME}:{program_id}",
        "title": title,
        "description": description,
        "text": text,
        "keep": flags,
        "line": 0,
    }
