"""Ids that occur twice in a table, found in little memory."""

from array import array
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq


def repeated(folder: Path, column: str) -> str | None:
    """Return the first, by name, of the values that a column of a table has twice; None if all differ.

    Of each value its hash of 64 bits is kept. Values of one hash are compared themselves: two may have the same.

    Args:
        folder: of the table's Parquet files.
        column: of texts.
    """
    hashes = np.array(array("q", map(hash, _values(folder, column))))
    hashes.sort()
    twice = {*hashes[1:][hashes[1:] == hashes[:-1]].tolist()}
    if not twice:
        return None
    counts = Counter(value for value in _values(folder, column) if hash(value) in twice)
    return min((value for value, count in counts.items() if count > 1), default=None)


def _values(folder: Path, column: str) -> Iterator[str]:
    for path in sorted(folder.glob("*.parquet")):
        with pq.ParquetFile(path) as file:
            for batch in file.iter_batches(columns=[column]):
                yield from batch.column(0).to_pylist()
