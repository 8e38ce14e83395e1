"""Faults of the human-like agent: none changes nothing, and each does what it says."""

from __future__ import annotations

import math
from statistics import mean

import pytest
from small_tasks import play, start, wanted

from hearth.agents.belief import usual_containers
from hearth.agents.human_faults import Faults, Faulty
from hearth.agents.human_like import HumanLike
from hearth.agents.human_population import TURNS, ChangesGoal
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.world.states import OPEN


@pytest.fixture(scope="module")
def kitchen(maple):
    return start(maple, {"plate": 3, "fork": 3, "apple": 2}, seed=8)


@pytest.fixture(scope="module")
def goal(kitchen):
    return wanted(kitchen, "ON", "dining_table", plate=2, fork=2)


def puts(played, name: str = "PutBack"):
    return [t.instructions[0].objects for t in played.ticks if 0 in t.instructions and t.instructions[0].action == name]


@pytest.mark.parametrize("seed", range(3))
def test_none_changes_nothing(kitchen, goal, seed):
    plain = play(kitchen, goal, [HumanLike(), None], seed)
    assert play(kitchen, goal, [Faulty(Faults()), None], seed).choices == plain.choices


@pytest.mark.parametrize(
    "faults",
    [
        Faults(rationality=0.0), Faults(forgetting=0.1), Faults(leaving_open=1.0), Faults(mistake=0.4),
        Faults(change_of_mind=0.2), Faults(detour=0.1), Faults(distractor=0.1),
    ],
    ids=str,
)  # fmt: skip
def test_each_changes_something_and_the_goal_is_reached(kitchen, goal, faults):
    runs = [play(kitchen, goal, [Faulty(faults), None], seed, limit=600) for seed in range(3)]
    plain = [play(kitchen, goal, [HumanLike(), None], seed) for seed in range(3)]
    assert all(run.progress.satisfied for run in runs)
    assert [run.choices for run in runs] != [run.choices for run in plain]
    again = play(kitchen, goal, [Faulty(faults), None], 0, limit=600)
    assert again.choices == runs[0].choices


def test_the_less_rational_is_slower(kitchen, goal):
    def ticks(rationality: float) -> float:
        agents = (Faulty(Faults(rationality=rationality)) for _ in range(8))
        return mean(len(play(kitchen, goal, [agent, None], seed).ticks) for seed, agent in enumerate(agents))

    assert ticks(math.inf) < ticks(0.0)


def test_a_mistake_puts_a_thing_elsewhere(kitchen, goal):
    played = play(kitchen, goal, [Faulty(Faults(mistake=0.5)), None], 1, limit=600)
    assert len({target.node for _, target in puts(played)}) > 1


def test_a_distractor_is_not_wanted(kitchen, goal):
    played = play(kitchen, goal, [Faulty(Faults(distractor=0.05)), None], 1, limit=600)
    assert {thing.name for thing, _ in puts(played)} - {"plate", "fork"}


def test_who_leaves_things_open_closes_nothing(kitchen, goal):
    tidy = play(kitchen, goal, [HumanLike(), None], 1).ticks[-1].world
    untidy = play(kitchen, goal, [Faulty(Faults(leaving_open=1.0)), None], 1).ticks[-1].world
    assert untidy.states[OPEN].bit_count() > tidy.states[OPEN].bit_count() + 2


def test_a_detour_opens_what_nothing_wanted_is_in(kitchen, goal):
    def opened(agent) -> set[int]:
        ticks = play(kitchen, goal, [agent, None], 1, limit=60).ticks
        steps = [t.instructions[0] for t in ticks if 0 in t.instructions]
        return {kitchen.home.index[step.objects[0].node] for step in steps if step.action == "Open"}

    usual = usual_containers(kitchen.home, "plate") | usual_containers(kitchen.home, "fork")
    assert not [i for i in opened(HumanLike()) if not usual >> i & 1]
    assert [i for i in opened(Faulty(Faults(detour=0.5))) if not usual >> i & 1]


@pytest.mark.parametrize("wrong", [{"mistake": 1.5}, {"forgetting": -0.1}, {"rationality": -1.0}, {"detour": math.nan}])
def test_rates_are_probabilities(wrong):
    with pytest.raises(HearthError, match="not from 0 to"):
        Faults(**wrong)


def test_who_changes_their_goal_begins_with_another_and_reaches_their_own(kitchen):
    own, other = wanted(kitchen, "ON", "dining_table", fork=2), wanted(kitchen, "ON", "dining_table", plate=3)
    unreachable, near = wanted(kitchen, "ON", "dining_table", plate=4), wanted(kitchen, "ON", "dining_table", fork=1)
    plates, ticks = kitchen.home.instances("plate"), []
    for seed in range(4):
        agent = ChangesGoal(lambda home: {own: 9.0, unreachable: 9.0, near: 9.0, other: 1.0})
        played = play(kitchen, own, [agent, None], seed)
        steps = [(tick, each.instructions[0]) for tick, each in enumerate(played.ticks) if 0 in each.instructions]
        grabs = [(tick, kitchen.home.index[step.objects[0].node]) for tick, step in steps if step.action == "Grab"]
        of_other = [bool(plates >> thing & 1) for _, thing in grabs]
        assert played.progress.satisfied and of_other == sorted(of_other, reverse=True)
        ticks += [tick for tick, thing in grabs if plates >> thing & 1]
    assert ticks and max(ticks) <= TURNS[1]


def test_who_has_no_other_goal_does_not_change_it(kitchen, goal):
    plain = play(kitchen, goal, [HumanLike(), None], 1)
    assert play(kitchen, goal, [ChangesGoal(lambda home: {goal: 1.0}), None], 1).choices == plain.choices
