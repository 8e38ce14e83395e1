"""Commands that read a published dataset, as users give them: what they print, their JSON, and their exit status."""

import json
import shutil

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.commands import output

SQL = "SELECT origin, count(*) AS n FROM programs GROUP BY origin ORDER BY origin"


def run(*words):
    return CliRunner().invoke(cli.app, [str(word) for word in words], catch_exceptions=True)


def answer(*words):
    result = run(*words, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


@pytest.fixture(scope="module")
def dataset(made):
    return made.out / "publish"


@pytest.fixture
def changed(dataset, tmp_path):
    return shutil.copytree(dataset, tmp_path / "changed")


def test_a_question_is_answered_as_a_table_and_for_machines(dataset):
    rows = answer("query", dataset, SQL)
    assert {row["origin"] for row in rows} >= {"crowd", "augmented"}
    shown = run("query", dataset, SQL)
    assert shown.exit_code == 0
    assert all(str(row["n"]) in shown.stdout for row in rows)


def test_a_limited_number_of_rows_is_printed_with_a_note(dataset):
    shown = run("query", dataset, "SELECT program_id FROM programs ORDER BY ALL", "--rows", "1")
    assert shown.exit_code == 0
    assert "... more than 1 rows; --rows 0 prints all" in shown.stdout
    assert "more than" not in run("query", dataset, SQL, "--rows", "0").stdout


def test_nothing_of_the_files_is_kept_for_a_query_that_will_not_come(dataset):
    assert answer("query", dataset, "SELECT current_setting('parquet_metadata_cache') AS kept") == [{"kept": False}]


@pytest.mark.parametrize(
    ("sql", "why"), [("SELECT nothing FROM programs", "nothing"), ("COPY programs TO '{}'", "can only be read")]
)
def test_a_wrong_or_a_writing_question_is_refused(dataset, tmp_path, sql, why):
    target = tmp_path / "stolen.csv"
    result = run("query", dataset, sql.format(target))
    assert result.exit_code == 1 and why in result.output
    assert not target.exists()


def test_a_dataset_is_as_it_says(dataset):
    assert answer("verify", dataset, "-j", "1")["faults"] == []
    assert run("verify", dataset, "-j", "1").exit_code == 0


def test_a_changed_byte_is_named(changed):
    part = next((changed / "executions").glob("*.parquet"))
    content = bytearray(part.read_bytes())
    content[len(content) // 2] ^= 0xFF
    part.write_bytes(content)
    result = run("verify", changed, "-j", "1")
    assert result.exit_code == 1
    assert part.name in result.output


def test_two_datasets_that_are_the_same_differ_in_nothing(dataset, changed):
    assert run("diff", dataset, changed).exit_code == 0
    assert not any(table["changed"] or table["added"] or table["removed"] for table in answer("diff", dataset, changed))


def test_augmented_programs_are_compared_with_the_thesis(dataset, tmp_path):
    figures = answer("augmented", dataset)
    counted = {row["origin"]: row["n"] for row in answer("query", dataset, SQL)}
    assert figures["table"]["augmented"]["ours"]["programs"] == counted["augmented"]
    shown = run("augmented", dataset, "--out", tmp_path / "figures")
    assert shown.exit_code == 0
    assert "13.26" in shown.stdout, "table 5.1"
    headings = [part for part in shown.stdout.split("\n\n") if part.startswith("Conditions of the start")]
    assert all(len(part.splitlines()) > 1 for part in headings)
    assert any((tmp_path / "figures").iterdir())


@pytest.mark.parametrize("form", ["jsonl", "code", "nl"])
def test_a_dataset_is_exported(dataset, tmp_path, form):
    result = run("export", dataset, "--format", form, "--out", tmp_path / form, "--limit", "3")
    assert result.exit_code == 0, result.output
    assert any(path.is_file() and path.stat().st_size for path in (tmp_path / form).rglob("*"))


@pytest.mark.parametrize("asked", [("--format", "nothing"), ()])
def test_an_unknown_or_missing_format_is_answered_with_those_there_are(dataset, tmp_path, asked):
    result = run("export", dataset, *asked, "--out", tmp_path / "x")
    assert result.exit_code == 2
    assert "jsonl" in result.output


@pytest.mark.parametrize("command", ["query", "verify", "augmented", "report"])
def test_a_missing_dataset_is_reported(tmp_path, command):
    more = ["SELECT 1"] if command == "query" else []
    result = run(command, tmp_path / "nowhere", *more)
    assert result.exit_code == 1
    assert "nowhere" in result.output


def test_a_figure_that_there_is_not_is_an_empty_cell(capsys):
    output.table(("activity", "LCS"), [("Watch TV", float("nan")), ("Read", 0.25)])
    assert capsys.readouterr().out == "activity    LCS\nWatch TV\nRead      0.250\n"


def test_statistics_of_one_program_have_no_nan(tmp_path):
    (tmp_path / "one.txt").write_text("Watch TV\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n")
    result = run("corpus", "stats", tmp_path / "one.txt")
    assert result.exit_code == 0 and "Watch TV" in result.stdout
    assert "nan" not in result.stdout.split()
