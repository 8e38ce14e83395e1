"""Crowd-sourcing batches: CSV of both stages (thesis 3.3), worker ids replaced by salted hashes."""

from __future__ import annotations

import csv
import hashlib
import io
import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass

from hearth.pipelines.crowd.topics import no_activity
from hearth.pipelines.readers.item import LARGEST_FILE, Item, fault_of, lines, record, refused
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.rows import IngestedRow, QuantityRow
from hearth.schemas.syntax import normal_name
from hearth.storage.archives import Place
from hearth.storage.rejects import Reject

NAME = "crowd"

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

LONGEST_RECORD = 2_000
"""Lines of one answer at most: a longer one has a quote that is never closed, and reading continues after its line."""

LONGEST_ANSWER = 2_000_000
"""Characters of one answer at most, likewise."""

_ACCEPTED = frozenset({"approved", "submitted", "accepted", ""})
_LOOK_AHEAD = 200
_DELIMITERS = ",;\t"
_QUANTITY = re.compile(r"\s*<?([^*<>]+?)>?\s*(?:\*\s*(\d{1,6}))?\s*")


@dataclass(frozen=True, slots=True)
class Header:
    """A batch's first line: columns, delimiter, stage (1 or 2) and missing columns."""

    columns: tuple[str, ...]
    delimiter: str
    stage: int
    missing: tuple[str, ...]


def header_of(line: str) -> Header | None:
    """Read a first line; None if it is not the header of a batch."""
    delimiter = max(_DELIMITERS, key=line.count)
    columns = tuple(cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), []))
    names = set(columns)
    lacking = [(len(set(wanted) - names), stage) for stage, wanted in ((1, DESCRIPTIONS), (2, PROGRAMS))]
    _, stage = min(lacking)
    wanted = DESCRIPTIONS if stage == 1 else PROGRAMS
    if not any(name in names for name in wanted if name.startswith(("Input.", "Answer."))):
        return None
    return Header(columns, delimiter, stage, tuple(name for name in wanted if name not in names))


def scan(path: Place, place: str) -> Iterator[Item]:
    """One item for each answer of a batch."""
    rows = _Rows(path)
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


def _answers(rows: _Rows, header: Header, place: str) -> Iterator[Item]:
    empty = True
    for line, raw, cells in rows.parsed(header):
        fault = _row_fault(line, raw, cells, header, place)
        empty = empty and not fault and not cells
        if fault:
            yield refused(place, Reject((fault,)), line=line)
        elif cells:
            values = dict(zip(header.columns, cells, strict=False))
            record_id = f"{NAME}:{values['HITId'].strip() or f'{place}:{line}'}"
            yield Item(record_id, NAME, place, {"stage": header.stage, "cells": values}, line=line)
    if empty:
        yield refused(place, Reject.of(Code.EMPTY, "a batch with its first line only", file=place, line=1))


def _row_fault(line: int, raw: str, cells: list[str] | None, header: Header, place: str) -> Diagnostic | None:
    if cells is None:
        message = "cells that can't be separated: a quote that is never closed, or too many cells"
        suggestion = "quote cells that hold separators or line breaks, and double the quotes inside"
        return Diagnostic(Code.BAD_TABLE, message, place, line, found=raw[:60], suggestion=suggestion)
    if len(cells) != len(header.columns) and cells:
        message = f"{len(cells)} cells where the table has {len(header.columns)} columns"
        suggestion = "quote cells that hold separators or line breaks"
        return Diagnostic(Code.BAD_TABLE, message, place, line, found=raw[:60], suggestion=suggestion)
    return fault_of(raw, place, line)


class _Rows(Iterator[tuple[int, str]]):
    """A file's lines with their numbers; lines can be put back."""

    def __init__(self, path: Place) -> None:
        self._source = enumerate((line for line, _ in lines(path)), 1)
        self._again: list[tuple[int, str]] = []

    def __next__(self) -> tuple[int, str]:
        return self._again.pop() if self._again else next(self._source)

    def parsed(self, header: Header) -> Iterator[tuple[int, str, list[str] | None]]:
        """Each record: its first line's number, its text and its cells; None for cells that can't be separated."""
        for number, line in self:
            taken = self._record(number, line, header)
            text = "\n".join(piece for _, piece in taken)
            cells = _cells(text, header) if _even(taken) or len(taken) == 1 else None
            if len(taken) > 1 and (cells is None or len(cells) != len(header.columns)):
                # An open quote takes in the records after it: put back the lines from the next whole record on.
                ahead = [*taken, *itertools.islice(self, _LOOK_AHEAD)]
                keep = next((k for k in range(1, len(taken)) if _whole(ahead[k:], header)), len(taken))
                self._again.extend(reversed(ahead[keep:]))
                text = "\n".join(piece for _, piece in taken[:keep])
                cells = None
            yield number, text, cells

    def _record(self, number: int, line: str, header: Header) -> list[tuple[int, str]]:
        """The lines of the record that begins here, according to its quotes."""
        taken = [(number, line)]
        odd, size = line.count('"') % 2 == 1, len(line)
        if odd and _whole(taken, header):
            return taken
        while odd and len(taken) < LONGEST_RECORD and size <= LONGEST_ANSWER and (more := next(self, None)):
            taken.append(more)
            size += len(more[1])
            odd ^= more[1].count('"') % 2 == 1
        return taken


def _even(taken: list[tuple[int, str]]) -> bool:
    return sum(piece.count('"') for _, piece in taken) % 2 == 0


def _whole(taken: list[tuple[int, str]], header: Header) -> bool:
    """Whether these lines begin with a record of the right number of cells."""
    text = ""
    for _, piece in taken[:_LOOK_AHEAD]:
        text += piece
        try:
            return len(_cells(text, header, strict=True)) == len(header.columns)
        except csv.Error:
            text += "\n"
    return False


def _cells(text: str, header: Header, strict: bool = False) -> list[str]:
    csv.field_size_limit(LARGEST_FILE)
    return next(csv.reader(io.StringIO(text, newline=""), delimiter=header.delimiter, strict=strict), [])


def read(item: Item, salt: str) -> IngestedRow | Reject:
    """The record of an answer, or the reject of an answer that is not used."""
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
    worker, platform = _who(cells, salt)
    return record(item, "description", title, description, scene=normal_name(scene), worker=worker, platform=platform)


_GARBLED = re.compile("(?:\u00c3[\u0080-\u00bf\u0152-\u2122]|\u00e2\u20ac[\u0080-\u2122]|\u00c2[\u00a0-\u00bf])[^ ]*")


def _garbled(text: str) -> str:
    """The first word that is UTF-8 decoded as Windows-1252, or ""; only a word that decodes back counts."""
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
    worker, platform = _who(cells, salt)
    return record(
        item,
        "program",
        cells["Input.title"].strip(),
        cells["Input.description"].strip(),
        description_id=f"{NAME}:{described}" if described else "",
        worker=worker,
        platform=platform,
        rooms=_quantities(cells["Answer.rooms"]),
        props=_quantities(cells["Answer.props"]),
        text=text if text.endswith("\n") else text + "\n",
        line=item.line - 1,
    )


def _who(cells: dict[str, str], salt: str) -> tuple[str | None, str | None]:
    """The worker, as a salted hash, and the platform."""
    worker = cells["WorkerId"].strip()
    hashed = hashlib.blake2b(f"{salt}\0{worker}".encode(), digest_size=8).hexdigest() if worker else None
    return hashed, next((cells[name].strip() for name in ("Platform", "platform") if cells.get(name)), None)


def _empty(item: Item, columns: list[str]) -> Reject:
    return Reject.of(Code.EMPTY, f"an empty answer: {', '.join(columns)}", file=item.place, line=item.line)


def _quantities(text: str) -> list[QuantityRow]:
    found: list[QuantityRow] = []
    for piece in re.split(r"[,;\n]", text):
        match = _QUANTITY.fullmatch(piece)
        if match:
            found.append({"name": normal_name(match[1]), "quantity": int(match[2] or 1)})
    return found
