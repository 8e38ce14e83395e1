"""Figures of augmentation beside the thesis."""

from __future__ import annotations

import shutil

import pytest

from hearth.analysis.augmentation_results import GIVEN_UP, THESIS, figures, outcome
from hearth.repair.perturbation_strengths import strength
from hearth.schemas.diagnostics import HearthError


def repaired(made):
    """Rows of augmentation that are programs; others are originals that fail."""
    return [row for row in made.rows("augment") if row["origin"] == "augmented"]


def test_every_pair_is_accounted_for(made):
    found = outcome(made.out / "augment")
    assert found["pairs_tried"] == found["programs_out"] + sum(found["rejected"].values())
    assert found["programs_out"] == len(repaired(made))
    assert found["repaired"] == found["programs_out"] + found["rejected"].get("DUPLICATE", 0)
    assert not set(found["rejected"]) & set(map(str, GIVEN_UP)) and found["repaired_share"] == 1


def test_the_table_of_the_thesis_stands_beside_ours(made):
    found = figures(made.out / "publish")
    originals = {row["program_id"] for row in made.rows("sample") if row["executable"]}
    table = found["table"]
    assert table["executable"]["ours"]["programs"] == len(originals)
    assert table["augmented"]["ours"]["programs"] == len(repaired(made))
    assert table["all"]["thesis"] == THESIS["all"]
    lengths = [len(row["steps"]) for row in repaired(made)]
    assert table["augmented"]["ours"]["average_length"] == pytest.approx(sum(lengths) / len(lengths), abs=0.01)
    assert sum(found["lengths"]["augmented"].values()) == len(lengths)
    assert found["near_duplicates"] == 0
    assert found["bytes_a_program"] > 0


def test_what_was_not_augmented_has_no_outcome(tmp_path):
    with pytest.raises(HearthError, match="nothing was augmented"):
        outcome(tmp_path)


def test_pairs_are_spread_over_executions_to_reach_a_target(built, inputs):
    built = built(inputs / "crowd", variants=9, target=3)
    built.run("ingest", "validate", "sample", "augment")
    executions = sum(row["executable"] for row in built.rows("sample"))
    found = outcome(built.out / "augment")
    assert 3 <= found["pairs_tried"] <= 3 * strength("mild").allowance + executions


def test_figures_are_drawn_the_same_each_time(made, tmp_path):
    from hearth.analysis.augmentation_charts import draw

    found = figures(made.out / "publish")
    first, second = (draw(found, tmp_path / name) for name in ("a", "b"))
    assert [file.name for file in first] == ["conditions.png", "conditions.svg", "lengths.png", "lengths.svg"]
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]


@pytest.mark.parametrize("name", ["timing.json", "rejects.parquet"])
def test_a_stage_that_is_damaged_is_told(made, tmp_path, name):
    folder = shutil.copytree(made.out / "augment", tmp_path / "augment")
    (folder / name).write_text("{}")
    with pytest.raises(HearthError, match="DAMAGED_FILE"):
        outcome(folder)
