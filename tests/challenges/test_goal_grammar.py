"""The goals of challenges: how many there are, how probable, and as text."""

from __future__ import annotations

from collections import Counter
from random import Random

import pytest

from hearth.challenges.challenge_definition import NAMES, challenge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

WAH = challenge("wah").grammar
OWAH = challenge("owah").grammar


def test_table_b1_has_1123_goals_of_30_predicates():
    assert [len(one.goals) for one in WAH.sets.values()] == [71, 339, 602, 71, 40]
    assert (len(WAH.goals), len(WAH.predicates)) == (1123, 30)
    assert {WAH.size(goal) for goal in WAH.goals} == {2, 3, 4, 5, 6}


def test_table_c2_has_661_goals_and_119_predicates_with_counts():
    assert [len(one.goals) for one in OWAH.sets.values()] == [12, 315, 315, 18, 1]
    assert len(OWAH.goals) == 661
    assert len({pair for goal in OWAH.goals for pair in goal}) == 119


@pytest.mark.parametrize("name", NAMES)
def test_probabilities_sum_to_one_and_sets_are_equally_probable(name):
    grammar = challenge(name).grammar
    assert sum(grammar.goals.values()) == pytest.approx(1)
    assert all(sum(one.goals.values()) == pytest.approx(1) for one in grammar.sets.values())
    assert grammar.prior(next(iter(grammar.goals))) > 0


@pytest.mark.parametrize("name", NAMES)
def test_a_goal_is_read_as_it_was_written(name):
    grammar = challenge(name).grammar
    for goal in grammar.goals:
        assert grammar.read(grammar.written(goal)) == grammar.read(str(goal)) == goal


def test_goals_of_two_sets_are_read_as_they_were_written():
    for seed in range(200):
        goal, sets = WAH.sample(Random(seed), 2)
        assert len(set(sets)) == 2
        assert 2 <= WAH.size(goal) <= 8
        assert WAH.read(WAH.written(goal)) == goal


def test_the_spellings_of_the_thesis_are_read():
    goal = WAH.read("HOLD(Alice, book), SIT(Alice, sofa); ON(cupcake,coffeetable):2")
    assert goal in WAH.goals
    assert WAH.read("IN(plate,dishwasher):2; in(fork, dishwasher)") in WAH.goals


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ("", Code.SYNTAX),
        ("ON(plate, dinnertable", Code.SYNTAX),
        ("ON(plate, dinnertable) or ON(fork, dinnertable)", Code.SYNTAX),
        ("ON(plate, dinnertable): 0", Code.SYNTAX),
        ("ON(plate, dinnertable): 99", Code.SYNTAX),
        ("ON(plate, fridge)", Code.UNKNOWN_OBJECT),
        ("ON(plate, dinnertable) and ON(plate, dinnertable)", Code.UNKNOWN_OBJECT),
        ({"ON(plate, dinnertable)": "2"}, Code.SYNTAX),
        ({"ON(plate, dinnertable)": True}, Code.SYNTAX),
        ({7: 1}, Code.UNKNOWN_OBJECT),
        ({}, Code.SYNTAX),
    ],
)
def test_what_is_not_a_goal_of_the_challenge_is_refused(given, code):
    with pytest.raises(HearthError) as raised:
        WAH.read(given)
    assert raised.value.diagnostics[0].code is code


def test_draws_have_the_probabilities_of_the_prior():
    drawn = Counter(WAH.sample(Random(seed))[1][0] for seed in range(2000))
    assert all(320 < number < 480 for number in drawn.values())
    pool = OWAH.sets["stock_fridge"].goals
    classes = Counter()
    for goal, probability in pool.items():
        classes[len(goal.counts)] += probability
    # Of 3 things at most 3 classes, of 4 to 7 any of 4: a class alone comes a third or a quarter of the time.
    assert classes[1] == pytest.approx((1 / 3 + 4 * 1 / 4) / 5)


def test_an_unknown_challenge_is_refused():
    with pytest.raises(HearthError) as raised:
        challenge("../wah")
    assert raised.value.diagnostics[0].code is Code.BAD_ARGUMENT
