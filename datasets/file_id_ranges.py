"""Files of a table by the ids that they have: a query over all files of a big dataset would open each of them."""

from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from hearth.datasets.consistent_reads import version
from hearth.schemas.tables import KEYS
from hearth.storage.duckdb_connections import limited, open_database, pattern_of, quoted, without_patterns

_LAST = "\U0010ffff"
"""No id is greater."""


_FOOTERS = """
    SELECT file_name, min(stats_min_value), max(stats_max_value), bool_and(
        coalesce(type = 'BYTE_ARRAY' AND stats_min_value <= stats_max_value, false)
    )
    FROM parquet_metadata($paths) WHERE path_in_schema = $key GROUP BY file_name
"""
"""The ranges of each file with the column: its least and greatest value, and whether all row groups state theirs."""


class Range(NamedTuple):
    """The least and the greatest id in a file."""

    low: str
    high: str
    path: str


def reading_between(folder: Path, table: str, low: str, high: str) -> str:
    """Return the expression that replaces a table in a query for a range of ids: the files that may have some.

    Args:
        folder: of the dataset; of the present format, or one whose table has its own files.
        table: with one column as its key.
        low: least id.
        high: greatest id.
    """
    (key,) = KEYS[table]
    ranges = _ranges(without_patterns(folder), table, key, version(folder))
    found = [each.path for each in ranges if each.low <= high and low <= each.high]
    names = ", ".join(quoted(pattern_of(path)) for path in found)
    return f"read_parquet([{names}])" if found else table


@lru_cache(maxsize=16)
def _ranges(folder: str, table: str, key: str, _: tuple[int, int] | None) -> tuple[Range, ...]:
    """Return the ranges of all files; a file whose footer has no range may have all ids.

    The ranges are read again after a build.

    DuckDB reads the footers, because pyarrow ends the process where one has damaged statistics of sizes.
    """
    paths = sorted(str(path) for path in Path(folder, table).glob("*.parquet"))
    if not paths:
        return ()
    with limited(open_database(), f"{Path(folder).resolve()}/") as connection:
        found = connection.execute(_FOOTERS, {"paths": [pattern_of(path) for path in paths], "key": key}).fetchall()
    ranges = {path: Range(low, high, path) for path, low, high, whole in found if whole}
    return tuple(ranges.get(path, Range("", _LAST, path)) for path in paths)
