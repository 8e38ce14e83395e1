"""CSV that people open in a spreadsheet: a cell of theirs must not run there as a formula."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable

_RUNS = ("=", "+", "-", "@", "\t", "\r")


def safe_cell(text: str) -> str:
    """The text, with an apostrophe before what a spreadsheet would take for a formula."""
    return f"'{text}" if text.startswith((*_RUNS, "'")) else text


def cell_said(text: str) -> str:
    """The inverse of `safe_cell`; a spreadsheet that took the apostrophe away has done it already."""
    return text[1:] if text.startswith("'") else text


def sheet_of(rows: Iterable[Iterable[object]]) -> str:
    """Rows as CSV; text cells are made safe, numbers are numbers."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    for row in rows:
        writer.writerow([safe_cell(cell) if isinstance(cell, str) else cell for cell in row])
    return out.getvalue()
