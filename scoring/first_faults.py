"""The first faults of each kind, and how many more: a file of a million bad rows is as bad as one of twenty."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code

SHOWN = 20
"""Faults of one kind that are kept; the rest are counted."""


class FirstFaults:
    """Faults of the rows of a file; memory does not grow with their number."""

    def __init__(self) -> None:
        self._kept: list[Diagnostic] = []
        self._counts: Counter[Code] = Counter()
        self._files: dict[Code, str] = {}

    def __bool__(self) -> bool:
        return bool(self._kept)

    def append(self, fault: Diagnostic) -> None:
        """Add one."""
        self._counts[fault.code] += 1
        self._files.setdefault(fault.code, fault.file)
        if self._counts[fault.code] <= SHOWN:
            self._kept.append(fault)

    def extend(self, faults: Iterable[Diagnostic]) -> None:
        """Add several."""
        for fault in faults:
            self.append(fault)

    def __iter__(self) -> Iterator[Diagnostic]:
        """The kept ones, and for each kind the number of further ones."""
        yield from self._kept
        for code, count in self._counts.items():
            if count > SHOWN:
                yield Diagnostic(code, f"and {count - SHOWN:,} more of this kind", self._files[code])
