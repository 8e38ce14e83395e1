"""Prediction files: one row per id, with the predicted program and, unless in a separate file, the reference."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from hearth.datasets.format.ids import names_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.syntax import parse_steps
from hearth.scoring.line_reader import LineReader
from hearth.scoring.line_sequences import Lines, Reader, Source, read, steps_of
from hearth.scoring.prediction_rows import Named, Row, rows_of, source_of
from hearth.scoring.refused_rows import SHOWN, FirstFaults

EXAMPLE = '{"id": "p1", "predicted": "[Walk] <kitchen> (1)", "reference": ["[Walk] <kitchen> (1)"]}'


@dataclass(frozen=True, slots=True)
class Pair:
    """One id's prediction and reference.

    Attributes:
        id: as in the file.
        predicted: the lines of the prediction; None if it is missing.
        reference: the lines of the reference; none without one.
        line: the prediction's line (or row of a Parquet file), from 1; 0 if it is missing.
        more: the other fields of the prediction's row.
        referenced: whether there is a reference.
        fuzzy: steps of the prediction in which words were corrected or left out.
    """

    id: str
    predicted: Lines | None
    reference: Lines
    line: int = 0
    more: Mapping[str, Any] = field(default_factory=dict, compare=False)
    referenced: bool = True
    fuzzy: int = 0


def read_pairs(
    path: Path,
    references: Path | Mapping[str, Source] | None = None,
    reader: Reader = parse_steps,
    named: Named | None = None,
    rejects: FirstFaults | None = None,
    alone: bool = False,
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
        rejects: gets the faults of rows, which are left out; without it they are raised.
        alone: whether a prediction needs no reference. A row without an id then has its line as its id.

    Raises:
        HearthError: unreadable files, missing columns, rows that are not objects, duplicate and unknown ids; each with
            the file and its line.
    """
    faults = FirstFaults() if rejects is None else rejects
    if references is None:
        columns = ("id", "predicted") if alone else ("id", "predicted", "reference")
        rows = _rows(path, columns, faults, numbered=alone)
        pairs = [pair for row in rows if (pair := _whole(row, path, reader, faults, alone))]
    else:
        known = _references(references, reader, faults)
        rows = _unique((_as_known(row, known) for row in _rows(path, ("id", "predicted"), faults, named)), path, faults)
        for row, fault in _unknown_ids(rows, known, path):
            faults.append(fault, row.id)
        by_id = {row.id: row for row in rows}
        pairs = [
            (_pair(by_id[name], lines, path, reader, faults) if name in by_id else None) or Pair(name, None, lines)
            for name, lines in known.items()
        ]
    if faults and (rejects is None or not any(pair.line for pair in pairs)):
        raise HearthError(faults)
    return pairs


def _as_known(row: Row, known: Mapping[str, Lines]) -> Row:
    """Return the row under the id of its reference, which may be of another version."""
    return replace(row, id=next((name for name in names_of(row.id) if name in known), row.id))


def _references(references: Path | Mapping[str, Source], reader: Reader, faults: FirstFaults) -> dict[str, Lines]:
    if isinstance(references, Path):
        rows = _rows(references, ("id", "reference"), faults)
        found = {row.id: _program(row, "reference", references, reader) for row in rows}
        for row in rows:
            if isinstance(fault := found[row.id], Diagnostic):
                faults.append(fault, row.id)
        return {name: lines for name, lines in found.items() if not isinstance(lines, Diagnostic)}
    return {name: read(source, reader) for name, source in references.items()}


def _rows(
    path: Path, columns: Sequence[str], faults: FirstFaults, named: Named | None = None, numbered: bool = False
) -> list[Row]:
    """Return the rows of a file with unique ids; faults of the others are added to `faults`."""
    rows = _unique(rows_of(path, columns, faults, named, numbered), path, faults)
    if not rows and not faults:
        raise HearthError.of(Code.EMPTY, "no predictions", file=str(path), suggestion=f"write rows like {EXAMPLE}")
    return rows


def _unique(found: Iterable[Row], path: Path, faults: FirstFaults) -> list[Row]:
    """Return the first row of each id; the others are faults."""
    rows: dict[str, Row] = {}
    for row in found:
        first = rows.setdefault(row.id, row)
        if first is not row:
            message = f"a second row of id `{row.id}`; the first is line {first.line}"
            fault = Diagnostic(Code.DUPLICATE, message, str(path), row.line, suggestion="keep one row an id")
            faults.append(fault, row.id)
    return list(rows.values())


def _whole(row: Row, path: Path, reader: Reader, faults: FirstFaults, alone: bool) -> Pair | None:
    """Return the pair of a row with its own reference, or without one; None if the row is refused."""
    if alone and row.values.get("reference") is None:
        return _pair(row, None, path, reader, faults)
    reference = _program(row, "reference", path, reader)
    if isinstance(reference, Diagnostic):
        faults.append(reference, row.id)
        return None
    return _pair(row, reference, path, reader, faults)


def _pair(row: Row, reference: Lines | None, path: Path, reader: Reader, faults: FirstFaults) -> Pair | None:
    more = {key: value for key, value in row.values.items() if key not in ("id", "predicted", "reference")}
    before = reader.fuzzy if isinstance(reader, LineReader) else 0
    predicted = None if row.values["predicted"] is None else _program(row, "predicted", path, reader)
    fuzzy = reader.fuzzy - before if isinstance(reader, LineReader) else 0
    if isinstance(predicted, Diagnostic):
        faults.append(predicted, row.id)
        return None
    return Pair(row.id, predicted, reference or (), row.line, more, reference is not None, fuzzy)


def _program(row: Row, column: str, path: Path, reader: Reader) -> Lines | Diagnostic:
    source = source_of(row.values[column])
    lines = () if source is None else read(source, reader)
    found = type(row.values[column]).__name__ if source is None else "text without a step" if lines else ""
    if source is None or (column == "reference" and found and not steps_of(lines)):
        message = f"`{column}` of id `{row.id}` is {found}, not a program"
        return Diagnostic(Code.BAD_TABLE, message, str(path), row.line, suggestion="a text, or a list of steps")
    return lines


def _unknown_ids(rows: Iterable[Row], known: Mapping[str, Lines], path: Path) -> Iterator[tuple[Row, Diagnostic]]:
    from difflib import get_close_matches

    unknown = [row for row in rows if row.id not in known]
    for number, row in enumerate(unknown):
        # Searching similar names is slow among many ids; faults that are not shown need none.
        near = get_close_matches(row.id, known, n=1) if number < SHOWN else []
        example = f", as `{next(iter(known))}`" if known else ""
        suggestion = f"did you mean `{near[0]}`?" if near else f"ids are those of the references{example}"
        message = f"no reference has the id `{row.id}`"
        yield row, Diagnostic(Code.UNKNOWN_ID, message, str(path), row.line, suggestion=suggestion)
