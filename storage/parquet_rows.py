"""Rows of Parquet files of strangers, whose few bytes may stand for millions of rows, or for one text in all rows."""

from collections.abc import Iterator, Sequence
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.batch_sizes import ROWS_OF_STRANGERS
from hearth.storage.input_files import LARGEST_TABLE

HARMLESS_ROWS = 1_000_000
"""Rows that any file may have; more only if it has as many bytes: each row has an id of its own."""

MOST_PACKED = 200
"""Largest ratio of a file's contents to its size, once the contents exceed `LARGEST_TABLE` bytes."""

BATCH = ROWS_OF_STRANGERS
"""Its name in 0.2."""

_HELD = 64 << 20
"""Bytes that a column of such rows may take, if each row has the largest value that the column's part has room for."""


def row_lists(
    file: Any, packed: int, name: str, columns: Sequence[str] | None = None
) -> Iterator[list[dict[str, Any]]]:
    """Yield the rows of an opened Parquet file, some at a time.

    Args:
        file, packed, name, columns: those of `row_batches`.

    Raises:
        HearthError: FILE_TOO_LARGE: it unpacks to more than a table of its size does.
        ValueError: a value is none that Python has, as a date in the year 300,000; or not text.
        pyarrow.ArrowException: it is damaged.
    """
    for batch in row_batches(file, packed, name, columns):
        try:
            yield batch.to_pylist()
        except OverflowError as error:
            raise ValueError(f"a date or time out of range: {error}") from error


def row_batches(file: Any, packed: int, name: str, columns: Sequence[str] | None = None) -> Iterator[Any]:
    """Yield the rows of an opened Parquet file as `pyarrow.RecordBatch`es.

    Args:
        file: a `pyarrow.parquet.ParquetFile`.
        packed: its size in bytes.
        name: of the file, in errors.
        columns: those that are read; all if None.

    Raises:
        HearthError: FILE_TOO_LARGE: it unpacks to more than a table of its size does.
        pyarrow.ArrowException: it is damaged.
    """
    check_rows(file.metadata.num_rows, packed, name)
    unpacked = 0
    for batch in file.iter_batches(_at_once(file.metadata), columns=None if columns is None else list(columns)):
        unpacked += batch.nbytes
        if unpacked > max(LARGEST_TABLE, MOST_PACKED * packed):
            raise _too_large(f"{packed:,} bytes that unpack to more than {unpacked:,}", name)
        yield batch


def check_rows(rows: int, packed: int, name: str) -> None:
    """Refuse a file of few bytes that says it has very many rows.

    Raises:
        HearthError: FILE_TOO_LARGE.
    """
    if rows > max(HARMLESS_ROWS, packed):
        raise _too_large(f"{packed:,} bytes that unpack to {rows:,} rows", name)


def _at_once(footer: Any) -> int:
    """Return how many rows are read at a time: a text that a part has once, all its rows may have."""
    # Of whole row groups: to ask for the parts of a column ends the process if their statistics are damaged.
    sizes = [footer.row_group(number).total_byte_size for number in range(footer.num_row_groups)]
    return int(max(1, min(ROWS_OF_STRANGERS, _HELD // max(1, *sizes, 1))))


def _too_large(message: str, name: str) -> HearthError:
    return HearthError.of(Code.FILE_TOO_LARGE, message, file=name, suggestion="write it anew, without repetitions")
