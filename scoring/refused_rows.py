"""Rows that are refused: the first fault of each kind with a count, since a million bad rows are as bad as one."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code

SHOWN = 20
"""Different faults of one code that are kept; the rest are counted."""

LISTED = 5
"""Lines of further rows with the same fault that are listed."""

_DIGITS = re.compile(r"\d+")


@dataclass(slots=True)
class _Group:
    """A fault that several rows have: the first one, the lines of the next ones, and how many more there are."""

    first: Diagnostic
    lines: list[int] = field(default_factory=list)
    more: int = 0

    def add(self, line: int) -> None:
        self.more += 1
        if line and len(self.lines) < LISTED:
            self.lines.append(line)

    def shown(self) -> Diagnostic:
        if not self.more:
            return self.first
        lines = ", ".join(map(str, self.lines)) + (", ..." if self.more > len(self.lines) else "")
        where = f": line{'s' * (self.more > 1)} {lines}" if self.lines else ""
        rows = f"{self.more:,} more row{'s' * (self.more > 1)}"
        return replace(self.first, message=f"{self.first.message} (and {rows}{where})")


class FirstFaults:
    """Faults of the rows of a file, equal ones counted; memory does not grow with their number.

    Attributes:
        rows: number of refused rows.
        notes: number of rows that are scored, but of which a part can't be read.
    """

    def __init__(self) -> None:
        self.rows = self.notes = 0
        self._groups: dict[tuple[Code, str, str, str], _Group] = {}
        self._kept: Counter[Code] = Counter()
        self._more: Counter[tuple[Code, str]] = Counter()

    def __bool__(self) -> bool:
        return bool(self.rows or self.notes)

    def append(self, fault: Diagnostic, name: str = "") -> None:
        """Add a row with one fault; see `reject`."""
        self.reject([fault], name)

    def extend(self, faults: Iterable[Diagnostic]) -> None:
        """Add several rows with one fault each."""
        for fault in faults:
            self.append(fault)

    def reject(self, faults: Iterable[Diagnostic], name: str = "", line: int = 0) -> None:
        """Add one row with all its faults.

        Args:
            faults: of the row.
            name: its id; messages that differ in it alone are the same fault.
            line: of the row, for faults that do not name it.
        """
        self.rows += 1
        self._add(faults, name, line)

    def note(self, faults: Iterable[Diagnostic], name: str = "", line: int = 0) -> None:
        """Add the faults of a part of a row that is scored without it; `reject` has the arguments."""
        self.notes += 1
        self._add(faults, name, line)

    def _add(self, faults: Iterable[Diagnostic], name: str, line: int) -> None:
        for fault in faults:
            words = _DIGITS.sub("#", fault.message.replace(f"`{name}`", "`"))
            key = fault.code, fault.file, words, fault.suggestion
            group = self._groups.get(key)
            if group:
                group.add(fault.line or line)
            elif self._kept[fault.code] < SHOWN:
                self._kept[fault.code] += 1
                self._groups[key] = _Group(fault)
            else:
                self._more[fault.code, fault.file] += 1

    def __iter__(self) -> Iterator[Diagnostic]:
        """Yield the different faults with their counts, and for each code the number of further ones."""
        yield from (group.shown() for group in self._groups.values())
        for (code, file), count in self._more.items():
            yield Diagnostic(code, f"and {count:,} more of this kind", file)
