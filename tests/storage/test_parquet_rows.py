"""Parquet files whose few bytes stand for more than they hold."""

from __future__ import annotations

from types import SimpleNamespace

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage import parquet_rows
from hearth.storage.parquet_rows import row_lists


def read(path, **options):
    with pq.ParquetFile(path) as file:
        return [row for rows in row_lists(file, path.stat().st_size, str(path), **options) for row in rows]


def written(path, **columns):
    pq.write_table(pa.table(columns), path)
    return path


def test_rows_come_as_they_are(tmp_path):
    path = written(tmp_path / "t.parquet", id=[str(n) for n in range(3_000)], n=list(range(3_000)))
    assert read(path) == [{"id": str(n), "n": n} for n in range(3_000)]
    assert read(path, columns=["n"])[2_999] == {"n": 2_999}


def test_millions_of_rows_of_nothing(tmp_path):
    path = written(tmp_path / "t.parquet", id=pa.nulls(2_000_000, pa.string()))
    with pytest.raises(HearthError) as caught:
        read(path)
    assert caught.value.diagnostics[0].code == Code.FILE_TOO_LARGE


def test_a_text_that_all_rows_have_is_read_row_by_row(tmp_path, monkeypatch):
    text = pa.DictionaryArray.from_arrays(pa.array([0] * 900, pa.int32()), pa.array(["x" * (4 << 20)]))
    path = written(tmp_path / "t.parquet", id=text)
    assert path.stat().st_size < 1 << 20
    monkeypatch.setattr(parquet_rows, "LARGEST_TABLE", 64 << 20)
    monkeypatch.setattr(parquet_rows, "MOST_PACKED", 1)
    with pq.ParquetFile(path) as file:
        assert parquet_rows._at_once(file.metadata) <= 16
        with pytest.raises(HearthError) as caught:
            list(row_lists(file, path.stat().st_size, "t"))
    assert caught.value.diagnostics[0].code == Code.FILE_TOO_LARGE


def test_parts_of_columns_are_not_asked_for_before_they_are_read():
    """The library would end the process where the statistics of their sizes are damaged."""
    group = SimpleNamespace(total_byte_size=1 << 20)  # it has no `column`
    assert parquet_rows._at_once(SimpleNamespace(num_row_groups=1, row_group=lambda _: group)) == 64


def test_a_date_that_no_calendar_has(tmp_path):
    path = written(tmp_path / "t.parquet", when=pa.array([2**40], pa.timestamp("s")))
    with pytest.raises(ValueError, match="out of range"):
        read(path)
