"""Files of a table by the ids that they have: a query over all files of a big dataset would open each of them."""

from __future__ import annotations

import glob
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from hearth.datasets.format.catalog import quoted
from hearth.datasets.steady import version
from hearth.schemas.tables import KEYS

_LAST = "\U0010ffff"
"""No id is greater."""


class Range(NamedTuple):
    """The least and the greatest id in a file."""

    low: str
    high: str
    path: str


def reading_between(folder: Path, table: str, low: str, high: str) -> str:
    """What a query reads instead of a table when it asks for a range of ids: the files that may have some.

    Args:
        folder: of the dataset; of the present format, or one whose table has its own files.
        table: with one column as its key.
        low: least id.
        high: greatest id.
    """
    (key,) = KEYS[table]
    ranges = _ranges(str(folder.resolve()), table, key, version(folder))
    found = [each.path for each in ranges if each.low <= high and low <= each.high]
    names = ", ".join(quoted(glob.escape(path)) for path in found)
    return f"read_parquet([{names}])" if found else table


@lru_cache(maxsize=16)
def _ranges(folder: str, table: str, key: str, _: tuple[int, int] | None) -> tuple[Range, ...]:
    """The ranges of all files; read again once a build has replaced the dataset."""
    import pyarrow.parquet as pq

    paths = sorted(str(path) for path in Path(folder, table).glob("*.parquet"))
    return tuple(Range(*_range(pq.read_metadata(path), key), path) for path in paths)


def _range(footer: Any, key: str) -> tuple[str, str]:
    """The least and the greatest id by a file's footer; all ids where it does not say."""
    paths = [footer.schema.column(number).path for number in range(len(footer.schema))]
    if key not in paths:
        return "", _LAST
    column = paths.index(key)
    groups = [footer.row_group(number).column(column).statistics for number in range(footer.num_row_groups)]
    if not groups or not all(group is not None and group.has_min_max for group in groups):
        return "", _LAST
    return min(str(group.min) for group in groups), max(str(group.max) for group in groups)
