"""Helpers that do not know the goal: what they fetch, hand over and bring back, and that none is in the way."""

import pytest
from online_tasks import COUNTS, goals_of, holding, play
from small_tasks import start, target, wanted

from hearth.agents.belief import Place
from hearth.agents.empowerment_helper import Empowerment
from hearth.agents.expected_time_helper import ExpectedTime
from hearth.agents.goal_space import Edge
from hearth.agents.human_like import HumanLike
from hearth.agents.nopa import Nopa
from hearth.agents.online_helper_registry import ONLINE
from hearth.schemas.literals import HOLDS
from hearth.simulation.actions.legal import legal
from hearth.simulation.env import Env
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit

PLAIN = sorted(name for name, kind in ONLINE.items() if not kind.network and not name.startswith("nopa_k"))
"""Helpers that need no network, which knows one grammar only."""


@pytest.fixture
def world(maple):
    return start(maple, COUNTS, seed=3)


@pytest.mark.parametrize("make", [ExpectedTime, Nopa])
def test_who_knows_the_goal_for_certain_moves_nothing_else_and_is_faster(world, make):
    goal = list(goals_of(world))[3]
    alone = play(world, goal, [HumanLike(), None])
    both = play(world, goal, [HumanLike(), make(lambda home: {goal: 1.0})])
    assert both.success and both.ticks < alone.ticks
    names = {literal.subject for literal, _ in goal}
    taken = [
        tick.instructions[1].objects[0].name
        for tick in both.env.ticks
        if 1 in tick.instructions and tick.instructions[1].action == "Grab"
    ]
    assert taken and set(taken) <= names


def test_a_goal_that_is_given_is_the_only_one(world):
    goals = goals_of(world)
    goal = list(goals)[3]
    env = Env(partial=False)
    env.restore(world)
    helper = ExpectedTime(lambda home: goals)
    helper.reset(env.observe(1), goal, 0)
    assert helper.space.goals == (goal,)


@pytest.mark.parametrize("name", PLAIN)
def test_no_helper_keeps_the_goal_from_being_reached(world, name):
    goals = goals_of(world)
    for number, goal in enumerate(goals):
        played = play(world, goal, [HumanLike(), ONLINE[name].make(lambda home: goals)], number)
        assert played.success, goal


@pytest.mark.parametrize("name", PLAIN)
def test_the_seed_decides_everything(world, name):
    goals = goals_of(world)
    goal = next(iter(goals))

    def choices():
        helper = ONLINE[name].make(lambda home: goals)
        return [tick.instructions for tick in play(world, goal, [HumanLike(), helper], 5, limit=15).env.ticks]

    assert choices() == choices()


def decided(helper, env):
    helper.reset(env.observe(1), None, 0)
    helper.act(env.observe(1), legal(env.world, 1, env.rules))
    return helper.subgoal


def test_what_is_wanted_nobody_knows_where_is_handed_over(maple):
    """Figure 7-5a: both goals want the only apple, in places that are equally probable; watching teaches nothing, since
    the one who is helped can do nothing without it.
    """
    world = start(maple, {"plate": 3, "apple": 1})
    env, apple = holding(world, "apple")
    goals = {
        wanted(world, "INSIDE", "fridge", apple=1): 0.5,
        wanted(world, "ON", "coffee_table", apple=1): 0.5,
    }
    assert decided(ExpectedTime(lambda home: goals), env) == Edge(HOLDS, apple, env.world.agents[0].index)


def test_what_is_not_wanted_is_brought_back(maple):
    """Figure 7-5b: what it has taken is of no use for any goal."""
    env, apple = holding(start(maple, {"apple": 2}), "apple")
    goals = {wanted(env.world, "ON", "desk", plate=2): 1.0, wanted(env.world, "ON", "desk", apple=1): 0.0}
    helper = ExpectedTime(lambda home: goals)
    helper.reset(env.observe(1), None, 0)
    desk = env.world.home.index[target(env.world, "desk")]
    helper.first_places[apple] = Place("ON", desk)
    helper.act(env.observe(1), legal(env.world, 1, env.rules))
    assert helper.subgoal == Edge("ON", apple, desk)


@pytest.mark.parametrize("name", ["expected_time", "asking", "nopa", "nopa_no_return", "likeliest"])
def test_what_the_helper_holds_alone_is_brought_in_the_end(maple, name):
    """Nobody can reach the goal without what the helper has taken."""
    env, _ = holding(start(maple, {"plate": 3, "apple": 1}), "apple")
    goals = {
        wanted(env.world, "ON", "desk", plate=2): 0.85,
        wanted(env.world, "INSIDE", "fridge", apple=1): 0.1,
        wanted(env.world, "ON", "coffee_table", apple=1): 0.05,
    }
    done = play(env.world, list(goals)[1], [HumanLike(), ONLINE[name].make(lambda home: goals)], 0)
    assert done.success


@pytest.mark.parametrize("name", ["expected_time", "nopa", "nopa_no_return"])
def test_who_has_both_hands_full_before_a_closed_door_puts_something_down_once(maple, name):
    """Nobody else opens the fridge: it does not walk to and fro between a place to put things and the fridge."""
    world = start(maple, {"apple": 2, "plate": 1})
    apples = [world.home.ids[i] for i in indices(world.home.instances("apple"))]
    desk = target(world, "desk")
    world = edit(
        world, place=dict.fromkeys(apples, ("ON", desk)), set=[(target(world, "fridge"), "CLOSED")], check=False
    )
    goal = wanted(world, "INSIDE", "fridge", apple=2)
    done = play(world, goal, [None, ONLINE[name].make(lambda home: {goal: 1.0})], limit=60)
    steps = [tick.instructions[1].action for tick in done.env.ticks if 1 in tick.instructions]
    assert steps.count("PutIn") == 2 and steps.count("Open") == 1 and len(steps) < 40


def test_empowerment_wants_what_most_goals_want(world):
    same = wanted(world, "ON", "desk", fork=1)
    goals = {same & wanted(world, "ON", "desk", plate=1): 0.5, same & wanted(world, "INSIDE", "fridge", apple=1): 0.5}
    helper = Empowerment(lambda home: goals, particles=40, horizon=500.0)
    env = Env(partial=False)
    env.restore(world)
    found = decided(helper, env)
    assert found is not None and world.home.classes[found.thing] == "fork"
