"""The page of predictions beside references: which are shown, and what it says of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.analysis.prediction_examples import examples_page, prediction_examples, spread_over
from hearth.models.prediction_files import write
from hearth.models.text_examples import examples
from hearth.rendering.film import execution_keyframes
from hearth.scoring.dataset_scores import score_given
from hearth.scoring.line_sequences import steps_of
from hearth.scoring.metrics.lcs import LcsScore
from hearth.scoring.prediction_scores import Scored
from hearth.scoring.predictions import Pair


def scored(name: str, activity: str, lcs: float) -> Scored:
    one = LcsScore(lcs, lcs, lcs)
    return Scored(Pair(name, (), (), more={"activity": activity}), one, one)


@pytest.fixture(scope="module")
def given(parted, tmp_path_factory) -> Path:
    """A file of predictions: what was done for every second program, nothing for the others."""
    file = tmp_path_factory.mktemp("given") / "given.jsonl"
    known = [each for each in examples(parted, "activities", "train", originals=True) if each.executions][:6]
    write(((each.executions[0], ()) for each in known), file)
    true = [(each.pair.id, steps_of(each.pair.reference)) for each in score_given(parted, file)]
    write(((name, steps if place % 2 else ()) for place, (name, steps) in enumerate(true)), file)
    return file


def test_examples_are_spread_from_the_best_to_the_worst_over_activities():
    found = [scored(f"{n:02d}", f"activity {n % 7}", n / 20) for n in range(21)]
    chosen = spread_over(found, 5)
    values = [each.lcs.step for each in chosen]
    assert values == sorted(values, reverse=True) and values[0] == 1 and values[-1] == 0
    assert all(abs(value - aim) <= 0.11 for value, aim in zip(values, (1, 0.75, 0.5, 0.25, 0), strict=True))
    assert len({each.pair.more["activity"] for each in chosen}) == 5
    assert len(spread_over(found, 50)) == 7 and spread_over([], 3) == []
    assert spread_over(list(reversed(found)), 5) == chosen


def test_both_programs_stand_side_by_side(parted, given):
    found = score_given(parted, given)
    (best, *_, worst) = prediction_examples(parted, found, 4, pictures=0)
    assert all(both for _, _, both in best.steps) and best.scores["LCS"] == "1.00"
    assert not any(right for _, right, _ in worst.steps) and worst.scores["LCS"] == "0.00"
    assert best.home in best.request.id and not best.pictures


def test_pictures_are_of_the_home_as_built_and_what_its_environment_moves(parted, given, monkeypatch):
    """Things that an environment moves are found by comparing its graph with the home's own."""
    pytest.importorskip("open3d")
    asked = []
    whole = execution_keyframes.trajectory_of
    monkeypatch.setattr(execution_keyframes, "trajectory_of", lambda *given: asked.append(given) or whole(*given))
    list(prediction_examples(parted, score_given(parted, given), 2, pictures=1))
    ((ran, graph, _),) = asked
    home = parted.home(ran.worlds[0].home.name)
    assert graph.edges == home.edges and [node.id for node in graph.nodes] == [node.id for node in home.nodes]
    assert set(ran.worlds[0].graph().edges) != set(home.edges)


def test_texts_of_strangers_stay_texts(parted, given):
    (one,) = prediction_examples(parted, score_given(parted, given), 1, pictures=0)
    evil = one._replace(request=one.request.__class__(one.request.id, "<script>x()</script>", "<b>", ()), home="<i>")
    page = examples_page([evil], "<u>", 1)
    assert "<script" not in page and "<b>" not in page and "<i>" not in page and "<u>" not in page


def test_the_command_writes_a_page_with_pictures(parted, given, tmp_path):
    out = tmp_path / "new" / "examples.html"
    words = ["model", "examples", given, parted.folder, "--out", out, "-n", "2", "--pictures", "1", "--json"]
    result = CliRunner().invoke(cli.app, list(map(str, words)))
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout) == {"out": str(out), "examples": 2, "of": 3}
    assert out.read_text("utf-8").count("data:image/png;base64,") == 1, "of the program that does something"
