"""Tables from a spreadsheet or a program: CSV whose first line names the columns."""

import csv
import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import IO

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.terminal import CONTROLS, escaped
from hearth.schemas.text_decoding import decode
from hearth.storage.input_files import LARGEST, read_input

LONGEST = 131_072
"""Characters of a cell: the usual limit of `csv`, which readers of corpora raise for the whole process."""

DELIMITERS = ",;\t|"


def delimiter_of(line: str) -> str:
    """Return the separator of a table's cells, by its first line: the most frequent of `DELIMITERS`."""
    return max(DELIMITERS, key=line.count)


_RUNS = ("=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠")
"""Beginnings of formulas; spreadsheets of East Asian languages take the wide forms for the narrow ones."""

_SKIPPED = " \ufeff\u200b\u200c\u200d\u2060\u00a0"
"""Characters in front of a formula that a spreadsheet does not show, or takes for the mark of a file's beginning."""

_UNSEEN = {code: escaped(code) for code in CONTROLS if chr(code) not in "\t\n"}
"""A carriage return is escaped too: readers take one that stands alone, even within quotes, for the end of a row."""


def safe_cell(text: str) -> str:
    """Return the text, with an apostrophe in front if a spreadsheet would read it as a formula."""
    seen = text.lstrip(_SKIPPED)
    return f"'{text}" if seen.startswith((*_RUNS, "'")) else text


def rows_writer(file: IO[str], delimiter: str = ",") -> Callable[[Iterable[Iterable[object]]], object]:
    """Return a function that writes rows of cells as lines.

    Spreadsheets read every cell as text (`safe_cell`); characters that would move a terminal's cursor are escaped.
    """
    writer = csv.writer(file, delimiter=delimiter, lineterminator="\n")
    return lambda rows: writer.writerows(
        [_safe(cell) if isinstance(cell, str) else cell for cell in row] for row in rows
    )


def _safe(text: str) -> str:
    cell = safe_cell(text)
    return cell if cell.isprintable() else cell.translate(_UNSEEN)


class CsvTable:
    """A table of a file.

    Args:
        path: the file.
        columns: those that it must have; `name*` is a column that begins so, as one with an explanation.
        largest: bytes of the file, at most.

    Raises:
        HearthError: as of `read_input`; NOT_TEXT; BAD_TABLE: a column is missing.
    """

    def __init__(self, path: Path, columns: Sequence[str], largest: int = LARGEST) -> None:
        text = decode(read_input(path, largest), str(path))
        if isinstance(text, Diagnostic):
            raise HearthError(text)
        self._path = path
        self._rows = csv.DictReader(
            io.StringIO(text, newline=""), delimiter=delimiter_of(text.partition("\n")[0]), restval=""
        )
        try:
            names = self._rows.fieldnames or []
        except csv.Error as error:
            raise self._fault(f"not CSV: {error}", 1) from error
        self._columns = {each: _column(each, names) for each in columns}
        if missing := [f"`{each.removesuffix('*')}`" for each, name in self._columns.items() if name is None]:
            raise self._fault(f"the table lacks the column {', '.join(missing)}", 1)

    def rows(self) -> Iterator[tuple[int, tuple[str, ...]]]:
        """Yield the line in which each row ends, and its cells in the order of `columns`; a row at a time is in memory.

        Raises:
            HearthError: BAD_TABLE with the line: a quote that is not closed, or a cell that is too long.
        """
        try:
            for row in self._rows:
                cells = tuple(row[name] or "" for name in self._columns.values() if name is not None)
                if any(len(cell) > LONGEST for cell in cells):
                    raise self._fault(f"a cell has more than {LONGEST:,} characters", self._rows.line_num)
                yield self._rows.line_num, cells
        except csv.Error as error:
            raise self._fault(f"not CSV: {error}", self._rows.reader.line_num) from error

    def _fault(self, message: str, line: int) -> HearthError:
        return HearthError(Diagnostic(Code.BAD_TABLE, message, str(self._path), line))


def _column(wanted: str, names: Sequence[str]) -> str | None:
    begins = wanted.removesuffix("*")
    return next((name for name in names if name == wanted or (begins != wanted and name.startswith(begins))), None)
