"""Helping without seeing everything: going to watch, what was brought unseen, reading nothing that is out of view."""

from __future__ import annotations

import pytest
from small_tasks import play, scrambled, standing, start, target, wanted

from hearth.agents.human_like import HumanLike
from hearth.agents.partial_view_helper import NEAR, Watchful, Watching
from hearth.simulation.env import Env
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.edit import edit


@pytest.fixture(scope="module")
def world(maple):
    made = start(maple, {"plate": 3, "fork": 3, "apple": 2}, seed=4)
    return standing(standing(made, 0, "kitchen"), 1, "bedroom")


def goals_of(world):
    return {
        wanted(world, "ON", "desk", plate=2): 0.4,
        wanted(world, "ON", "coffee_table", plate=1, fork=1): 0.4,
        wanted(world, "INSIDE", "fridge", apple=2): 0.2,
    }


def followed(world, helper, ticks=30, goal=None):
    """The helper's subgoals beside who reaches for a goal, and whether it saw that one, in each tick."""
    found = []

    def note(env):
        found.append((helper.subgoal, bool(env.observe(1).others)))

    goal = goal or next(iter(goals_of(world)))
    play(world, goal, [HumanLike(), helper], goals=[goal, None], limit=ticks, after=note)
    return found


def test_who_knows_nothing_goes_to_watch(world):
    found = followed(world, Watchful(lambda home: goals_of(world)))
    assert found[0][0].relation == NEAR and not found[0][1]
    assert any(seen for _, seen in found[:12])


def test_who_knows_the_goal_does_not(world):
    goal = next(iter(goals_of(world)))
    found = followed(world, Watchful(lambda home: {goal: 1.0}), goal=goal)
    assert all(subgoal is None or subgoal.relation != NEAR for subgoal, _ in found)


def test_who_does_not_seek_waits(world):
    found = followed(world, Watchful(lambda home: goals_of(world), Watching(seeks=False)), ticks=5)
    assert all(subgoal is None for subgoal, seen in found if not seen)


def test_what_was_brought_unseen_is_evidence(world):
    """It has seen a plate on the table before it finds it on the desk, where one goal of three wants plates."""
    home = world.home
    plate = next(home.ids[i] for i in indices(home.instances("plate")))
    desk, table = target(world, "desk"), target(world, "coffee_table")
    helper = Watchful(lambda home: goals_of(world))

    def shown(place, partner):
        """Return the helper's view of one room, with the plate somewhere and its partner in a room."""
        env = Env(partial=True)
        room = home.classes[lowest(home.inside[home.index[place]] & home.rooms)]
        moved = edit(world, place={plate: ("ON", place)}, check=False)
        env.restore(standing(standing(moved, 0, partner or room), 1, room))
        return env

    env = shown(table, None)
    helper.reset(env.observe(1), None, 0)
    helper.act(env.observe(1), env.legal(1))
    before = helper.posterior.probability(0)
    env = shown(desk, "bathroom")
    assert not env.observe(1).others
    helper.act(env.observe(1), env.legal(1))
    assert helper.posterior.probability(0) > 0.9 > before


def test_nothing_out_of_view_is_read(world):
    goal = next(iter(goals_of(world)))

    def choices(scramble):
        helper = Watchful(lambda home: goals_of(world))
        return play(world, goal, [HumanLike(), helper], goals=[goal, None], limit=25, scramble=scramble).choices

    assert choices(None) == choices(scrambled)


@pytest.mark.parametrize("number", range(3))
def test_the_goal_is_reached(world, number):
    goal = list(goals_of(world))[number]
    helper = Watchful(lambda home: goals_of(world))
    assert play(world, goal, [HumanLike(), helper], number, goals=[goal, None]).progress.satisfied
