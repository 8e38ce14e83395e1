"""Tables 4.2 and 4.3 and figure 4-4: what stands beside what, and which clips count."""

from __future__ import annotations

import numpy as np
import pytest

from hearth.models.films import clip_result_tables
from hearth.models.films.clip_confusion import drawn, of_pairs
from hearth.models.films.clip_data import Clip, Clips, Instruction
from hearth.models.films.mask_clip_model import TrainedSeenModel
from hearth.models.films.mask_model import TrainedMaskModel
from hearth.schemas.diagnostics import HearthError

WALK, GRAB = Instruction("Walk", ("bed",)), Instruction("Grab", ("cup",))


class Named(TrainedSeenModel):
    """It takes every clip for the same; it remembers the films that it was asked about."""

    def __init__(self, done):
        object.__setattr__(self, "done", done)
        object.__setattr__(self, "films", [])

    def named(self, clips):
        self.films.append(clips.films)
        return [self.done] * len(clips)


class Masked(TrainedMaskModel):
    def __init__(self):
        pass

    def masks(self, pictures):
        return pictures[..., 0].astype(np.uint16) + 1


@pytest.fixture
def given(monkeypatch):
    """Test clips: three of seen homes, one of an unseen one."""
    films = [np.zeros((9, 2, 2, 3), np.uint8)]
    clips = tuple(
        Clip(0, 0, done, kind, 1) for done, kind in ((WALK, "seen"),) * 2 + ((GRAB, "seen"), (GRAB, "unseen"))
    )
    models = {"a": ("clips-seen", Named(WALK)), "b": ("clips-seen", Named(GRAB)), "m": ("masks", Masked())}
    monkeypatch.setattr(clip_result_tables.Clips, "of", lambda *_, **__: Clips(("film",), films, clips, 9))
    monkeypatch.setattr(clip_result_tables, "restore", models.__getitem__)
    monkeypatch.setattr(clip_result_tables, "named_in_films", lambda trained, test, _: [GRAB] * len(test))
    return models


def test_rows_are_of_homes_and_seeds(given):
    rows = clip_result_tables.clip_table("4.3", None, ["a", "b"])
    ours = {row.homes: row for row in rows if row.method == "clips-seen"}
    whole = [row.scores["action"] for row in rows if row.method == "clips-seen, whole film"]
    assert whole == [0.5, 1.0, 0.5]
    assert ours["seen"].clips == 3 and ours["unseen"].clips == 1 and ours["all"].clips == 4
    assert ours["seen"].scores["mean"] == 0.5 and ours["seen"].seeds == 2 and ours["seen"].spread == 0
    assert ours["unseen"].scores["mean"] == 0.5 and ours["unseen"].spread == 0.5
    assert [row.scores["mean"] for row in rows if row.of == "thesis"] == [0.6916, 0.5044, 0.5742]
    assert {row.method for row in rows if row.of == "yardstick"} == {"random retrieval", "commonest"}


def test_predicted_masks_need_a_network_that_predicts_them(given):
    rows = clip_result_tables.clip_table("4.2", None, ["a", "m"])
    assert [row.method for row in rows if row.of == "ours"] == ["clips-seen"] * 3 + ["clips-seen, whole film"] * 3
    assert given["a"][1].films[0][0].tolist() == np.ones((9, 2, 2)).tolist()
    with pytest.raises(HearthError, match="0 checkpoints of `masks`"):
        clip_result_tables.clip_table("4.2", None, ["a"])


def test_models_look_at_what_the_table_is_about(given):
    with pytest.raises(HearthError, match="does not read the input"):
        clip_result_tables.clip_table("4.3", None, ["m"])
    with pytest.raises(HearthError, match="does not read the input"):
        clip_result_tables.clip_table("4.3b", None, ["a"])


def test_the_thesis_has_a_mean_of_its_columns():
    for table in clip_result_tables.TABLES.values():
        for *parts, mean in table.thesis.values():
            assert mean == pytest.approx(sum(parts) / 3, abs=6e-4)


def test_confusion_by_hand():
    found = of_pairs([("Walk", "Walk"), ("Walk", "Sit"), ("Walk", "Walk"), ("Grab", "Walk")])
    assert found.actions == ("Walk", "Grab", "Sit") and found.clips == (3, 1, 0)
    assert np.allclose(found.shares, [[2 / 3, 0, 1 / 3], [1, 0, 0], [0, 0, 0]])
    assert drawn(found).count(">0.67<") == 1 and drawn(found).count(">1.00<") == 1
