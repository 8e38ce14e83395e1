"""The consensus of a network and of neighbours: most like all of them, whatever else is asked, and kept."""

from __future__ import annotations

import dataclasses

import pytest

from hearth.models.interface import Training
from hearth.scoring.metrics.lcs import score_pairs


@pytest.fixture(scope="module")
def trained(dataset, eight):
    from hearth.models.text.consensus_model import Consensus, TrainedConsensus
    from hearth.models.text.text_models import TextModel
    from hearth.models.text_examples import Corpus

    corpus = Corpus(dataset, "activities", eight, eight[:2])
    found = Consensus(draws=6).fit(corpus, Training(epochs=1))
    writer = TextModel(hidden=16, vector=16, dropout=0.0).fit(corpus, Training(epochs=3, rate=1e-2))
    return TrainedConsensus(found.settings, writer, found.neighbours)


@pytest.fixture(scope="module")
def asked(eight):
    return [each.request for each in eight]


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_the_answer_is_the_program_with_the_best_expected_score(trained, asked, share):
    model = dataclasses.replace(trained, settings=dataclasses.replace(trained.settings, share=share))
    for request, answer in zip(asked, model.predict(asked), strict=True):
        written = [*trained.writer.predict([request]), *trained.writer.drawn(request, 6)]
        ((programs, weights),) = trained.neighbours.candidates([request])
        every = [(one, (1 - share) / 7) for one in written] + [
            (one, share * weight / sum(weights)) for one, weight in zip(programs, weights, strict=True)
        ]

        def expected(program, every=every):
            scores = score_pairs((program, one) for one, _ in every)
            return sum(score.mean * weight for score, (_, weight) in zip(scores, every, strict=True))

        assert expected(answer) == pytest.approx(max(expected(one) for one, _ in every))
        assert len({*written}) > 1


def test_the_network_and_the_neighbours_both_count(trained, asked):
    shares = [dataclasses.replace(trained.settings, share=share) for share in (0.0, 1.0)]
    one, other = (dataclasses.replace(trained, settings=each).predict(asked) for each in shares)
    assert one != other


def test_an_answer_depends_on_its_text_alone(trained, asked):
    together = trained.predict(asked)
    renamed = [dataclasses.replace(each, id=f"other {n}") for n, each in enumerate(asked)]
    assert trained.predict(renamed[::-1]) == together[::-1]
    assert [trained.predict([each])[0] for each in asked] == together


def test_a_checkpoint_gives_the_same_answers(trained, asked, tmp_path):
    from hearth.models.checkpoint import load, save
    from hearth.models.text.consensus_model import Consensus

    save(trained.checkpoint(), tmp_path)
    assert Consensus.restored(load(tmp_path)).predict(asked) == trained.predict(asked)


@pytest.mark.parametrize("changed", [{"share": 2.0}, {"draws": 0}, {"draws": 5_000_000}])
def test_settings_that_cannot_be_are_refused(trained, changed):
    from hearth.models.text.consensus_model import Consensus

    checkpoint = trained.checkpoint()
    with pytest.raises(ValueError):
        Consensus.restored(dataclasses.replace(checkpoint, settings={**checkpoint.settings, **changed}))
