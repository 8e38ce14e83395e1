"""Datasets whose few bytes stand for millions of rows, steps or letters: refused before they are read as a whole."""

from __future__ import annotations

import shutil

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.datasets import unpacked_sizes
from hearth.datasets.dataset import Dataset
from hearth.datasets.unpacked_sizes import check_unpacked
from hearth.storage import parquet_rows


@pytest.fixture
def data(made, tmp_path):
    return shutil.copytree(made.out / "publish", tmp_path / "data")


def first(data):
    """The first part of the programs that has rows, and its table."""
    return next(
        (path, table) for path in sorted((data / "programs").glob("*.parquet")) if len(table := pq.read_table(path))
    )


def with_column(table, name, values):
    index = table.column_names.index(name)
    return table.set_column(index, table.schema.field(index), pa.array(values, table.schema.field(index).type))


def rows(table):
    return pa.concat_tables([table.slice(0, 1)] * 3_000)


def titles(table):
    return with_column(table, "title", ["x" * 3_000_000] * len(table))


def descriptions(table):
    return with_column(table, "description", ["x" * 3_000_000] * len(table))


def steps(table):
    return with_column(table, "steps", [each * 20_000 for each in table.column("steps").to_pylist()])


@pytest.fixture
def few(monkeypatch):
    """Lower limits, so that the bombs of the tests are small ones."""
    monkeypatch.setattr(parquet_rows, "HARMLESS_ROWS", 1_000)
    monkeypatch.setattr(unpacked_sizes, "MOST_TEXT", 1 << 20)
    monkeypatch.setattr(unpacked_sizes, "MOST_PACKED", 2)


@pytest.mark.parametrize("bomb", [rows, titles, descriptions, steps])
def test_a_bomb_is_refused_by_every_command_that_reads_all(data, tmp_path, bomb, few):
    path, table = first(data)
    pq.write_table(bomb(table), path, compression="zstd")
    for words in (("report", data, "--out", tmp_path / "r", "--replays", "0"),
                  ("export", data, "--format", "jsonl", "--out", tmp_path / "e"),
                  ("diff", data, data)):  # fmt: skip
        result = CliRunner().invoke(cli.app, [str(word) for word in words])
        assert result.exit_code == 1 and "FILE_TOO_LARGE" in result.output, result.output
    assert not (tmp_path / "r").exists() and not (tmp_path / "e").exists()


def test_ours_is_read(data):
    check_unpacked(Dataset.open(data))
