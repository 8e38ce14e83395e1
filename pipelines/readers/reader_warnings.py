"""Warnings of readers: what a reader decided about a record, kept with it until its program is checked."""

from collections.abc import Mapping, Sequence
from typing import Any

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.row_types import WarningRow

KEY = "warnings of the reader"
"""The key of a record that holds them, as lists of a line, a message and a remedy."""

ORDERED = "the steps are ordered by their numbers"
IN_ORDER = "number them in the order in which they are done"


def warned(record: Mapping[str, Any], more: Sequence[Sequence[Any]]) -> dict[str, Any]:
    """Return a record with more warnings."""
    return {**record, KEY: [*record.get(KEY, ()), *map(list, more)]} if more else {**record}


def rows_of(found: Any) -> list[WarningRow]:
    """Return warnings as rows; leave out anything else under their key."""
    listed = found if isinstance(found, list) else []
    return [
        _row(*each) for each in listed if isinstance(each, list) and [type(part) for part in each] == [int, str, str]
    ]


def _row(line: int, message: str, remedy: str) -> WarningRow:
    code = str(Code.AMBIGUOUS)
    return {"code": code, "line": line, "column": 0, "found": "", "message": message, "suggestion": remedy}


def diagnostics(rows: Sequence[WarningRow] | None, place: str) -> tuple[Diagnostic, ...]:
    """Return the warnings of an ingested row."""
    return tuple(
        Diagnostic(Code[row["code"]], row["message"], place, row["line"], suggestion=row["suggestion"])
        for row in rows or ()
    )
