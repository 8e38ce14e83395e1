"""What augmenting gave, told beside the thesis."""

from __future__ import annotations

import pytest

from hearth.analysis.augment_figures import GIVEN_UP, THESIS, figures, outcome
from hearth.schemas.diagnostics import HearthError


def test_every_pair_is_accounted_for(made):
    told = outcome(made.out / "augment")
    assert told["pairs_tried"] == told["programs_out"] + sum(told["rejected"].values())
    assert told["programs_out"] == len(made.rows("augment"))
    assert told["repaired"] == told["programs_out"] + told["rejected"].get("DUPLICATE", 0)
    assert not set(told["rejected"]) & set(map(str, GIVEN_UP)) and told["repaired_share"] == 1


def test_the_table_of_the_thesis_stands_beside_ours(made):
    told = figures(made.out / "publish")
    originals = {row["program_id"] for row in made.rows("sample") if row["executable"]}
    table = told["table"]
    assert table["executable"]["ours"]["programs"] == len(originals)
    assert table["augmented"]["ours"]["programs"] == len(made.rows("augment"))
    assert table["all"]["thesis"] == THESIS["all"]
    lengths = [len(row["steps"]) for row in made.rows("augment")]
    assert table["augmented"]["ours"]["average_length"] == pytest.approx(sum(lengths) / len(lengths), abs=0.01)
    assert sum(told["lengths"]["augmented"].values()) == len(lengths)
    assert told["near_duplicates"] == 0
    assert told["bytes_a_program"] > 0


def test_what_was_not_augmented_has_no_outcome(tmp_path):
    with pytest.raises(HearthError, match="nothing was augmented"):
        outcome(tmp_path)


def test_pairs_are_spread_over_executions_to_reach_a_target(built, inputs):
    from hearth.pipelines.augment import ALLOWANCE

    built = built(inputs / "crowd", variants=9, target=3)
    built.run("ingest", "validate", "sample", "augment")
    executions = sum(row["executable"] for row in built.rows("sample"))
    told = outcome(built.out / "augment")
    assert 3 <= told["pairs_tried"] <= 3 * ALLOWANCE + executions


def test_figures_are_drawn_the_same_each_time(made, tmp_path):
    from hearth.analysis.augment_pictures import draw

    found = figures(made.out / "publish")
    first, second = (draw(found, tmp_path / name) for name in ("a", "b"))
    assert [file.name for file in first] == ["conditions.png", "conditions.svg", "lengths.png", "lengths.svg"]
    assert [file.read_bytes() for file in first] == [file.read_bytes() for file in second]
