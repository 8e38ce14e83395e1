"""The encoder-decoder over clips: what it learns, what its answers do not depend on, and what runs."""

from __future__ import annotations

from dataclasses import replace
from random import Random
from types import SimpleNamespace

import numpy as np
import pytest
import torch

import hearth
from hearth.kb.loading.load import default
from hearth.models.checkpoint import load, save
from hearth.models.execution_trials import Trial
from hearth.models.films import film_self_critical, film_training_examples, film_writer
from hearth.models.films.clip_batches import clip_batch, rows_of
from hearth.models.films.clip_data import Clips, Instruction
from hearth.models.films.clip_probabilities import ClipProbabilities, of_scores
from hearth.models.films.film_result_tables import by_writer
from hearth.models.films.film_self_critical import FilmCritical, sim_reward
from hearth.models.films.film_training_examples import FilmExample, film_probabilities
from hearth.models.films.film_writer import FilmWriter, TrainedFilmWriter
from hearth.models.films.mask_clip_model import Scored, SeenModel, TrainedSeenModel
from hearth.models.films.object_class_properties import ClassTable
from hearth.models.films.step_order import StepOrder
from hearth.models.interface import Request, Training
from hearth.models.model_registry import restore
from hearth.models.text.likelihood_training import likelihood
from hearth.models.text.program_writer import sample
from hearth.models.text.self_critical import SIM, Drawn, rewarding, surrogate
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_batches import encoded, step_batch
from hearth.models.text.text_models import listed
from hearth.models.training import train
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.scoring.metrics.executability import executability
from hearth.scoring.metrics.parsability import parsability
from hearth.simulation.rules import DEFAULT
from tests.models.conftest import TEXTS, steps_of

PROGRAMS = [
    tuple(replace(step, objects=tuple(ObjectRef(ref.name) for ref in step.objects)) for step in steps_of(*lines))
    for _, _, lines in TEXTS
]

EPOCHS = 100


@pytest.fixture(scope="module")
def reader():
    """A classifier with random weights: its table is what counts here."""
    torch.manual_seed(0)
    done = [Instruction(step.action, tuple(ref.name for ref in step.objects)) for steps in PROGRAMS for step in steps]
    table, settings = ClassTable.of(default(), done), SeenModel(width=16, layers=1, dropout=0.0)
    return TrainedSeenModel(settings, table, StepOrder.of([done]), settings.network(table).eval())


def seen(steps, table, sure=0.9, clips=3):
    """Return a classifier's probabilities for a film of some steps, each in some clips."""
    rows = [table.numbers(Instruction(step.action, tuple(ref.name for ref in step.objects))) for step in steps]
    actions = np.full((len(rows) * clips, len(table.actions)), (1 - sure) / len(table.actions), np.float32)
    objects = np.full((len(rows) * clips, 2, len(table) + 1), (1 - sure) / len(table), np.float32)
    for number in range(len(actions)):
        action, first, second = rows[number // clips]
        actions[number, action] = sure
        objects[number, 0, first] = objects[number, 1, second] = sure
    return ClipProbabilities(actions, objects, np.ones(len(actions), np.float32))


@pytest.fixture(scope="module")
def films(reader):
    trial = Trial(hearth.World.start(hearth.home("maple")), Program(), DEFAULT)
    return [FilmExample(str(n), seen(steps, reader.table), steps, trial) for n, steps in enumerate(PROGRAMS)]


def untrained(reader, **changed):
    settings = FilmWriter(**{"hidden": 32, "vector": 24, "dropout": 0.0, "batch": 8, "longest": 20, **changed})
    pairs = [(Request(str(n)), steps) for n, steps in enumerate(PROGRAMS)]
    vocabulary = StepVocabulary.of(pairs, default())
    closed = listed(pairs, vocabulary, 40) if settings.steps == "closed" else ()
    torch.manual_seed(1)
    return TrainedFilmWriter(settings, reader, vocabulary, closed, settings.network(vocabulary, closed, reader).eval())


def by_heart(model, films):
    """Without noise, which takes one film for another."""
    data = [(each.clips, encoded(each.steps, model.vocabulary, 20)) for each in films]
    task = likelihood(
        model.writer, data, lambda asked, _: model.read(asked), 8, 20, lambda: model.score(films), "heart"
    )
    train(task, Training(epochs=EPOCHS, rate=0.01, patience=0, halve_after=0))


@pytest.fixture(scope="module", params=["composed", "closed"])
def learned(request, reader, films):
    model = untrained(reader, steps=request.param)
    by_heart(model, films)
    return model


def test_it_learns_eight_films_by_heart(learned, films):
    assert learned.write([each.clips for each in films]) == [each.steps for each in films]
    assert learned.score(films) == 1.0


def test_answers_do_not_depend_on_the_batch_its_order_or_its_padding(learned, films, reader):
    asked = [each.clips for each in films]
    long = seen(PROGRAMS[0] * 9, reader.table)
    order = Random(3).sample(range(len(asked)), len(asked))
    together = learned.write([*(asked[number] for number in order), long])
    assert [learned.write([asked[number]])[0] for number in order] == together[:-1]
    with torch.no_grad():
        one = learned.writer.body.encode(learned.read([asked[4]])).states
        many = learned.writer.body.encode(learned.read([long, asked[4]])).states
    assert many.shape[1] > one.shape[1]
    assert torch.allclose(one[0], many[1, : one.shape[1]], atol=1e-5)


def test_a_checkpoint_gives_the_same_answers(learned, films, tmp_path):
    model = replace(learned, trained={"films": 8})
    save(model.checkpoint(), tmp_path)
    name, again = restore(tmp_path)
    assert name == "films-mle" and again.trained == model.trained
    noisy = [each.clips.part(np.arange(len(each.clips))[::-1]).merged() for each in films]
    assert again.write(noisy, beam=2) == model.write(noisy, beam=2)
    assert again.reader.table.document() == model.reader.table.document()
    assert torch.equal(again.reader.network.action.weight, model.reader.network.action.weight)
    assert load(tmp_path).settings == load(tmp_path).settings | {"steps": model.settings.steps}


def test_the_reference_is_not_read(reader, films):
    model = untrained(reader)
    other = [each._replace(steps=PROGRAMS[0] * 3) for each in films]
    assert model.write([each.clips for each in other]) == model.write([each.clips for each in films])
    one, same = (model.asked(given, Random(5)) for given in (films, other))
    assert torch.equal(one.inputs, same.inputs)


@pytest.mark.parametrize("beam", [1, 2])
def test_with_random_weights_each_program_parses_and_runs(reader, films, environments, beam):
    model = untrained(reader)
    worlds = environments[:24]
    asked = [films[number % len(films)].clips for number in range(len(worlds))]
    search = model.followed(asked, worlds, beam)
    for steps, world in zip(search, worlds, strict=True):
        assert steps and parsability(steps, world.home.knowledge).parsable
        assert executability(steps, world).executable


def test_a_closed_list_cannot_be_followed_by_the_engine(reader, films):
    model = untrained(reader, steps="closed")
    with pytest.raises(HearthError, match="closed list"):
        model.followed([films[0].clips], [films[0].trial.world])
    assert by_writer(model, films[0].clips, films[0].trial.world).keys() == {"free", "free, repaired"}


def test_what_is_written_runs_where_the_engine_is_asked(reader, films):
    model = untrained(reader)
    by_heart(model, films)
    found = by_writer(model, films[0].clips, films[0].trial.world)
    assert found["free"] == films[0].steps
    for way in ("free, repaired", "engine"):
        assert executability(found[way], films[0].trial.world).executable
    assert found["engine"] and found["engine"][0].objects[0].node is not None


def test_the_mean_gradient_of_the_baseline_is_about_zero(reader, films):
    """Eq. 4.7: any constant times the gradient of the logarithm of the probability of samples has the mean 0."""
    model = untrained(reader, longest=4)
    many = model.read([films[0].clips] * 400)
    with torch.no_grad():
        programs = sample(model.writer, many, 4, torch.Generator().manual_seed(0))
    gradients = []
    for start in range(0, 400, 20):
        model.writer.zero_grad()
        part = step_batch(programs[start : start + 20], model.writer.device, 4)
        inputs = model.read([films[0].clips] * 20)
        model.writer.log_probabilities(inputs, part).sum(1).mean().backward()
        gradients.append(model.writer.head.action.bias.grad.clone())
    found = torch.stack(gradients)
    error = found.std(0) / len(found) ** 0.5
    assert (found.mean(0).abs() < 4.5 * error + 1e-3).all()
    assert found.abs().max() > 0.05


def test_what_is_rewarded_becomes_more_probable(reader, films):
    model = untrained(reader, longest=4)
    program = step_batch([[(model.vocabulary.action_numbers["Sleep"], 0, 0)]], model.writer.device)

    def probability():
        with torch.no_grad():
            return float(model.writer.log_probabilities(model.read([films[0].clips]), program)[0, 0])

    def rewarded(examples, programs):
        return [float(any(step.action == "Sleep" for step in steps)) for steps in programs]

    before = probability()
    optimiser = torch.optim.Adam(model.writer.parameters(), lr=0.02)
    for seed in range(8):
        optimiser.zero_grad()
        surrogate(model, Drawn([films[0]] * 32, seed), rewarded).backward()
        optimiser.step()
    assert probability() > before + 0.1


def test_rewards(films):
    sleeping, walking = films[4], films[0]
    given = [sleeping, sleeping, walking]
    found = sim_reward(given, [(), sleeping.steps, (Step("Drink", (ObjectRef("milk"),)),)])
    assert found[0] == 0 and found[1] in (1.0, 1 + SIM) and found[2] == 0
    runs = (Step("Walk", (ObjectRef("bedroom"),)),)
    assert sim_reward([sleeping], [runs]) == [pytest.approx(1 / 3 + SIM)]


def test_the_second_phase_trains(reader, films):
    model = untrained(reader)
    before = model.writer.head.action.weight.clone()
    task = rewarding(model, films, sim_reward, 4, lambda: model.score(films), "second")
    assert len(train(task, Training(epochs=1)).epochs) == 1
    assert not torch.equal(before, model.writer.head.action.weight)


def test_noise_doubts_films_and_leaves_them_as_they_are(reader, films):
    model = untrained(reader)
    asked = [each.clips for each in films]
    plain, noisy, same = model.read(asked), model.read(asked, Random(1)), model.read(asked, Random(1))
    assert noisy.lengths.sum() < plain.lengths.sum() and torch.equal(noisy.inputs, same.inputs)
    assert noisy.inputs.amax(-1)[noisy.mask].mean() < plain.inputs.amax(-1)[plain.mask].mean()
    assert torch.equal(model.read(asked).inputs, plain.inputs)


def test_probabilities_of_objects_by_hand(reader):
    """Two clips; the first action that takes no object and the first that takes one."""
    table = reader.table
    none, one = (table.objects.index(count) for count in (0, 1))
    actions = np.full((1, len(table.actions)), -np.inf, np.float32)
    actions[0, none], actions[0, one] = np.log(0.25), np.log(0.75)
    objects = np.full((1, 2, len(table.actions), len(table) + 1), -np.inf, np.float32)
    objects[0, 0, one, 5], objects[0, 0, one, 7], objects[0, :, none, 9] = np.log(0.2), np.log(0.8), 0.0
    found = of_scores(Scored(actions, objects), table)
    assert found.objects[0, 0, [0, 5, 7, 9]] == pytest.approx([0.25, 0.15, 0.6, 0.0])
    assert found.objects[0, 1, 0] == pytest.approx(1.0)


def test_clips_alike_in_a_row_are_one(reader):
    film = seen(PROGRAMS[0], reader.table)
    one = film.merged()
    assert one.lengths.tolist() == [3.0] * len(PROGRAMS[0])
    assert np.allclose(one.actions, film.actions[::3]) and np.allclose(one.objects, film.objects[::3])
    twice = seen(PROGRAMS[0][:1] * 2 + PROGRAMS[0][1:], reader.table).merged()
    assert twice.lengths.tolist() == [6.0, 3.0, 3.0]


def test_classes_of_programs_are_those_of_clips(reader, films):
    model = untrained(reader)
    rows = rows_of(model.vocabulary, reader.table)
    assert rows[0] == 0
    milk = model.vocabulary.class_numbers["milk"]
    assert reader.table.names[rows[milk] - 1] == "milk"
    batch = clip_batch([films[2].clips], rows, model.writer.device)
    assert batch.mentioned[0, -1, milk] > 0.8 > batch.mentioned[0, 0, milk]
    assert (batch.mentioned[..., 0] == 0).all()


@pytest.fixture
def filmed(reader, films, monkeypatch):
    """A dataset of the eight films, read by the classifier."""
    monkeypatch.setattr(film_writer, "classifier", lambda start: ("clips-seen", reader))
    for module in (film_writer, film_self_critical):
        monkeypatch.setattr(module, "film_examples", lambda *_: list(films))
    return SimpleNamespace(knowledge=default())


def test_both_phases_are_trained_and_recorded(filmed, reader, tmp_path):
    first = FilmWriter(hidden=16, vector=16, passes=1, longest=8).fit(filmed, Training(epochs=2))
    assert first.trained["epochs"] == 2 and first.trained["films"] == 8
    save(first.checkpoint(), tmp_path / "first")
    second = FilmCritical("lcs+sim", str(tmp_path / "first"), 4).fit(filmed, Training(epochs=1))
    assert second.trained["first_phase"]["epochs"] == 2 and second.trained["films"] == 8
    assert FilmCritical.restored(second.checkpoint()).trained == second.trained
    save(reader.checkpoint(), tmp_path / "reader")
    with pytest.raises(HearthError, match="writes no programs of films"):
        FilmCritical(start=str(tmp_path / "reader")).fit(filmed, Training(epochs=1))


def test_films_are_read_once_by_equal_classifiers(reader, monkeypatch):
    asked = []
    monkeypatch.setattr(film_training_examples, "facts_of", lambda dataset: {"digest": "of this test"})
    monkeypatch.setattr(film_training_examples, "of_film", lambda trained, masks: asked.append(trained))
    clips = Clips(("film",), [np.zeros((9, 2, 2), np.uint16)], (), 9)
    same = SeenModel.restored(reader.checkpoint())
    for each in (reader, same):
        film_probabilities(SimpleNamespace(), clips, "test", 0, each)
    assert asked == [reader]
    torch.manual_seed(9)
    other = replace(reader, network=reader.settings.network(reader.table).eval())
    film_probabilities(SimpleNamespace(), clips, "test", 0, other)
    film_probabilities(SimpleNamespace(), clips, "train", 0, other)
    assert asked == [reader, other, other]
