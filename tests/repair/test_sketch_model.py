"""Learned sketches: features by hand, stored models that can't harm, and the same model for the same annotations."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from hearth.analysis import sketch_model_training as learning
from hearth.analysis import sketch_validation as validation
from hearth.kb.loading.load import default
from hearth.repair import sketch_model
from hearth.repair.sketch_features import NUMBERS, RATED, features
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import parse_program

PAGE = """Read a book
I get comfortable and read my novel.

[Walk] <novel> (1)
[Grab] <novel> (1)
[Sit] <sofa> (1)
[Read] <novel> (1)
[PutBack] <novel> (1) <table> (1)
"""


def program_of(page):
    program, faults = parse_program(page)
    assert not faults
    return program


@pytest.fixture(scope="module")
def steps():
    return features(program_of(PAGE), (False, False, False, True, False), default())


def test_a_step_is_described_by_action_objects_neighbours_and_text(steps):
    read = steps[3]
    assert set(read.numbers) == NUMBERS
    assert read.names[: len(RATED)][:2] == ("Read", "Read novel")
    assert read.numbers["ruled"] == 1 and read.numbers["object_in_text"] == 1 and read.numbers["verb_in_title"] == 1
    assert read.numbers["uses_before"] == 2 and read.numbers["uses_after"] == 1
    assert "Read used_in:PutBack" in read.names
    assert steps[1].numbers["put_after"] == 1 and steps[4].numbers["taken_before"] == 1
    assert steps[2].numbers["object_in_text"] == 0


def examples(programs=24):
    """Annotated programs of six activities, in which what is read is kept and what is put away is not."""
    found = []
    known = default()
    for number in range(programs):
        page = PAGE.replace("Read a book", f"Activity {number % 6}")
        page = page.replace("novel", ("novel", "book", "magazine", "newspaper")[number % 4])
        program = program_of(page)
        answer = (False, False, False, True, number % 4 == 1)
        ruled = (False, False, True, False, True)
        actions = tuple(step.action for step in program.steps)
        found.append(
            learning.Example(f"activity {number % 6}", actions, ruled, answer, features(program, ruled, known))
        )
    return found


@pytest.fixture(scope="module")
def fitted():
    return learning.fit(examples(), "test")


def test_a_fitted_model_keeps_what_annotators_kept(fitted):
    assert all(fitted.keep(one.steps) == one.answer for one in examples())


def test_a_stored_model_is_the_same_model(fitted, tmp_path):
    path = tmp_path / "model.json"
    path.write_text(json.dumps(fitted.to_json()))
    read = sketch_model.load_model(path)
    assert all(read.probability(s) == fitted.probability(s) for one in examples(4) for s in one.steps)
    assert read == fitted or replace(read, fitted_on=fitted.fitted_on) == fitted


def test_a_model_on_top_of_another_sees_its_logit(fitted):
    base = sketch_model.shipped()
    above = learning.fit(examples(), "test", base)
    assert above.base is base and any(name.startswith("base share") for name in above.numbers)
    assert above.keep(examples(1)[0].steps) == examples(1)[0].answer


def test_a_model_on_top_of_another_has_a_forest_whose_probabilities_count(fitted, tmp_path):
    above = learning.fit(examples(), "test", sketch_model.shipped())
    assert above.forest and not fitted.forest
    path = tmp_path / "above.json"
    path.write_text(json.dumps(above.to_json()))
    read = sketch_model.load_model(path)
    for step in (step for one in examples(4) for step in one.steps):
        alone = replace(above, linear=False, trees=())
        others = [replace(above, trees=(), forest=()), replace(above, linear=False, forest=())]
        mean = sum(part.probability(step) for part in (alone, *others)) / 3
        assert 0 <= alone.probability(step) <= 1 and above.probability(step) == pytest.approx(mean)
        assert read.probability(step) == above.probability(step)


@pytest.mark.parametrize(
    "fault",
    [
        {"form": 9},
        {"numbers": ["nothing"]},
        {"trees": [{"number": [0, -1, -1], "threshold": [0, 0, 0], "left": [0, 1, 2], "right": [2, 1, 2],
                    "value": [0, 0, 0]}]},
        {"trees": [{"number": [0], "threshold": [0], "left": [1], "right": [2], "value": [0]}]},
        {"forest": [{"number": [0], "threshold": [0], "left": [1], "right": [2], "value": [0]}]},
        {"weights": []},
        {"fitted_on": None},
        {"bias": "nan"},
        {"start": "inf"},
        {"counts": {"": [-3, -3]}},
        {"counts": {"": [1, 2]}},
        {"counts": {"": ["inf", 0]}},
        {"forest": [{"number": [-1], "threshold": [0], "left": [-1], "right": [-1], "value": [5]}]},
    ],
)  # fmt: skip
def test_a_strangers_model_is_refused_if_it_could_not_end_or_give_no_probability(fitted, tmp_path, fault):
    path = tmp_path / "model.json"
    path.write_text(json.dumps({**fitted.to_json(), **fault}))
    with pytest.raises(HearthError, match="not a model of sketches"):
        sketch_model.load_model(path)


def test_a_model_that_never_begins_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(HearthError, match="UNSUPPORTED_FILE"):
        sketch_model.load_model(tmp_path / "pipe")


@pytest.mark.parametrize("kept", [True, False])
def test_nothing_is_learned_from_sketches_that_keep_all_or_nothing(kept):
    alike = [one._replace(answer=(kept,) * len(one.answer)) for one in examples(4)]
    with pytest.raises(HearthError, match="nothing to learn"):
        learning.fit(alike, "test")


def test_one_step_at_least_is_kept(fitted):
    assert sum(replace(fitted, least=2.0).keep(examples(1)[0].steps)) == 1


def test_whole_activities_are_held_out():
    activities = ["a", "b", "b", "c", "a", "d"]
    part = learning.parts(activities, 3, 0).tolist()
    assert all(len({p for p, name in zip(part, activities, strict=True) if name == one}) == 1 for one in "abcd")
    assert set(part) == {0, 1, 2}


def test_cross_validation_reports_every_way_with_its_lead():
    ways = validation.cross_validate(examples(), folds=3)
    assert set(ways) == set(validation.WAYS) - {"base"}
    assert ways["all parts"]["f1"] > 0.7 > 0.2 > ways["repairs"]["f1"]
    assert ways[validation.MAJORITY]["lead"] == 0
    assert all(one["lead_low"] <= one["lead"] + 1e-9 <= one["lead_high"] + 2e-4 for one in ways.values())


def test_the_shipped_model_is_of_our_own_annotations_alone():
    shipped = sketch_model.shipped()
    assert shipped.base is None and shipped.fitted_on["source"] == "sketches.json"
    assert shipped.fitted_on["programs"] > 3_000


def test_evaluating_a_model_needs_no_library():
    code = (
        "import sys, hearth\n"
        "from hearth.repair.sketch_model import shipped\n"
        "shipped()\n"
        "assert not {'sklearn', 'scipy', 'torch'} & set(sys.modules), sorted(sys.modules)\n"
    )
    root = Path(__file__).resolve().parents[2]
    subprocess.run([sys.executable, "-c", code], check=True, cwd=root)
