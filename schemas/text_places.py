"""Where the lines of a text stand in the file that it was taken from: a text file, or a cell, or a string in JSON."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hearth.schemas.diagnostics import Diagnostic


@dataclass(frozen=True, slots=True)
class TextPlaces:
    """The place of each line of a text in its file.

    Attributes:
        before: lines of the file before the text, where its lines are lines of the file.
        starts: for a text that is not: line and column (from 1) in the file at which each of its lines begins. A line
            beyond them stands where the last one does.
    """

    before: int = 0
    starts: Sequence[tuple[int, int]] = ()

    def place(self, row: int, column: int = 1) -> tuple[int, int]:
        """Return line and column in the file of a column of a line of the text, both from 1."""
        if not self.starts:
            return self.before + row, column
        line, first = self.starts[min(row, len(self.starts)) - 1]
        return line, first + max(column, 1) - 1

    def placed(self, fault: Diagnostic) -> Diagnostic:
        """Return a fault whose line counts from 1 in the text, moved to its place in the file."""
        if not fault.line:
            return fault
        line, column = self.place(fault.line, fault.column)
        return replace(fault, line=line, column=column if fault.column else 0)
