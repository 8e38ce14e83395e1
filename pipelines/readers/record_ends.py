"""Ends of the records of a table as text, by their quotes: each line is parsed once, however often it is asked for.

A quote that is never closed takes in the lines after it, and each of them may begin the next record. What follows an
open quote at the beginning of a line is the same for all records that come to it: it is found once, and remembered.
"""

from __future__ import annotations

import csv
from collections.abc import Callable
from typing import NamedTuple

LOOK_AHEAD = 200
"""Most lines of a record that is looked for after a broken one."""

_REMEMBERED = 4096
"""Lines whose parses are kept."""


class _Run(NamedTuple):
    """Cells from the beginning of a line, up to the beginning of a later line.

    Attributes:
        after: the number of that later line.
        cells: how many cells it has, the open ones at its two ends among them; 0: they can't be separated.
        open: whether the last cell goes on in the next line.
    """

    after: int
    cells: int
    open: bool


class RecordEnds:
    """The sizes of the records of a table, by the lines on which they begin.

    Args:
        line_at: returns the line with a number, None after the last.
        delimiter: between cells.
    """

    def __init__(self, line_at: Callable[[int], str | None], delimiter: str) -> None:
        self._line_at, self._delimiter = line_at, delimiter
        self._inside: dict[int, _Run] = {}

    def cells(self, number: int, lines: int = LOOK_AHEAD) -> int:
        """Return the number of cells of the record on a line; 0 if the record needs more lines than these."""
        run = self._parsed(number, "")
        run = run if not run.open or lines == 1 else self._followed(run, number + lines)
        return 0 if run.open or run.after > number + lines else run.cells

    def _followed(self, first: _Run, limit: int) -> _Run:
        """Extend a run, whose last cell is open, to the end of the record or to the limit."""
        passed, run = [], first
        while run.open and run.after < limit:
            at = run.after
            more = self._inside.get(at) or self._parsed(at, '"')
            passed.append((at, run.cells - 1))
            run = _Run(more.after, more.cells and run.cells - 1 + more.cells, more.open)
        if len(self._inside) > _REMEMBERED:
            self._inside.clear()
        for at, before in passed:  # the next record that comes to one of these lines goes on from the end at once
            self._inside[at] = _Run(run.after, run.cells and run.cells - before, run.open)
        return run

    def _parsed(self, number: int, before: str) -> _Run:
        """Return the run of one line, which begins inside of quotes where `before` is one."""
        line = self._line_at(number)
        if line is None:
            return _Run(number, 0, False)
        for end in ("", '"'):
            try:
                cells = next(csv.reader([f"{before}{line}{end}"], delimiter=self._delimiter, strict=True), [])
            except csv.Error:
                continue
            return _Run(number + 1, len(cells), bool(end))
        return _Run(number + 1, 0, False)
