"""Answers to questions as files: CSV, tab-separated, JSON and Parquet, a batch of rows in memory at a time."""

from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from itertools import chain
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import IO, Any

import orjson
import pyarrow.compute as pc
import pyarrow.parquet as pq
import pyarrow.types as kinds

from hearth.datasets.damage_faults import using
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.exact_types import FILE, exactly
from hearth.datasets.places_outside import check_outside
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.batch_sizes import ROWS_OF_AN_ANSWER
from hearth.storage.chosen_files import writing
from hearth.storage.csv_files import rows_writer
from hearth.storage.names import numbered


def plain(value: Any) -> Any:
    """Return a value of DuckDB's for JSON; a value without a form there, such as a number over 64 bits, as text."""
    if isinstance(value, dict):
        return {str(key): plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, bytes):
        return _bytes(value)
    if isinstance(value, Decimal):
        return plain(int(value)) if value.as_tuple().exponent == 0 else _fraction(value)
    kept = value is None or isinstance(value, str) or (isinstance(value, float) and isfinite(value))
    return value if kept or (isinstance(value, int) and abs(value) < 2**63) else str(value)


def _fraction(value: Decimal) -> float | str:
    """Return a number as JSON's readers have it; as text, where they would round it."""
    near = float(value)
    return near if Decimal(repr(near)) == value else str(value)


def _bytes(value: bytes) -> str:
    """Return bytes as DuckDB writes them: `ab\\x00`."""
    return "".join(chr(each) if 31 < each < 127 and each not in b"\"'\\" else f"\\x{each:02X}" for each in value)


def line_of(value: Any) -> Any:
    """Return a value for a cell: nested ones as JSON."""
    if isinstance(value, bytes):
        return _bytes(value)
    return orjson.dumps(plain(value)).decode() if isinstance(value, list | dict | tuple) else value


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

    No cell of text is a formula to a spreadsheet, or moves a terminal's cursor: see `storage.csv_files.rows_writer`.

    Raises:
        HearthError: as of `Dataset.sql`.
    """
    columns, batches = dataset.batches(query, ROWS_OF_AN_ANSWER, **asked)
    write, number, first = rows_writer(to, separator), 0, next(batches, None)
    write([distinct(columns)])
    for batch in () if first is None else chain([first], batches):
        write(zip(*(_each(column, line_of) for column in batch.columns), strict=True))
        number += batch.num_rows
    return number


def _each(column: Any, form: Callable[[Any], Any]) -> Any:
    """Return the values of a column in a form; what every form leaves as it is, is not looked at one by one."""
    kind, values = column.type, column.to_pylist()
    kept = kinds.is_signed_integer(kind) or kinds.is_boolean(kind) or kinds.is_string(kind)
    kept = kept or (kinds.is_floating(kind) and pc.all(pc.is_finite(column)).as_py() is not False)
    return values if kept else map(form, values)


def _records(columns: list[str], batch: Any) -> list[dict[str, Any]]:
    """Return the rows of a batch as JSON has them."""
    rows = zip(*(_each(column, plain) for column in batch.columns), strict=True)
    return [dict(zip(columns, row, strict=True)) for row in rows]


def document(dataset: Dataset, query: str) -> Iterator[str]:
    """Yield an answer as the pieces of one indented JSON document, a batch of rows each.

    Raises:
        HearthError: as of `Dataset.rows`.
    """
    columns, batches = dataset.batches(query, ROWS_OF_AN_ANSWER)
    names, begun = distinct(columns), False
    for batch in batches:
        text = orjson.dumps(_records(names, batch), option=orjson.OPT_INDENT_2).decode()
        yield ("," if begun else "[") + text[1:-2]
        begun = True
    yield "\n]\n" if begun else "[]\n"


def _csv(dataset: Dataset, query: str, path: Path) -> int:
    with path.open("w", encoding="utf-8", newline="") as file:
        return write_separated(dataset, query, file)


def _tsv(dataset: Dataset, query: str, path: Path) -> int:
    with path.open("w", encoding="utf-8", newline="") as file:
        return write_separated(dataset, query, file, "\t")


def _json(dataset: Dataset, query: str, path: Path) -> int:
    columns, batches = dataset.batches(query, ROWS_OF_AN_ANSWER)
    names, number = distinct(columns), 0
    with path.open("wb") as file:
        for batch in batches:
            rows = b",\n".join(map(orjson.dumps, _records(names, batch)))
            file.write((b",\n" if number else b"[\n") + rows)
            number += batch.num_rows
        file.write(b"\n]\n" if number else b"[]\n")
    return number


def _parquet(dataset: Dataset, query: str, path: Path) -> int:
    reader = exactly(dataset.sql(query), FILE).to_arrow_reader(ROWS_OF_AN_ANSWER)
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
    check_outside(path, dataset.folder)
    with using(dataset.folder), writing(path) as temporary:
        return WRITERS[form](dataset, query, temporary)
