"""Tables as text, with commas, semicolons or tabs: rows found by their quotes, so that a broken one costs no other."""

from __future__ import annotations

import csv
import io
import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from hearth.pipelines.readers.placed_texts import text_at
from hearth.pipelines.readers.reader_items import LARGEST_FILE, fault_of, lines
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.storage.archives import Place
from hearth.storage.csv_files import delimiter_of

LONGEST_RECORD = 2_000
"""Lines of one row at most: a longer row has a quote that is never closed, and reading continues after its line."""

LONGEST_ANSWER = 2_000_000
"""Characters of one row at most, likewise."""

_LOOK_AHEAD = 200

csv.field_size_limit(LARGEST_FILE)  # of the process: a cell is refused by the limits here, whatever was read before


@dataclass(frozen=True, slots=True)
class Layout:
    """The columns of a table and their separator."""

    columns: tuple[str, ...]
    delimiter: str


def layout_of(line: str, delimiter: str = "") -> Layout:
    """Read a first line; the most frequent delimiter is that of the table unless given."""
    delimiter = delimiter or delimiter_of(line)
    return Layout(tuple(cell.strip() for cell in next(csv.reader([line], delimiter=delimiter), [])), delimiter)


def row_fault(line: int, raw: str, cells: list[str] | None, layout: Layout, place: str) -> Diagnostic | None:
    """Return why a row can't be read."""
    if cells is None:
        message = "cells that can't be separated: a quote that is never closed, or too many cells"
        suggestion = "quote cells that hold separators or line breaks, and double the quotes inside"
        return Diagnostic(Code.BAD_TABLE, message, place, line, found=raw[:60], suggestion=suggestion)
    if len(cells) != len(layout.columns) and cells:
        message = f"{len(cells)} cells where the table has {len(layout.columns)} columns"
        suggestion = "quote cells that hold separators or line breaks"
        return Diagnostic(Code.BAD_TABLE, message, place, line, found=raw[:60], suggestion=suggestion)
    return fault_of(raw, place, line)


class Rows(Iterator[tuple[int, str]]):
    """A file's lines with their numbers; lines can be put back."""

    def __init__(self, path: Place) -> None:
        self._source = enumerate((line for line, _ in lines(path)), 1)
        self._again: list[tuple[int, str]] = []

    def __next__(self) -> tuple[int, str]:
        return self._again.pop() if self._again else next(self._source)

    def put_back(self, number: int, line: str) -> None:
        """Give a line once more."""
        self._again.append((number, line))

    def parsed(self, layout: Layout) -> Iterator[tuple[int, str, list[str] | None]]:
        """Each record: its first line's number, its text and its cells; None for cells that can't be separated."""
        for number, line in self:
            taken = self._record(number, line, layout)
            text = "\n".join(piece for _, piece in taken)
            cells = cells_of(text, layout) if _even(taken) or len(taken) == 1 else None
            if len(taken) > 1 and (cells is None or len(cells) != len(layout.columns)):
                # An open quote takes in the records after it: put back the lines from the next whole record on.
                ahead = [*taken, *itertools.islice(self, _LOOK_AHEAD)]
                keep = next((k for k in range(1, len(taken)) if _whole(ahead[k:], layout)), len(taken))
                self._again.extend(reversed(ahead[keep:]))
                text = "\n".join(piece for _, piece in taken[:keep])
                cells = None
            yield number, text, cells

    def _record(self, number: int, line: str, layout: Layout) -> list[tuple[int, str]]:
        """Return the lines of the record that begins here, according to its quotes."""
        taken = [(number, line)]
        odd, size = line.count('"') % 2 == 1, len(line)
        if odd and _whole(taken, layout):
            return taken
        while odd and len(taken) < LONGEST_RECORD and size <= LONGEST_ANSWER and (more := next(self, None)):
            taken.append(more)
            size += len(more[1])
            odd ^= more[1].count('"') % 2 == 1
        return taken


def _even(taken: list[tuple[int, str]]) -> bool:
    return sum(piece.count('"') for _, piece in taken) % 2 == 0


def _whole(taken: list[tuple[int, str]], layout: Layout) -> bool:
    """Return whether these lines begin with a record of the right number of cells."""
    text = ""
    for _, piece in taken[:_LOOK_AHEAD]:
        text += piece
        try:
            return len(cells_of(text, layout, strict=True)) == len(layout.columns)
        except csv.Error:
            text += "\n"
    return False


def cells_of(text: str, layout: Layout, strict: bool = False) -> list[str]:
    """Return the cells of a record.

    Raises:
        csv.Error: with `strict`, a quote that is never closed.
    """
    return next(csv.reader(io.StringIO(text, newline=""), delimiter=layout.delimiter, strict=strict), [])


def cells_at(text: str, cells: list[str], line: int, layout: Layout) -> list[str]:
    """Return the cells of a record that begins on this line, with their places; one that can't be found has none."""
    found: list[str] = []
    at = 0
    for cell in cells:
        quoted = text.startswith('"', at)
        end = _CELL[quoted](layout.delimiter).match(text, at)
        raw = end[1] if end else ""
        if end is None or (raw.replace('""', '"') if quoted else raw) != cell:
            return [*found, *(text_at(rest, line, 1, rest) for rest in cells[len(found) :])]
        first = end.start(1)
        breaks = text.count("\n", 0, first)
        column = first - text.rfind("\n", 0, first) if breaks else first + 1
        found.append(text_at(cell, line + breaks, column, raw, '""'))
        at = end.end() + 1
    return found


@cache
def _quoted_cell(delimiter: str) -> re.Pattern[str]:
    return re.compile(rf'"((?:[^"]|"")*+)"(?={re.escape(delimiter)}|\r?$)')


@cache
def _plain_cell(delimiter: str) -> re.Pattern[str]:
    return re.compile(rf"([^{re.escape(delimiter)}\n]*)")


_CELL = {True: _quoted_cell, False: _plain_cell}
