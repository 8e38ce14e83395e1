"""Partitions on disk: Parquet files with their key and their counts in their metadata.

A partition is one `part-00000.parquet` for each of the stage's tables, and, where records were refused, a hidden
`.rejects-00000.parquet` that ends up in the stage's `rejects.parquet`. The part of the last table is renamed last and
carries the counts: a partition is complete when that file is there with the right key.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import orjson
import pyarrow as pa
import pyarrow.parquet as pq

from hearth.schemas.row_types import Row
from hearth.schemas.tables import REJECTED
from hearth.storage.batch_sizes import ROWS_OF_A_GROUP, ROWS_READ
from hearth.storage.files import TEMPORARY, commit

ROW_GROUP = ROWS_OF_A_GROUP
READ_BATCH = ROWS_READ
"""The names of both in 0.2."""
_META = b"hearth"


@dataclass(slots=True)
class Counts:
    """Counts of records by outcome. `records_in = through + rejected` always, and every reject has its code counted.

    Attributes:
        records_in: records read.
        through: records that gave at least one row.
        rejected: records refused whole.
        partial: parts refused of records that went on.
        rows: rows written, by table, whatever the share.
        codes: why records were refused whole.
        tally: the stage's own counts of its rows.
    """

    records_in: int = 0
    through: int = 0
    rejected: int = 0
    partial: int = 0
    rows: Counter[str] = field(default_factory=Counter)
    codes: Counter[str] = field(default_factory=Counter)
    tally: Counter[str] = field(default_factory=Counter)

    def add(self, other: Counts) -> None:
        """Count another partition too."""
        self.records_in += other.records_in
        self.through += other.through
        self.rejected += other.rejected
        self.partial += other.partial
        for mine, theirs in ((self.rows, other.rows), (self.codes, other.codes), (self.tally, other.tally)):
            mine.update(theirs)

    def check(self, where: str) -> None:
        """Assert that nothing vanished."""
        if self.records_in != self.through + self.rejected or self.rejected != self.codes.total():
            message = f"{where}: {self.records_in} records in, {self.through} through, {self.rejected} rejected"
            raise AssertionError(message)

    def to_json(self) -> dict[str, Any]:
        """Plain values, reasons commonest first."""
        value = asdict(self)
        for name in ("rows", "codes", "tally"):
            value[name] = dict(sorted(getattr(self, name).items(), key=lambda item: (-item[1], item[0])))
        return value

    @classmethod
    def from_json(cls, value: Mapping[str, Any]) -> Counts:
        """Return the inverse of `to_json`."""
        counters: dict[str, Any] = {name: Counter(value[name]) for name in ("rows", "codes", "tally")}
        numbers = {name: value[name] for name in ("records_in", "through", "rejected", "partial")}
        return cls(**numbers, **counters)


def part_path(folder: Path, table: str, number: int) -> Path:
    """Return where partition `number` of a table stands; a stage with one table has its parts in its own folder.

    A table in several files has one for each share: that of `programs.test` is `programs/part-00000.test.parquet`.
    """
    name, *share = table.split(".")
    return folder / name / f"{'.'.join([f'part-{number:05d}', *share])}.parquet"


def rejects_path(folder: Path, number: int) -> Path:
    """Return where the rejects of a partition wait until the stage is complete."""
    return folder / f".rejects-{number:05d}.parquet"


def read_rows(path: Path, columns: list[str] | None = None) -> Iterator[Any]:
    """Yield the rows of a Parquet file, or of them these columns; a batch in memory at a time."""
    with pq.ParquetFile(path) as file:
        for batch in file.iter_batches(batch_size=ROWS_READ, columns=columns):
            yield from batch.to_pylist()


def part_state(folder: Path, tables: Iterable[str], number: int) -> tuple[str, Counts] | None:
    """Key and counts of a partition that is complete; None otherwise."""
    paths = [part_path(folder, table, number) for table in tables]
    try:
        states = [orjson.loads(pq.read_metadata(path).metadata[_META]) for path in paths]
    except (OSError, pa.ArrowInvalid, KeyError, TypeError, orjson.JSONDecodeError):
        return None
    if len({state["key"] for state in states}) != 1:
        return None
    return states[-1]["key"], Counts.from_json(states[-1]["counts"])


class PartWriter:
    """Writes one partition; nothing of it is seen under its name before `finish`."""

    def __init__(self, folder: Path, tables: Mapping[str, pa.Schema], number: int, key: str) -> None:
        self.folder, self.tables, self.number, self.key = folder, tables, number, key
        self._files: dict[str, _File] = {}
        self._rejects: list[Row] = []
        for table, schema in tables.items():
            path = part_path(folder, table, number)
            path.parent.mkdir(parents=True, exist_ok=True)
            self._files[table] = _File(path, schema)

    def write(self, table: str, batch: pa.RecordBatch) -> None:
        """Add rows to a table."""
        self._files[table].write(batch)

    def reject(self, rows: Iterable[Row]) -> None:
        """Add rows to the rejects."""
        self._rejects.extend(rows)

    def finish(self, counts: Counts) -> None:
        """Put everything in place, the last table's part last."""
        if self._rejects:
            rejects = _File(rejects_path(self.folder, self.number), REJECTED)
            rejects.write(pa.RecordBatch.from_pylist(self._rejects, schema=REJECTED))
            rejects.finish({})
        else:
            rejects_path(self.folder, self.number).unlink(missing_ok=True)
        state = {"key": self.key, "counts": counts.to_json()}
        for file in self._files.values():
            file.finish({_META: orjson.dumps(state)})

    def abandon(self) -> None:
        """Leave nothing behind."""
        for file in self._files.values():
            file.abandon()


class _File:
    """One Parquet file under a temporary name."""

    def __init__(self, path: Path, schema: pa.Schema) -> None:
        self.path, self.schema = path, schema
        self.temporary = path.with_name(f".{path.name}.{os.getpid()}{TEMPORARY}")
        self._writer = pq.ParquetWriter(self.temporary, schema, compression="zstd", compression_level=3)
        self._waiting: list[pa.RecordBatch] = []

    def write(self, batch: pa.RecordBatch) -> None:
        self._waiting.append(batch)
        if sum(len(waiting) for waiting in self._waiting) >= ROWS_OF_A_GROUP:
            self._flush()

    def _flush(self) -> None:
        if self._waiting:
            self._writer.write_table(pa.Table.from_batches(self._waiting, self.schema))
            self._waiting.clear()

    def finish(self, metadata: Mapping[bytes, bytes]) -> None:
        self._flush()
        self._writer.add_key_value_metadata(dict(metadata))
        self._writer.close()
        commit(self.temporary, self.path)

    def abandon(self) -> None:
        self._writer.close()
        self.temporary.unlink(missing_ok=True)


def write_table(path: Path, table: pa.Table) -> None:
    """Write a small table whole, in the stages' way."""
    write_batches(path, table.schema, table.to_batches(ROWS_OF_A_GROUP))


def write_batches(path: Path, schema: pa.Schema, batches: Iterable[pa.RecordBatch]) -> None:
    """Write a table of which some batches are in memory at a time, in the stages' way; each is a row group.

    Until the file is finished its footer is in memory, a kilobyte or so for each group and column.
    """
    with table_writer(path, schema) as write:
        for batch in batches:
            write(batch)


@contextmanager
def table_writer(path: Path, schema: pa.Schema) -> Iterator[Callable[[pa.RecordBatch], None]]:
    """Give a function that adds a batch to a table; the file is seen when the block ends, and never after an error."""
    path.parent.mkdir(parents=True, exist_ok=True)
    file = _File(path, schema)
    try:
        yield file.write
    except BaseException:
        file.abandon()
        raise
    file.finish({})
