"""Distance fields of floors on disk: made beforehand, one file a floor, read where they lie and shared by processes.

A file is named for its floor, so that every home with that floor finds it, and a home that is changed does not. The
content of a file is compared with the floor before it is used: the ways are always the shortest.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.motion.navigation import Field, Ways
from hearth.storage.files import replacing
from hearth.storage.names import inside

VARIABLE = "HEARTH_WAYS"
"""Environment variable with the folder of stored ways."""

_ROUNDING = 1e-9
Ends = tuple[int, ...]


def folder() -> Path:
    """Return where ways are stored: in `HEARTH_WAYS`, else next to our homes."""
    given = os.environ.get(VARIABLE)
    return Path(given) if given else Path(__file__).resolve().parents[2] / "data_raw/homes/ways"


def file_of(ways: Ways, place: Path) -> Path:
    """Return the file of a floor in a folder."""
    return inside(place, f"{ways.digest}.arrow")


def store(ways: Ways, every: Iterable[Ends], place: Path) -> Path:
    """Make the fields to some ends and write them.

    Args:
        ways: over the floor.
        every: the ends of each field, as `Ground.stands` gives them.
        place: the folder; made where it is not there.

    Raises:
        HearthError: UNWRITABLE.
    """
    import pyarrow as pa

    rows = [(ends, ways.field(ends)) for ends in sorted(set(every))]
    schema = _schema(len(ways.cells))
    columns = [
        pa.array([ends for ends, _ in rows], schema.field("ends").type),
        *(
            pa.FixedSizeListArray.from_arrays(
                pa.array(np.concatenate([np.asarray(getattr(field, name)) for _, field in rows])), len(ways.cells)
            )
            for name in ("distance", "following")
        ),
    ]
    file = file_of(ways, place)
    try:
        place.mkdir(parents=True, exist_ok=True)
        with replacing(file) as temporary, pa.OSFile(str(temporary), "wb") as sink, pa.ipc.new_file(sink, schema) as to:
            to.write_batch(pa.RecordBatch.from_arrays(columns, schema=schema))
    except OSError as error:
        remedy = f"name another folder in {VARIABLE}"
        raise HearthError.of(Code.UNWRITABLE, error.strerror or str(error), file=str(file), suggestion=remedy) from None
    return file


def _schema(cells: int) -> Any:
    import pyarrow as pa

    numbers = {"distance": pa.float64(), "following": pa.int32()}
    lists = [pa.field(name, pa.list_(kind, cells), nullable=False) for name, kind in numbers.items()]
    return pa.schema([pa.field("ends", pa.list_(pa.int32()), nullable=False), *lists])


class StoredWays:
    """The stored fields of a floor; none where there is no file, or one that is not of this version.

    Args:
        ways: over the floor.
        place: the folder; the usual one where None.
    """

    def __init__(self, ways: Ways, place: Path | None = None) -> None:
        self._ways = ways
        file = file_of(ways, place or folder())
        self._columns = _read(file, len(ways.cells)) if file.is_file() else None
        ends = self._columns["ends"].to_pylist() if self._columns is not None else []
        self._row: Mapping[Ends, int] = {tuple(each): row for row, each in enumerate(ends)}

    def field(self, ends: Ends) -> Field | None:
        """Return the field to some ends; None where it is not stored, or is not true."""
        row = self._row.get(ends)
        if row is None or self._columns is None:
            return None
        size = len(self._ways.cells)
        distance, following = (
            self._columns[name].values.to_numpy(zero_copy_only=True)[row * size : (row + 1) * size]
            for name in ("distance", "following")
        )
        true = _are_shortest(self._ways, ends, distance, following)
        return Field(memoryview(distance), memoryview(following)) if true else None


def _read(file: Path, cells: int) -> Any:
    """Return the columns of a file, mapped into memory; None where it has other ones."""
    import pyarrow as pa

    try:
        found = pa.ipc.open_file(pa.memory_map(str(file)))
        if found.schema != _schema(cells) or found.num_record_batches != 1:
            return None
        batch = found.get_batch(0)
        batch.validate(full=True)
    except (OSError, pa.ArrowException):
        return None
    return {name: batch.column(name) for name in batch.schema.names}


def _are_shortest(ways: Ways, ends: Ends, distance: np.ndarray, following: np.ndarray) -> bool:
    """Return whether these are the shortest ways.

    Each step leads to a neighbor at the stored length, and no neighbor has a shorter way.
    """
    at, there = np.fromiter(ends, np.int64), np.isfinite(distance)
    if not len(at) or (at < 0).any() or (at >= len(distance)).any() or np.isnan(distance).any():
        return False
    source, target, length = ways.edges
    if (distance[at] != 0).any() or (following[at] >= 0).any() or (there[source] != there[target]).any():
        return False
    known = there[source]
    gaps = np.abs(distance[source[known]] - distance[target[known]]) - length[known]
    moving = there.copy()
    moving[at] = False
    cells = np.flatnonzero(moving)
    after = following[cells]
    if (gaps > _ROUNDING).any() or (after < 0).any() or (after >= len(distance)).any():
        return False
    steps = distance[cells] - distance[after] - _lengths(ways, cells, after)
    return bool((np.abs(steps) <= _ROUNDING).all())


def _lengths(ways: Ways, cells: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Metres of each step from a cell to another; nan where they are not neighbours, or a corner is in between."""
    (i, j), (k, m) = ways.cells[cells].T, ways.cells[after].T
    far = np.maximum(np.abs(i - k), np.abs(j - m))
    free = (far == 1) & (ways.number[i, m] >= 0) & (ways.number[k, j] >= 0)
    found: np.ndarray = np.where(free, np.hypot(i - k, j - m) * ways.floor.cell, np.nan)
    return found
