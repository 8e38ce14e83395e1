"""Limits on rows and texts of a stranger's dataset, before it is read whole: a few bytes may stand for millions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.tables import TABLES
from hearth.storage.parquet_rows import MOST_PACKED, check_rows

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset

MOST_TEXT = 256 << 20
"""Bytes of text of all programs, at most, unless the files are so large that they are `MOST_PACKED` times packed."""

_TEXTS = """SELECT coalesce(sum(strlen(title::VARCHAR) + strlen(description::VARCHAR)), 0) AS bytes,
    coalesce(sum(len(steps)), 0) AS steps FROM programs"""

OF_A_STEP = 64
"""Bytes that a step of a program is counted as."""


def check_unpacked(dataset: Dataset) -> None:
    """Refuse a dataset that unpacks to more than one of its size does.

    Raises:
        HearthError: FILE_TOO_LARGE, with the file.
    """
    import pyarrow
    import pyarrow.parquet as pq

    packed = 0
    for table in TABLES:
        for path in sorted((dataset.folder / table).glob("*.parquet")):
            if not path.is_file():
                continue
            try:
                rows = pq.read_metadata(path).num_rows
            except (pyarrow.ArrowException, OSError, ValueError):  # the reading of it names what is damaged
                continue
            size = path.stat().st_size
            packed += size if table == "programs" else 0
            check_rows(rows, size, f"{table}/{path.name}")
    ((texts, steps),) = dataset.rows(_TEXTS)[1]
    if texts + OF_A_STEP * steps > max(MOST_TEXT, MOST_PACKED * packed):
        message = f"{packed:,} bytes of programs that unpack to {texts:,} of text and {steps:,} steps"
        remedy = "write it anew, without repetitions"
        raise HearthError.of(Code.FILE_TOO_LARGE, message, file=str(dataset.folder), suggestion=remedy)
