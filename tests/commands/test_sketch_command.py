"""`sketch`: prints, judges, and says what is wrong."""

from __future__ import annotations

import json

from typer.testing import CliRunner

from hearth import cli

PROGRAM = "Read\nI read.\n\n\n[Walk] <novel> (1)\n[Grab] <novel> (1)\n[Read] <novel> (1)\n"


def run(*words):
    return CliRunner().invoke(cli.app, ["sketch", *map(str, words)])


def drawn(tmp_path, title):
    program = {"title": title, "descr": "I read.", "prog": ["read novel "], "prefix": "batch/file1_1"}
    (tmp_path / "drawn.json").write_text(json.dumps({"answer": [[0, 1, 1]], "represent": [1], "input": [program]}))
    return tmp_path / "drawn.json"


def test_a_program_is_shown_with_the_steps_that_are_kept(tmp_path):
    (tmp_path / "read.txt").write_text(PROGRAM)
    found = json.loads(run(tmp_path / "read.txt", "--json").stdout)
    assert [one["keep"] for one in found] == [[False, False, True]]
    assert "* [Read] <novel> (1)" in run(tmp_path / "read.txt").stdout


def test_sketches_of_other_programs_are_an_error(tmp_path):
    (tmp_path / "read.txt").write_text(PROGRAM)
    result = run(tmp_path / "read.txt", "--judge", drawn(tmp_path, "Something else"))
    assert "no sketch is of one of these programs" in result.output


def test_people_are_compared_step_by_step(tmp_path):
    from hearth.analysis.sketch_evaluation import Counts

    counts = Counts()
    counts.add((True, True, False), (True, False, True))
    assert counts.scores() == {"precision": 0.5, "recall": 0.5, "f1": 0.5}
