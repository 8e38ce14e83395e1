"""Answers to questions as files: CSV, tab-separated, JSON and Parquet, a batch of rows in memory at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from datetime import date, datetime, time
from decimal import Decimal
from pathlib import Path
from types import MappingProxyType
from typing import IO, Any

import orjson

from hearth.datasets.damage import using
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.catalog import without_zones
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.csv_files import writer_of
from hearth.storage.files import replacing
from hearth.storage.names import numbered

_BATCH = 2_048


def plain(value: Any) -> Any:
    """Return a value of DuckDB's for JSON; a value without a form there, such as a number over 64 bits, as text."""
    if isinstance(value, dict):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, Decimal):
        return float(value)
    kept = value is None or isinstance(value, str | float | datetime | date | time)
    return value if kept or (isinstance(value, int) and abs(value) < 2**63) else str(value)


def line_of(value: Any) -> Any:
    """A value for a cell: nested ones as JSON."""
    return orjson.dumps(plain(value)).decode() if isinstance(value, list | dict) else value


def distinct(columns: list[str]) -> list[str]:
    """Names of columns; of several of one name, the later ones with a number: `a~2`."""
    found: list[str] = []
    for name in columns:
        found.append(numbered(name, {*found, *columns}) if name in found else name)
    return found


def write_separated(
    dataset: Dataset, query: str, to: IO[str], separator: str = ",", asked: Mapping[str, Any] = MappingProxyType({})
) -> int:
    """Write an answer as lines of cells, and return how many rows it has.

    No cell of text is a formula to a spreadsheet, or moves a terminal's cursor: see `storage.csv_files.writer_of`.

    Raises:
        HearthError: as of `Dataset.sql`.
    """
    columns, rows = dataset.batches(query, _BATCH, **asked)
    write = writer_of(to, separator)
    write(distinct(columns))
    number = 0
    for number, row in enumerate(rows, 1):  # noqa: B007 - the last number is the count
        write([line_of(cell) for cell in row])
    return number


def _csv(dataset: Dataset, query: str, path: Path) -> int:
    with path.open("w", encoding="utf-8", newline="") as file:
        return write_separated(dataset, query, file)


def _tsv(dataset: Dataset, query: str, path: Path) -> int:
    with path.open("w", encoding="utf-8", newline="") as file:
        return write_separated(dataset, query, file, "\t")


def _json(dataset: Dataset, query: str, path: Path) -> int:
    columns, rows = dataset.batches(query, _BATCH)
    names, number = distinct(columns), 0
    with path.open("wb") as file:
        for number, row in enumerate(rows, 1):
            file.write(b"[\n" if number == 1 else b",\n")
            file.write(orjson.dumps(dict(zip(names, map(plain, row), strict=True))))
        file.write(b"\n]\n" if number else b"[]\n")
    return number


def _parquet(dataset: Dataset, query: str, path: Path) -> int:
    import pyarrow.parquet as pq

    reader = without_zones(dataset.sql(query)).to_arrow_reader(_BATCH)
    number = 0
    with pq.ParquetWriter(path, reader.schema) as file:
        for batch in reader:
            file.write_batch(batch)
            number += batch.num_rows
    return number


WRITERS: dict[str, Callable[[Dataset, str, Path], int]] = {
    ".csv": _csv,
    ".tsv": _tsv,
    ".json": _json,
    ".parquet": _parquet,
}
"""Writers of answers by the ending of a file's name; each returns the number of rows."""

_ENDINGS = f"let the file end in {', '.join(WRITERS)}"


def write_answer(dataset: Dataset, query: str, path: Path, form: str = "") -> int:
    """Write an answer into a file, which is there whole or not at all.

    Args:
        dataset: that is asked.
        query: the question.
        path: the file; one of before is replaced.
        form: of `WRITERS`; by default the ending of the file's name.

    Raises:
        HearthError: as of `Dataset.sql`; UNSUPPORTED_FILE, where the name ends in none of `WRITERS`; UNWRITABLE.
    """
    form = form or path.suffix.lower()
    if form not in WRITERS:
        message = f"an answer is not written as `{form}`" if form else "its name has no ending that says how"
        raise HearthError.of(Code.UNSUPPORTED_FILE, message, file=str(path), suggestion=_ENDINGS)
    if path.is_dir() or not path.absolute().parent.is_dir():
        remedy = "name a file in a folder that there is"
        raise HearthError.of(Code.UNWRITABLE, "no file can be written there", file=str(path), suggestion=remedy)
    with using(dataset.folder), replacing(path) as temporary:
        return WRITERS[form](dataset, query, temporary)
