"""Answers say what DuckDB says, whatever the type: on a terminal, in CSV, JSON and Parquet; or they are refused."""

from __future__ import annotations

import csv
import io
import json

import duckdb
import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.exact_types import DEEPEST
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

LARGEST = str(2**128 - 1)

VALUES = (
    f"{LARGEST}::UHUGEINT", "(-170141183460469231731687303715884105728)::HUGEINT", "18446744073709551615::UBIGINT",
    "(-9223372036854775808)::BIGINT", "255::UTINYINT", "'10110'::BIT", "''::BIT", "repeat('9', 60)::BIGNUM",
    "'12:34:56.123456+02:00'::TIMETZ", "'12:34:56.123456'::TIME", "'24:00:00'::TIME", "'12:34:56.123456789'::TIME_NS",
    "INTERVAL '-1 month 3 days -5 seconds'", "INTERVAL '1000000 hours'", "'ffffffff-0000-0000-0000-0000000000ff'::UUID",
    "'a'::ENUM('a', 'b')", "union_value(num := 2)", f"union_value(big := {LARGEST}::UHUGEINT)",
    r"'\xAA\x00b''\x22\x5C'::BLOB", "''::BLOB",
    "'2020-01-01 01:02:03.123456789'::TIMESTAMP_NS", "'2020-01-01 01:02:03.123'::TIMESTAMP_MS",
    "'2020-01-01 01:02:03'::TIMESTAMP_S", "'2020-01-01 01:02:03.5'::TIMESTAMP",
    "'2020-01-01 01:02:03+00'::TIMESTAMPTZ", "'2020-01-01'::DATE", "'12345-01-01'::DATE", "'0044-03-15 (BC)'::DATE",
    "'290000-01-01'::TIMESTAMP", "'0044-03-15 (BC) 01:00:00'::TIMESTAMP", "12345678901234567890123456789012.345678",
    "'nan'::DOUBLE", "'inf'::DOUBLE", "'-inf'::FLOAT", "1e300::DOUBLE", "'{\"a\": 1}'::JSON", "1::VARIANT",
    *(f"'{sign}infinity'::{kind}" for sign in ("", "-") for kind in
      ("DATE", "TIMESTAMP", "TIMESTAMPTZ", "TIMESTAMP_S", "TIMESTAMP_MS", "TIMESTAMP_NS")),
)  # fmt: skip
"""Values whose form in Python, Arrow or JSON may be another than DuckDB's own."""

NESTED = {
    "['infinity'::DATE]": ["infinity"],
    f"{{'a b': {LARGEST}::UHUGEINT, 'size': 1}}": {"a b": LARGEST, "size": 1},
    "['101'::BIT, '1'::BIT]::BIT[2]": ["101", "1"],
    "MAP {'24:00:00'::TIME: [INTERVAL '1 month']}": [["24:00:00", ["1 month"]]],
    "[{'a': ['-infinity'::TIMESTAMP]}]": [{"a": ["-infinity"]}],
    r"['\xAA'::BLOB]": ["\\xAA"],
    "['inf'::DOUBLE, 0.5]": ["inf", 0.5],
    "[12345678901234567890123456789012.345678]": ["12345678901234567890123456789012.345678"],
    "[1.10::DECIMAL(4, 2)]": [1.1],
}
"""Values in lists, structures and maps, and what JSON has for them."""


@pytest.fixture(scope="module")
def dataset(made):
    return made.out / "publish"


def run(*words):
    result = CliRunner().invoke(cli.app, ["query", *map(str, words)])
    assert result.exit_code == 0, result.output
    return result.stdout


def stated(value: str) -> str:
    """DuckDB's own text of a value."""
    with duckdb.connect() as plain:
        plain.execute("SET TimeZone = 'UTC'")
        return plain.execute(f"SELECT ({value})::VARCHAR").fetchone()[0]


@pytest.fixture(scope="module")
def answers(dataset):
    """The rows of one question with all values: as the library has them, as CSV, and as JSON."""
    query = f"SELECT {', '.join(f'({value}) AS v{n}' for n, value in enumerate(VALUES))}"
    rows = Dataset.open(dataset).rows_as_text(query)[1][0]
    lines = list(csv.reader(io.StringIO(run(dataset, query, "--csv"))))[1]
    return query, rows, lines, list(json.loads(run(dataset, query, "--json"))[0].values())


@pytest.mark.parametrize("number", range(len(VALUES)), ids=VALUES)
def test_every_type_says_what_duckdb_says(answers, number):
    expected = stated(VALUES[number])
    _, rows, lines, documents = answers
    plain = rows[number].decode("latin-1") if isinstance(rows[number], bytes) else str(rows[number])
    found = {"csv": lines[number].removeprefix("'"), "json": str(documents[number])}
    found |= {} if isinstance(rows[number], bytes) else {"rows": plain}
    for form, text in found.items():
        assert text == expected or float_of(text) == float_of(expected) is not None, form


def float_of(text: str) -> float | None:
    """A number as others write it: 1e+300 is 1e300. None for other texts."""
    return float(text) if "e+" in text else None


def test_the_terminal_says_infinity(dataset):
    shown = run(dataset, "SELECT 'infinity'::TIMESTAMP AS a, '-infinity'::DATE AS b, '\\xAA'::BLOB AS c")
    assert shown.splitlines()[1].split() == ["infinity", "-infinity", "\\xAA"]


@pytest.mark.parametrize("value", NESTED)
def test_nested_values_are_exact_too(dataset, value):
    assert json.loads(run(dataset, f"SELECT {value} AS v", "--json")) == [{"v": NESTED[value]}]
    (line,) = list(csv.reader(io.StringIO(run(dataset, f"SELECT {value} AS v", "--csv"))))[1]
    assert json.loads(line) == NESTED[value]


@pytest.mark.parametrize("value", [*VALUES, *NESTED])
def test_a_parquet_file_has_the_same_value_or_is_refused(dataset, tmp_path, value):
    path = tmp_path / "a.parquet"
    words = ["query", str(dataset), f"SELECT {value} AS v", "--parquet", str(path)]
    result = CliRunner().invoke(cli.app, words)
    if result.exit_code:
        assert "HUGEINT" in value and "Conversion" in result.output and not path.exists(), result.output
        return
    with duckdb.connect() as plain:
        found = plain.execute(f"SELECT v::VARCHAR FROM '{path}'").fetchone()[0]
    assert found.replace('"', "") == stated(value).replace('"', "")


def test_an_answer_that_is_too_deep_is_refused(dataset):
    for depth in (DEEPEST + 1, 900):
        query = f"SELECT {'[' * depth}1{']' * depth} AS v"
        with pytest.raises(HearthError) as caught:
            Dataset.open(dataset).rows(query)
        assert caught.value.diagnostics[0].code in (Code.FILE_TOO_LARGE, Code.SYNTAX)
    depth = DEEPEST
    assert run(dataset, f"SELECT {'[' * depth}1{']' * depth} AS v", "--json").count("[") == depth + 1
