"""Places of a text's lines in its file: a text file, a cell, or a string in JSON."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hearth.schemas.diagnostics import Diagnostic


@dataclass(frozen=True, slots=True)
class TextPlaces:
    """The place of each line of a text in its file.

    Attributes:
        before: lines of the file before the text, where its lines are lines of the file.
        starts: for a text that is not: line and column (from 1) in the file at which each of its lines begins; or, for
            a line with escapes, or made of several pieces, triples: from this character on (counted from 0), it stands
            at that line and column. What is before the first was put there by a reader. A line beyond them stands
            where the last one does.
    """

    before: int = 0
    starts: Sequence[Sequence[int]] = ()

    def place(self, row: int, column: int = 1) -> tuple[int, int]:
        """Return line and column in the file of a column of a line of the text, both from 1."""
        if not self.starts:
            return self.before + row, column
        jumps, index = self._jumps(row), max(column, 1) - 1
        at, line, first = next((jump for jump in reversed(jumps) if jump[0] <= index), jumps[0])
        return line, first + max(index - at, 0)

    def line(self, row: int) -> int:
        """Return the line in the file of a line of the text."""
        return self.place(row)[0] if row else 0

    def placed(self, fault: Diagnostic) -> Diagnostic:
        """Return a fault whose line counts from 1 in the text, moved to its place in the file."""
        if not fault.line:
            return fault
        line, column = self.place(fault.line, fault.column)
        if not self.starts:
            return replace(fault, line=line)
        if not fault.column:
            return replace(fault, line=line, source="")
        last, end = self.place(fault.line, fault.column + fault.length)
        length = max(end - column, min(fault.length, 1)) if last == line else fault.length
        # What a reader has put before the line is not shown.
        added = self._jumps(fault.line)[0][0]
        added = added if fault.column > added else 0
        cut = max(added - fault.before, 0)
        before = max(column - (fault.column - fault.before - cut), 0)
        return replace(fault, line=line, column=column, length=length, source=fault.source[cut:], before=before)

    def _jumps(self, row: int) -> list[tuple[int, int, int]]:
        start = self.starts[min(row, len(self.starts)) - 1]
        if len(start) == 2:
            return [(0, start[0], start[1])]
        return list(zip(start[::3], start[1::3], start[2::3], strict=True))
