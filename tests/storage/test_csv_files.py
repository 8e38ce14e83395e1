"""CSV that somebody wrote: columns by name, lines of faults, and nothing that never ends."""

from __future__ import annotations

import os

import pytest

from hearth.schemas.diagnostics import HearthError
from hearth.storage.csv_files import CsvTable


def rows(path, data, columns=("id", "rating*"), **more):
    path.write_bytes(data)
    return list(CsvTable(path, columns, **more).rows())


@pytest.mark.parametrize(
    "data",
    [
        b"id,note,rating (1 good)\na,x,1\n\nb,y\n",
        b"\xef\xbb\xbfid;note;rating (1 good)\r\na;x;1\r\n\r\nb;y\r\n",
        "id\tnote\trating (1 good)\na\tx\t1\n\nb\ty\n".encode("utf-16"),
    ],
)
def test_columns_are_found_by_name_whatever_wrote_them(tmp_path, data):
    assert rows(tmp_path / "a.csv", data) == [(2, ("a", "1")), (4, ("b", ""))]


def test_only_a_name_with_a_star_may_be_longer(tmp_path):
    with pytest.raises(HearthError, match="lacks the column `id`, `rating`"):
        rows(tmp_path / "a.csv", b"ids,rating (1 good)\n", ("id", "rating"))


@pytest.mark.parametrize(
    ("data", "code", "line"),
    [
        (b"id,rating\na,1\n" + b"x" * 200_000 + b",1\n", "BAD_TABLE", 3),
        (b"x" * 200_000, "BAD_TABLE", 1),
        (b"", "BAD_TABLE", 1),
        (b"id,rating\n\x81\x81\x81,1\n", "NOT_TEXT", 2),
        (b"id,rating\na\x00,1\n", "NOT_TEXT", 2),
    ],
)
def test_what_is_not_a_table_is_told_by_line(tmp_path, data, code, line):
    with pytest.raises(HearthError) as caught:
        rows(tmp_path / "a.csv", data)
    assert [(fault.code, fault.line) for fault in caught.value.diagnostics] == [(code, line)]


def test_a_file_that_is_too_large_or_never_ends_is_not_read(tmp_path):
    with pytest.raises(HearthError, match="FILE_TOO_LARGE"):
        rows(tmp_path / "a.csv", b"id,rating\n", largest=5)
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(HearthError, match="UNSUPPORTED_FILE"):
        CsvTable(tmp_path / "pipe", ("id",))
