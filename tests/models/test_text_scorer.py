"""Models of texts decoded with the engine in the loop: with random weights, too, each program parses and runs."""

from __future__ import annotations

from dataclasses import replace

import pytest

from hearth.models.interface import Training
from hearth.models.text_examples import requests
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import Program
from hearth.scoring.dataset_scores import chosen
from hearth.scoring.metrics.executability import executability
from hearth.scoring.metrics.parsability import parsability
from hearth.simulation.world.home import Home


def untrained(dataset, eight, **changed):
    from hearth.models.text.text_models import TextModel
    from hearth.models.text_examples import Corpus

    settings = TextModel(hidden=16, vector=16, dropout=0.0, **changed)
    return settings.fit(Corpus(dataset, "activities", eight, eight[:1]), Training(epochs=1, rate=1e-6))


@pytest.mark.parametrize("body", ["lstm", "transformer"])
def test_with_random_weights_each_program_parses_and_runs(dataset, eight, body):
    from hearth.models.decoding.search import Search, Start, decode

    model = untrained(dataset, eight, body=body)
    (share,) = requests(dataset, chosen(dataset)[:12], worlds=True)
    for beam in (1, 2):
        programs = decode(model.scorer(), [Start(each.world, each) for each in share], Search(beam=beam, longest=15))
        for each, steps in zip(share, programs, strict=True):
            assert steps
            assert executability(steps, each.world).executable
            assert parsability(steps, each.world.home.knowledge).parsable


def test_what_it_has_learned_is_written_where_it_can_be_done(dataset, eight, maple):
    from hearth.models.decoding.search import Start, decode
    from hearth.models.text.text_models import TextModel
    from hearth.models.text_examples import Corpus
    from hearth.simulation.world.world import World

    one = eight[0]
    settings = TextModel(hidden=32, vector=16, dropout=0.0)
    model = settings.fit(
        Corpus(dataset, "activities", (one,), (one,)), Training(epochs=60, rate=0.01, patience=0, halve_after=0)
    )
    (steps,) = decode(model.scorer(), [Start(World.start(maple), one.request)])
    assert isinstance(maple, Home) and executability(steps, World.start(maple)).executable
    assert steps[0].action == "Walk" and Program(steps=steps).objects()


def test_a_closed_list_is_refused(dataset, eight):
    model = untrained(dataset, eight, steps="closed", copy=False)
    with pytest.raises(HearthError, match="mle-composed"):
        model.scorer()
    assert replace(eight[0], title="").request.title == ""
