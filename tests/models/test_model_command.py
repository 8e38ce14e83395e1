"""`model`: from a dataset to a checkpoint, predictions, scores and a program that runs; and what is bad input."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth import cli


def call(*words):
    return CliRunner().invoke(cli.app, ["model", *map(str, words)])


@pytest.fixture(scope="module")
def checkpoint(made, tmp_path_factory):
    folder = tmp_path_factory.mktemp("checkpoint") / "nearest"
    result = call("train", "nearest", made.out, "--out", folder, "--json")
    assert result.exit_code == 0, result.output
    facts = json.loads(result.stdout)
    assert facts["split"] == "activities" and facts["train"] > 0 and len(facts["digest"]) == 64
    return folder


def test_list():
    rows = json.loads(call("list", "--json").stdout)
    assert {"name", "input"} <= set(rows[0])
    assert {row["input"] for row in rows} <= {"text", "sketch", "film", "episode"}
    known = {row["name"]: row for row in rows}
    assert known["goal-inference"]["trained"] and known["helping-subgoals"]["trained"]
    assert "nearest" in call("list").output


@pytest.mark.parametrize("words", [("train", "goal-inference", "X", "--out", "Y"), ("show", "goal-inference", "sit")])
def test_what_writes_no_programs_says_what_it_is_for(words, tmp_path):
    result = call(*words)
    assert result.exit_code == 1 and "writes no programs" in str(result.output) + str(result.stderr or "")


def test_predictions_are_what_score_reads(checkpoint, made, tmp_path):
    out = tmp_path / "p.jsonl"
    result = call("predict", checkpoint, made.out, "--part", "t", "--out", out, "--json")
    assert result.exit_code == 0, result.output
    rows = [json.loads(line) for line in out.read_text().splitlines()]
    assert len(rows) == json.loads(result.stdout)["predictions"] > 0
    result = call("score", out, made.out, "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert found["count"] == len(rows) and 0 <= found["mean"]["lcs_step"]["mean"] <= 1
    same = CliRunner().invoke(cli.app, ["score", "dataset", str(made.out), str(out), "--json"])
    scored = {row["id"]: row for row in json.loads(same.stdout)["scores"]}
    mean = sum(scored[row["id"]]["lcs_step"] for row in rows) / len(rows)
    assert found["mean"]["lcs_step"]["mean"] == pytest.approx(mean)


def test_repaired_predictions_run(checkpoint, made, tmp_path):
    out = tmp_path / "p.jsonl"
    assert call("predict", checkpoint, made.out, "--part", "t", "--out", out, "--repair").exit_code == 0
    mean = json.loads(call("score", out, made.out, "--json").stdout)["mean"]
    assert mean["executable"]["mean"] == mean["parsable"]["mean"] == 1


TEXTS = {
    "usual": "Go to the kitchen, open the fridge and take the milk",
    "another language": "Hände waschen und dann fernsehen, bitte",
    "other letters": "打开电视，坐下",
    "long": "walk to the fridge " * 2_500,
    "what no home has": "Launch the space rocket from the volcano",
    "signs": "\x00\x1b[31m!?!",
    "empty": "",
    "blank": "  \n ",
}


@pytest.mark.parametrize("kind", TEXTS)
def test_any_text_gives_a_program_that_runs_or_a_failure(checkpoint, kind):
    result = call("show", checkpoint, TEXTS[kind], "--home", "maple", "--json")
    assert "Traceback" not in result.output and result.exit_code in (0, 1), result.output
    found = json.loads(result.stdout)
    assert {"words", "sketch", "program", "executable", "failure"} <= set(found)
    assert found["executable"] == (result.exit_code == 0) == (found["failure"] is None)
    if kind in ("empty", "blank"):
        assert found["failure"]["code"] == "EMPTY"
    plain = call("show", checkpoint, TEXTS[kind], "--home", "maple")
    assert plain.exit_code == result.exit_code and "\x1b" not in plain.output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("train", "nearst", "x", "--out", "y"), "did you mean `nearest`"),
        (("show", "nowhere", "Watch TV"), "no checkpoint here"),
        (("show", "nearest", "Watch TV"), "model train nearest"),
    ],
)
def test_unknown_names(words, message):
    result = call(*words)
    assert result.exit_code in (1, 2) and message in result.output and "Traceback" not in result.output


@pytest.mark.parametrize("name", ["mle-composed", "retrieve-edit"])
def test_models_that_come_with_hearth_write_programs_at_once(name):
    assert name in [row["name"] for row in json.loads(call("list", "--json").stdout) if row["trained"]]
    result = call("show", name, "Turn on the TV and sit down", "--home", "maple", "--beam", "2", "--json")
    assert result.exit_code == 0, result.output
    program = " ".join(json.loads(result.stdout)["program"])
    assert "[SwitchOn] <television>" in program and "[Sit]" in program


def test_the_budget_is_that_of_each_network():
    """`test_self_critical` sees that both phases have it, `test_chooser` that both networks do."""
    said = " ".join(call("train", "--help").output.replace("│", " ").split())
    assert "each network that is trained" in said


def test_unknown_settings(made, tmp_path):
    result = call("train", "nearest", made.out, "--out", tmp_path, "--set", "size=4")
    assert result.exit_code == 1 and "singular=0" in result.output


def test_without_the_extra_it_says_how_to_install_it(checkpoint, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "safetensors", None)
    monkeypatch.setitem(sys.modules, "safetensors.numpy", None)
    result = call("show", checkpoint, "Watch TV")
    assert result.exit_code == 1 and "pip install '.[models]'" in result.output


@pytest.mark.parametrize(
    ("name", "setting", "said"),
    [
        ("clips-seen", "context=maybe", "not a setting"),
        ("films-pg-lcs", "reward=LCS", "not one of lcs"),
        ("masks", "width=60", "multiple of 8"),
        ("masks", "batch=0", "is 0, not 1 to"),
        ("mle", "hidden=75", "`hidden` is 75, not a multiple of 2"),
        ("mle", "hidden=0", "`hidden` is 0, not 1 to 10,000"),
        ("mle", "dropout=2", "`dropout` is 2, not 0 to 1"),
        ("transformer", "hidden=30", "`hidden` is 30, not a multiple of 4"),
        ("transformer", "layers=0", "`layers` is 0, not 1 to 64"),
        ("films-mle", "hidden=75", "not a multiple of 2"),
        ("clips-seen", "width=90", "not a multiple of 4"),
        ("fcactgraph", "change=both", "not one of none, residual"),
        ("consensus", "draws=0", "`draws` is 0, not 1 to 1,000"),
        ("retrieve-edit", "neighbours=0", "`neighbours` is 0, not 1 to"),
    ],
)
def test_values_of_settings_that_cannot_be(made, tmp_path, name, setting, said):
    result = call("train", name, made.out, "--out", tmp_path, "--set", setting)
    assert result.exit_code == 1 and said in result.output and "Traceback" not in result.output


@pytest.mark.parametrize(("value", "meant"), [("True", True), ("yes", True), ("False", False), ("0", False)])
def test_settings_that_are_true_or_false(value, meant):
    from hearth.models.fit_model import _changed

    assert _changed("clips-seen", [f"context={value}"]) == {"context": meant}
