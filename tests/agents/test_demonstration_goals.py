"""Demonstrations read as goals."""

from __future__ import annotations

import pytest
from small_tasks import play, start, target, wanted

from hearth.agents.demonstration_goals import READERS, Question, agreement
from hearth.agents.human_faults import Faults, Faulty
from hearth.agents.human_like import HumanLike
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.schemas.rng import rng


@pytest.fixture(scope="module")
def kitchen(maple):
    return start(maple, {"plate": 3, "fork": 3, "apple": 2, "book": 2}, seed=8)


def asked(world, *goals: Goal) -> Question:
    table, fridge, sofa = (target(world, name) for name in ("dining_table", "fridge", "sofa"))
    predicates = [
        Literal.of(*each)
        for name in ("plate", "fork", "apple")
        for each in [("ON", name, table), ("INSIDE", name, fridge)]
    ]
    own = (Literal.of("HOLDS", "agent:0", "book"), Literal.of("ON", "agent:0", sofa))
    return Question((*predicates, *own), goals)


def read(how: str, played, question: Question) -> Goal:
    return READERS[how](played.ticks, question, rng(0))


@pytest.mark.parametrize("how", ["actions", "last-frame"])
@pytest.mark.parametrize(("relation", "furniture"), [("ON", "dining_table"), ("INSIDE", "fridge")])
def test_a_clean_demonstration_gives_the_goal_away(kitchen, how, relation, furniture):
    goal = wanted(kitchen, relation, furniture, plate=2, apple=1)
    found = read(how, play(kitchen, goal, [HumanLike(), None]), asked(kitchen))
    assert dict(found) == dict(goal)


@pytest.mark.parametrize("how", ["actions", "last-frame"])
def test_what_is_held_and_sat_on_is_read(kitchen, how):
    goal = Goal.of(Literal.of("HOLDS", "agent:0", "book"), Literal.of("ON", "agent:0", target(kitchen, "sofa")))
    assert dict(read(how, play(kitchen, goal, [HumanLike(), None]), asked(kitchen))) == dict(goal)


def test_what_was_taken_away_again_counts_by_actions_only(kitchen):
    """The goal of the second half wants the plate elsewhere."""
    first = play(kitchen, (goal := wanted(kitchen, "ON", "dining_table", plate=1, fork=1)), [HumanLike(), None])
    plates = [r.node for r in (t.instructions[0].objects[0] for t in first.ticks if "Put" in t.instructions[0].action)]
    (plate,) = [n for n in plates if kitchen.home.classes[kitchen.home.index[n]] == "plate"]
    away = Goal.of(Literal.of("ON", plate, target(kitchen, "kitchen_counter")))
    second = play(first.ticks[-1].world, away, [HumanLike(), None])
    ticks = (*first.ticks, *second.ticks)
    question = asked(kitchen)
    assert dict(READERS["actions"](ticks, question, rng(0))) == dict(goal)
    last = READERS["last-frame"](ticks, question, rng(0))
    assert dict(last) == dict(wanted(kitchen, "ON", "dining_table", fork=1))


def test_chance_draws_one_of_the_goals(kitchen):
    goals = [wanted(kitchen, "ON", "dining_table", plate=n) for n in (1, 2, 3)]
    drawn = {str(READERS["chance"]((), asked(kitchen, *goals), rng(n))) for n in range(40)}
    assert drawn == set(map(str, goals))


def test_distractors_are_read_as_wanted(kitchen):
    goal = wanted(kitchen, "ON", "dining_table", plate=1)
    faulty = Faulty(Faults(mistake=0.5))
    played = play(kitchen, goal, [faulty, None], 3, limit=400)
    assert played.progress.satisfied
    assert read("actions", played, asked(kitchen))


def test_agreement_counts_predicates_as_often_as_they_are_wanted(kitchen):
    true, found = wanted(kitchen, "ON", "dining_table", plate=2, fork=1), wanted(kitchen, "ON", "dining_table", plate=3)
    compared = agreement(found, true)
    assert (compared.precision, compared.recall) == (2 / 3, 2 / 3)
    assert agreement(Goal(), true).recall == 0
    assert agreement(true, true).precision == agreement(true, true).recall == 1
