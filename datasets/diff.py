"""Differences between two datasets, by table and row."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hearth.datasets.damage_faults import using
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.catalog import absent_tables, earlier, reading
from hearth.datasets.format.ids import OURS
from hearth.datasets.unpacked_sizes import check_unpacked
from hearth.schemas.tables import KEYS, TABLES
from hearth.storage.duckdb_connections import identifier, limited, open_database, quoted, without_patterns

MORE = {"repairs": ("parent_id", "home", "perturbations")}
"""Further key columns in format 1, where repairs that led to no program have no environment."""


@dataclass(frozen=True, slots=True)
class Changed:
    """A row of both datasets with different values.

    Attributes:
        key: values of its key columns.
        columns: the columns that differ.
    """

    key: tuple[Any, ...]
    columns: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class TableDifference:
    """The differences in one table.

    Attributes:
        table: its name.
        only_first, only_second: keys in one dataset only, sorted; at most `limit`.
        changed: rows that differ, sorted; at most `limit`.
        counts: the numbers of the three, without limit.
    """

    table: str
    only_first: tuple[tuple[Any, ...], ...]
    only_second: tuple[tuple[Any, ...], ...]
    changed: tuple[Changed, ...]
    counts: tuple[int, int, int]

    def __bool__(self) -> bool:
        return any(self.counts)


def compare(first: str | Path, second: str | Path, limit: int | None = None) -> list[TableDifference]:
    """Every table that differs, in the order of the tables.

    Nested values are compared too. A column in one dataset only differs in every row.

    Args:
        first, second: datasets, or the folders of builds.
        limit: number of rows listed per table and kind; None for all.

    Raises:
        HearthError: one of them is not a dataset, or a newer version wrote it; or its tables cannot be read.
    """
    a, b = Dataset.open(first), Dataset.open(second)
    for each in (a, b):
        absent_tables(each.folder, each.manifest)  # refuses pipes, which a query would wait for
        with using(each.folder):
            check_unpacked(each)
    found = []
    with using(f"{a.folder}, {b.folder}"), open_database() as connection:
        limited(connection, *(f"{each.folder.resolve()}/" for each in (a, b)))
        for table in TABLES:
            difference = _table(connection, table, (a, b), limit)
            if difference:
                found.append(difference)
    return found


def _table(connection: Any, table: str, both: tuple[Dataset, Dataset], limit: int | None) -> TableDifference:
    columns = []
    for name, dataset in zip("ab", both, strict=True):
        there = any((dataset.folder / table).glob("*.parquet"))  # else it is of a version without the table
        format = dataset.manifest["format"]
        files = reading(table, format, f"{without_patterns(dataset.folder)}/")
        there = there or "query" in earlier(format).get(table, {})
        rows = connection.sql(f"FROM {files}") if there else connection.from_arrow(TABLES[table].empty_table())
        rows.project(", ".join(map(_current, rows.columns))).create_view(name)
        columns.append(rows.columns)
    keys = tuple(key for key in (*KEYS[table], *MORE.get(table, ())) if all(key in names for names in columns))
    odd = sorted({*columns[0]} ^ {*columns[1]})
    common = [name for name in columns[0] if name in columns[1] and name not in keys]
    only_first, only_second = (_only(connection, one, other, keys) for one, other in ("ab", "ba"))
    changed = _changed(connection, keys, common, odd)
    counts = (len(only_first), len(only_second), len(changed))
    return TableDifference(table, only_first[:limit], only_second[:limit], changed[:limit], counts)


def _current(column: str) -> str:
    """Return a column, ids as this version has them."""
    is_id = column == "found" or (column.endswith("_id") and column != "activity_id")
    name = identifier(column)
    return f"regexp_replace({name}, '{OURS}', 'written\\1') AS {name}" if is_id else name


def _same_key(keys: tuple[str, ...]) -> str:
    return " AND ".join(f"a.{identifier(key)} IS NOT DISTINCT FROM b.{identifier(key)}" for key in keys)


def _only(connection: Any, one: str, other: str, keys: tuple[str, ...]) -> tuple[tuple[Any, ...], ...]:
    names = ", ".join(f"{one}.{identifier(key)}" for key in keys)
    query = f"SELECT DISTINCT {names} FROM {one} ANTI JOIN {other} ON {_same_key(keys)} ORDER BY ALL"
    return tuple(connection.execute(query).fetchall())


def _changed(connection: Any, keys: tuple[str, ...], common: list[str], odd: list[str]) -> tuple[Changed, ...]:
    named = [(identifier(name), quoted(name)) for name in common]
    tests = [f"CASE WHEN a.{name} IS DISTINCT FROM b.{name} THEN {text} END" for name, text in named]
    tests += [quoted(name) for name in odd]
    if not tests:
        return ()
    names = ", ".join(f"a.{identifier(key)}" for key in keys)
    differing = f"list_filter([{', '.join(tests)}], lambda name: name IS NOT NULL)"
    query = f"""SELECT {names}, differing FROM (
        SELECT {names}, {differing} AS differing FROM a JOIN b ON {_same_key(keys)}
    ) a WHERE len(differing) > 0 ORDER BY ALL"""
    return tuple(Changed(row[:-1], tuple(row[-1])) for row in connection.execute(query).fetchall())
