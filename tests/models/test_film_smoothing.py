"""Clips read by the whole film: sums over sequences, and what rare classes are worth."""

from __future__ import annotations

from itertools import pairwise, product
from types import SimpleNamespace

import numpy as np
import pytest

from hearth.models.films.clip_data import Instruction
from hearth.models.films.film_programs import even_moves
from hearth.models.films.film_smoothing import ClassWorth, named_in_films, posteriors
from hearth.models.films.possible_instructions import Reading
from hearth.models.films.step_order import StepOrder

WALK, GRAB, SIT = Instruction("Walk", ("bed",)), Instruction("Grab", ("cup",)), Instruction("Sit", ("bed",))


def enumerated(scores, moves):
    """The same by all sequences, one after another."""
    found = np.zeros(scores.shape)
    for path in product(range(scores.shape[1]), repeat=len(scores)):
        log = -moves[-1, path[0]] + sum(scores[place, number] for place, number in enumerate(path))
        log -= sum(moves[one, other] for one, other in pairwise(path) if one != other)
        found[range(len(path)), path] += np.exp(log)
    return found / found.sum(1, keepdims=True)


@pytest.mark.parametrize(("clips", "instructions", "seed"), [(1, 3, 0), (2, 1, 1), (4, 3, 2), (5, 2, 3), (3, 5, 4)])
def test_posteriors_are_those_of_all_sequences(clips, instructions, seed):
    draw = np.random.default_rng(seed)
    scores = draw.normal(0, 3, (clips, instructions)).astype(np.float32)
    moves = draw.exponential(3, (instructions + 1, instructions)).astype(np.float32)
    assert np.allclose(posteriors(scores, moves), enumerated(scores, moves), atol=1e-5)


def test_posteriors_of_improbable_clips_are_numbers():
    found = posteriors(np.full((300, 3), -4e3, np.float32), even_moves(3))
    assert np.allclose(found, 1 / 3)


def test_what_is_rare_is_worth_more():
    learned = [WALK] * 9 + [GRAB] + [SIT] * 9
    probable = np.array([[0.4, 0.2, 0.4], [0.9, 0.02, 0.08]])
    order = (WALK, GRAB, SIT)
    assert ClassWorth.of(learned, 0.0).gains(probable, order).argmax(1).tolist() in ([0, 0], [2, 0])
    assert ClassWorth.of(learned, 1.0).gains(probable, order).argmax(1).tolist() == [1, 0]


def test_gains_by_hand():
    gains = ClassWorth.of([WALK, WALK, SIT, GRAB], 1.0).gains(np.array([[0.5, 0.3, 0.2]]), (WALK, SIT, GRAB))
    share = {1: 2 / 4, 2: 3 / 4, 3: 4 / 4}  # of counts and one more, over four clips
    actions = [0.5 / share[2] / 3, 0.3 / share[1] / 3, 0.2 / share[1] / 3]
    objects = [0.8 / share[3] / 2, 0.8 / share[3] / 2, 0.2 / share[1] / 2]
    assert np.allclose(gains, [[2 * one + other for one, other in zip(actions, objects, strict=True)]])


def test_a_clip_is_named_by_its_neighbours():
    """One of nine clips looks a little more like sitting; alone it is taken for that."""
    scores = np.log(np.full((9, 2), (0.8, 0.2), np.float32))
    scores[4] = np.log((0.4, 0.6))
    films = [Reading((WALK, SIT), scores), Reading((WALK, SIT), scores[4:5])]
    order = StepOrder.of([[WALK, SIT]] * 3 + [[SIT, WALK]] * 3)
    trained = SimpleNamespace(settings=SimpleNamespace(balance=0.5), order=order, readings=lambda _: iter(films))
    assert named_in_films(trained, None, [WALK, SIT]) == [WALK] * 9 + [SIT]
