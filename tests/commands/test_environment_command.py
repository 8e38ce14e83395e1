"""`environment conditions|realism|diversity|preconditions`, through typer's runner."""

import json
from collections import Counter

import pytest
from typer.testing import CliRunner

from hearth.analysis import object_distribution
from hearth.cli import app

WATCHING = (
    "Watch TV\nSit.\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n"
    "[Watch] <television> (1)\n"
)
LATE = "Watch TV\nSit.\n\n\n[Walk] <television> (1)\n[TurnTo] <television> (1)\n[PlugOut] <television> (1)\n" \
    "[SwitchOn] <television> (1)\n"  # fmt: skip


def run(*arguments):
    return CliRunner().invoke(app, ["environment", *map(str, arguments)])


@pytest.fixture
def watching(tmp_path):
    path = tmp_path / "tv.txt"
    path.write_text(WATCHING)
    return path


def test_conditions_say_which_step_needs_them(watching):
    found = json.loads(run("conditions", watching, "--json").stdout)
    assert {"step": 2, "condition": "is_off(television (1))", "needed": True} in found["conditions"]
    rules = {c["condition"]: c for c in found["release_rules"]}
    assert rules["free(sofa (1))"]["ours"]
    assert all(c["ours"] or c["why"] for c in found["release_rules"])
    assert "the step needs it" in run("conditions", watching).stdout


def test_two_steps_at_odds_are_shown(tmp_path):
    (tmp_path / "late.txt").write_text(LATE)
    result = run("conditions", tmp_path / "late.txt", "--json")
    assert result.exit_code == 1
    assert [step["line"] for step in json.loads(result.stdout)["steps"]] == [7, 8]
    assert "step 3, line 7: [PlugOut]" in run("conditions", tmp_path / "late.txt").stdout


def test_samples_of_one_program_differ(watching):
    found = json.loads(run("diversity", watching, "--samples", 20, "--json").stdout)
    assert found["samples"] == found["distinct"] == 20 and found["failed"] == {}
    assert found["preconditions"]["television"] == {"facing": 1, "is_off": 1, "plugged": 1, "together": 1}
    assert run("diversity", watching, "--home", "mapel").exit_code == 2


def test_bars_count_what_is_about_a_class(watching):
    found = json.loads(run("preconditions", watching, "--class", "television", "--json").stdout)
    assert found == {"programs": {"television": {"facing": 1, "is_off": 1, "plugged": 1, "together": 1}}}
    assert "#" in run("preconditions", watching, "--class", "television").stdout


def test_distances_are_0_for_equal_and_1_for_disjoint_distributions():
    one = {"cup": Counter(table=2, sink=2), "milk": Counter(fridge=4), "pen": Counter(desk=1)}
    other = {"cup": Counter(table=5, sink=5), "milk": Counter(floor=1)}
    found = object_distribution.distances(one, other)
    assert found == {"cup": (0.0, 4, 10), "milk": (1.0, 4, 1)}
    assert object_distribution.overall(found) == 0.5


def test_realism_reads_a_release_and_draws_heat_maps(real_data, tmp_path):
    release = real_data / "activityprograms-sample.zip"
    result = run("realism", release, "--limit", 6, "--home", "maple", "--out", tmp_path, "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert 0 <= found["states"] <= found["places"] < 1
    assert (tmp_path / "release.svg").read_text().count("<rect") > 5
    assert (tmp_path / "sampled.svg").read_text().startswith("<svg")


def test_each_help_has_an_example():
    for command in ("conditions", "realism", "diversity", "preconditions"):
        assert f"hearth environment {command}" in run(command, "--help").stdout


def test_one_environment_is_drawn_for_a_program_a_goal_or_nothing(watching, tmp_path):
    out = tmp_path / "tv.json"
    found = json.loads(run("sample", watching, "--nodes", 290, "--out", out, "--json").stdout)
    nodes = {node["id"]: node["class_name"] for node in json.loads(out.read_text())["nodes"]}
    objects = {row["object"]: row["node"] for row in found["objects"]}
    assert 275 <= found["nodes"] == len(nodes) <= 305
    assert "television" in nodes[objects["television (1)"]]
    goal = json.loads(run("sample", "--goal", "ON(plate, kitchen_table): 9", "--json").stdout)["goal"]
    assert goal[0]["wanted"] == 9 > goal[0]["met"]
    assert json.loads(run("sample", "--seed", 7, "--json").stdout)["goal"] == []
    goals = ("--goal", "OPEN(fridge) then PUTIN(milk, fridge)", "--goal", "LOOKAT or WATCH", "--goal", "CLEAN(stove)")
    found = json.loads(run("sample", *goals, "--json").stdout)["goal"]
    assert [(row["predicate"], row["wanted"], row["met"]) for row in found] == [
        ("CLEAN(stove)", 1, 0),
        ("(OPEN(fridge)) then ([PutIn](milk, fridge))", 1, 0),
        ("([LookAt]) or ([Watch])", 1, 0),
    ]


@pytest.mark.parametrize(
    ("goal", "code"),
    [
        ("ON plate", "UNKNOWN_ACTION"),
        ("ON(plate", "SYNTAX"),
        ("ON(plate, kitchen_table): 12", "NO_PLACE"),
        ("ON(plte, sofa)", "UNKNOWN_OBJECT"),
        ("@none.txt", "MISSING_FILE"),
    ],
)
def test_goals_that_cannot_be_are_refused(goal, code):
    done = run("sample", "--goal", goal, "--json")
    assert done.exit_code == 1
    assert [fault["code"] for fault in json.loads(done.stdout)["errors"]] == [code]


def test_a_program_and_a_goal_exclude_each_other(watching):
    assert run("sample", watching, "--goal", "CLEAN(stove)").exit_code == 1


def test_rules_are_counted_over_a_source(watching):
    found = json.loads(run("rules", watching.parent, "--json").stdout)
    counts = {row["condition"]: row for row in found["conditions"]}
    assert found["programs"] == 1 and counts["free"]["ours"] == 1
    for row in found["conditions"]:
        assert row["by_rules"] == row["ours"] + row["not needed"] + row["refused"]
