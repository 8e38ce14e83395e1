"""Figure 4-9 by automatic scores: bands of LCS, and what the programs in them do."""

from __future__ import annotations

import json

from typer.testing import CliRunner

from hearth import cli
from hearth.analysis.scores_by_lcs import Agreement, BandRow, draw_by_lcs
from hearth.models.prediction_files import write
from hearth.models.text_examples import examples


def test_a_score_that_no_program_has_is_no_bar_of_height_0(tmp_path):
    one, other = (
        {"executable": 0.5, "goal_fraction": None, "f1": 0.0},
        {"executable": 0.2, "goal_fraction": None, "f1": 1},
    )
    found = Agreement([BandRow(0, 0.25, 3, one), BandRow(0.95, 1, 2, other)], dict.fromkeys(one))
    text = draw_by_lcs(found, "t", tmp_path / "bands")[1].read_text()
    drawn = [text.count(f">{value}<") for value in ("none", "0.00", "0.20")]
    assert drawn == [2, 2, 1], "one 0.00 is of the axis"


def test_true_programs_are_in_the_last_band_and_empty_ones_in_the_first(parted, tmp_path):
    known = [each for each in examples(parted, "activities", "train", originals=True) if each.executions][:6]
    programs = [each.steps if place % 2 else () for place, each in enumerate(known)]
    write(iter(zip((each.executions[0] for each in known), programs, strict=True)), tmp_path / "given.jsonl")
    words = ["model", "bands", str(tmp_path / "given.jsonl"), str(parted.folder), "--out", str(tmp_path), "--json"]
    result = CliRunner().invoke(cli.app, words)
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    first, last = found["bands"]
    counts = (len(known) + 1) // 2, len(known) // 2
    assert (first["low"], last["high"]) == (0, 1) and (first["programs"], last["programs"]) == counts
    assert last["scores"]["goal_fraction"] > first["scores"]["goal_fraction"]
    assert found["correlations"]["goal_fraction"] > 0.5
    assert {path.rpartition(".")[2] for path in found["files"]} == {"png", "svg"}
    plain = CliRunner().invoke(cli.app, words[:4])
    assert plain.exit_code == 0 and "rank correlation" in plain.stdout
