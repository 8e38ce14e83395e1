"""Differences between two datasets, by table and row."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.schemas.tables import TABLES

KEYS = {
    "activities": ("activity_id",),
    "descriptions": ("description_id",),
    "programs": ("program_id",),
    "homes": ("home",),
    "home_nodes": ("home", "id"),
    "home_edges": ("home", "source", "relation", "target"),
    "environments": ("environment_id",),
    "executions": ("execution_id",),
    # Repairs that led to no program of their own have none: those of a parent differ in what was perturbed.
    "repairs": ("program_id", "parent_id", "environment_id", "home", "perturbations", "attempt"),
    "splits": ("split", "execution_id"),
    "sketches": ("program_id", "keep"),
    "frames": ("execution_id", "tick", "camera", "modality"),
    "videos": ("execution_id", "camera"),
    "vocabulary": ("kind", "id"),
    "rejects": ("stage", "record_id", "code", "fault", "line", "column", "file"),
    "ledger": ("stage",),
}
"""Key columns of each table."""


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
        HearthError: one of them is not a dataset, or a newer version wrote it.
    """
    import duckdb

    a, b = Dataset.open(first), Dataset.open(second)
    found = []
    with duckdb.connect() as connection:
        for table in TABLES:
            difference = _table(connection, table, (a, b), limit)
            if difference:
                found.append(difference)
    return found


def _table(connection: Any, table: str, both: tuple[Dataset, Dataset], limit: int | None) -> TableDifference:
    columns = []
    for name, dataset in zip("ab", both, strict=True):
        connection.execute(f"DROP VIEW IF EXISTS {name}")
        if any((dataset.folder / table).glob("*.parquet")):
            files = str(dataset.folder / table / "*.parquet").replace("'", "''")
            connection.execute(f"CREATE TEMP VIEW {name} AS SELECT * FROM read_parquet('{files}')")
        else:  # a dataset of a version without the table
            connection.from_arrow(TABLES[table].empty_table()).create_view(name)
        columns.append([row[0] for row in connection.execute(f"DESCRIBE {name}").fetchall()])
    keys = KEYS[table]
    odd = sorted({*columns[0]} ^ {*columns[1]})
    common = [name for name in columns[0] if name in columns[1] and name not in keys]
    only_first, only_second = (_only(connection, one, other, keys) for one, other in ("ab", "ba"))
    changed = _changed(connection, keys, common, odd)
    counts = (len(only_first), len(only_second), len(changed))
    return TableDifference(table, only_first[:limit], only_second[:limit], changed[:limit], counts)


def _same_key(keys: tuple[str, ...]) -> str:
    return " AND ".join(f'a."{key}" IS NOT DISTINCT FROM b."{key}"' for key in keys)


def _only(connection: Any, one: str, other: str, keys: tuple[str, ...]) -> tuple[tuple[Any, ...], ...]:
    names = ", ".join(f'{one}."{key}"' for key in keys)
    query = f"SELECT DISTINCT {names} FROM {one} ANTI JOIN {other} ON {_same_key(keys)} ORDER BY ALL"
    return tuple(connection.execute(query).fetchall())


def _changed(connection: Any, keys: tuple[str, ...], common: list[str], odd: list[str]) -> tuple[Changed, ...]:
    tests = [f"""CASE WHEN a."{name}" IS DISTINCT FROM b."{name}" THEN '{name}' END""" for name in common]
    tests += [f"'{name}'" for name in odd]
    if not tests:
        return ()
    names = ", ".join(f'a."{key}"' for key in keys)
    differing = f"list_filter([{', '.join(tests)}], lambda name: name IS NOT NULL)"
    query = f"""SELECT {names}, differing FROM (
        SELECT {names}, {differing} AS differing FROM a JOIN b ON {_same_key(keys)}
    ) a WHERE len(differing) > 0 ORDER BY ALL"""
    return tuple(Changed(row[:-1], tuple(row[-1])) for row in connection.execute(query).fetchall())
