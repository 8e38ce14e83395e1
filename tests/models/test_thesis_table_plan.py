"""The models that the tables of chapters 4 and 5 need, and tables made of them."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.models import thesis_table_plan
from hearth.models.checkpoint import Checkpoint, save
from hearth.models.fit_model import STATE
from hearth.models.model_registry import MODELS
from hearth.models.thesis_table_plan import ONCE, PLANS, Plan, chosen, rows, train, training
from hearth.pipelines.build import build
from hearth.schemas.diagnostics import HearthError


def test_every_table_has_models_that_there_are():
    for plan in PLANS.values():
        assert {*plan.once, *plan.seeded, *plan.given} <= MODELS.keys()
    tables = {"4.2", "4.3", "4.3b", "4.4", "4.5", "4.6", "5.2", "5.3", "5.4"}
    assert {plan.table for plan in PLANS.values()} == tables


def test_a_model_is_trained_once_and_after_the_one_that_it_goes_on_from():
    needed = training(chosen(()), 3)
    assert len(needed) == len(set(needed)) == len({each.folder for each in needed})
    for number, each in enumerate(needed):
        if each.before is not None:
            assert each.before in needed[:number]
            assert each.before.seed == (0 if each.before.name in ONCE else each.seed)
    graphs = Counter(each.changed for each in needed if each.name == "resactgraph")
    assert graphs == {"": 3, "rounds=1": 3, "rounds=3": 3}  # 5.2 and 5.3 share those of the usual rounds
    assert {each.seed for each in needed if each.name in ("nearest", "retrieve-edit", "masks")} == {0}
    of_films = [each.name for each in training(chosen(["4.6"]), 1)]
    assert of_films == ["clips-context", "films-mle", "films-pg-lcs", "films-pg-lcs-sim"]
    assert {each.split for each in needed if each.data == "drawn"} == {"pairs", "paraphrases"}


def test_models_of_drawn_programs_leave_out_less_and_others_go_on_from_them(tmp_path):
    settings = {(each.data, each.name): each.settings(tmp_path) for each in training(chosen(["4.4-pairs", "4.5"]), 1)}
    assert settings["drawn", "mle"] == settings["drawn", "mle-composed"] == ["dropout=0.2", "batch=64"]
    assert settings["people", "mle"] == settings["people", "transformer"] == []
    start = training(chosen(["4.4-pairs"]), 1)[1].folder(tmp_path)
    assert start.name == "drawn.pairs.mle.0"
    (given,) = settings["drawn", "pg-lcs"]
    assert given == f"start={start.with_name('drawn.pairs.mle-composed.0')}"


def test_tables_are_chosen_by_number_or_name():
    assert [plan.name for plan in chosen(["4.4"])] == ["4.4-pairs", "4.4-paraphrases"]
    assert [plan.name for plan in chosen(["4.4-pairs", "5.2"])] == ["4.4-pairs", "5.2"]
    with pytest.raises(HearthError, match="BAD_ARGUMENT"):
        chosen(["9.9"])
    assert {plan.data for plan in chosen((), ("clips",))} == {"people", "drawn"}
    assert [plan.name for plan in chosen(["4.6"], ("clips",))] == ["4.6"]


def test_a_table_of_what_is_trained_for_it(tmp_path):
    pytest.importorskip("torch", reason="torch is not installed: pip install torch")
    texts, data = tmp_path / "drawn.jsonl", tmp_path / "drawn"
    assert CliRunner().invoke(app, ["corpus", "synthesize", "40", "--out", str(texts)]).exit_code == 0
    build([str(texts)], str(data), pictures=0, homes_each=1, variants=0)
    plan = Plan("4.4", "drawn", "pairs", ("nearest",))
    (needed,) = training([plan], 2)
    assert train(needed, data, tmp_path, 0) and not train(needed, data, tmp_path, 0)
    manifest = data / "publish/manifest.json"
    manifest.write_bytes(manifest.read_bytes().replace(b'"bytes": ', b'"bytes": 1', 1))
    assert train(needed, data, tmp_path, 0)  # another dataset, by its files
    assert train(needed, data, tmp_path, 1) and not train(needed, data, tmp_path, 1)  # another budget
    found = {row.method: row for row in rows(plan, data, tmp_path, 2, 10)}
    assert found["nearest"].of == "ours" and found["nearest"].seeds == 1


def test_a_training_that_was_stopped_goes_on_only_by_the_same_recipe(made, tmp_path, monkeypatch):
    (needed,) = Plan("4.5", "people", "activities", ("nearest",)).needed(1)
    state = needed.folder(tmp_path) / STATE
    found = []

    def stopped(*given, **more):
        found.append(state.exists())
        state.mkdir(parents=True, exist_ok=True)
        raise KeyboardInterrupt

    monkeypatch.setattr(thesis_table_plan, "fit", stopped)
    for minutes in (0, 0, 1):
        with pytest.raises(KeyboardInterrupt):
            train(needed, made.out, tmp_path, minutes)
    (state.parent / thesis_table_plan.RECIPE).write_text("{")  # another recipe: it cannot be read
    with pytest.raises(KeyboardInterrupt):
        train(needed, made.out, tmp_path, 1)
    assert found == [False, True, False, False]


def test_how_long_the_model_before_took_is_not_in_the_recipe(tmp_path):
    pytest.importorskip("safetensors")
    (needed,) = Plan("5.4", "people", "activities", (), ("consensus-sketch",)).needed(1)
    before = needed.before.folder(tmp_path)

    def recipe(minutes, loss):
        trained = {"minutes": minutes, "imitation": {"minutes": 2 * minutes}, "curves": {"loss": [loss]}}
        save(Checkpoint("desc2sketch", {}, {}, {"weights": np.ones(3, np.float32)}, trained), before)
        return needed.recipe(tmp_path, "a dataset", {})

    assert recipe(0.1, 1.0) == recipe(0.2, 1.0) != recipe(0.1, 2.0)
