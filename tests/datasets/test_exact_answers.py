"""Answers keep values that Arrow or Python has no exact form for, in every form in which they are written."""

from __future__ import annotations

import json

import duckdb
import pytest

from hearth.datasets.dataset import Dataset
from hearth.datasets.query_output import write_answer

LARGEST = "340282366920938463463374607431768211455"

VALUES = {
    f"{LARGEST}::UHUGEINT": LARGEST,
    "'101'::BIT": "101",
    "'24:00:00'::TIME": "24:00:00",
    "'12:00:00+02'::TIMETZ": "12:00:00+02",
    "'infinity'::TIMESTAMP": "infinity",
    "'infinity'::TIMESTAMP_S": "infinity",
    "'infinity'::TIMESTAMP_NS": "infinity",
    "'infinity'::TIMESTAMPTZ": "infinity",
    "'infinity'::DATE": "infinity",
    "DATE '20000-01-02'": "20000-01-02",
    "DATE '2020-01-02'": "2020-01-02",
    "INTERVAL 3 DAY": "3 days",
}
"""Values in SQL, and their text."""


@pytest.fixture(scope="module")
def dataset(made):
    return Dataset.open(made.out / "publish")


@pytest.mark.parametrize("value", VALUES)
def test_csv_and_json_have_the_value(dataset, value, tmp_path):
    query = f"SELECT {value} AS v"
    write_answer(dataset, query, tmp_path / "a.csv")
    assert (tmp_path / "a.csv").read_text().splitlines()[1].strip('"') == VALUES[value]
    write_answer(dataset, query, tmp_path / "a.json")
    assert str(json.loads((tmp_path / "a.json").read_text())[0]["v"]) == VALUES[value]


@pytest.mark.parametrize("value", VALUES)
def test_parquet_has_the_value(dataset, value, tmp_path):
    write_answer(dataset, f"SELECT {value} AS v", tmp_path / "a.parquet")
    found = duckdb.sql(f"SELECT CAST(v AS VARCHAR) FROM '{tmp_path / 'a.parquet'}'").fetchall()
    assert found == [(VALUES[value],)]


@pytest.mark.parametrize("value", [value for value in VALUES if "INTERVAL" not in value])
def test_rows_as_text_have_the_value(dataset, value):
    assert dataset.rows_as_text(f"SELECT {value} AS v")[1] == [(VALUES[value],)]


def test_an_infinite_date_within_a_value_is_said(dataset, tmp_path):
    write_answer(dataset, "SELECT {'a': 'infinity'::DATE} AS v", tmp_path / "a.json")
    assert json.loads((tmp_path / "a.json").read_text()) == [{"v": {"a": "infinity"}}]
