"""`diff`: the differences between two datasets."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output
from hearth.commands.time_limits import WITHIN

if TYPE_CHECKING:
    from hearth.datasets.diff import TableDifference


def diff(
    first: Path, second: Path, rows: int = 5, strict: bool = False, as_json: bool = False, within: float = WITHIN
) -> None:
    """Print the differences between two datasets, by table and by row.

    \b
    Example:
      hearth diff data_out yesterday/data_out --rows 20
    """
    from hearth.commands.bounded_process import in_time
    from hearth.datasets.diff import compare

    with in_time(within):
        found = compare(first, second, rows or None)
    if as_json:
        output.emit([_json(each) for each in found])
    elif not found:
        output.line("no differences")
    else:
        columns = ["table", f"only in {first}", f"only in {second}", "changed"]
        output.table(columns, [[each.table, *each.counts] for each in found])
        output.line()
        for each in found:
            output.line("\n".join(_lines(each)))
    output.status(len(found), strict=strict)


def _lines(found: TableDifference) -> Iterator[str]:
    yield from (f"- {found.table} {_key(key)}" for key in found.only_first)
    yield from (f"+ {found.table} {_key(key)}" for key in found.only_second)
    yield from (f"~ {found.table} {_key(each.key)}: {', '.join(each.columns)}" for each in found.changed)


def _key(key: tuple[Any, ...]) -> str:
    """Return the key of a row, as far as it is short."""
    return " ".join(str(value) for value in key if value is not None and not isinstance(value, list))


def _json(found: TableDifference) -> dict[str, Any]:
    kinds = ("only_first", "only_second", "changed")
    rows = {kind: getattr(found, kind) for kind in kinds}
    return {"table": found.table, "counts": dict(zip(kinds, found.counts, strict=True)), **rows}
