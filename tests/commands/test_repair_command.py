"""`repair`: the dialogue of failures and fixes, against golden pages."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth import cli

GOLDEN = Path(__file__).resolve().parents[1] / "golden/repair"
REFRESH = "if the new text is right: HEARTH_REFRESH=1 python -m pytest tests/commands/test_repair_command.py"
PAGES = {
    "watch_tv": ["watch_tv.txt", "--seed", "3", "--variants", "2"],
    "watch_tv_thesis": ["watch_tv.txt", "--seed", "2", "--strength", "thesis"],
    "watch_tv_doors_closed": ["watch_tv.txt", "--perturb", "door", "--perturb", "pet", "--perturb", "plugged"],
    "drink_water": ["drink_water.txt", "--perturb", "container", "--perturb", "open", "--perturb", "full_hands"],
    "drink_water_seated": ["drink_water.txt", "--perturb", "seated", "--perturb", "free", "--perturb", "on"],
}


def repair(*arguments):
    return CliRunner().invoke(cli.app, ["repair", *map(str, arguments)])


@pytest.mark.parametrize("page", PAGES)
def test_golden_dialogues(page, monkeypatch):
    monkeypatch.chdir(GOLDEN)
    result = repair(*PAGES[page])
    shown = f"{result.stdout}status {result.exit_code}\n"
    path = GOLDEN / f"{page}.expected"
    if os.environ.get("HEARTH_REFRESH"):
        path.write_text(shown)
    assert shown == path.read_text(), REFRESH


def test_json_says_the_same(monkeypatch):
    monkeypatch.chdir(GOLDEN)
    result = repair(*PAGES["watch_tv_doors_closed"], "--json")
    report = json.loads(result.stdout)
    (pair,) = report["pairs"]
    page = (GOLDEN / "watch_tv_doors_closed.expected").read_text()
    assert (report["home"], report["seed"], pair["failure"]) == ("maple", 0, None)
    assert [one["kind"] for one in pair["perturbations"]] == ["plugged", "door", "pet"]
    assert pair["attempts"][0]["before"] == pair["original"]
    for attempt in pair["attempts"]:
        assert (
            f"{attempt['attempt']:3}  step {attempt['step']} failed: {attempt['before'][attempt['step'] - 1]}" in page
        )
        assert f"({attempt['failure']['code']})" in page
    for step in pair["repaired"]:
        assert step in page


def test_an_unknown_kind_is_reported_with_the_known_ones():
    result = repair(GOLDEN / "watch_tv.txt", "--perturb", "colour")
    assert result.exit_code == 2
    assert "unknown perturbation `colour`" in result.output
    assert "at_reach" in result.output


def test_a_program_without_preconditions(tmp_path):
    path = tmp_path / "turn.txt"
    path.write_text("Turn\n\n\n[TurnTo] <television> (1)\n")
    result = repair(path, "--perturb", "open")
    assert result.exit_code == 0
    assert "has no precondition that can be perturbed" in result.output


def test_a_program_that_no_start_can_help(tmp_path):
    path = tmp_path / "cup.txt"
    path.write_text("Sit on a cup\n\n\n[Walk] <cup> (1)\n[Sit] <cup> (1)\n")
    result = repair(path)
    assert result.exit_code == 1
    assert "NOT_AFFORDED" in result.output
    assert json.loads(repair(path, "--json").stdout)["failure"]["code"] == "NOT_AFFORDED"
