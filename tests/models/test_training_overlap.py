"""Models are not asked about programs that they were trained on by another split of the same dataset."""

from __future__ import annotations

import shutil
from dataclasses import replace

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import hearth
from hearth.models.checkpoint import load, save
from hearth.models.fit_model import fit
from hearth.models.model_registry import recorded
from hearth.models.prediction_files import predict_part
from hearth.models.sketches import sketch_result_tables
from hearth.models.text import text_result_tables
from hearth.models.text_examples import facts_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

HOW = {"epochs": 1, "minutes": 0.0, "rate": 1e-3, "seed": 0}
OTHER = "homes_1_4"


@pytest.fixture(scope="module")
def crossed(parted, tmp_path_factory):
    """The dataset whose training programs of `activities` are the tests of another split."""
    folder = shutil.copytree(parted.folder, tmp_path_factory.mktemp("crossed") / "out")
    (path,) = (folder / "splits").glob("*.parquet")
    table = pq.read_table(path)
    swapped = {"train": "test", "test": "train"}
    parts = [
        swapped.get(part, part) if split == OTHER else part
        for split, part in zip(table["split"].to_pylist(), table["part"].to_pylist(), strict=True)
    ]
    place = table.schema.get_field_index("part")
    field = table.schema.field(place)
    pq.write_table(table.set_column(place, field, pa.array(parts).cast(field.type)), path)
    return hearth.load(folder)


@pytest.fixture(scope="module")
def nearest(crossed, tmp_path_factory):
    out = tmp_path_factory.mktemp("nearest")
    fit("nearest", crossed.folder, out, "activities", how=HOW)
    return out


def test_a_model_that_was_trained_on_what_is_asked_is_refused(crossed, nearest, tmp_path):
    out = tmp_path / "p.jsonl"
    with pytest.raises(HearthError, match=r"trained on \d+ of these programs, by the split `activities`"):
        predict_part(str(nearest), crossed.folder, out, OTHER, "test")
    with pytest.raises(HearthError, match="of these programs"):
        text_result_tables.table("4.5", crossed, OTHER, [nearest])
    assert not out.exists()
    for split, part in (("activities", "test"), (OTHER, "train")):  # its own split, and what is said to be training
        assert predict_part(str(nearest), crossed.folder, out, split, part)


def test_a_model_of_sketches_that_was_trained_on_the_tests_is_refused(crossed, tmp_path):
    fit("unaries", crossed.folder, tmp_path, "activities", ["programs=8", "hidden=16"], how=HOW)
    with pytest.raises(HearthError, match="of these programs"):
        sketch_result_tables.table("5.2", crossed, OTHER, [tmp_path], most=2)


def test_of_another_dataset_nothing_is_known(crossed, nearest, tmp_path):
    other = shutil.copytree(crossed.folder, tmp_path / "out")
    manifest = other / "manifest.json"
    manifest.write_bytes(manifest.read_bytes().replace(b'"bytes": ', b'"bytes": 1', 1))
    assert predict_part(str(nearest), other, tmp_path / "p.jsonl", OTHER, "test")


@pytest.fixture(scope="module")
def network(crossed, tmp_path_factory):
    out = tmp_path_factory.mktemp("network")
    fit("mle-composed", crossed.folder, out, "activities", ["hidden=16", "vector=16"], how=HOW)
    return out


@pytest.mark.parametrize("name", ["pg-lcs", "consensus"])
def test_what_a_training_goes_on_from_is_checked(name, crossed, network, nearest, tmp_path):
    with pytest.raises(HearthError, match="of these programs"):
        fit(name, crossed.folder, tmp_path, OTHER, [f"start={network}"], how=HOW)
    with pytest.raises(HearthError, match="does not write programs of texts"):
        fit(name, crossed.folder, tmp_path, "activities", [f"start={nearest}"], how=HOW)


def test_sketches_go_on_from_what_writes_sketches(crossed, network, tmp_path):
    """And programs from what writes programs."""
    with pytest.raises(HearthError, match="does not write sketches of texts") as caught:
        fit("consensus-sketch", crossed.folder, tmp_path / "c", "activities", [f"start={network}"], how=HOW)
    (fault,) = caught.value.diagnostics
    assert fault.code == Code.BAD_ARGUMENT and "desc2sketch" in fault.suggestion
    sketches = tmp_path / "sketches"
    fit("desc2sketch", crossed.folder, sketches, "activities", ["hidden=16", "vector=16"], how=HOW)
    assert fit("consensus-sketch", crossed.folder, tmp_path / "c", "activities", [f"start={sketches}"], how=HOW)
    for name in ("consensus", "pg-lcs"):
        with pytest.raises(HearthError, match="does not write programs of texts"):
            fit(name, crossed.folder, tmp_path / "p", "activities", [f"start={sketches}"], how=HOW)


def test_a_network_is_named_as_in_the_list_of_models(crossed, tmp_path):
    facts = fit("consensus", crossed.folder, tmp_path, OTHER, ["start=mle-composed"], how=HOW)
    assert facts["split"] == OTHER and facts["digest"] == facts_of(crossed)["digest"]


def test_what_a_model_was_first_trained_on_counts(crossed, network, tmp_path):
    """The second phase by another split does not hide the first one."""
    fit("pg-lcs", crossed.folder, tmp_path, "activities", [f"start={network}"], how=HOW)
    first = recorded(tmp_path)["first_phase"]
    assert first["split"] == "activities" and first["digest"] == facts_of(crossed)["digest"]
    made = load(tmp_path)
    save(replace(made, trained={**made.trained, "split": OTHER}), tmp_path)
    with pytest.raises(HearthError, match="by the split `activities`"):
        predict_part(str(tmp_path), crossed.folder, tmp_path / "p.jsonl", OTHER, "test")
