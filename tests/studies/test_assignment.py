"""Assignments are balanced, whatever the design: every task under every condition equally often, everybody alike."""

from collections import Counter
from itertools import pairwise
from types import SimpleNamespace

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hearth.studies.assignment import Planned, assignment, imbalances, latin_square
from hearth.studies.study_file import SHIPPED, groups_of, named


def design(items, conditions, repeats, people, seed=0):
    names = [SimpleNamespace(name=f"c{number}") for number in range(conditions)]
    trials = items * conditions * repeats
    least = trials // people // conditions
    return SimpleNamespace(
        name="any", seed=seed, items=items, conditions=names, repeats=repeats, people=people, trials=trials, least=least
    )


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_every_design_that_gives_nobody_a_task_twice_is_balanced(data):
    items, conditions, repeats = (data.draw(st.integers(1, most)) for most in (40, 5, 3))
    study = design(items, conditions, repeats, 1, data.draw(st.integers(0, 99)))
    study.people = data.draw(st.integers(1, study.trials))
    study.least = study.trials // study.people // conditions
    assume(-(-study.trials // study.people) < items)
    assert imbalances(study, assignment(study, data.draw(st.integers(1, 6)))) == []


@pytest.mark.parametrize("name", SHIPPED)
def test_the_studies_that_ship_are_balanced_and_of_the_published_sizes(name):
    study = named(name)
    slots = assignment(study, groups_of(study))
    assert imbalances(study, slots) == []
    published = {
        "people-alone": (6, 60, {10}),
        "people-with-helpers": (12, 90, {7, 8}),
        "likeness-of-films": (8, 120, {15}),
        "online": (10, 40, {4}),
        "programs-by-lcs": (5, 200, {40}),
    }[name]
    assert (len(slots), sum(map(len, slots)), set(map(len, slots))) == published


def test_helpers_come_at_least_twice_to_everybody_and_all_tasks_once_to_every_helper():
    study = named("people-with-helpers")
    slots = assignment(study, groups_of(study))
    assert all(min(Counter(each.condition for each in slot).values()) >= 2 for slot in slots)
    assert len({(each.item, each.condition) for slot in slots for each in slot}) == 90


def test_what_is_not_balanced_is_found():
    study = design(4, 2, 1, 4)
    slots = assignment(study)
    assert imbalances(study, slots) == []
    wrong = ((Planned(0, "c0", 0), Planned(0, "c0", 0)), *slots[1:])
    found = " ".join(imbalances(study, wrong))
    assert "not every task is done 1 times under every condition" in found
    assert "place 1 has 0 trials under `c1`" in found
    assert "place 1 has task 1 twice" in found


def test_an_assignment_is_of_its_seed():
    one, same, other = (assignment(design(10, 3, 1, 6, seed)) for seed in (1, 1, 2))
    assert one == same != other


@pytest.mark.parametrize("size", range(1, 9))
def test_a_latin_square_has_each_number_once_in_each_row_and_column(size):
    square = latin_square(size)
    every = set(range(size))
    assert all(set(row) == every for row in square)
    assert all({row[place] for row in square} == every for place in range(size))
    if size % 2 == 0:
        following = Counter(pair for row in square for pair in pairwise(row))
        assert set(following.values()) <= {1}
