"""Models that write a program step by step: what they learn, and what their answers do not depend on."""

from __future__ import annotations

import math
from dataclasses import replace
from random import Random

import pytest

from hearth.models.interface import Request, Training

KINDS = {
    "lstm, composed": {},
    "lstm, closed": {"steps": "closed", "copy": False},
    "transformer": {"body": "transformer", "layers": 1},
}
HOW = Training(epochs=120, rate=0.01, patience=0, halve_after=0)
SLOWLY = replace(HOW, epochs=160, rate=0.004)
"""For those that are right by chance early at a greater rate: their weights would be those of then."""


def small(**changed):
    from hearth.models.text.text_models import TextModel

    return TextModel(**{"hidden": 32, "vector": 24, "dropout": 0.0, "batch": 8, **changed})


def plain(programs):
    return [[(step.action, *(ref.name for ref in step.objects)) for step in steps] for steps in programs]


@pytest.fixture(scope="module")
def learned(dataset, eight):
    """Each kind, trained on the eight; they have titles in the noise, so that some texts are seen without."""
    from hearth.models.text_examples import Corpus

    corpus = Corpus(dataset, "activities", eight, eight)
    return {kind: small(**changed).fit(corpus, SLOWLY if changed else HOW) for kind, changed in KINDS.items()}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("beam", [1, 3])
def test_it_learns_eight_examples_by_heart(learned, eight, kind, beam):
    found = learned[kind].predict([each.request for each in eight], beam)
    assert plain(found) == plain(each.steps for each in eight)


@pytest.mark.parametrize("kind", KINDS)
def test_answers_do_not_depend_on_the_batch_its_order_or_its_padding(learned, eight, kind):
    model = learned[kind]
    asked = [each.request for each in eight]
    together = model.predict(asked)
    assert [model.predict([each])[0] for each in asked] == together
    long = Request("long", "", "walk to the fridge and then " * 60)
    order = Random(3).sample([*asked, long], 9)
    assert dict(zip(order, model.predict(order), strict=True)) | {} == {
        **dict(zip(asked, together, strict=True)), long: model.predict([long])[0],
    }  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_the_code_of_a_text_does_not_depend_on_its_neighbours(learned, eight, kind):
    import torch

    from hearth.models.text.text_batches import text_batch

    model = learned[kind]
    alone, among = (
        text_batch(requests, model.vocabulary, model.writer.device)
        for requests in ([eight[4].request], [each.request for each in eight])
    )
    with torch.no_grad():
        one, all_ = model.writer.body.encode(alone).states, model.writer.body.encode(among).states
    length = one.shape[1]
    assert all_.shape[1] > length
    assert torch.allclose(one[0], all_[4, :length], atol=1e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_the_loss_before_training_is_the_logarithm_of_the_choices(learned, eight, kind):
    import torch

    from hearth.models.text.text_batches import encoded, step_batch, text_batch

    model = learned[kind]
    torch.manual_seed(0)
    writer = model.settings.network(model.vocabulary, model.closed, None).eval()
    for layer in writer.modules():  # without the small numbers that they begin with
        if isinstance(layer, torch.nn.Embedding | torch.nn.Linear):
            layer.weight.data.zero_()
    programs = [encoded(each.steps, model.vocabulary, 40) for each in eight]
    texts = text_batch([each.request for each in eight], model.vocabulary, writer.device)
    found = float(writer.loss(texts, step_batch(programs, writer.device)).detach())
    if model.closed:
        expected = math.log(len(model.closed) + 1)
    else:
        known, total, count = model.vocabulary, 0.0, 0
        for program in programs:
            total, count = total + (len(program) + 1) * math.log(len(known.actions) + 1), count + len(program) + 1
            for action, first, second in program:
                choices = [set(found) for found in known.takes[action - 1]]
                total += math.log(len(choices[0])) if first else 0
                total += math.log(len(choices[1] - {first})) if second else 0
        expected = total / count
    assert found == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("kind", KINDS)
def test_all_probabilities_of_a_step_add_up_to_one(learned, eight, kind):
    import torch

    from hearth.models.text.text_batches import text_batch

    model = learned[kind]
    with torch.no_grad():
        draft = model.writer.begin(text_batch([eight[0].request], model.vocabulary, model.writer.device))
        _, context = model.writer.look(draft)
        scores, steps = model.writer.head.best(context, 20)
        again = model.writer.head.log_probability(
            type(context)(*(part.repeat_interleave(scores.shape[1], 0) for part in context)), steps[0]
        )
    assert torch.allclose(scores[0][scores[0] > -1e8], again[scores[0] > -1e8], atol=1e-4)
    assert scores.exp().sum() <= 1 + 1e-4
    assert scores[0].diff().max() <= 0


@pytest.mark.parametrize("kind", KINDS)
def test_a_checkpoint_gives_the_same_answers(learned, eight, kind, tmp_path):
    from hearth.models.checkpoint import save
    from hearth.models.model_registry import restore

    model = learned[kind]
    save(replace(model.checkpoint(), model="mle"), tmp_path)
    _, again = restore(tmp_path)
    asked = [*(each.request for each in eight), Request("x", "", "Wash the plate and sleep on the couch")]
    for beam in (1, 3):
        assert again.predict(asked, beam) == model.predict(asked, beam)
    assert again.checkpoint().trained == model.checkpoint().trained


def test_copying_writes_objects_that_no_training_program_has(learned):
    """`mug` is in no example."""
    model = learned["lstm, composed"]
    assert "mug" in model.vocabulary.classes
    found = model.predict([Request("x", "Put a plate away", "Put a mug on the table.")])[0]
    assert all(step.action in model.vocabulary.actions for step in found)


def test_samples_follow_the_generator(learned, eight):
    import torch

    from hearth.models.text.program_writer import sample
    from hearth.models.text.text_batches import text_batch

    model = learned["lstm, composed"]
    texts = text_batch([each.request for each in eight], model.vocabulary, model.writer.device)
    with torch.no_grad():
        one, same = (sample(model.writer, texts, 20, torch.Generator().manual_seed(1)) for _ in range(2))
    assert one == same and len(one) == 8


@pytest.mark.parametrize("text", ["", "!!!", "日本語", "x " * 10_000])
@pytest.mark.parametrize("kind", KINDS)
def test_any_text_has_an_answer(learned, kind, text):
    (found,) = learned[kind].predict([Request("x", "", text)], 2)
    assert len(found) <= learned[kind].settings.longest


def test_word_vectors_are_the_same_whatever_the_order():
    import numpy as np

    from hearth.models.text.word_vectors import word_vectors

    documents = [
        (["open", "the", "fridge"], ["fridge"]),
        (["take", "the", "milk"], ["milk"]),
        (["open", "it"], ["milk"]),
    ]
    known = sorted({word for text, names in documents for word in (*text, *names)})
    one, other = word_vectors(documents, known, 3), word_vectors(documents[::-1], known, 3)
    assert np.allclose(one, other, atol=1e-6) and one.shape == (len(known), 3)
    assert word_vectors([], ["a"], 3).tolist() == [[0, 0, 0]]


def test_mentions(knowledge):
    from hearth.models.text.object_mentions import mentions, spellings

    known = spellings(knowledge, list(knowledge.objects))
    found = mentions(["put", "the", "plates", "and", "the", "coffee", "maker", "next", "to", "the", "salt"], known)
    assert [place for place, _ in found] == [2, 5, 10]
    assert {"plate"} <= {name for _, name in found}
    assert next(iter(mentions(["knives"], known)))[1] == "knife"
