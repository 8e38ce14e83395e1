"""Files by the ids that they have: only those that may have some of a range are read."""

import subprocess
import sys

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.datasets.file_id_ranges import reading_between

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


def test_a_file_without_the_key_is_read(folder):
    pq.write_table(pa.table({"title": ["t"]}), folder / "programs/part-00003.parquet")
    assert reading_between(folder, "programs", "x", "y").count(".parquet") == 1


def test_a_range_of_numbers_is_none_of_ids(folder):
    """Their order as text is another one."""
    pq.write_table(pa.table({"program_id": [9, 10]}), folder / "programs/part-00003.parquet")
    assert reading_between(folder, "programs", "x", "y").count(".parquet") == 1


ASKING = """
import sys, pathlib
from hearth.datasets.file_id_ranges import reading_between
print(reading_between(pathlib.Path(sys.argv[1]), "programs", "a", "b"))
"""


def test_damaged_statistics_of_sizes_do_not_end_the_process(folder):
    """pyarrow ends it, where a column's statistics are of another type: no error of Python's, but an abort."""
    path = folder / "programs/part-00000.parquet"
    data = path.read_bytes()
    texts, truths = b"\x15\x0c\x19", b"\x15\x00\x19"  # the type of a column's part, and its encodings
    assert texts in data
    path.write_bytes(data.replace(texts, truths))
    asked = [sys.executable, "-c", ASKING, str(folder)]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count(".parquet") == 2
