"""Tables as text, with commas, semicolons or tabs: rows found by their quotes, so that a broken one costs no other."""

from __future__ import annotations

import csv
import io
import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from hearth.pipelines.readers.reader_items import LARGEST_FILE, fault_of, lines
from hearth.pipelines.readers.record_ends import RecordEnds
from hearth.pipelines.readers.texts_with_positions import text_at
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.storage.archives import Place
from hearth.storage.csv_files import delimiter_of

LONGEST_RECORD = 2_000
"""Lines of one row at most: a longer row has a quote that is never closed, and reading continues after its line."""

LONGEST_ANSWER = 2_000_000
"""Characters of one row at most, likewise."""

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
        below, column, found = unclosed(raw, layout)
        return Diagnostic(Code.BAD_TABLE, message, place, line + below, column, found=found[:60], suggestion=suggestion)
    if len(cells) != len(layout.columns) and cells:
        message = f"{len(cells)} cells where the table has {len(layout.columns)} columns"
        suggestion = "quote cells that hold separators or line breaks"
        return Diagnostic(Code.BAD_TABLE, message, place, line, found=raw[:60], suggestion=suggestion)
    return fault_of(raw, place, line)


def unclosed(text: str, layout: Layout) -> tuple[int, int, str]:
    """Return where the quote opens that is never closed: lines below the first, the column, and the line.

    The first line, without a column, where every quote is closed.
    """
    at = 0
    while at < len(text):
        end = _CELL[text.startswith('"', at)](layout.delimiter).match(text, at)
        if end is None:
            first = text.rfind("\n", 0, at) + 1
            return text.count("\n", 0, at), at - first + 1, text[first:].partition("\n")[0]
        at = end.end() + 1
    return 0, 0, text.partition("\n")[0]


class Rows(Iterator[tuple[int, str]]):
    """A file's lines with their numbers; lines can be put back, and looked at before their turn."""

    def __init__(self, path: Place) -> None:
        self._source = (line for line, _ in lines(path))
        self._waiting: dict[int, str] = {}
        self._next = self._unread = 1

    def __next__(self) -> tuple[int, str]:
        number, line = self._next, self._line_at(self._next)
        if line is None:
            raise StopIteration
        del self._waiting[number]
        self._next += 1
        return number, line

    def _line_at(self, number: int) -> str | None:
        """Return a line that has not been taken yet."""
        while self._unread <= number:
            line = next(self._source, None)
            if line is None:
                return None
            self._waiting[self._unread] = line
            self._unread += 1
        return self._waiting[number]

    def put_back(self, number: int, line: str) -> None:
        """Give the line before the next once more."""
        self._next, self._waiting[number] = number, line

    def parsed(self, layout: Layout) -> Iterator[tuple[int, str, list[str] | None]]:
        """Each record: its first line's number, its text and its cells; None for cells that can't be separated."""
        ends, wanted = RecordEnds(self._line_at, layout.delimiter), len(layout.columns)
        while (first := self._line_at(self._next)) is not None:
            number = self._next
            count, even = 1, first.count('"') % 2 == 0
            if not even and ends.cells(number, 1) != wanted:
                count, even = self._extent(first)
            text = self._text(number, count) if count > 1 else first
            cells = cells_of(text, layout) if even or count == 1 else None
            if count > 1 and (cells is None or len(cells) != wanted):
                # An open quote takes in the records after it: go on at the next line that begins a whole record.
                count = next((k for k in range(1, count) if ends.cells(number + k) == wanted), count)
                text, cells = self._text(number, count), None
            for _ in itertools.islice(self, count):
                pass
            yield number, text, cells

    def _extent(self, first: str) -> tuple[int, bool]:
        """Return how many lines the record with this first line has by its quotes, and whether they are all closed."""
        count, size, odd = 1, len(first), True
        while odd and count < LONGEST_RECORD and size <= LONGEST_ANSWER:
            more = self._line_at(self._next + count)
            if more is None:
                break
            count, size = count + 1, size + len(more)
            odd ^= more.count('"') % 2 == 1
        return count, not odd

    def _text(self, number: int, count: int) -> str:
        return "\n".join(self._waiting[number + k] for k in range(count))


def cells_of(text: str, layout: Layout) -> list[str]:
    """Return the cells of a record."""
    return next(csv.reader(io.StringIO(text, newline=""), delimiter=layout.delimiter), [])


def cells_at(text: str, cells: list[str], line: int, layout: Layout) -> list[str]:
    """Return the cells of a record that begins on this line, with their places; one that can't be found has none."""
    found: list[str] = []
    at = begins = 0
    for cell in cells:
        quoted = text.startswith('"', at)
        end = _CELL[quoted](layout.delimiter).match(text, at)
        raw = end[1] if end else ""
        if end is None or (raw.replace('""', '"') if quoted else raw) != cell:
            return [*found, *(text_at(rest, line, 1, rest) for rest in cells[len(found) :])]
        first = end.start(1)
        found.append(text_at(cell, line, first - begins + 1, raw, '""'))
        if quoted and (breaks := raw.count("\n")):
            line, begins = line + breaks, first + raw.rfind("\n") + 1
        at = end.end() + 1
    return found


@cache
def _quoted_cell(delimiter: str) -> re.Pattern[str]:
    return re.compile(rf'"((?:[^"]|"")*+)"(?={re.escape(delimiter)}|\r?(?:\n|\Z))')


@cache
def _plain_cell(delimiter: str) -> re.Pattern[str]:
    return re.compile(rf"([^{re.escape(delimiter)}\n]*)")


_CELL = {True: _quoted_cell, False: _plain_cell}
