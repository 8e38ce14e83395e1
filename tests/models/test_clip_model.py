"""The classifier of clips by colours: it learns what pictures show, and what training never had is nothing to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch

from hearth.models.checkpoint import load, save
from hearth.models.films.class_accuracy import accuracies
from hearth.models.films.clip_data import Clip, Clips, Instruction
from hearth.models.films.clip_model import RELATIONS, ClipModel, TrainedClipModel
from hearth.models.films.clip_network import ClipNetwork, loss_of
from hearth.models.films.frame_data import WIDTH, Labels, frames_of, pictures_of

ALIKE = [torch.ones(3), torch.ones(2), torch.ones(2)]
"""Weights of three actions and of two objects, none being one."""

DONE = (Instruction("Walk", ("sofa",)), Instruction("Sit", ("sofa",)), Instruction("StandUp", ()))


@pytest.fixture(scope="module")
def clips():
    """Three films: a red square moves right, left or not at all over grey."""
    films, found = [], []
    for number, done in enumerate(DONE * 2):
        frames = np.full((12, 48, 64, 3), 90, np.uint8)
        for time, frame in enumerate(frames):
            left = {0: 2 + 3 * time, 1: 40 - 3 * time, 2: 20}[number % 3]
            frame[10:30, left : left + 12] = (220, 30, 30)
        films.append(frames)
        found += [Clip(number, first, done, "seen", 1) for first in range(4)]
    return Clips(tuple(f"film {n}" for n in range(6)), tuple(films), tuple(found), 9)


@pytest.fixture(scope="module")
def labels(clips):
    return Labels.of(clips)


@pytest.fixture(scope="module")
def model(clips, labels):
    torch.manual_seed(1)
    model = TrainedClipModel(settings := ClipModel(width=32, dropout=0.0), labels, settings.network(labels))
    masks = torch.from_numpy(frames_of(clips, pictures_of(clips), range(len(clips)), RELATIONS[0]))
    wanted = torch.tensor([labels.numbers(clip.done) for clip in clips.clips])
    optimiser = torch.optim.Adam(model.network.parameters(), 3e-3)
    for _ in range(40):
        optimiser.zero_grad()
        loss_of(
            model.network(masks), wanted, [torch.ones(len(row)) for row in (range(3), range(2), range(2))]
        ).backward()
        optimiser.step()
    model.network.eval()
    return model


def test_it_learns_an_order_of_frames_by_heart(model, clips):
    assert accuracies([clip.done for clip in clips.clips], model.named(clips, RELATIONS[:1]))["mean"] == 1.0


def test_what_a_clip_is_taken_for_does_not_depend_on_its_neighbours(model, clips):
    one = replace(clips, clips=clips.clips[5:6])
    assert np.allclose(model.scores(one), model.scores(clips)[5:6], atol=1e-5)


def test_the_order_of_frames_matters(model, clips):
    back = replace(clips, films=tuple(film[::-1].copy() for film in clips.films))
    assert [each.action for each in model.named(back, RELATIONS[:1])[:4]] != ["Walk"] * 4


def test_untrained_it_is_indifferent(labels):
    torch.manual_seed(0)
    network = ClipNetwork(32, 3, 2, 0.0).eval()
    heads = network(torch.zeros(5, 4, 48, 64, 3, dtype=torch.uint8))
    loss = loss_of(heads, torch.zeros(5, 3, dtype=torch.long), ALIKE)
    assert abs(loss.item() - np.log(12)) < 0.7


def test_a_checkpoint_gives_the_same_scores(model, clips, tmp_path):
    save(model.checkpoint(), tmp_path)
    assert np.array_equal(ClipModel.restored(load(tmp_path)).scores(clips), model.scores(clips))


def test_larger_pictures_are_looked_at_as_small_ones(clips):
    larger = replace(clips, films=[film.repeat(2, 1).repeat(2, 2) for film in clips.films])
    one, other = pictures_of(clips), pictures_of(larger)
    assert one[0].shape[2] == other[0].shape[2] == WIDTH and np.array_equal(one[0], other[0])


def test_what_training_never_had_has_no_number(labels):
    assert labels.numbers(Instruction("Fly", ("cup",))) == (-1, -1, 0)


@pytest.mark.parametrize(
    ("name", "bad"),
    [("actions", []), ("objects", []), ("instructions", [["Walk", "a", "b", "c"]])],
)
def test_labels_that_do_not_fit(labels, name, bad):
    assert Labels.read(labels.document()) == labels
    with pytest.raises(ValueError, match="do not fit"):
        Labels.read({**labels.document(), name: bad})


def test_every_class_counts_the_same():
    walk, grab = Instruction("Walk", ("bed",)), Instruction("Grab", ("cup",))
    found = accuracies([walk] * 9 + [grab], [walk] * 10)
    assert found == {"action": 0.5, "objects": 0.5, "steps": 0.5, "mean": 0.5}
