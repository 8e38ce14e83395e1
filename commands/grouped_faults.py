"""Faults that repeat: equal ones are printed once, with their number and their other places."""

import re
import sys
from collections.abc import Callable, Hashable, Iterable
from typing import TextIO

from hearth.commands import output
from hearth.kb.language.line_diagnostics import TRANSLATE
from hearth.schemas.diagnostics import Diagnostic

PLACES = 5
"""Other places of a fault that are named."""

NODE = re.compile(r"\w+ \(\d+\)")
"""A node of a graph in a message: `cup (12)`."""


def in_order(faults: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return faults by file, line and column."""
    return sorted(faults, key=place_of)


def place_of(fault: Diagnostic) -> tuple[str, int, int]:
    """Return file, line and column of a fault."""
    return fault.file, fault.line, fault.column


def equal(fault: Diagnostic) -> Hashable:
    """Return the common key of equal faults, with the words at fault; lines of another language are one fault."""
    start = max(0, fault.column - fault.before - 1)
    words = "" if fault.suggestion == TRANSLATE else fault.source[start : start + fault.length]
    return fault.code, fault.message, fault.suggestion, words


def alike(fault: Diagnostic) -> Hashable:
    """Return the common key of faults of different nodes of a graph: all but `cup (12)`."""
    return fault.code, *(NODE.sub("", text) for text in (fault.message, fault.suggestion))


def groups(faults: Iterable[Diagnostic], key: Callable[[Diagnostic], Hashable] = equal) -> list[list[Diagnostic]]:
    """Return faults in groups that share a key, in the order of the first of each."""
    found: dict[Hashable, list[Diagnostic]] = {}
    for fault in faults:
        found.setdefault(key(fault), []).append(fault)
    return list(found.values())


def report(
    faults: Iterable[Diagnostic],
    stream: TextIO | None = None,
    kind: str = "error",
    key: Callable[[Diagnostic], Hashable] = equal,
) -> None:
    """Print the first fault of each group in full, and where the others are."""
    for first, *others in groups(faults, key):
        output.report([first], stream, kind)
        if others:
            output.line(f"    + {len(others):,} more: {_places(first, others)}", file=stream or sys.stderr)


def report_together(found: Iterable[tuple[str, Diagnostic]], stream: TextIO) -> None:
    """Print faults, each with its kind, as `report` does: equal ones of a kind once, in the order of the first."""
    kept: dict[Hashable, tuple[str, list[Diagnostic]]] = {}
    for kind, fault in found:
        kept.setdefault((kind, equal(fault)), (kind, []))[1].append(fault)
    for kind, group in kept.values():
        report(group, stream, kind)


def _places(first: Diagnostic, others: list[Diagnostic]) -> str:
    """Name some places, the file only where it differs from that of the place before; nodes where there is no line."""
    file, named = first.file, []
    for fault in others[:PLACES]:
        node = None if fault.line else NODE.search(fault.message)
        where = node[0] if node else fault.place()
        named.append(where.removeprefix(f"{file}:") if fault.line and fault.file == file else where)
        file = fault.file
    return output.shown(", ".join(named) + (", ..." if len(others) > PLACES else ""))


def summary(kinds: Iterable[tuple[str, list[Diagnostic]]]) -> None:
    """Print a row for each code of errors and of warnings: how many, in how many files, and one of them."""
    rows = [
        (
            kind,
            first.code,
            1 + len(others),
            len({fault.file for fault in (first, *others)}),
            first.place(),
            first.message,
        )
        for kind, faults in kinds
        for first, *others in sorted(groups(faults, lambda fault: fault.code), key=len, reverse=True)
    ]
    if rows:
        output.table(("", "code", "faults", "files", "first", "which says"), rows)
