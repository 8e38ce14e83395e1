"""Crowd-sourcing batches: CSV of both stages (thesis 3.3), worker ids replaced by salted hashes.

A corpus that its authors wrote in this form says `written` in the column `Origin`, and has no workers: `Writer` may
stand for `WorkerId` and `Style` names the voice of a text.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypedDict

from hearth.pipelines.crowd.key_counts import SeenSet, digest
from hearth.pipelines.crowd.topics import no_activity
from hearth.pipelines.readers.delimited import Layout, Rows, layout_of, row_fault
from hearth.pipelines.readers.reader_items import Item, record, refused, worker_hash
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.row_types import QuantityRow
from hearth.schemas.stage_rows import IngestedRow
from hearth.schemas.syntax import normal_name
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "crowd"
WRITTEN = "written"

SHARED = ("HITId", "WorkerId", "AssignmentStatus")
DESCRIPTIONS = (*SHARED, "Input.scene", "Answer.title", "Answer.description")
PROGRAMS = (
    *SHARED,
    "Input.description_id",
    "Input.title",
    "Input.description",
    "Answer.rooms",
    "Answer.props",
    "Answer.program",
)

COLUMNS = frozenset({*DESCRIPTIONS, *PROGRAMS, "Origin", "Platform", "Style"}) - {"HITId"}
"""The columns that identify an answer, but for its task: of two that agree in them, the second is a copy."""

_ACCEPTED = frozenset({"approved", "submitted", "accepted", ""})
_QUANTITY = re.compile(r"\s*<?([^*<>]+?)>?\s*(?:\*\s*(\d{1,6}))?\s*")


@dataclass(frozen=True, slots=True)
class Header(Layout):
    """A batch's first line, its stage (1 or 2) and missing columns."""

    stage: int
    missing: tuple[str, ...]


def header_of(line: str) -> Header | None:
    """Read a first line; None if it is not the header of a batch."""
    layout = layout_of(line)
    columns = tuple("WorkerId" if name == "Writer" and "Origin" in layout.columns else name for name in layout.columns)
    names = set(columns)
    lacking = [(len(set(wanted) - names), stage) for stage, wanted in ((1, DESCRIPTIONS), (2, PROGRAMS))]
    _, stage = min(lacking)
    wanted = DESCRIPTIONS if stage == 1 else PROGRAMS
    if not any(name in names for name in wanted if name.startswith(("Input.", "Answer."))):
        return None
    return Header(columns, layout.delimiter, stage, tuple(name for name in wanted if name not in names))


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each answer of a batch.

    An answer has the id of its task (`HITId`); further answers to the same task, with other assignments, have both ids.
    """
    rows = Rows(path)
    first = next(rows, None)
    header = header_of(first[1]) if first else None
    if header is None:
        fault = Reject.of(Code.BAD_TABLE, "not a batch: its first line names none of the columns", file=place, line=1)
        yield refused(place, fault)
    elif header.missing:
        columns = ", ".join(f"`{name}`" for name in header.missing)
        message = f"the table lacks the column{'s' * (len(header.missing) > 1)} {columns}"
        found = ", ".join(header.columns)
        suggestion = f"a batch of stage {header.stage} has them; download it again, unchanged"
        yield refused(place, Reject.of(Code.BAD_TABLE, message, file=place, line=1, found=found, suggestion=suggestion))
    else:
        yield from _answers(rows, header, place)


def _answers(rows: Rows, header: Header, place: str) -> Iterator[Item]:
    empty, hits = True, SeenSet()
    for line, raw, cells in rows.parsed(header):
        fault = _row_fault(line, raw, cells, header, place)
        empty = empty and not fault and not cells
        if fault:
            yield refused(place, Reject((fault,)), line=line)
        elif cells:
            values = dict(zip(header.columns, cells, strict=False))
            name = values["HITId"].strip() or f"{place}:{line}"
            assignment = values.get("AssignmentId", "").strip()
            if hits.add(digest(name)) and assignment:  # another worker's answer to the same task
                name = f"{name}:{assignment}"
            yield Item(f"{_origin(values)}:{name}", NAME, place, {"stage": header.stage, "cells": values}, line=line)
    if empty:
        yield refused(place, Reject.of(Code.EMPTY, "a batch with its first line only", file=place, line=1))


def _row_fault(line: int, raw: str, cells: list[str] | None, header: Header, place: str) -> Diagnostic | None:
    fault = row_fault(line, raw, cells, header, place)
    origin = _origin(dict(zip(header.columns, cells or (), strict=False)))
    if fault or origin in (NAME, WRITTEN):
        return fault
    message, suggestion = f"an origin that no answer has: `{origin[:60]}`", f"`{NAME}` or `{WRITTEN}`"
    return Diagnostic(Code.BAD_TABLE, message, place, line, found=origin[:60], suggestion=suggestion)


def _origin(cells: dict[str, str]) -> str:
    """Return the value of the column `Origin`; without one, an answer is a crowd's."""
    return cells.get("Origin", "").strip() or NAME


def read(item: Item, salt: str) -> IngestedRow | Reject:
    """Return the record of an answer, or the reject of an answer that is not used."""
    cells = item.value["cells"]
    status = cells["AssignmentStatus"].strip()
    if status.lower() not in _ACCEPTED:
        message = f"the assignment is {status}"
        return Reject.of(Code.REJECTED_ANSWER, message, file=item.place, line=item.line, found=status)
    return _description(item, cells, salt) if item.value["stage"] == 1 else _program(item, cells, salt)


def _description(item: Item, cells: dict[str, str], salt: str) -> IngestedRow | Reject:
    empty = [name for name in ("Answer.title", "Answer.description") if not cells[name].strip()]
    if empty:
        return _empty(item, empty)
    garbled = _garbled(cells["Answer.description"])
    if garbled:
        message = f"text decoded with the wrong encoding: `{garbled}`"
        hint = "download the batch again, as UTF-8"
        return Reject.of(Code.NOT_TEXT, message, file=item.place, line=item.line, found=garbled, suggestion=hint)
    other = no_activity(f"{cells['Answer.title']}. {cells['Answer.description']}")
    if other:
        kind, phrases = other
        message = f"{kind}, not an activity: {', '.join(f'`{phrase}`' for phrase in phrases[:3])}"
        return Reject.of(Code.OFF_TOPIC, message, file=item.place, line=item.line, found=phrases[0])
    title, description, scene = (cells[name].strip() for name in ("Answer.title", "Answer.description", "Input.scene"))
    return record(item, "description", title, description, scene=normal_name(scene), **_who(cells, salt))


_GARBLED = re.compile("(?:\u00c3[\u0080-\u00bf\u0152-\u2122]|\u00e2\u20ac[\u0080-\u2122]|\u00c2[\u00a0-\u00bf])[^ ]*")


def _garbled(text: str) -> str:
    """Return the first word that is UTF-8 decoded as Windows-1252, or ""; only a word that decodes back counts."""
    match = _GARBLED.search(text)
    if match is None:
        return ""
    try:
        match[0].encode("cp1252").decode("utf-8")
    except UnicodeError:
        return ""
    return match[0][:40]


def _program(item: Item, cells: dict[str, str], salt: str) -> IngestedRow | Reject:
    if not cells["Answer.program"].strip():
        return _empty(item, ["Answer.program"])
    text = cells["Answer.program"]
    described = cells["Input.description_id"].strip()
    return record(
        item,
        "program",
        cells["Input.title"].strip(),
        cells["Input.description"].strip(),
        description_id=f"{_origin(cells)}:{described}" if described else "",
        rooms=_quantities(cells["Answer.rooms"]),
        props=_quantities(cells["Answer.props"]),
        text=text if text.endswith("\n") else text + "\n",
        line=item.line - 1,
        **_who(cells, salt),
    )


class _Who(TypedDict):
    origin: str
    worker: str | None
    platform: str | None
    style: str | None


def _who(cells: dict[str, str], salt: str) -> _Who:
    """Return the source of an answer: a crowd's worker, as a salted hash, and the platform; none for a written text."""
    origin, worker, style = _origin(cells), cells["WorkerId"].strip(), cells.get("Style", "").strip() or None
    if origin == WRITTEN:
        return {"origin": origin, "worker": None, "platform": None, "style": style}
    hashed = worker_hash(worker, salt) if worker else None
    platform = next((cells[name].strip() for name in ("Platform", "platform") if cells.get(name)), None)
    return {"origin": origin, "worker": hashed, "platform": platform, "style": style}


def _empty(item: Item, columns: list[str]) -> Reject:
    return Reject.of(Code.EMPTY, f"an empty answer: {', '.join(columns)}", file=item.place, line=item.line)


def _quantities(text: str) -> list[QuantityRow]:
    found: list[QuantityRow] = []
    for piece in re.split(r"[,;\n]", text):
        match = _QUANTITY.fullmatch(piece)
        if match:
            found.append({"name": normal_name(match[1]), "quantity": int(match[2] or 1)})
    return found
