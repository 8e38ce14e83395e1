"""Rows of a JSON Lines or Parquet file of programs by id."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.text_decoding import decode
from hearth.scoring.line_sequences import Source
from hearth.scoring.refused_rows import FirstFaults
from hearth.storage.input_files import LARGEST_TABLE, read_input

PARQUET = b"PAR1"
"""First bytes of a Parquet file, whatever its name."""


@dataclass(frozen=True, slots=True)
class Row:
    """One row with its id as text, and its line."""

    id: str
    values: Mapping[str, Any]
    line: int


Named = Callable[[Mapping[str, Any]], Sequence[str]]
"""Gives the ids of a row without `id` by its other columns; empty if it lacks them too."""


def rows_of(
    path: Path, columns: Sequence[str], faults: FirstFaults, named: Named | None = None, numbered: bool = False
) -> Iterator[Row]:
    """Yield the rows with all of these columns, the first of which is the id.

    Faults of other rows are added to `faults`.

    Args:
        path: JSON Lines or Parquet.
        columns: required columns.
        faults: gets the faults of rows.
        named: gives the ids of rows without one.
        numbered: whether a row without an id has its line as its id.

    Raises:
        HearthError: the file is missing, or is neither JSON Lines nor Parquet.
    """
    data = read_input(path, LARGEST_TABLE)
    needed = columns[1:] if named or numbered else columns
    records = _parquet(path, len(data), needed) if data.startswith(PARQUET) else _json_lines(data, path, faults)
    for line, row in records:
        given = {columns[0]: line, **row} if numbered else row
        values, *more = _with_ids(given, columns[0], named)
        missing = [name for name in columns if name not in values]
        yield from (Row(each[columns[0]], each, line) for each in more if not missing)
        if missing:
            listed = ", ".join(f"`{name}`" for name in missing)
            faults.append(_fault(path, line, f"no {listed}", "every row needs " + ", ".join(columns)))
            continue
        name = values[columns[0]]
        if isinstance(name, bool) or not isinstance(name, str | int) or name == "":
            faults.append(_fault(path, line, f"`{columns[0]}` is {repr(name)[:60]}", "a text or a whole number"))
            continue
        yield Row(str(name), values, line)


def _with_ids(values: dict[str, Any], column: str, named: Named | None) -> list[dict[str, Any]]:
    """Return the row, once for each of its ids."""
    if named is None or column in values:
        return [values]
    return [{**values, column: name} for name in named(values)] or [values]


def has_predictions(path: Path) -> bool:
    """Return whether a file has rows of predictions; else it is read as programs, in any form."""
    import orjson

    data = read_input(path, LARGEST_TABLE)
    if data.startswith(PARQUET):
        return True
    for words in data.split(b"\n", HEAD)[:HEAD]:
        try:
            row = orjson.loads(words)
        except orjson.JSONDecodeError:
            continue
        if isinstance(row, dict) and ("predicted" in row or "reference" in row):
            return True
    return False


HEAD = 100
"""Lines of a file from which its contents are recognized."""


def source_of(value: Any) -> Source | None:
    """Return a value as a program: a text, or a list of texts and of steps as in the published tables; else None."""
    if isinstance(value, str):
        return value
    if not isinstance(value, list):
        return None
    steps = [item if isinstance(item, str) else _step(item) for item in value]
    known = [step for step in steps if step is not None]
    return known if len(known) == len(steps) else None


def _step(item: Any) -> Step | None:
    try:
        objects = tuple(
            ObjectRef(ref["name"], int(ref.get("instance") or 0), ref.get("node")) for ref in item.get("objects") or ()
        )
        step = Step(item["action"], objects, int(item.get("agent") or 0), bool(item.get("joins")))
    except (AttributeError, KeyError, TypeError, ValueError, OverflowError):
        return None
    named = all(isinstance(name, str) for name in (step.action, *(ref.name for ref in objects)))
    return step if named and all(ref.node is None or type(ref.node) is int for ref in objects) else None


def _json_lines(data: bytes, path: Path, faults: FirstFaults) -> Iterator[tuple[int, dict[str, Any]]]:
    import orjson

    text = decode(data, str(path))
    if isinstance(text, Diagnostic):
        raise HearthError(text)
    for line, words in enumerate(text.split("\n"), 1):
        if not words.strip():
            continue
        try:
            values = orjson.loads(words)
        except orjson.JSONDecodeError as error:
            faults.append(
                Diagnostic(Code.BAD_JSON, error.msg, str(path), line, error.colno, suggestion="one JSON object a line")
            )
            continue
        if isinstance(values, dict):
            yield line, values
        else:
            faults.append(_fault(path, line, f"a {type(values).__name__}, not an object", "one JSON object a line"))


def _parquet(path: Path, size: int, columns: Sequence[str]) -> Iterator[tuple[int, dict[str, Any]]]:
    import pyarrow as pa
    from pyarrow import parquet

    from hearth.storage.parquet_rows import row_lists

    try:
        table = parquet.ParquetFile(path)
        missing = [name for name in columns if name not in table.schema_arrow.names]
        if missing:
            listed = ", ".join(f"`{name}`" for name in missing)
            found = ", ".join(table.schema_arrow.names)
            raise HearthError(_fault(path, 0, f"no column {listed}", f"its columns are {found}"))
        line = 0
        for rows in row_lists(table, size, str(path)):
            for values in rows:
                line += 1
                yield line, values
    except (pa.ArrowException, ValueError, OSError) as error:
        message = f"not readable as Parquet: {error}".splitlines()[0]
        raise HearthError.of(Code.BAD_TABLE, message, file=str(path)) from None


def _fault(path: Path, line: int, message: str, suggestion: str) -> Diagnostic:
    return Diagnostic(Code.BAD_TABLE, message, str(path), line, suggestion=suggestion)
