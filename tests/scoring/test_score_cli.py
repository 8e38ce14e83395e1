import json
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.schemas.graph import to_release

HERE = Path(__file__).resolve().parents[1] / "golden/score"
PREDICTIONS = "predictions.jsonl"


@pytest.fixture
def score(tmp_path, flat, monkeypatch):
    """Runs `score` in a folder that holds the golden predictions and the flat."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / PREDICTIONS).write_bytes((HERE / PREDICTIONS).read_bytes())
    (tmp_path / "flat.json").write_text(json.dumps(to_release(flat)))

    def run(*args):
        return CliRunner().invoke(app, ["score", *args])

    return run


@pytest.mark.parametrize(
    ("name", "args"),
    [
        ("lcs.txt", ["lcs", PREDICTIONS]),
        ("lcs.json", ["lcs", PREDICTIONS, "--json"]),
        ("program.txt", ["program", PREDICTIONS, "--graph", "flat.json", "--by", "activity"]),
        ("program.json", ["program", PREDICTIONS, "--graph", "flat.json", "--json"]),
        ("program_alone.txt", ["program", PREDICTIONS]),
        ("graphs.txt", ["graphs", "flat.json", "flat.json", "--nodes", "20,22/21"]),
        ("graphs.json", ["graphs", "flat.json", "flat.json", "--nodes", "20/21", "--match", "swap1", "--json"]),
    ],
)
def test_prints(score, golden, name, args):
    found = score(*args)
    assert found.exit_code == 0, found.output
    golden(name, found.stdout)


def test_json_holds_the_mean_and_each_value(score):
    found = json.loads(score("lcs", PREDICTIONS, "--json").stdout)
    values = [each["step"] for each in found["scores"]]
    assert found["mean"]["step"]["mean"] == pytest.approx(sum(values) / len(values))
    assert [each["id"] for each in found["scores"] if each["missing"]] == ["nothing yet"]


def test_the_environment_may_stand_in_the_row(score, tmp_path):
    row = {"id": "a", "predicted": "[Walk] <cup> (1)", "reference": "[Walk] <cup> (1)"}
    (tmp_path / "rows.jsonl").write_text(json.dumps({**row, "graph": "flat.json"}))
    assert json.loads(score("program", "rows.jsonl", "--json").stdout)["mean"]["f1"]["mean"] == 1
    (tmp_path / "rows.jsonl").write_text(json.dumps({**row, "home": "maple"}))
    assert json.loads(score("program", "rows.jsonl", "--json").stdout)["mean"]["executable"]["mean"] == 1


@pytest.mark.parametrize("text", [
    "[Walk] <sofa> (1)\n[Sit] <sofa> (1)", "1. Walk to the sofa\n2. Sit on the sofa.",
    "Step 1: walk to the sofa\nStep 2: sit on the sofa",
])  # fmt: skip
def test_lcs_reads_what_program_reads(score, tmp_path, text):
    row = {"id": "a", "predicted": text, "reference": "[Walk] <sofa> (1)\n[Sit] <sofa> (1)"}
    (tmp_path / "rows.jsonl").write_text(json.dumps(row))
    whole = json.loads(score("program", "rows.jsonl", "--json").stdout)["scores"][0]
    found = json.loads(score("lcs", "rows.jsonl", "--json").stdout)["scores"][0]
    assert (found["step"], found["unread"]) == (whole["lcs_step"], 0) == (1, 0)


def test_what_is_not_read_is_counted_or_refused(score, tmp_path):
    row = {"id": "a", "predicted": "sit = robot.sit(1 + sofa)", "reference": "[Sit] <sofa> (1)"}
    (tmp_path / "rows.jsonl").write_text(json.dumps(row))
    assert "1 with lines that are not steps" in score("lcs", "rows.jsonl").stdout
    found = json.loads(score("lcs", "rows.jsonl", "--json").stdout)
    assert (found["unread"], found["scores"][0]["unread"], found["scores"][0]["step"]) == (1, 1, 0)
    (tmp_path / "rows.jsonl").write_text(json.dumps(row | {"reference": "robot.sit(1 + sofa)"}))
    for command in ("lcs", "program"):
        refused = score(command, "rows.jsonl")
        assert refused.exit_code == 1 and "`reference` of id `a` is text without a step" in refused.output


@pytest.mark.parametrize("command", ["program", "dataset", "graphs"])
def test_the_help_shows_the_published_reading_as_the_default(score, command):
    words = " ".join(score(command, "--help").stdout.split())
    assert "[default: swap1]" in words and "[default: own]" in words


@pytest.mark.parametrize("one", ["sofa", "couch"])
@pytest.mark.parametrize("other", ["sofa", "couch", "settee"])
def test_a_goal_is_reached_whatever_the_thing_is_called(score, tmp_path, one, other):
    predicted, reference = (f"[Walk] <{name}> (1)\n[Sit] <{name}> (1)" for name in (one, other))
    row = {"id": "a", "home": "maple", "predicted": predicted, "reference": reference}
    (tmp_path / "rows.jsonl").write_text(json.dumps(row))
    assert json.loads(score("program", "rows.jsonl", "--json").stdout)["mean"]["goal"]["mean"] == 1


@pytest.mark.parametrize(
    ("args", "status", "said"),
    [
        (["lcs", "none.jsonl"], 1, "error[MISSING_FILE]"),
        (["lcs", "flat.json"], 1, "error[BAD_TABLE]: no `id`, `predicted`, `reference`"),
        (["lcs", PREDICTIONS, "--references", "references.jsonl"], 1, "error[UNKNOWN_ID]"),
        (["program", "rows.jsonl"], 1, "the environment of `a` (rows.jsonl:1)"),
        (["graphs", "flat.json", PREDICTIONS, "--nodes", "1"], 1, "error[BAD_JSON]"),
        (["graphs", "flat.json", "flat.json", "--nodes", "cup"], 1, "error[SYNTAX]"),
        (["lcs"], 2, "Missing argument"),
        (["graphs", "flat.json", "flat.json"], 2, "--nodes"),
    ],
)
def test_bad_input_is_one_clear_error(score, tmp_path, args, status, said):
    (tmp_path / "references.jsonl").write_text('{"id": "other", "reference": ""}\n')
    (tmp_path / "rows.jsonl").write_text('{"id": "a", "predicted": "", "reference": "", "graph": "none.json"}\n')
    found = score(*args)
    assert found.exit_code == status, found.output
    assert said in found.output
    assert "Traceback" not in found.output


def test_a_row_may_have_a_goal_of_its_own(score, tmp_path):
    row = {"predicted": "[Walk] <cup> (1.20)\n[Grab] <cup> (1.20)", "reference": "[Walk] <cup> (1.20)"}
    record = {"actions": ["GRAB|TOUCH"], "goal": [{"from_id": 9, "relation_type": "HOLDS_RH", "to_id": 20}]}
    goals = [{"goal": "GRAB(cup) then HOLDS(agent, cup)"}, {"goal": "OPEN(fridge) or WALK: 2"}, {"vh_goal": record}]
    lines = (json.dumps({"id": number, **row, **goal}) for number, goal in enumerate([*goals, {}]))
    (tmp_path / "rows.jsonl").write_text("\n".join(lines))
    found = json.loads(score("program", "rows.jsonl", "--graph", "flat.json", "--json").stdout)
    assert [each.get("goal") for each in found["scores"]] == [1, 0, 1, None]
    assert [each["goal_whole"] for each in found["scores"]] == [1, 0, 1, 1]
    assert found["reached_before"] == 1  # the reference walks: it achieves nothing that lasts
    assert found["signatures"]["goal"] == "goal|level:program|empty:0|own:3|v2"
    assert found["signatures"]["goal_whole"] == "goal_whole|level:program|empty:1|own:3|v2"
    (tmp_path / "rows.jsonl").write_text(json.dumps({"id": "a", **row, "goal": "GRAB(cup) then SHINY(cup)"}))
    refused = score("program", "rows.jsonl", "--graph", "flat.json").output
    assert "SHINY is not a known state" in refused and "goal of `a`, row 1:1:16" in refused


@pytest.mark.parametrize("command", ["lcs", "program", "graphs"])
def test_help_shows_an_example(score, command):
    found = score(command, "--help")
    assert found.exit_code == 0
    assert f"hearth score {command}" in found.output


@pytest.mark.skipif("HEARTH_REFRESH" in os.environ, reason="golden files are being written")
def test_golden_files_are_the_ones_compared():
    assert {path.name for path in HERE.iterdir()} == {
        PREDICTIONS,
        *("lcs.txt", "lcs.json", "program.txt", "program.json", "program_alone.txt", "graphs.txt", "graphs.json"),
    }
