"""The shared cases that are run, scored or linted, opened where they lie beside the real data."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth.cli import app

ROOT = Path(__file__).resolve().parents[2]
CASES = Path(os.environ.get("HEARTH_REAL_DATA", ROOT.parent / "shared/real")).parent / "cases"
HOME, BARE, OFFICE = "05-vh2-home.json", "58-bare-node.json", "25-home.json"
RUNS = [
    ("05-vh2-compound-class.txt", HOME, "auto", 0, "washingmachine (300)"),
    ("07-vh2-exact-nodes.txt", HOME, "auto", 0, "<chair> to node 71 (chair), <coffeepot> to node 383"),
    ("25-reach-by-own-hands.txt", OFFICE, "default", 1, "NOT_CLOSE"),
    ("55-vh2-node-ids.txt", BARE, "auto", 0, "book (108)"),
    ("56-grab-from-opened.txt", BARE, "auto", 0, "Done: 3 steps."),
    ("58-bare-node.txt", BARE, "auto", 0, "Done: 3 steps."),
    ("82-walk-into-room.txt", OFFICE, "replay", 0, "Done: 2 steps."),
    ("82-walk-into-room.txt", OFFICE, "evolving_graph", 1, "NOT_CLOSE"),
]


def case(name: str) -> Path:
    if not (CASES / name).exists():
        pytest.skip(f"no {name} in {CASES} (they lie beside the folder HEARTH_REAL_DATA)")
    return CASES / name


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.mark.parametrize(("file", "graph", "rules", "status", "words"), RUNS)
def test_a_case_is_run_as_meant(file, graph, rules, status, words):
    done = call("run", case(file), "--graph", case(graph), "--as-is", "--rules", rules)
    assert done.exit_code == status and words in done.output, done.output


@pytest.mark.parametrize("file", ["08-init-graph-wrapper.json", "59-prefab-category.json"])
def test_a_graph_is_read(file):
    assert "BAD_GRAPH" not in call("home", "lint", case(file)).output


def test_a_goal_without_conditions_holds_at_once():
    goal = case("13-empty-vh-goal.json").read_text()
    assert "Goal: reached." in call("run", case("74-turn-to-room.txt"), "--home", "maple", "--goal", goal).output


def test_turning_to_a_room_is_no_fault():
    assert call("check", case("74-turn-to-room.txt")).exit_code == 0


def test_replay_names_what_it_takes():
    done = call("replay", case("83-replay-json.json"))
    assert done.exit_code and "release" in done.output and "damaged" not in done.output


def test_codes_of_scores_and_goals_behind_a_failure():
    found = json.loads(call("score", "program", case("73-score-codes.jsonl"), "--json").stdout)
    assert [(row["code"], row["executable"]) for row in found["scores"]] == [("WRONG_ARITY", 0), (None, 0), (None, 0)]
    rows = call("score", "program", case("79-goal-without-run.jsonl"), "--rules", "replay", "--json").stdout
    (row,) = json.loads(rows)["scores"]
    assert (row["executable"], row["goal"]) == (0, 0)
