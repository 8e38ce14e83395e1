"""A value that a table has twice is found, and two of one hash are not taken for one."""

from __future__ import annotations

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from hearth.storage import repeated_ids as module
from hearth.storage.repeated_ids import repeated


def table(folder, *files):
    for number, names in enumerate(files):
        pq.write_table(
            pa.table({"id": pa.array(names, pa.string()), "other": ["x"] * len(names)}), folder / f"{number}.parquet"
        )
    return folder


def test_the_first_by_name_that_is_there_twice(tmp_path):
    assert repeated(table(tmp_path, ["d", "b", "c"], ["b", "a", "c"]), "id") == "b"


@pytest.mark.parametrize("files", [(), ([],), (["b", "a"], ["c"])])
def test_none_is(tmp_path, files):
    assert repeated(table(tmp_path, *files), "id") is None


def test_two_of_one_hash_differ(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "hash", len, raising=False)
    assert repeated(table(tmp_path, ["aa", "bb", "c"]), "id") is None
    assert repeated(table(tmp_path, ["aa", "bb", "c"], ["bb"]), "id") == "bb"
