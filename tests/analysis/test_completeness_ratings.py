"""Completeness: what repairing inserts, sheets for raters, medians, agreement."""

from __future__ import annotations

import csv
import io

import pytest
from typer.testing import CliRunner

from hearth.analysis import completeness_ratings
from hearth.analysis.completeness_ratings import Completeness
from hearth.cli import app
from hearth.kb import action_grammar
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_program


@pytest.mark.parametrize(
    ("steps", "expected"),
    [
        ("[Walk] <sofa> (1)\n[Sit] <sofa> (1)", Completeness.COMPLETE),
        ("[Walk] <bedroom> (1)\n[Sit] <sofa> (1)", Completeness.MINOR),
        ("[Walk] <television> (1)\n[TurnTo] <television> (1)\n[Watch] <television> (1)", Completeness.CRUCIAL),
        ("[Walk] <kitchen> (1)\n[Drink] <milk> (1)", Completeness.CRUCIAL),
    ],
)
def test_the_estimate_is_what_has_to_be_inserted(knowledge, maple, steps, expected):
    program = action_grammar.check(parse_program(f"{steps}\n")[0], knowledge)[0]
    assert completeness_ratings.estimate(program, maple, knowledge, 0) == expected


def test_a_sheet_has_every_program_for_every_rater():
    program = parse_program("Nap\nOn it.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n")[0]
    rows = list(csv.reader(io.StringIO(completeness_ratings.sheet([("p1", program), ("p2", Program("T"))], 3))))
    assert len(rows) == 1 + 6
    assert rows[1] == ["p1", "Nap", "On it.", "[Walk] <sofa> (1)\n[Sit] <sofa> (1)", "rater 1", ""]
    assert "3 something crucial" in rows[0][-1]


def test_answers_are_read_back_and_medians_taken(tmp_path):
    file = tmp_path / "a.csv"
    rows = "".join(f"p1,,,,r{n},{answer}\n" for n, answer in enumerate("11323"))
    file.write_text(f"program_id,title,description,program,rater,rating (1)\n{rows}p2,,,,r1,2\np3,,,,r1,\n")
    medians = completeness_ratings.medians(completeness_ratings.read_sheets([file]))
    assert medians == {"p1": Completeness.MINOR, "p2": Completeness.MINOR}
    assert completeness_ratings.agreement(medians, {"p1": Completeness.MINOR, "p2": Completeness.CRUCIAL}) == 0.5
    assert completeness_ratings.shares(medians.values())[Completeness.MINOR] == 1


def test_answers_that_are_no_ratings_are_told_by_line(tmp_path):
    file, other = tmp_path / "a.csv", tmp_path / "b.csv"
    file.write_text("program_id,rating\np1,4\np2,fine\np3,1\n")
    other.write_text("program,rating\n")
    with pytest.raises(HearthError) as caught:
        completeness_ratings.read_sheets([file, other])
    assert [(fault.code, fault.line) for fault in caught.value.diagnostics] == [("BAD_TABLE", n) for n in (2, 3, 1)]


def test_the_commands(tmp_path):
    source, sheet = tmp_path / "a.txt", tmp_path / "sheet.csv"
    source.write_text("Nap\nOn the sofa.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n")
    done = CliRunner().invoke(app, ["corpus", "sheet", str(source), "--raters", "2", "--out", str(sheet)])
    assert done.exit_code == 0, done.output
    sheet.write_text(
        "".join(f"{line}1\n" if line.endswith(",") else f"{line}\n" for line in sheet.read_text().split("\n"))
    )
    result = CliRunner().invoke(app, ["corpus", "completeness", str(source), "--sheet", str(sheet)])
    assert result.exit_code == 0, result.output
    assert "agree on 100%" in result.stdout


def test_of_many_rows_that_are_no_ratings_some_are_reported(tmp_path):
    (tmp_path / "a.csv").write_text("program_id,rating\n" + "p1,9\n" * 5_000)
    with pytest.raises(HearthError) as caught:
        completeness_ratings.read_sheets([tmp_path / "a.csv"])
    assert len(caught.value.diagnostics) == completeness_ratings.MOST_FAULTS
