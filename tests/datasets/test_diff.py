"""Differences between two datasets."""

from __future__ import annotations

import shutil

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.datasets.diff import compare
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.tables import KEYS, TABLES


@pytest.fixture
def copy(made, tmp_path):
    return shutil.copytree(made.out / "publish", tmp_path / "copy")


def rewritten(folder, table, change):
    path = next(p for p in sorted((folder / table).glob("*.parquet")) if pq.read_metadata(p).num_rows > 1)
    rows = pq.ParquetFile(path).read()
    pq.write_table(change(rows), path)
    return rows.to_pylist()


def test_every_table_has_a_key_that_tells_its_rows_apart(made):
    assert set(KEYS) == set(TABLES)
    for table, keys in KEYS.items():
        rows = [
            row
            for p in (made.out / "publish" / table).glob("*.parquet")
            for row in pq.ParquetFile(p).read().to_pylist()
        ]
        assert len({tuple(map(str, (row[key] for key in keys))) for row in rows}) == len(rows), table


def test_the_same_dataset(made, copy):
    assert compare(made.out, copy) == []


def test_repairs_that_led_to_no_program(copy, tmp_path):
    """They have no program's id; what was perturbed distinguishes them."""

    def duplicates(table):
        rows = [{**row, "program_id": None, "execution_id": None} for row in table.to_pylist()]
        return pa.Table.from_pylist(rows, table.schema)

    rows = rewritten(copy, "repairs", duplicates)
    assert len(rows) > len({row["attempt"] for row in rows})
    assert compare(copy, shutil.copytree(copy, tmp_path / "again")) == []


def test_a_row_that_is_gone_and_one_that_came(made, copy):
    rows = rewritten(copy, "executions", lambda table: table.slice(1))
    (found,) = compare(made.out, copy)
    gone = (rows[0]["execution_id"],)
    assert (found.table, found.only_first, found.only_second, found.changed) == ("executions", (gone,), (), ())
    (back,) = compare(copy, made.out)
    assert back.only_second == (gone,)


def test_a_nested_value_that_changed(made, copy):
    def other(table):
        rows = table.to_pylist()
        rows[1]["steps"][0]["action"] = "Run"
        rows[1]["title"] = "Otherwise"
        return pa.Table.from_pylist(rows, table.schema)

    rows = rewritten(copy, "programs", other)
    (found,) = compare(made.out, copy)
    (changed,) = found.changed
    assert (found.table, changed.key, changed.columns) == ("programs", (rows[1]["program_id"],), ("title", "steps"))


def test_a_column_that_only_one_has(made, copy):
    for path in (copy / "homes").glob("*.parquet"):
        pq.write_table(pq.ParquetFile(path).read().drop_columns(["nodes"]), path)
    (found,) = compare(made.out, copy)
    assert {each.columns for each in found.changed} == {("nodes",)}


def test_few_are_told_and_all_are_counted(made, copy):
    rewritten(copy, "home_edges", lambda table: table.slice(7))
    (found,) = compare(made.out, copy, limit=2)
    assert (len(found.only_first), found.counts) == (2, (7, 0, 0))


def test_no_dataset(made, tmp_path):
    with pytest.raises(HearthError, match="no dataset here"):
        compare(made.out, tmp_path)
