"""Retrieve and edit: objects of the new text in the programs of similar ones."""

from __future__ import annotations

from random import Random

import pytest

from hearth.models.interface import Request, Training
from hearth.schemas.syntax import parse_steps
from hearth.scoring.metrics.lcs import score_pairs


def lines(steps):
    return [(step.action, *(ref.name for ref in step.objects)) for step in steps]


def test_objects_of_the_new_text_take_the_place_of_those_of_the_old(tiny):
    from hearth.models.text.retrieve_edit import RetrieveEdit

    model = RetrieveEdit(neighbours=1).fit(tiny, Training())
    (found,) = model.predict([Request("x", "Drink juice", "Take the juice out of the fridge and drink it.")])
    assert lines(found) == [("Walk", "kitchen"), ("Open", "fridge"), ("Grab", "juice"), ("Drink", "juice")]
    (same,) = model.predict([Request("x", "Drink milk", "Take the milk out of the fridge and drink it.")])
    assert lines(same)[2] == ("Grab", "milk")
    (odd,) = model.predict([Request("x", "Drink", "Take the piano out of the fridge and drink it.")])
    assert lines(odd)[2] == ("Grab", "milk"), "one can't drink a piano"


def test_the_consensus_is_what_most_do():
    from hearth.models.text.retrieve_edit import consensus

    one, two, odd = (
        tuple(step for line in text for step in parse_steps(line))
        for text in (("[Walk] <sofa> (1)", "[Sit] <sofa> (1)"), ("[Walk] <sofa> (1)",), ("[Open] <fridge> (1)",))
    )
    assert consensus([odd, one, two], [1, 1, 1]) in (one, two)
    assert consensus([odd, one, two], [9, 1, 1]) == odd
    assert consensus([], []) == ()


@pytest.mark.parametrize("seed", range(20))
def test_the_consensus_is_that_of_each_pair_apart(seed):
    from hearth.models.text.retrieve_edit import consensus

    random = Random(seed)
    lines = ["[Walk] <sofa> (1)", "[Sit] <sofa> (1)", "[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[StandUp]"]
    known = [parse_steps(line)[0] for line in lines]
    programs = [tuple(random.choices(known, k=random.randint(0, 6))) for _ in range(12)]
    programs += random.choices(programs, k=6)
    weights = [random.random() for _ in programs]

    def total(one):
        scores = score_pairs([(one, other) for other in programs])
        return sum(score.mean * weight for score, weight in zip(scores, weights, strict=True))

    assert total(consensus(programs, weights)) == pytest.approx(max(map(total, programs)), abs=1e-4)


def test_the_consensus_does_not_depend_on_the_unit_of_weights():
    from hearth.models.text.retrieve_edit import consensus

    one, two = parse_steps("[Walk] <sofa> (1)"), parse_steps("[Open] <fridge> (1)")
    programs = [tuple(one), tuple(two), (*one, *two), tuple(two)]
    weights = [0.2, 0.5, 0.1, 0.7]
    assert consensus(programs, weights) == consensus(programs, [weight * 1e-9 for weight in weights]) == tuple(two)
