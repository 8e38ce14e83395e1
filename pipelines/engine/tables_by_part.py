"""Tables whose rows descend from programs: each part of `programs.split` has files of its own, as programs have.

A row is in its program's part, so that a row of `test` descends from no program of `train`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from pathlib import Path

import pyarrow as pa

from hearth.datasets.format.ids import stamp
from hearth.datasets.format.splits import SHARES, share_of
from hearth.schemas.row_types import Row
from hearth.storage.batch_sizes import ROWS_OF_A_PART
from hearth.storage.partitions import part_path, table_writer


def write_split_rows(
    folder: Path,
    table: str,
    schema: pa.Schema,
    rows: Iterable[tuple[str | None, Row]],
    versions: Mapping[str, str] = stamp(),
) -> None:
    """Write the rows of a table, each stamped with its versions, to the file of its part.

    Args:
        folder: of the dataset.
        table: its name.
        schema: its columns.
        rows: each with the part of its program; None for a program without one.
        versions: the columns of the versions that every row belongs to.
    """
    with ExitStack() as files:
        names = [share_of(table, share) for share in SHARES]
        shares = {name: _Share(files, part_path(folder, name, 0), schema) for name in names}
        for part, row in rows:
            shares[share_of(table, part)].add({**row, **versions})
        for share in shares.values():
            share.flush()


class _Share:
    """The file of a part, with the rows that wait to be written."""

    def __init__(self, files: ExitStack, path: Path, schema: pa.Schema) -> None:
        self._write: Callable[[pa.RecordBatch], None] = files.enter_context(table_writer(path, schema))
        self._schema, self._waiting = schema, list[Row]()

    def add(self, row: Row) -> None:
        self._waiting.append(row)
        if len(self._waiting) >= ROWS_OF_A_PART:
            self.flush()

    def flush(self) -> None:
        if self._waiting:
            self._write(pa.RecordBatch.from_pylist(self._waiting, self._schema))
            self._waiting = []
