"""Predicted masks: the network learns them, stands where true masks would, and refuses what is none."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
import torch
from torch.nn import functional

from hearth.models.checkpoint import load, save
from hearth.models.films.clip_data import Clips
from hearth.models.films.film_arrays import COLOURS
from hearth.models.films.mask_model import MaskModel, TrainedMaskModel, mean_iou, read_classes
from hearth.models.films.predicted_masks import PredictedMasks, predicted
from hearth.schemas.diagnostics import HearthError

CLASSES = (300, 7)
PAINT = {0: (40, 40, 40), 300: (200, 60, 60), 7: (60, 60, 220)}


def drawn(count):
    """Squares of two classes in places of their own, and their masks."""
    places = np.random.default_rng(3)
    masks = np.zeros((count, 48, 64), np.uint16)
    for mask in masks:
        for number in CLASSES:
            x, y = places.integers(0, 40), places.integers(0, 28)
            mask[y : y + 16, x : x + 20] = number
    pictures = np.zeros((*masks.shape, 3), np.uint8)
    for number, colour in PAINT.items():
        pictures[masks == number] = colour
    return pictures, masks


@pytest.fixture(scope="module")
def model():
    torch.manual_seed(0)
    settings = MaskModel(width=16)
    model = TrainedMaskModel(settings, CLASSES, settings.network(CLASSES))
    pictures, masks = drawn(12)
    wanted = torch.from_numpy(model.palette[masks].astype(np.int64))
    optimiser = torch.optim.Adam(model.network.parameters(), 1e-2)
    for _ in range(60):
        optimiser.zero_grad()
        functional.cross_entropy(model.network(torch.from_numpy(pictures)), wanted).backward()
        optimiser.step()
    model.network.eval()
    return model


def test_it_learns_masks(model):
    pictures, masks = drawn(12)
    assert (model.masks(pictures) == masks).mean() > 0.95


def test_a_picture_does_not_depend_on_its_neighbours(model):
    pictures, _ = drawn(20)
    assert np.array_equal(model.masks(pictures)[17:18], model.masks(pictures[17:18]))


def test_untrained_it_is_indifferent():
    torch.manual_seed(0)
    network = MaskModel(width=16).network(CLASSES)
    scores = network(torch.zeros(2, 48, 64, 3, dtype=torch.uint8)).log_softmax(1)
    assert scores.shape == (2, 3, 48, 64) and abs(-scores.mean().item() - np.log(3)) < 0.2


def test_a_checkpoint_gives_the_same_masks(model, tmp_path):
    save(model.checkpoint(), tmp_path)
    pictures, _ = drawn(3)
    assert np.array_equal(MaskModel.restored(load(tmp_path)).masks(pictures), model.masks(pictures))


@pytest.mark.parametrize("bad", [[], [0], [7, 7], [70_000], ["bed"], list(range(1, 300))])
def test_classes_that_are_none(bad):
    assert read_classes({"classes": [3, 2]}) == (3, 2)
    with pytest.raises(ValueError, match="class"):
        read_classes({"classes": bad})


def test_iou_by_hand():
    wanted, found = np.array([0, 0, 1, 1, 2], np.uint8), np.array([0, 1, 1, 1, 0], np.uint8)
    assert mean_iou(wanted, found, 4) == pytest.approx((1 / 3 + 2 / 3 + 0) / 3)
    assert mean_iou(wanted, wanted, 4) == 1.0


def test_predicted_films_are_made_once(model, monkeypatch):
    pictures, _ = drawn(4)
    films = PredictedMasks([pictures[:2], pictures[2:]], model)
    assert len(films) == 2 and films[1].shape == (2, 48, 64) and len(films[:1]) == 1
    monkeypatch.setattr(type(model), "masks", None)
    assert films[1].dtype == np.uint16


def test_pictures_in_another_light_keep_what_they_show():
    """Each has a light of its own, brighter or darker by a share at most; the same draw gives the same."""
    pictures = np.full((40, 2, 2, 3), 120, np.uint8)
    found, again = (MaskModel(light=0.3)._lit(pictures, Random(1)) for _ in range(2))
    assert torch.equal(found, again) and found.min() >= 120 * 0.7 * 0.9 and found.max() <= 120 * 1.3 * 1.1
    assert (found.flatten(1, 2).std(1) < 1e-3).all() and found.mean((1, 2, 3)).std() > 5
    assert torch.equal(MaskModel(light=0.0)._lit(pictures, Random(1)), torch.from_numpy(pictures).float())
    assert MaskModel()._lit(np.full((9, 1, 1, 3), 250, np.uint8), Random(1)).max() == 255


def test_only_a_network_of_masks_predicts_them(model, tmp_path, monkeypatch):
    films = [drawn(9)[0], drawn(9)[0]]
    monkeypatch.setattr(Clips, "of", lambda dataset, part, most, array: Clips((part, array), films, (), 9))
    save(model.checkpoint(), tmp_path)
    found = predicted(str(tmp_path), None, "train")
    assert found.executions == ("train", COLOURS)
    assert np.array_equal(found.films[0], model.masks(films[0]))
    with pytest.raises(HearthError, match="does not predict masks"):
        predicted("clips-context", None, "train")


def test_the_matrix_of_figure_4_4_shows_names_as_text():
    from hearth.models.films.clip_confusion import drawn as matrix
    from hearth.models.films.clip_confusion import of_pairs

    found = matrix(of_pairs([("<script>alert(1)</script>", "A & B")]))
    assert "<script>" not in found and "&lt;script&gt;" in found and "A &amp; B" in found
    assert of_pairs([]).actions == ()
