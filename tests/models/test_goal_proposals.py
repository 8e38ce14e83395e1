"""The goal proposal network: what it starts from, what it learns, and that a checkpoint gives the same answers."""

from __future__ import annotations

import importlib.util
import math

import numpy as np
import pytest

from hearth.models.checkpoint import load, save
from hearth.models.interface import Training
from hearth.models.proposals.goal_proposals import Episode, GoalProposals, restored
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.rng import rng

SMALL = GoalProposals(inputs=6, outputs=3, counts=4, d=8, h=16, batch=4)


@pytest.fixture(autouse=True)
def torch_is_there():
    if importlib.util.find_spec("torch") is None or importlib.util.find_spec("safetensors") is None:
        pytest.skip("the extra `models` is not installed")


def eight():
    """Eight episodes whose goals can be read from their states."""
    chooser = rng(0, "eight")
    goals = [tuple(chooser.randrange(4) for _ in range(3)) for _ in range(8)]
    return [Episode(((*goal, 0, 0, 1),), goal) for goal in goals]


def test_before_training_every_count_is_about_as_probable():
    import torch

    torch.manual_seed(0)
    logs = SMALL.network()(torch.zeros((1, 6), dtype=torch.long))
    assert logs.shape == (1, 3, 4)
    assert float(-logs.detach().mean()) == pytest.approx(math.log(4), abs=0.1)


def test_it_learns_eight_goals_by_heart_and_a_checkpoint_answers_as_it_does(tmp_path):
    examples = [each for each in eight() for _ in range(10)]
    trained = SMALL.fit(examples, Training(epochs=60, rate=5e-3, patience=0, halve_after=0))
    for each in examples:
        found = trained.probabilities(each.states[0])
        assert found.sum(axis=1) == pytest.approx([1.0] * 3)
        assert tuple(found.argmax(axis=1)) == each.counts
    save(trained.checkpoint(), tmp_path)
    again = GoalProposals.restored(load(tmp_path))
    state = examples[0].states[0]
    assert np.allclose(again.probabilities(state), trained.probabilities(state), atol=1e-2)
    assert restored(str(tmp_path)).settings == SMALL


def test_the_same_seed_trains_the_same():
    how = Training(epochs=2, patience=0)
    one, other = (SMALL.fit(eight(), how).probabilities((1, 0, 0, 0, 0, 0)) for _ in range(2))
    assert (one == other).all()


def test_a_folder_without_a_network_is_named(tmp_path):
    with pytest.raises(HearthError, match="challenge learn owah"):
        restored(str(tmp_path / "none"))
