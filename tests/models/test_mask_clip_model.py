"""The classifier of clips by class: what it reads of masks, what it learns, and what it can name."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import torch

import hearth
from hearth.commands import film_output
from hearth.kb.loading.load import default
from hearth.models.checkpoint import load, save
from hearth.models.films import mask_clip_model
from hearth.models.films.class_accuracy import accuracies
from hearth.models.films.clip_data import Clip, Clips, Instruction
from hearth.models.films.film_input import read_masks
from hearth.models.films.film_prediction import cut, show_film
from hearth.models.films.mask_clip_model import SeenModel, TrainedSeenModel, tensors
from hearth.models.films.mask_clip_network import loss_of
from hearth.models.films.mask_clips import CONTEXT, joined, offsets, seen_clips
from hearth.models.films.mask_features import CROP, seen_film
from hearth.models.films.object_class_properties import ClassTable
from hearth.models.films.possible_instructions import reading
from hearth.models.films.step_order import START, StepOrder, programs_of
from hearth.models.interface import Training
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

SOFA, MUG, FRIDGE, PERSON = (default().objects[name].id for name in ("sofa", "mug", "fridge", "character"))


def film_of(thing: int, still: bool) -> np.ndarray:
    """Somebody stands still beside a thing, or walks to it."""
    frames = np.zeros((12, 48, 64), np.uint16)
    for time, frame in enumerate(frames):
        frame[20:40, 44:60] = thing
        frame[30:34, 4:8] = MUG
        left = 36 if still else 2 + 3 * time
        frame[10:42, left : left + 6] = PERSON
    return frames


@pytest.fixture(scope="module")
def clips():
    made = [(Instruction(action, (name,)), film_of(number, action == "Touch"))
            for name, number in (("sofa", SOFA), ("fridge", FRIDGE)) for action in ("Walk", "Touch")]  # fmt: skip
    found = [Clip(film, first, done, "seen", 1) for film, (done, _) in enumerate(made) for first in range(3)]
    return Clips(tuple(f"film {n}" for n in range(4)), [film for _, film in made], tuple(found), 9)


@pytest.fixture(scope="module")
def model(clips):
    torch.manual_seed(0)
    table = ClassTable.of(default(), [clip.done for clip in clips.clips])
    settings = SeenModel(width=32, layers=1, dropout=0.0)
    model = TrainedSeenModel(settings, table, StepOrder.of(programs_of(clips)), settings.network(table))
    batch, wanted = tensors(seen_clips(clips, table)), torch.tensor([table.numbers(clip.done) for clip in clips.clips])
    optimiser = torch.optim.Adam(model.network.parameters(), 3e-3)
    for _ in range(60):
        optimiser.zero_grad()
        loss_of(model.network, batch, wanted, torch.ones(len(wanted), 2)).backward()
        optimiser.step()
    model.network.eval()
    return model


def test_it_learns_clips_by_heart(model, clips):
    assert accuracies([clip.done for clip in clips.clips], model.named(clips))["mean"] == 1.0


def test_it_learns_from_predicted_masks_beside_true_ones(clips, monkeypatch):
    """Predicted masks alone have the second half of the clips, and validation has predicted ones."""
    halves = replace(clips, clips=clips.clips[:6]), replace(clips, clips=clips.clips[6:])
    parts = []

    def predicted(model, dataset, part, most=0):
        parts.append((model, part))
        return halves[1]

    monkeypatch.setattr(mask_clip_model, "predicted", predicted)
    monkeypatch.setattr(Clips, "of", lambda dataset, part, films=0: halves[0])
    monkeypatch.setattr(mask_clip_model, "mask_predictor", lambda _: SimpleNamespace(network=torch.nn.Linear(1, 1)))
    data = SimpleNamespace(knowledge=default(), manifest={"files": {}})
    both = SeenModel(width=16, layers=1, masks="network").fit(data, Training(epochs=1))
    assert parts == [("network", "train"), ("network", "validation")]
    assert both.facts["clips"] == 12
    true = SeenModel(width=16, layers=1).fit(data, Training(epochs=1))
    assert true.facts["clips"] == 6 and len(parts) == 2


def test_clips_of_two_parts_are_those_of_both(clips, model):
    whole = seen_clips(clips, model.table)
    for one, other in zip(joined([whole.part(slice(0, 5)), whole.part(slice(5, None))]), whole, strict=True):
        assert np.array_equal(one, other)


def test_it_points_at_what_training_never_named(model, clips):
    """A washing machine stands where the fridge was."""
    other = default().objects["bookshelf"].id
    films = [np.where(film == FRIDGE, other, film).astype(np.uint16) for film in clips.films]
    named = model.named(replace(clips, films=films))
    assert Instruction("Walk", ("bookshelf",)) in named[6:9]


def test_what_a_clip_is_taken_for_does_not_depend_on_its_neighbours(model, clips):
    shown = seen_clips(clips, model.table)
    every, one = (next(model._scored(part)) for part in (shown, shown.part(slice(5, 6))))
    assert np.allclose(every.actions[5:6], one.actions, atol=1e-5)
    assert np.allclose(every.objects[5:6], one.objects, atol=1e-4)


def test_untrained_it_is_indifferent(clips, model):
    torch.manual_seed(1)
    network = model.settings.network(model.table).eval()
    batch = tensors(seen_clips(clips, model.table))
    scores = network.actions(network.read(batch)[0])
    assert abs(-scores.mean().item() - np.log(2)) < 1e-4


def test_what_is_not_afforded_is_not_named(model, clips):
    table = ClassTable.of(default(), [Instruction("SwitchOn", ("television",))])
    assert table.afforded[0, 0, table.numbers(Instruction("SwitchOn", ("television",)))[1]]
    assert not table.afforded[0, 0, table.numbers(Instruction("SwitchOn", ("sofa",)))[1]]


def test_mirrored_twice_is_the_same(clips, model):
    batch, every = tensors(seen_clips(clips, model.table)), torch.ones(len(clips), dtype=torch.bool)
    once = batch.mirrored(every)
    assert not torch.equal(once.people, batch.people) and not torch.equal(once.numbers, batch.numbers)
    for one, other in zip(once.mirrored(every), batch, strict=True):
        assert torch.equal(one, other)
    mirrored = tensors(seen_clips(replace(clips, films=[film[:, :, ::-1].copy() for film in clips.films]), model.table))
    assert torch.equal(mirrored.classes, once.classes)
    assert torch.allclose(mirrored.numbers, once.numbers, atol=0.06)
    assert torch.allclose(mirrored.people, once.people, atol=1e-3)


def test_numbers_do_not_depend_on_the_size_of_pictures():
    film = film_of(SOFA, False)
    small, large = seen_film(film, PERSON), seen_film(film.repeat(2, 1).repeat(2, 2), PERSON)
    assert small.classes.tolist() == large.classes.tolist() == sorted((MUG, SOFA))
    assert np.abs(small.numbers[..., :9].astype(float) - large.numbers[..., :9]).max() < 0.05
    assert np.abs(small.people.astype(float) - large.people).max() < 0.05
    assert small.crops.shape == (12, CROP, CROP) and (small.crops == PERSON).any()


def test_a_film_without_people_is_read(clips, model):
    empty = replace(clips, films=[np.where(film == PERSON, 0, film).astype(np.uint16) for film in clips.films])
    assert len(model.named(empty)) == len(clips)


def test_a_checkpoint_gives_the_same_answers(model, clips, tmp_path):
    save(model.checkpoint(), tmp_path)
    restored = SeenModel.restored(load(tmp_path))
    shown = seen_clips(clips, model.table)
    assert restored.order == model.order
    assert np.array_equal(next(restored._scored(shown)).objects, next(model._scored(shown)).objects)


@pytest.mark.parametrize(("name", "bad"), [("classes", [[1, "a", []]]), ("named", [9_999]), ("afforded", ["01"])])
def test_tables_that_do_not_fit(model, name, bad):
    document = model.table.document()
    assert ClassTable.read(document).document() == document
    with pytest.raises(ValueError, match="do not fit"):
        ClassTable.read({**document, name: bad})


def test_a_reading_scores_probable_instructions_in_every_clip(model, clips):
    (first, *_) = model.readings(clips)
    assert Instruction("Walk", ("sofa",)) in first.instructions and first.scores.shape == (3, len(first.instructions))
    best = {first.instructions[number] for number in first.scores.argmax(1)}
    assert best == {Instruction("Walk", ("sofa",))}
    actions, objects = np.zeros((0, 2), np.float32), np.zeros((0, 2, 2, len(model.table) + 1), np.float32)
    assert reading(actions, objects, model.table).scores.shape == (0, 0)


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04 no archive", b"\x93NUMPY", b"PK\x05\x06" + bytes(18)])
def test_a_file_that_is_no_film_is_refused(data, tmp_path):
    (tmp_path / "film.npz").write_bytes(data)
    with pytest.raises(HearthError) as found:
        read_masks(tmp_path / "film.npz")
    assert found.value.diagnostics[0].code == Code.DAMAGED_FILE


def test_a_film_becomes_a_program_that_runs(model, clips, tmp_path):
    np.savez_compressed(tmp_path / "film.npz", class_ids=clips.films[0])
    masks = read_masks(tmp_path / "film.npz")
    shown = show_film(model, masks, hearth.home("maple"))
    assert [(step.action, step.objects[0].name) for step in shown.seen.steps] == [("Walk", "sofa")]
    assert shown.execution.executable and shown.clips == 2 and shown.times == (0.89,)
    with pytest.raises(HearthError, match="shorter than a clip"):
        cut(masks[:5])


def test_the_command_prints_steps_with_times(model, clips, tmp_path, capsys):
    save(model.checkpoint(), tmp_path / "model")
    np.savez_compressed(tmp_path / "film.npz", class_ids=clips.films[0])
    found = film_output.show(str(tmp_path / "model"), tmp_path / "film.npz", "maple", None, None, None)
    assert found["steps"] == [{"time": 0.89, "step": "[Walk] <sofa> (1)"}] and found["executable"]
    film_output.printed(found)
    assert "0.9 s  [Walk] <sofa> (1)" in capsys.readouterr().out
    with pytest.raises(HearthError, match="no film at"):
        film_output.show(str(tmp_path / "model"), tmp_path / "film.webm", "maple", None, None, None)


def test_steps_follow_each_other_as_in_programs(clips):
    walk, touch = Instruction("Walk", ("cup",)), Instruction("Touch", ("cup",))
    order = StepOrder.of([[walk, touch]] * 20)
    assert StepOrder.read(order.document()) == order
    logs = order.logs([START, walk], [walk, touch, Instruction("Touch", ("bed",))])
    assert logs[0, 0] > logs[0, 1] and logs[1, 1] > logs[1, 0] and logs[1, 1] > logs[1, 2] + 1
    assert programs_of(clips)[0] == [Instruction("Walk", ("sofa",))]


def test_a_reading_that_is_not_finished_leaves_gradients_on(model, clips):
    begun = model._scored(seen_clips(clips, model.table))
    assert next(begun) and torch.is_grad_enabled()


def test_the_context_of_a_clip_is_seen_where_the_film_has_it(clips, model):
    late = [film.copy() for film in clips.films]
    for film in late:
        film[11] = 0  # the third clip's last frame is the eleventh
    other = replace(clips, films=late)
    narrow, wide = (seen_clips(clips, model.table, context) for context in (False, True))
    assert np.array_equal(seen_clips(other, model.table).numbers, narrow.numbers)
    assert not np.array_equal(seen_clips(other, model.table, context=True).numbers, wide.numbers)
    assert wide.numbers.shape[2] == len(offsets(9, context=True)) == 9 + 2 * len(CONTEXT)
    before = wide.people[0, 9 : 9 + len(CONTEXT)]
    assert not before.any(), "nothing is before the film"
    assert np.array_equal(wide.people[:, :9], narrow.people)


def test_a_network_with_context_is_restored(clips, model, tmp_path):
    settings = SeenModel(width=32, layers=1, context=True)
    made = replace(model, settings=settings, network=settings.network(model.table).eval())
    save(made.checkpoint(), tmp_path)
    assert SeenModel.restored(load(tmp_path)).named(clips) == made.named(clips)


def test_a_stopped_training_goes_on_with_its_own_dataset_alone(clips, monkeypatch):
    """A stopped training is known by the dataset's files and by the weights that predict masks."""
    tasks = []
    monkeypatch.setattr(Clips, "of", lambda dataset, part, films=0: clips)
    monkeypatch.setattr(mask_clip_model, "predicted", lambda *_: clips)
    networks = {name: SimpleNamespace(network=torch.nn.Linear(1, number)) for number, name in enumerate("ab", 1)}
    monkeypatch.setattr(mask_clip_model, "mask_predictor", networks.get)
    monkeypatch.setattr(
        mask_clip_model, "train", lambda task, *_: tasks.append(task.identity) or SimpleNamespace(record=dict)
    )
    for files, masks in (("one", ""), ("other", ""), ("one", "a"), ("one", "b"), ("one", "")):
        data = SimpleNamespace(knowledge=default(), manifest={"files": {files: 1}})
        SeenModel(width=16, layers=1, masks=masks).fit(data, Training())
    assert tasks[0] == tasks[-1] and len({str(each) for each in tasks}) == 4
