"""Files by the ids that they have: only those that may have some of a range are read."""

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.datasets.file_ranges import reading_between

PARTS = {"part-00000": ["a", "b", "c"], "part-00001": ["d", "e"], "part-00002.test": ["b", "f"]}


@pytest.fixture(params=["plain", "it's [1] of *"])
def folder(request, tmp_path):
    found = tmp_path / request.param
    (found / "programs").mkdir(parents=True)
    for name, ids in PARTS.items():
        table = pa.table({"title": ["t"] * len(ids), "program_id": ids})
        pq.write_table(table, found / "programs" / f"{name}.parquet", row_group_size=2)
    return found


def ids(folder, low, high):
    source = reading_between(folder, "programs", low, high)
    found = duckdb.sql(f"SELECT program_id FROM {source} WHERE program_id BETWEEN '{low}' AND '{high}'").fetchall()
    return source.count(".parquet"), sorted(each for (each,) in found)


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [("a", "a", (1, ["a"])), ("c", "d", (3, ["c", "d"])), ("f", "z", (1, ["f"])), ("e", "e", (2, ["e"]))],
)
def test_only_files_with_ids_of_the_range_are_read(folder, low, high, expected):
    assert ids(folder, low, high) == expected


def test_a_range_without_files_reads_the_table(folder):
    assert reading_between(folder, "programs", "x", "y") == "programs"


def test_a_file_that_does_not_say_what_it_has_is_read(folder):
    table = pa.table({"title": ["t"], "program_id": ["x"]})
    pq.write_table(table, folder / "programs/part-00003.parquet", write_statistics=False)
    assert ids(folder, "x", "y") == (1, ["x"])
