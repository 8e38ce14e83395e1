"""Retrieval: what is drawn for a text depends on the text and the seed alone."""

from __future__ import annotations

from dataclasses import replace

from hearth.models.interface import Request, Training
from hearth.models.prediction_files import predict
from hearth.models.text.retrieval import RandomRetrieval


def test_the_program_of_a_text_is_the_same_alone_and_among_others(parted, tiny):
    """Executions of one text are asked about once, whichever of them come along."""
    trained = RandomRetrieval().fit(tiny, Training(seed=3))
    names = [name for (name,) in parted.rows("SELECT execution_id FROM executions ORDER BY 1")[1]]
    every = dict(predict(trained, parted, names, text=True))
    assert len({*every.values()}) > 1
    for name in names[::7]:
        assert dict(predict(trained, parted, [name], text=True)) == {name: every[name]}


def test_texts_and_seeds_have_draws_of_their_own(tiny):
    asked = [Request("one", "Sleep", f"Lie down in bed {number}") for number in range(40)]
    found = [RandomRetrieval().fit(tiny, Training(seed=seed)).predict(asked) for seed in (0, 1, 0)]
    assert found[0] == found[2] != found[1]
    assert {*found[0]} == {each.steps for each in tiny.train}
    named = [replace(each, id=f"{number}") for number, each in enumerate(asked)]
    assert RandomRetrieval().fit(tiny, Training()).predict(named[::-1]) == found[0][::-1]
