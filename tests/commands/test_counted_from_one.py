"""Steps and lines are counted from 1, in text and in JSON, by every command that names one."""

from __future__ import annotations

import json
import re

import pytest
from typer.testing import CliRunner

from hearth.cli import app

STEPS = ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Open] <fridge> (1)", "[Walk] <sofa> (1)"]
THIRD = "T\n\n\n" + "\n".join(STEPS) + "\n"
"""The third step fails, in line 6 of the file."""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "third.txt"
    path.write_text(THIRD)
    return path


def call(*words):
    return CliRunner().invoke(app, [*map(str, words)])


def test_run_and_repair_name_the_third_step(file):
    for command in (
        ["run", file, "--home", "maple"],
        ["repair", file, "--home", "maple"],
        ["environment", "conditions", file],
    ):
        text = call(*command).stdout
        assert re.search(r"step 3 failed: \[Open\] <fridge>", text), (command, text)
        found = json.loads(call(*command, "--json").stdout)
        failure = found.get("failure") or {}
        assert failure.get("step", 3) == 3 and failure.get("tick", 2) == 2
        assert "step 3 failed" in json.dumps(found)


def test_score_names_the_third_line(tmp_path):
    rows = tmp_path / "rows.jsonl"
    rows.write_text(json.dumps({"id": 1, "predicted": "\n".join(STEPS), "reference": STEPS[0]}) + "\n")
    found = json.loads(call("score", "program", rows, "--home", "maple", "--json").stdout)
    assert found["scores"][0]["failed_line"] == 3 and found["failed_at"] == {"3": 1}


def test_check_names_the_line_of_the_file(tmp_path):
    path = tmp_path / "bad.txt"
    path.write_text("\n".join(["T", "", "", *STEPS[:2], "[Fly] <fridge> (1)", STEPS[3]]) + "\n")
    assert "bad.txt:6:" in call("check", path).output
    (fault,) = json.loads(call("check", path, "--json").stdout)["files"][0]["faults"]
    assert fault["line"] == 6


def test_attempts_of_a_repair_are_counted_alike(tmp_path):
    path = tmp_path / "tv.txt"
    path.write_text("TV\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[TurnTo] <television> (1)\n")
    command = ["repair", path, "--home", "maple", "--seed", "3", "--perturb", "plugged", "--perturb", "sitting"]
    text, found = call(*command).stdout, json.loads(call(*command, "--json").stdout)
    attempts = [each for pair in found["pairs"] for each in pair["attempts"]]
    said = re.findall(r"^ *(\d+)  step (\d+) failed: ", text, re.MULTILINE)
    assert attempts and said == [(str(each["attempt"]), str(each["step"])) for each in attempts]
    for each in attempts:
        assert each["failure"]["step"] == each["step"] and each["step"] >= 1
        assert each["before"][each["step"] - 1].startswith(f"[{each['failure']['action']}]")
