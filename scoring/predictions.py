"""Prediction files: one row per id, with the predicted program and, unless in a separate file, the reference."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from hearth.datasets.format.ids import names_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.syntax import parse_steps
from hearth.scoring.first_faults import SHOWN, FirstFaults
from hearth.scoring.lines import Lines, Reader, Source, read, steps_of
from hearth.scoring.prediction_rows import Named, Row, rows_of, source_of

EXAMPLE = '{"id": "p1", "predicted": "[Walk] <kitchen> (1)", "reference": ["[Walk] <kitchen> (1)"]}'


@dataclass(frozen=True, slots=True)
class Pair:
    """One id's prediction and reference.

    Attributes:
        id: as in the file.
        predicted: the lines of the prediction; None if it is missing.
        reference: the lines of the reference; None without one.
        line: the prediction's line (or row of a Parquet file), from 1; 0 if it is missing.
        more: the other fields of the prediction's row.
    """

    id: str
    predicted: Lines | None
    reference: Lines | None
    line: int = 0
    more: Mapping[str, Any] = field(default_factory=dict, compare=False)


def read_pairs(
    path: Path,
    references: Path | Mapping[str, Source] | None = None,
    reader: Reader = parse_steps,
    named: Named | None = None,
) -> list[Pair]:
    """Read predictions with their references.

    A file is JSON Lines or Parquet with the columns `id` (text or number), `predicted` and `reference`; each program is
    a text or a list of steps. `predicted` may be null: that prediction is missing, and scores 0.

    Args:
        path: the predictions.
        references: a file of `id` and `reference`, or programs by id, if the predictions' file has none. Ids of the
            references only are missing predictions; pairs are in the references' order.
        reader: reads one line of a program; pass another for natural-language steps.
        named: gives the ids of a row without `id`, by its other columns.

    Raises:
        HearthError: unreadable files, missing columns, rows that are not objects, duplicate and unknown ids; each with
            the file and its line.
    """
    faults = FirstFaults()
    if references is None:
        rows = _rows(path, ("id", "predicted", "reference"), faults)
        pairs = [_pair(row, _program(row, "reference", path, reader, faults), path, reader, faults) for row in rows]
    else:
        known = _references(references, reader, faults)
        rows = _unique((_as_known(row, known) for row in _rows(path, ("id", "predicted"), faults, named)), path, faults)
        faults.extend(_unknown_ids(rows, known, path))
        by_id = {row.id: row for row in rows}
        pairs = [
            _pair(by_id[name], lines, path, reader, faults) if name in by_id else Pair(name, None, lines)
            for name, lines in known.items()
        ]
    if faults:
        raise HearthError(faults)
    return pairs


def _as_known(row: Row, known: Mapping[str, Lines]) -> Row:
    """The row under the id of its reference, which may be of another version."""
    return replace(row, id=next((name for name in names_of(row.id) if name in known), row.id))


def _references(references: Path | Mapping[str, Source], reader: Reader, faults: FirstFaults) -> dict[str, Lines]:
    if isinstance(references, Path):
        rows = _rows(references, ("id", "reference"), faults)
        return {row.id: _program(row, "reference", references, reader, faults) for row in rows}
    return {name: read(source, reader) for name, source in references.items()}


def _rows(path: Path, columns: Sequence[str], faults: FirstFaults, named: Named | None = None) -> list[Row]:
    """The rows of a file with unique ids; faults of the others are added to `faults`."""
    rows = _unique(rows_of(path, columns, faults, named), path, faults)
    if not rows and not faults:
        raise HearthError.of(Code.EMPTY, "no predictions", file=str(path), suggestion=f"write rows like {EXAMPLE}")
    return rows


def _unique(found: Iterable[Row], path: Path, faults: FirstFaults) -> list[Row]:
    """The first row of each id; the others are faults."""
    rows: dict[str, Row] = {}
    for row in found:
        first = rows.setdefault(row.id, row)
        if first is not row:
            message = f"a second row of id `{row.id}`; the first is line {first.line}"
            faults.append(Diagnostic(Code.DUPLICATE, message, str(path), row.line, suggestion="keep one row an id"))
    return list(rows.values())


def _pair(row: Row, reference: Lines, path: Path, reader: Reader, faults: FirstFaults) -> Pair:
    more = {key: value for key, value in row.values.items() if key not in ("id", "predicted", "reference")}
    predicted = None if row.values["predicted"] is None else _program(row, "predicted", path, reader, faults)
    return Pair(row.id, predicted, reference, row.line, more)


def _program(row: Row, column: str, path: Path, reader: Reader, faults: FirstFaults) -> Lines:
    source = source_of(row.values[column])
    lines = () if source is None else read(source, reader)
    found = type(row.values[column]).__name__ if source is None else "text without a step" if lines else ""
    if source is None or (column == "reference" and found and not steps_of(lines)):
        message = f"`{column}` of id `{row.id}` is {found}, not a program"
        faults.append(Diagnostic(Code.BAD_TABLE, message, str(path), row.line, suggestion="a text, or a list of steps"))
    return lines


def _unknown_ids(rows: Iterable[Row], known: Mapping[str, Lines], path: Path) -> Iterator[Diagnostic]:
    from difflib import get_close_matches

    unknown = [row for row in rows if row.id not in known]
    for number, row in enumerate(unknown):
        # Searching similar names is slow among many ids; faults that are not shown need none.
        near = get_close_matches(row.id, known, n=1) if number < SHOWN else []
        example = f", as `{next(iter(known))}`" if known else ""
        suggestion = f"did you mean `{near[0]}`?" if near else f"ids are those of the references{example}"
        yield Diagnostic(
            Code.UNKNOWN_ID, f"no reference has the id `{row.id}`", str(path), row.line, suggestion=suggestion
        )
