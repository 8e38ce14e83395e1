"""`environment conditions|realism|diversity|preconditions`, through typer's runner."""

import json
from collections import Counter

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.pipelines import realism

WATCHING = (
    "Watch TV\nSit.\n\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n"
    "[Watch] <television> (1)\n"
)
LATE = "Watch TV\nSit.\n\n\n[Walk] <television> (1)\n[TurnTo] <television> (1)\n[Watch] <television> (1)\n" \
    "[SwitchOn] <television> (1)\n"  # fmt: skip


def run(*arguments):
    return CliRunner().invoke(app, ["environment", *map(str, arguments)])


@pytest.fixture
def watching(tmp_path):
    path = tmp_path / "tv.txt"
    path.write_text(WATCHING)
    return path


def test_conditions_say_which_step_needs_them(watching):
    told = json.loads(run("conditions", watching, "--json").stdout)
    assert {"step": 2, "condition": "is_off(television (1))", "needed": True} in told["conditions"]
    rules = {c["condition"]: c for c in told["release_rules"]}
    assert rules["free(sofa (1))"]["ours"]
    assert all(c["ours"] or c["why"] for c in told["release_rules"])
    assert "the step needs it" in run("conditions", watching).stdout


def test_two_steps_at_odds_are_shown(tmp_path):
    (tmp_path / "late.txt").write_text(LATE)
    result = run("conditions", tmp_path / "late.txt", "--json")
    assert result.exit_code == 1
    assert [step["line"] for step in json.loads(result.stdout)["steps"]] == [7, 8]
    assert "step 3, line 7: [Watch]" in run("conditions", tmp_path / "late.txt").stdout


def test_samples_of_one_program_differ(watching):
    told = json.loads(run("diversity", watching, "--samples", 20, "--json").stdout)
    assert told["samples"] == told["distinct"] == 20 and told["failed"] == {}
    assert told["preconditions"]["television"] == {"facing": 1, "is_off": 1, "plugged": 1, "together": 1}
    assert run("diversity", watching, "--home", "mapel").exit_code == 1


def test_bars_count_what_is_about_a_class(watching):
    told = json.loads(run("preconditions", watching, "--class", "television", "--json").stdout)
    assert told == {"programs": {"television": {"facing": 1, "is_off": 1, "plugged": 1, "together": 1}}}
    assert "#" in run("preconditions", watching, "--class", "television").stdout


def test_distances_are_0_for_equal_and_1_for_disjoint_distributions():
    one = {"cup": Counter(table=2, sink=2), "milk": Counter(fridge=4), "pen": Counter(desk=1)}
    other = {"cup": Counter(table=5, sink=5), "milk": Counter(floor=1)}
    found = realism.distances(one, other)
    assert found == {"cup": (0.0, 4, 10), "milk": (1.0, 4, 1)}
    assert realism.overall(found) == 0.5


def test_realism_reads_a_release_and_draws_heat_maps(real_data, tmp_path):
    release = real_data / "activityprograms-sample.zip"
    result = run("realism", release, "--limit", 6, "--home", "maple", "--out", tmp_path, "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert 0 <= told["states"] <= told["places"] < 1
    assert (tmp_path / "release.svg").read_text().count("<rect") > 5
    assert (tmp_path / "sampled.svg").read_text().startswith("<svg")


def test_each_help_has_an_example():
    for command in ("conditions", "realism", "diversity", "preconditions"):
        assert f"python cli.py environment {command}" in run(command, "--help").stdout
