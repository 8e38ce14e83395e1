"""Answers of `query` as lines and files, and what it says of names that there are not."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.commands import output
from hearth.datasets import query_output as answers
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.terminal import shown

SQL = "SELECT program_id, title, steps, len(steps) AS length FROM programs ORDER BY program_id"


def run(*words):
    return CliRunner().invoke(cli.app, ["query", *map(str, words)])


@pytest.fixture(scope="module")
def dataset(made):
    return made.out / "publish"


@pytest.fixture(scope="module")
def expected(dataset):
    return hearth.load(dataset).rows(SQL)[1]


@pytest.mark.parametrize(("flag", "separator"), [("--csv", ","), ("--tsv", "\t")])
def test_lines_have_every_row_and_nested_values_as_json(dataset, expected, flag, separator):
    result = run(dataset, SQL, flag, "--rows", "1")
    assert result.exit_code == 0, result.output
    head, *rows = csv.reader(io.StringIO(result.stdout), delimiter=separator)
    assert head == ["program_id", "title", "steps", "length"]
    assert [(row[0], row[1], json.loads(row[2]), int(row[3])) for row in rows] == expected


@pytest.mark.parametrize("size", [1, 3, 10_000])
def test_files_have_the_same_rows_whatever_is_read_at_once(dataset, expected, tmp_path, size, monkeypatch):
    monkeypatch.setattr(answers, "ROWS_OF_AN_ANSWER", size)
    for name in ("a.csv", "a.tsv", "a.json", "a.parquet"):
        assert run(dataset, SQL, "--out", tmp_path / name).exit_code == 0
    assert [tuple(row.values()) for row in json.loads((tmp_path / "a.json").read_text())] == expected
    assert [tuple(row.values()) for row in pq.read_table(tmp_path / "a.parquet").to_pylist()] == expected
    for name, separator in (("a.csv", ","), ("a.tsv", "\t")):
        with (tmp_path / name).open(newline="") as file:
            found = list(csv.reader(file, delimiter=separator))[1:]
        assert [(row[0], int(row[3])) for row in found] == [(row[0], row[3]) for row in expected]
    assert {path.name for path in tmp_path.iterdir()} == {"a.csv", "a.tsv", "a.json", "a.parquet"}


def test_no_answer_is_written_whole_too(dataset, tmp_path):
    for name, text in (("a.json", "[]\n"), ("a.csv", "title\n")):
        assert run(dataset, "SELECT title FROM programs WHERE false", "--out", tmp_path / name).exit_code == 0
        assert (tmp_path / name).read_text() == text
    assert run(dataset, "SELECT title FROM programs WHERE false", "--parquet", tmp_path / "a.parquet").exit_code == 0
    assert pq.read_table(tmp_path / "a.parquet").column_names == ["title"]


def test_cells_are_no_formulas_and_move_no_cursor(dataset):
    shown = run(dataset, "SELECT '=1+1' AS a, chr(27) || '[2J' AS b, -1 AS c, 'x, \"y\"' AS d, 1 AS a", "--csv").stdout
    assert shown == 'a,b,c,d,a~2\n\'=1+1,\\x1b[2J,-1,"x, ""y""",1\n'


def test_whole_numbers_are_printed_as_ids_are(dataset):
    shown = run(dataset, "SELECT 2000 AS node, 1234567.5::DOUBLE AS metres, true AS yes").stdout
    assert shown.splitlines()[1].split() == ["2000", "1,234,567.500", "yes"]


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["--out", "a.xlsx"], 1, "an answer is not written as `.xlsx`"),
        (["--out", "a"], 1, "its name has no ending"),
        (["--out", "nowhere/a.csv"], 1, "name a file in a folder that there is"),
        (["--csv", "--tsv"], 2, "only one of --csv, --tsv and --json"),
        (["--csv", "--json"], 2, "only one of --csv, --tsv and --json"),
    ],
)
def test_what_cannot_be_written_is_said(dataset, tmp_path, monkeypatch, words, status, said):
    monkeypatch.chdir(tmp_path)
    result = run(dataset, SQL, *words)
    assert result.exit_code == status and said in " ".join(result.output.split())
    assert not list(tmp_path.iterdir())


def test_a_question_that_fails_leaves_the_file_of_before(dataset, tmp_path):
    Path(tmp_path / "a.csv").write_text("kept")
    assert run(dataset, "SELECT error('no') FROM programs", "--out", tmp_path / "a.csv").exit_code == 1
    assert [path.read_text() for path in tmp_path.iterdir()] == ["kept"]


@pytest.mark.parametrize("words", [["--out", "stolen.csv"], ["--csv"], ["--parquet", "stolen.parquet"]])
@pytest.mark.parametrize("sql", ["COPY programs TO 'x.csv'", "SELECT * FROM read_text('/etc/hostname')"])
def test_nothing_outside_the_folder_is_read_or_written(dataset, tmp_path, monkeypatch, words, sql):
    monkeypatch.chdir(tmp_path)
    assert run(dataset, sql, *words).exit_code == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("sql", "said"),
    [
        ("SELECT titel FROM programs", "there is no column `titel` did you mean `title`"),
        ("SELECT p.titel FROM programs p", "there is no column `titel` did you mean `title`"),
        ("SELECT * FROM program", "there is no table `program` did you mean `programs`"),
        ("SELECT progam_text('a')", "there is no function `progam_text` did you mean `program_text`"),
        ("SELECT * FROM step", "there is no table `step` did you mean `steps`? `step` is a column"),
        ("SELECT * FROM title", "there is no table `title`"),
        ("SELECT * FROM STEP", "there is no table `STEP` did you mean `steps`?"),
        ("SELECT zzzzzz FROM programs", "there is no column `zzzzzz` `DESCRIBE programs` prints the columns"),
    ],
)
def test_an_unknown_name_is_no_fault_of_syntax_and_has_near_names(dataset, sql, said):
    result = run(dataset, sql)
    assert result.exit_code == 1 and "BAD_ARGUMENT" in result.output
    assert said in " ".join(result.output.replace("=", " ").split())


def test_no_hint_is_the_unknown_name_itself(dataset):
    """Every name of one kind, asked for as another: columns as tables, tables and functions as columns."""
    names = hearth.load(dataset)._names()
    asked = {"table": "SELECT * FROM {0}", "column": "SELECT {0} FROM ledger", "function": "SELECT {0}(1)"}
    for kind, sql in asked.items():
        for name in sorted({each for other, known in names.items() if other != kind for each in known})[::7]:
            said = " ".join(run(dataset, sql.format(f'"{name}"')).output.split())
            meant = said.partition("did you mean")[2].partition("?")[0]
            assert f"`{name.lower()}`" not in meant.lower(), said


def test_a_fault_of_syntax_stays_one(dataset):
    assert "error[SYNTAX]: Parser Error" in run(dataset, "SELEC 1").output


def test_nothing_to_compare_is_an_empty_cell(capsys):
    output.table(("activity", "LCS"), [("Read", float("nan")), ("Sleep", 0.5)])
    assert capsys.readouterr().out.splitlines() == ["activity    LCS", "Read", "Sleep     0.500"]


def test_a_class_without_conditions_is_said_so(dataset):
    shown = CliRunner().invoke(cli.app, ["augmented", str(dataset)]).stdout.splitlines()
    headings = [number for number, line in enumerate(shown) if line.startswith("Conditions of the start")]
    assert all(shown[number + 1 : number + 2] and shown[number + 1].startswith("  ") for number in headings)
    assert "No condition of the start names a sauce pan." in shown


@pytest.mark.parametrize("within", ["inf", "nan", "1e400", "99999999999999999999", "31536001"])
def test_a_time_that_no_clock_takes_is_refused(dataset, within):
    result = run(dataset, "SELECT 1", "--within", within)
    assert result.exit_code == output.USAGE, result.output
    assert "--within" in result.output
    opened = hearth.load(dataset)
    opened.within = float(within)
    with pytest.raises(HearthError, match="time limit"):
        opened.rows("SELECT 1")


@pytest.mark.parametrize("name", ["\ufeff=1+1", " =1+1", "\u200b@x", "\ufeff\ufeff+1"])
def test_a_formula_behind_unseen_characters_is_text_in_heads_too(dataset, name):
    result = run(dataset, f"SELECT '{name}' AS \"{name}\"", "--csv")
    said = shown(name)
    assert result.stdout.encode().decode("utf-8") == f"'{said}\n'{said}\n"


ENDS = {
    "return": "\r",
    "tab": "\v",
    "feed": "\f",
    "next": "\x85",
    "line": "\u2028",
    "paragraph": "\u2029",
    "group": "\x1d",
}
"""Characters that readers of lines or of tables take for the end of a row, besides the line feed."""


@pytest.mark.parametrize("flag", ["--csv", "--tsv"])
@pytest.mark.parametrize("end", ENDS.values(), ids=ENDS)
def test_no_cell_begins_a_row_within_another(dataset, tmp_path, end, flag):
    sql = f"SELECT 'a' || chr({ord(end)}) || '=cmd|calc!A0' AS w, 2 AS z"
    result = run(dataset, sql, flag)
    assert end not in result.stdout, "nor does it reach a terminal"
    assert len(result.stdout.splitlines()) == 2
    file = tmp_path / f"x.{flag[2:]}"
    run(dataset, sql, "--out", file)
    assert file.read_bytes().decode() == result.stdout
    with file.open(newline="") as lines:
        assert len(list(csv.reader(lines, delimiter="," if flag == "--csv" else "\t"))) == 2


@pytest.mark.parametrize("sign", ["＝", "＋", "－", "＠", "\r=", "\u200b＝", "=", "\t="])
def test_a_cell_that_some_spreadsheet_takes_for_a_formula_is_text(dataset, sign):
    result = run(dataset, f"SELECT '{sign}1' AS w", "--csv")
    assert result.stdout.splitlines()[1].lstrip('"').startswith("'")


@pytest.mark.parametrize("unseen", ["\u200b", "\U000e0041", "\u2060", "\u00ad", "\U000e007f", "\ufeff"])
def test_text_that_nobody_sees_is_shown(dataset, unseen):
    for words in ((), ("--csv",), ("--tsv",), ("--json",)):
        result = run(dataset, f"SELECT 'a{unseen}b' AS w", *words)
        assert result.exit_code == 0 and unseen not in result.stdout and "\\" in result.stdout
    assert json.loads(run(dataset, f"SELECT 'a{unseen}b' AS w", "--json").stdout) == [{"w": f"a{unseen}b"}]


def test_joiners_of_writing_and_pictures_stay(dataset):
    text = "\u0645\u06cc\u200c\u062e\u0648\u0627\u0647\u0645"
    assert text in run(dataset, f"SELECT '{text}' AS w").stdout


def test_values_of_all_types_are_printed_in_every_form(dataset):
    for form in ((), ("--csv",), ("--json",)):
        result = run(dataset, "FROM test_all_types()", *form)
        assert result.exit_code == 0 and "infinity" in result.output, form


def test_the_bound_on_memory_ends_with_the_command(dataset):
    resource = pytest.importorskip("resource", reason="only systems with `resource` bound a process")
    before = resource.getrlimit(resource.RLIMIT_DATA)
    assert run(dataset, "SELECT 1").exit_code == 0
    assert resource.getrlimit(resource.RLIMIT_DATA) == before
