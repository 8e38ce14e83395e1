"""demo2sketch: what pictures from above show, the network's independence of the batch, learning by heart, and table
5.5, A.4 and the command over a dataset with pictures that were made up."""

from __future__ import annotations

import json
import math
import re
import shutil
from dataclasses import replace
from io import BytesIO
from random import Random

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.models.checkpoint import load, save
from hearth.models.demonstrations.demo_batches import done_batch, frame_batch, turn
from hearth.models.demonstrations.demo_model import DemoModel, TrainedDemoModel
from hearth.models.demonstrations.demo_sketches import pooled
from hearth.models.demonstrations.demonstration_comparison import compared
from hearth.models.demonstrations.demonstration_data import Demonstrations, Pictures, arrays, read_pictures
from hearth.models.demonstrations.mask_classes import MaskClasses
from hearth.models.demonstrations.overhead_features import above
from hearth.models.fit_model import fit
from hearth.models.interface import Request, Training
from hearth.models.sketches.sketch_result_tables import table
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_batches import encoded, step_batch
from hearth.models.text_examples import corpus
from hearth.models.training import train
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.tables import TABLES

HOW = {"epochs": 1, "minutes": 0.0, "rate": 1e-3, "seed": 0}
SIDE = 64


def pictures_of(steps, numbers, seed=0):
    """Pictures of a person who goes to the first object of each step; half of it is gone after the step."""
    random = np.random.Generator(np.random.PCG64(seed))
    names = list(dict.fromkeys(ref.name for step in steps for ref in step.objects if ref.name in numbers))
    spots = {name: (8 + 16 * (n % 4), 8 + 16 * (n // 4 % 4)) for n, name in enumerate(names)}
    base = np.full((SIDE, SIDE), numbers["floor"], np.uint16)
    for name, (x, y) in spots.items():
        base[y - 3 : y + 3, x - 3 : x + 3] = numbers[name]
    masks = []
    place = (4, 60)
    for step in (None, *steps):
        if step is not None and step.objects and step.objects[0].name in spots:
            x, y = spots[step.objects[0].name]
            base[y - 3 : y, x - 3 : x + 3] = numbers["floor"]
            place = x, y + 5
        mask = base.copy()
        mask[place[1] - 2 : place[1] + 2, place[0] - 2 : place[0] + 2] = numbers["character"]
        masks.append(mask)
    stacked = np.stack(masks)
    colours = random.integers(0, 255, (1 << 10, 3), np.uint8)[stacked % (1 << 10)]
    return Pictures(stacked, colours)


@pytest.fixture(scope="module")
def numbers(knowledge):
    return {thing.name: thing.id for thing in knowledge.objects.values()}


@pytest.fixture(scope="module")
def kept(eight):
    """The eight examples with sketches: all that is not walking."""
    return [replace(each, keep=tuple(step.action != "Walk" for step in each.steps)) for each in eight]


def made(settings, dataset, kept):
    vocabulary = StepVocabulary.of([(Request(each.program_id), each.steps) for each in kept], dataset.knowledge)
    known = MaskClasses.of(dataset.knowledge, vocabulary)
    return TrainedDemoModel(settings, vocabulary, known, settings.network(vocabulary, known))


def _trained(dataset, kept, numbers, epochs):
    model = made(DemoModel(hidden=48, vector=32, dropout=0.0, batch=8), dataset, kept)
    seen = [model.see(pictures_of(each.steps, numbers)) for each in kept]
    data = list(zip(seen, kept, strict=True))
    return model, seen, train(model.task(data, data, 0), Training(epochs=epochs, rate=4e-3, patience=0, halve_after=0))


@pytest.fixture(scope="module")
def tried(dataset, kept, numbers):
    """A model that has hardly learned anything, and what it saw."""
    return _trained(dataset, kept, numbers, 3)


@pytest.fixture(scope="module")
def learned(dataset, kept, numbers):
    """A model that knows the eight by heart: half a minute."""
    return _trained(dataset, kept, numbers, 320)


def test_what_is_near_and_what_changed_come_first(numbers, eight):
    found = above(*pictures_of(eight[2].steps, numbers), numbers["character"])
    rows = dict(zip(found.classes[3].tolist(), found.numbers[3], strict=True))
    assert found.classes[3][0] in (numbers["milk"], numbers["floor"])
    milk, fridge = rows[numbers["milk"]], rows[numbers["fridge"]]
    assert milk[0] > fridge[0] > 0 and milk[6] > 0 == fridge[6]
    assert milk[8] < 0 and milk[4] < 0
    assert numbers["character"] not in found.classes and found.people[:, 0].all()


def test_a_turned_demonstration_is_that_of_turned_pictures(numbers, eight):
    given = pictures_of(eight[3].steps, numbers)
    seen = above(*given, numbers["character"])
    for way in range(8):
        masks, colours = (each[:, :, ::-1] if way >= 4 else each for each in given)
        masks, colours = (np.rot90(each, way % 4, (1, 2)) for each in (masks, colours))
        wanted, found = above(masks, colours, numbers["character"]), turn(seen, way)
        for one, other in ((wanted, found), (found, wanted)):
            for picture in range(one.length):
                rows = dict(zip(other.classes[picture].tolist(), other.numbers[picture], strict=True))
                for number, row in zip(one.classes[picture].tolist(), one.numbers[picture], strict=True):
                    assert row[:9] == pytest.approx(rows[number][:9], abs=0.12)
        assert np.mean(wanted.masks != found.masks) < 0.2
    assert not np.array_equal(turn(seen, 1).masks, seen.masks)


@pytest.mark.slow
def test_it_learns_eight_by_heart(learned):
    assert learned[2].epochs[learned[2].best - 1].score == 1.0


def test_no_answer_depends_on_the_others(tried):
    model, seen, _ = tried
    together = model.sketches(seen)
    assert together == [model.sketches([each])[0] for each in seen]
    assert together == model.sketches(seen[::-1])[::-1]
    alone = model.writer.body.encode(frame_batch(seen[:1], model.known, model.writer.device))
    beside = model.writer.body.encode(frame_batch(seen, model.known, model.writer.device))
    count = seen[0].length
    assert beside.states[0, :count].detach().numpy() == pytest.approx(alone.states[0].detach().numpy(), abs=1e-5)


def test_a_checkpoint_gives_the_same_sketches(tried, tmp_path):
    model, seen, _ = tried
    save(replace(model.checkpoint(), trained={"dataset": "", "split": ""}), tmp_path)
    again = DemoModel.restored(load(tmp_path))
    assert again.sketches(seen, 3) == model.sketches(seen, 3)
    assert (again.known, again.vocabulary) == (model.known, model.vocabulary)


def test_the_loss_before_training_is_the_logarithm_of_the_choices(dataset, kept, numbers):
    import torch

    torch.manual_seed(0)
    model = made(DemoModel(guided=0.0), dataset, kept)
    example = kept[6]  # one step of one object
    frames = frame_batch([model.see(pictures_of(example.steps, numbers))], model.known, model.writer.device)
    sketch = encoded(example.sketch, model.vocabulary, 12)
    action = model.vocabulary.actions[sketch[0][0] - 1]
    choices = len(model.vocabulary.takes[model.vocabulary.action_numbers[action] - 1][0])
    model.writer.eval()
    done = done_batch([model.done(example)], model.writer.device)
    with torch.no_grad():
        found = float(model.loss((frames, step_batch([sketch], model.writer.device), done)))
    actions = math.log(len(model.vocabulary.actions) + 1)
    assert found == pytest.approx((2 * actions + math.log(choices)) / 2, rel=0.1)


@pytest.mark.slow
def test_guidance_names_what_each_step_is_about(learned, dataset, kept):
    import torch

    model, seen, _ = learned
    frames = frame_batch(seen, model.known, model.writer.device)
    memory = model.writer.body.encode(frames)
    done = done_batch([model.done(each) for each in kept], model.writer.device)
    assert ((memory.kept > 0) == (done.kept > 0))[done.real].float().mean() > 0.95
    before = made(DemoModel(), dataset, kept)
    memory_before = before.writer.body.encode(frames)
    with torch.no_grad():
        assert model.guidance(frames, memory, done) < before.guidance(frames, memory_before, done) / 4


@pytest.mark.parametrize("changed", [{"facts": False, "guided": 0.0, "whole": True}, {"colours": False},
                                     {"masks": False}])  # fmt: skip
def test_each_part_may_be_left_out(dataset, kept, numbers, changed):
    model = made(DemoModel(hidden=16, vector=16, **changed), dataset, kept)
    seen = [model.see(pictures_of(each.steps, numbers)) for each in kept]
    data = list(zip(seen, kept, strict=True))
    outcome = train(model.task(data, data, 0), Training(epochs=2))
    assert outcome.epochs[1].loss < outcome.epochs[0].loss
    assert len(model.sketches(seen)) == 8


def test_a_strangers_classes_are_checked(dataset, kept):
    known = made(DemoModel(), dataset, kept).known
    document = known.document()
    assert MaskClasses.read(document, len(known.ids)) == known
    for part, value in (("ids", [1 << 16] * len(known.ids)), ("serves", [[0]] * len(known.ids)), ("person", -1)):
        with pytest.raises(ValueError, match="do not fit"):
            MaskClasses.read({**document, part: value}, len(known.ids))


def _stored(given):
    changes = given.colours.copy()
    changes[1:] -= given.colours[:-1]
    buffer = BytesIO()
    np.savez_compressed(buffer, class_ids=given.masks, rgb_changes=changes)
    return buffer.getvalue()


def test_what_is_stored_is_read(eight, numbers):
    given = pictures_of(eight[0].steps, numbers)
    found = arrays(_stored(given), "above.npz")
    assert np.array_equal(found.masks, given.masks) and np.array_equal(found.colours, given.colours)
    with pytest.raises(HearthError, match="rgb_changes"):
        arrays(_stored(given._replace(colours=given.colours[:, :, :-1])), "above.npz")


@pytest.fixture(scope="module")
def pictured(parted, numbers, tmp_path_factory):
    """The parted dataset with pictures of each original's first execution."""
    from hearth.datasets.format.row_conversion import program_of
    from hearth.datasets.format.stored_cases import stored_cases

    folder = shutil.copytree(parted.folder, tmp_path_factory.mktemp("pictured") / "publish")
    names = [name for (name,) in parted.rows(
        "SELECT min(execution_id) FROM executions JOIN programs USING (program_id) "
        "WHERE executable AND parent_id IS NULL GROUP BY program_id ORDER BY 1")[1]]  # fmt: skip
    rows = []
    for place, case in enumerate(stored_cases(parted, names)):
        given = pictures_of(program_of(case).steps, numbers, place)
        file = folder / "frames" / str(place) / "above.npz"
        file.parent.mkdir(parents=True)
        file.write_bytes(_stored(given))
        for tick in range(len(given.masks)):
            row = {field.name: None for field in TABLES["demonstration_frames"]}
            rows.append({**row, "execution_id": case["execution_id"], "tick": tick, "index": tick,
                         "file": f"frames/{place}/above.npz"})  # fmt: skip
    path = next(iter(sorted((folder / "demonstration_frames").glob("*.parquet"))))
    pq.write_table(pa.Table.from_pylist(rows, TABLES["demonstration_frames"]), path)
    return hearth.load(folder)


@pytest.fixture(scope="module")
def models(pictured, tmp_path_factory):
    folder = tmp_path_factory.mktemp("demo models")
    fit("demo2sketch", pictured.folder, folder / "demo2sketch", "activities", ("hidden=16", "vector=16"), how=HOW)
    fit("retrieve-sketch", pictured.folder, folder / "retrieve-sketch", "activities", (), how=HOW)
    return folder


def test_training_records_how_many_demonstrations_there_were(models):
    trained = load(models / "demo2sketch").trained
    assert trained["demonstrations"] > 0 and trained["split"] == "activities"


def test_a_demonstration_that_does_not_fit_its_program_is_refused(pictured, tmp_path):
    """Programs of more steps than pictures have a step that nothing shows."""
    copy = hearth.load(shutil.copytree(pictured.folder, tmp_path / "copy"))
    for path in (copy.folder / "frames").glob("*/above.npz"):
        given = read_pictures(path)
        path.write_bytes(_stored(given._replace(masks=given.masks[:-1], colours=given.colours[:-1])))
    with pytest.raises(HearthError, match=r"it has \d+ pictures of \d+ ticks") as caught:
        DemoModel(hidden=16, vector=16).fit(corpus(copy, "activities"), Training(epochs=1))
    assert caught.value.diagnostics[0].code == Code.DAMAGED_FILE and caught.value.diagnostics[0].file


@pytest.mark.parametrize("part", ["train", "validation"])
@pytest.mark.parametrize("change", [lambda keep: keep[:1], lambda keep: (*keep, True)], ids=["few", "many"])
def test_a_sketch_that_does_not_fit_its_program_is_refused(pictured, part, change):
    """Annotations may have flags for other steps than those that were published."""
    given = corpus(pictured, "activities")
    train, validation = (
        tuple(replace(each, keep=(True,) * len(each.steps)) for each in some)
        for some in (given.train, given.validation)
    )
    given = replace(given, train=train, validation=validation)
    there = Demonstrations.of(pictured)
    some = getattr(given, part)
    bad = next(each for each in some if there.of_example(each))
    changed = replace(given, **{part: tuple(replace(each, keep=change(each.keep)) if each is bad else each
                                            for each in some)})  # fmt: skip
    with pytest.raises(HearthError, match=rf"the sketch of `{re.escape(bad.program_id)}` has \d+ flags") as caught:
        DemoModel(hidden=16, vector=16).fit(changed, Training(epochs=1))
    (fault,) = caught.value.diagnostics
    assert fault.code is Code.DAMAGED_FILE and "annotation" in fault.suggestion


def test_what_is_done_in_one_tick_is_before_one_picture(dataset, kept):
    steps = (kept[0].steps[0], replace(kept[0].steps[1], agent=1, joins=True), *kept[0].steps[2:])
    example = replace(kept[0], steps=steps, keep=(True, False, *kept[0].keep[2:]))
    found = made(DemoModel(hidden=16, vector=16), dataset, kept).done(example)
    assert len(found.kept) == len(found.steps) == len(steps) and found.kept[:2] == (None, True)


def test_5_5_has_sketches_of_demonstrations(pictured, models):
    rows = {row.method: row for row in table("5.5", pictured, "activities", [models / "demo2sketch"], most=4)}
    assert rows["ResActGraph"].scores["f1"] == 0.318 and rows["ResActGraph"].scores["lcs_instances"] == 0.327
    for name in ("demo2sketch, planner", "random sketch, planner", "nearest masks, planner"):
        assert 0 <= rows[name].scores["sketch"].mean <= 1
    assert rows["demo2sketch, planner"].of == "ours" and rows["nearest masks, planner"].of == "yardstick"
    assert "empty program" in rows and "sketch" not in rows["planner, given sketches"].scores
    with pytest.raises(HearthError, match=r"5\.5 needs a model"):
        table("5.5", pictured, "activities", ["planner"], most=4)
    with pytest.raises(HearthError, match=r"it takes planner, .*demo2sketch"):
        table("5.5", pictured, "activities", [models / "retrieve-sketch"], most=4)


def test_without_demonstrations_there_is_no_table(parted, models):
    with pytest.raises(HearthError, match="has no demonstrations"):
        table("5.5", parted, "activities", [models / "demo2sketch"], most=4)


def test_nearest_masks_are_those_of_the_same_pictures(pictured):
    there = Demonstrations.of(pictured)
    first, second, *_ = there.files
    assert pooled(there, first) @ pooled(there, first) == pytest.approx(1)
    assert pooled(there, first) @ pooled(there, second) < 1


def test_both_kinds_of_sketches_are_compared(pictured, models):
    found = compared(pictured, "activities", [models / "retrieve-sketch", models / "demo2sketch"])
    assert found.models == ("demo2sketch", "retrieve-sketch")
    assert sum(group.programs for group in found.by_words) == found.programs >= found.easier
    for group in found.by_activity:
        assert all(0 <= value <= 1 for value in group.lcs)
    with pytest.raises(HearthError, match="both a model"):
        compared(pictured, "activities", [models / "demo2sketch"])


def test_the_commands(pictured, models):
    given = next(iter(sorted((pictured.folder / "frames").glob("*/above.npz")))).parent
    assert read_pictures(given).masks.ndim == 3
    words = [
        "model",
        "show",
        str(models / "demo2sketch"),
        str(given),
        "--writer",
        "planner",
        "--home",
        "maple",
        "--json",
    ]
    shown = CliRunner().invoke(cli.app, words)
    assert set(json.loads(shown.stdout)) >= {"sketch", "program", "executable"}, shown.output
    words = ["model", "show", str(models / "retrieve-sketch"), str(given)]
    refused = CliRunner().invoke(cli.app, words)
    assert refused.exit_code == 1 and "does not read pictures" in refused.output
    pair = ["--model", str(models / "demo2sketch"), "--model", str(models / "retrieve-sketch")]
    result = CliRunner().invoke(cli.app, ["model", "table", "A.4", str(pictured.folder), *pair])
    assert result.exit_code == 0 and "Easier from pictures" in result.output


def test_noise_is_drawn_from_the_generator(tried):
    model, seen, _ = tried
    one, same, other = (frame_batch(seen, model.known, model.writer.device, Random(n)) for n in (1, 1, 2))
    assert (one.masks == same.masks).all() and (one.masks != other.masks).any()
