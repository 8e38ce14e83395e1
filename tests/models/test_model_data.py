"""Examples of a dataset: nothing of test is in train, and requests know no programs."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.datasets.format.sketch_choice import sketches_query
from hearth.datasets.format.stored_cases import stored_cases
from hearth.models.interface import Request
from hearth.models.prediction_files import write
from hearth.models.text_examples import Corpus, carved, corpus, examples, of_new_titles, requests, shared
from hearth.schemas.diagnostics import HearthError
from hearth.scoring.dataset_scores import chosen

OWN = Path(__file__).resolve().parents[2] / "data_out"
"""The dataset that `make` builds, where it did."""


def test_no_title_text_or_step_list_of_test_is_in_train(parted):
    for dataset in (parted, *([hearth.load(OWN)] if (OWN / "publish/manifest.json").exists() else [])):
        found, test = corpus(dataset, "activities"), examples(dataset, "activities", "test", originals=True)
        assert found.train and found.validation and test
        assert set(found.shared.values()) == {0} == set(shared(found.train, test).values())


def test_corpora_of_sketches_have_sketches_for_programs(parted):
    found = corpus(parted, "activities", originals=False)
    some = {each.program_id: each.sketch for each in (*found.train, *found.validation) if each.sketch}
    of = found.of_sketches()
    assert {each.program_id: each.steps for each in (*of.train, *of.validation)} == some and some


def test_which_sketches_are_taken(parted):
    """Those of people go before inferred ones, or the other way round."""
    query = "SELECT program_id, origin, keep FROM sketches WHERE keep IS NOT NULL"
    rows = parted.rows(query)[1]
    of = {kind: dict(parted.rows(sketches_query(kind))[1]) for kind in ("annotated", "inferred")}
    assert of["inferred"] == {name: keep for name, origin, keep in rows if origin not in ("people", "written")}
    assert set(of["annotated"]) >= set(of["inferred"])
    with pytest.raises(HearthError, match="no sketches are `drawn`"):
        sketches_query("drawn")


def test_what_train_and_test_share_is_counted_and_recorded(dataset, eight):
    assert shared(eight[:4], eight[4:]) == {"titles": 0, "descriptions": 0, "step_lists": 0}
    other = replace(eight[5], title="WASH hands", description="Go.")
    assert shared(eight, [other, eight[2]]) == {"titles": 2, "descriptions": 1, "step_lists": 2}
    assert corpus(dataset, "activities").facts["titles_of_test"] == 0


def test_executions_of_new_titles_are_those_outside_the_training_part(parted, tmp_path):
    """Executions of another dataset that a model has not been trained on; here the other dataset is the same one."""
    new = of_new_titles(parted, parted, "activities")
    trained = {name for each in examples(parted, "activities", "train") for name in each.executions}
    assert not new & trained
    assert {name for each in examples(parted, "activities", "test") for name in each.executions} <= new
    name, seen = min(new), min(trained)
    write(iter([(name, ()), (seen, ())]), tmp_path / "given.jsonl")
    words = ["model", "score", str(tmp_path / "given.jsonl"), str(parted.folder), "--json"]
    for more, count in (([], 2), (["--unseen", str(parted.folder)], 1)):
        result = CliRunner().invoke(cli.app, [*words, *more])
        assert result.exit_code == 0 and json.loads(result.stdout)["count"] == count, result.output


def test_cases_come_in_the_order_of_their_names(parted):
    """Else each training would see the executions in another order, and end with other weights."""
    names = [name for (name,) in parted.rows("SELECT execution_id FROM executions ORDER BY md5(execution_id)")[1]]
    assert [case["execution_id"] for case in stored_cases(parted, [*names, "unknown"])] == names
    assert [each.id for share in requests(parted, names, worlds=False) for each in share] == names


def test_validation_is_of_other_activities(dataset):
    found = corpus(dataset, "activities")
    assert found.train and not {e.activity for e in found.train} & {e.activity for e in found.validation}
    assert all(each.origin != "augmented" for each in found.train)
    many = examples(dataset, "activities", "train")
    assert len(many) > len(found.train)


def test_carving_by_activity(eight):
    train, validation = carved(eight * 3, 1)
    assert len(train) + len(validation) == 24
    assert not {e.activity for e in train} & {e.activity for e in validation}
    assert validation


@pytest.mark.parametrize("count", [0, 1, 2, 3, 8])
def test_each_part_of_two_activities_or_more_has_one(eight, count):
    for seed in range(120):
        train, validation = carved(eight[:count], seed)
        assert len(train) + len(validation) == count
        assert bool(train) == (count > 0) and bool(validation) == (count > 1)


def test_a_split_by_home_whose_validation_is_of_trained_activities_takes_some_of_training(parted, monkeypatch):
    """Of `homes_1_4` some 4 % of the validation programs were of other activities: too few to choose weights by."""
    from hearth.models import text_examples

    read = text_examples._read
    given = examples(parted, "homes_1_4", "train", originals=True)
    for known, instead in ((given * 10, 1), ((), None)):

        def seen(dataset, split, part, originals, sketches, known=known):
            other = read(dataset, split, "validation", originals, sketches)
            return (*known, *other[:1]) if part == "validation" else read(dataset, split, part, originals, sketches)

        monkeypatch.setattr(text_examples, "_read", seen)
        found = corpus(parted, "homes_1_4")
        assert found.validation and not {e.activity for e in found.train} & {e.activity for e in found.validation}
        assert found.facts.get("validation_of_train_instead_of") == instead
        assert (len(found.train) < len(given)) == (instead is not None)


def test_without_examples_for_validation_no_weights_are_chosen(dataset, eight):
    assert Corpus(dataset, "activities", eight, eight).checked() == eight
    for validation, sketches in (((), False), (eight, True)):
        with pytest.raises(HearthError, match="for validation"):
            Corpus(dataset, "activities", eight, validation).checked(sketches=sketches)


@pytest.mark.parametrize("model", ["text", "critical", "graph", "chooser"])
def test_models_that_choose_weights_need_validation(model, dataset, eight):
    from hearth.models.interface import Training
    from hearth.models.sketches.graph_model import GraphModel
    from hearth.models.sketches.plan_chooser import Chooser
    from hearth.models.text.self_critical import SelfCritical
    from hearth.models.text.text_models import TextModel

    settings = {"text": TextModel, "critical": SelfCritical, "graph": GraphModel, "chooser": Chooser}[model]()
    with pytest.raises(HearthError, match="for validation"):
        settings.fit(Corpus(dataset, "activities", eight, ()), Training(epochs=1))


def test_unknown_parts_are_named(dataset):
    with pytest.raises(HearthError, match="there are activities"):
        examples(dataset, "activities", "tomorrow")


def test_requests_have_texts_and_worlds_and_no_programs(dataset):
    assert [field.name for field in fields(Request)] == ["id", "title", "description", "sketch", "world", "rules"]
    names = chosen(dataset)
    for worlds in (False, True):
        found = [each for share in requests(dataset, names, worlds=worlds) for each in share]
        assert sorted(each.id for each in found) == names
        assert all((each.world is not None) == worlds for each in found)
