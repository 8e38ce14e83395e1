"""Forecasts of how two go on: alone, with help, sharing the work, and what waiting is worth."""

from __future__ import annotations

import pytest
from small_tasks import ALLOWED, start, wanted

from hearth.agents.completion_forecast import MOST, Forecast, Stop
from hearth.agents.expected_time_helper import ExpectedTime
from hearth.agents.goal_space import GoalSpace, Scene
from hearth.agents.human_like import HumanLike
from hearth.agents.interchangeable_objects import HELPER, Situation
from hearth.agents.walk_distances import Distances
from hearth.challenges.episode_loop import Player, play
from hearth.simulation.observation.views import pose


@pytest.fixture(scope="module")
def world(maple):
    return start(maple, {"plate": 3, "fork": 3, "apple": 3}, seed=3)


@pytest.fixture(scope="module")
def goal(world):
    return wanted(world, "ON", "coffee_table", plate=2, fork=2)


def hands(world):
    return tuple(agent.index for agent in world.agents)


def forecast(world, goal, pursued=-1):
    space = GoalSpace.of({goal: 1.0}, world.home)
    ways = Distances(world.home, 1.0), Distances(world.home, 3.0)
    here = Situation(space, space.scene(world), hands(world), (pose(world, 0), pose(world, 1)), ways)
    return Forecast(here, dict(enumerate(space.counts[0].tolist())), pursued), here


def test_heaps_hold_everything_that_may_be_wanted_once(world, goal):
    _, here = forecast(world, goal)
    things = sorted(number for heap in here.heaps for number in heap.things)
    assert things == list(range(6)) and all(heap.holder < 0 and heap.rows for heap in here.heaps)


def test_the_forecast_of_one_is_near_what_somebody_takes_alone(world, goal):
    found, _ = forecast(world, goal)
    done = play(world, goal, [Player(HumanLike(), goal)], 0, actions=ALLOWED, partial=False)
    alone = found.finish((), MOST)
    assert done.success and 0.7 < alone / done.ticks < 1.6
    assert found.finish() < 0.8 * alone


def test_the_forecast_of_both_is_near_what_they_take(world, goal):
    found, _ = forecast(world, goal)
    players = [Player(HumanLike(), goal), Player(ExpectedTime(lambda home: {goal: 1.0}), None)]
    done = play(world, goal, players, 0, actions=ALLOWED, partial=False)
    assert done.success and 0.6 < found.finish() / done.ticks < 1.5


def test_fetching_what_is_not_wanted_costs_time(world, goal):
    found, here = forecast(world, goal)
    best = min(found.finish((Stop(number),)) for number in range(len(here.heaps)))
    far = max(range(len(here.heaps)), key=lambda n: here.leg(HELPER, here.starts[HELPER], here.heaps[n].node)[0])
    assert best <= found.finish((Stop(far), Stop(far))) and best < found.finish((), 8.0)


def test_watching_somebody_who_can_do_nothing_is_in_vain(world, goal):
    space = GoalSpace.of({goal: 1.0}, world.home)
    places = [("HOLDS", world.agents[1].index) for _ in space.things]
    ways = Distances(world.home, 1.0), Distances(world.home, 3.0)
    here = Situation(space, Scene(places, 0), hands(world), (pose(world, 0), pose(world, 1)), ways)
    found = Forecast(here, {0: 1})
    assert found.finish((), 2.0) == MOST > found.finish()
