"""Helpers: they help, leave their partner its subgoal, take it in the endgame, and see no more than they may."""

from __future__ import annotations

from dataclasses import replace
from statistics import mean

import pytest
from small_tasks import play, scrambled, standing, start, wanted

from hearth.agents.agent_registry import HELPERS, MAIN
from hearth.agents.hierarchical_helper import HELPING, Hierarchical
from hearth.agents.human_like import HumanLike
from hearth.agents.random_helper import RandomHelper
from hearth.agents.subgoals import Subgoal
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World


@pytest.fixture(scope="module")
def kitchen(maple):
    return start(maple, {"plate": 3, "fork": 3, "apple": 2}, seed=8)


def ticks(kitchen, goal, helper: str, seed: int, told=None) -> int:
    chosen = HELPERS[helper]
    main = MAIN[chosen.main or "human_like"](lambda home: {})
    played = play(kitchen, goal, [main, chosen.make(main)], seed, goals=[goal, told or goal])
    assert played.progress.satisfied
    return len(played.ticks)


def test_who_knows_more_helps_more(kitchen):
    goal = wanted(kitchen, "ON", "dining_table", plate=3, fork=3)
    alone = mean(len(play(kitchen, goal, [HumanLike(), None], seed).ticks) for seed in range(4))
    planned, oracle, both = (
        mean(ticks(kitchen, goal, name, seed) for seed in range(4)) for name in ("hp_true", "oracle_b", "oracle_ab")
    )
    assert alone > 1.2 * planned > 1.2 * oracle >= both


class Standing(HumanLike):
    """Wants one thing and does nothing."""

    def act(self, observation, legal):
        things = list(indices(self.aims.wanted[0].counted))
        there = self.aims.wanted[0].candidates.targets.bit_length() - 1
        self.subgoal = Subgoal(Literal.of("ON", things[0], there), 0, things[0], there)


def test_the_partners_subgoal_is_left_to_it_until_nothing_else_is_left(kitchen):
    """The partner stands still: once its subgoal is all that is left, the helper takes it."""
    goal = wanted(kitchen, "ON", "dining_table", plate=3, fork=2)
    partner = Standing()
    played = play(kitchen, goal, [partner, Hierarchical(partner)])
    assert played.progress.satisfied
    put = [t.instructions[1].objects[0].node for t in played.ticks if t.instructions[1].action == "PutBack"]
    assert put[-1] == kitchen.home.ids[partner.subgoal.thing]
    left = play(kitchen, wanted(kitchen, "ON", "dining_table", plate=3), [partner, Hierarchical()])
    put = [t.instructions[1].objects[0].node for t in left.ticks if t.instructions[1].action == "PutBack"]
    assert len(put) == 3


def test_what_the_partner_holds_is_left_to_it(kitchen):
    """It stands there with the last thing in its hand."""
    goal = wanted(kitchen, "ON", "dining_table", plate=2)
    plate = next(indices(kitchen.home.instances("plate")))
    partner = Standing()
    holding = kitchen.with_agent(0, kitchen.agents[0]._replace(right=1 << plate))
    pose = kitchen.agents[0].pose
    beside = holding.with_agent(1, kitchen.agents[1]._replace(inside=kitchen.agents[0].inside, pose=pose))
    played = play(beside, goal, [partner, Hierarchical(partner)], limit=120)
    assert played.progress.counts == (1,)


def test_a_random_helper_is_no_planner(kitchen):
    goal = wanted(kitchen, "ON", "dining_table", plate=2, fork=1)
    played = play(kitchen, goal, [HumanLike(), RandomHelper()], 2)
    actions = {tick.instructions[1].action for tick in played.ticks if 1 in tick.instructions}
    assert len(actions) > 2
    assert not [tick.failures[1] for tick in played.ticks if 1 in tick.failures and tick.failures[1].code != "CONFLICT"]


def test_a_helper_with_another_goal_pursues_it(kitchen):
    goal = wanted(kitchen, "ON", "dining_table", plate=2)
    other = wanted(kitchen, "INSIDE", "fridge", apple=2)
    partner = HumanLike()
    played = play(kitchen, other, [partner, HELPERS["hp_random"].make(partner)], goals=[goal, other])
    assert played.progress.satisfied


@pytest.mark.parametrize("name", sorted(HELPERS))
def test_every_helper_repeats_itself(kitchen, name):
    goal = wanted(kitchen, "ON", "dining_table", plate=2, fork=1)
    runs = []
    for _ in range(2):
        main = MAIN[HELPERS[name].main or "human_like"](lambda home: {})
        runs.append(play(kitchen, goal, [main, HELPERS[name].make(main)], 4, limit=60).choices)
    assert runs[0] == runs[1]


@pytest.mark.parametrize("seed", range(3))
def test_a_helper_hands_over_what_its_partner_is_to_hold(maple, seed):
    """The partner stands still, so that only the helper can put the book into a hand of it."""
    apart = standing(start(maple, {"book": 2, "plate": 1}, seed), 0, "bathroom")
    world = standing(apart, 1, "kitchen")
    goal = Goal.of(Literal.of("HOLDS", "agent:0", "book"))
    played = play(world, goal, [None, Hierarchical(habits=replace(HELPING, gives=True))])
    assert played.progress.satisfied
    assert not play(
        world, goal, [None, Hierarchical(habits=replace(HELPING, gives=False))], limit=100
    ).progress.satisfied


def test_where_an_unseen_partner_is_is_not_known(maple):
    """The partner is put into another room in what the helper is shown; that room is out of its view."""
    world = start(maple, {"book": 2, "plate": 1}, seed=4)
    goal = Goal.of(Literal.of("HOLDS", "agent:0", "book"))

    def elsewhere(shown: World, mask: int) -> World:
        if mask & shown.agents[0].bit:
            return shown
        rooms = list(indices(shown.home.rooms & ~shown.agents[1].inside))
        return shown.with_agent(0, shown.agents[0]._replace(inside=1 << rooms[-1], close=0))

    plain = play(world, goal, [None, Hierarchical()], 1)
    assert play(world, goal, [None, Hierarchical()], 1, scramble=elsewhere).choices == plain.choices


@pytest.mark.parametrize("name", ["hp_true", "hp_true_veto", "hp_timed", "hp_random"])
def test_what_a_helper_does_not_see_changes_nothing(kitchen, name):
    goal = wanted(kitchen, "ON", "dining_table", plate=2, fork=2)
    runs = []
    for change in (None, scrambled):
        partner = HumanLike()
        helper = HELPERS[name].make(partner)
        runs.append(play(kitchen, goal, [partner, helper], 3, scramble=change).choices)
    assert runs[0] == runs[1]


def test_habits_of_helpers_close_nothing():
    assert HumanLike().habits.closes
    assert not Hierarchical().habits.closes
