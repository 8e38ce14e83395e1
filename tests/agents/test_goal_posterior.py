"""The posterior over an agent's goals, given its observed actions, and the things that goals want."""

from dataclasses import replace

import numpy as np
import pytest
from online_tasks import COUNTS, goals_of, holding, play
from oracles.posterior import Plain
from small_tasks import start, target, wanted

from hearth.agents.goal_posterior import ActionModel, Posterior
from hearth.agents.goal_space import GoalSpace
from hearth.agents.human_like import HumanLike
from hearth.schemas.program import Step
from hearth.simulation.observation.views import LastAction, pose


@pytest.fixture
def world(maple):
    return start(maple, COUNTS, seed=3)


def test_a_goal_that_wants_more_than_there_is_is_nobody_s(world):
    goals = {wanted(world, "ON", "desk", plate=4): 0.9, wanted(world, "ON", "desk", plate=3): 0.1}
    space = GoalSpace.of(goals, world.home)
    posterior = Posterior(space, world.home, 1.0)
    posterior.observe(space.scene(world), pose(world, 0))
    assert posterior.probability(0) == 0.0 and posterior.probability(1) == 1.0


def watched(world, goal, seed=0):
    """Each world of an episode of one agent, with what it has just tried."""
    played = play(world, goal, [HumanLike(), None], seed)
    assert played.success
    last = None
    for tick in played.env.ticks:
        yield tick.before, pose(tick.before, 0, last)
        step = tick.instructions.get(0)
        last = LastAction(step, tick.failures.get(0)) if step else None


@pytest.mark.parametrize("number", range(4))
def test_the_posterior_is_that_of_a_plain_count_over_all_goals(world, number):
    goals = goals_of(world)
    space, model = GoalSpace.of(goals, world.home), ActionModel(0.25, 0.03)
    fast, plain = Posterior(space, world.home, 1.0, model), Plain(goals, world.home, model)
    plain.all = space.things
    probable = []
    for now, other in watched(world, list(goals)[number]):
        scene = space.scene(now)
        fast.observe(scene, other)
        plain.observe(now, other, fast.costs(scene.closed, other), fast.round_trips(scene.closed), space)
        assert np.allclose(fast.weights, list(plain.weights.values()), atol=1e-9)
        probable.append(fast.probability(number))
    assert fast.weights.sum() == pytest.approx(1)
    assert probable[-1] > 0.9 > 0.5 > probable[0]


def test_goals_count_what_lies_where_they_want_it(world):
    goals = goals_of(world)
    space = GoalSpace.of(goals, world.home)
    assert space.counts.sum(axis=1).tolist() == [2, 2, 2, 3]
    assert len(space.things) == sum(COUNTS.values())
    places = space.places(world)
    plate = next(n for n, thing in enumerate(space.things) if world.home.classes[thing] == "plate")
    places[plate] = ("ON", world.home.index[target(world, "desk")])
    assert (space.counts.sum() - space.missing(space.counted(places)).sum()) == 1
    places[plate] = ("INSIDE", world.home.index[target(world, "desk")])
    assert space.missing(space.counted(places)).sum() == space.counts.sum()


def test_who_waits_wants_what_the_helper_has(maple):
    """Two goals want plates, one the only apple, too, which the helper holds: who does nothing waits for it."""
    env, _ = holding(start(maple, {"plate": 2, "apple": 1}), "apple")
    plates = wanted(env.world, "ON", "desk", plate=2)
    goals = {plates: 0.9, wanted(env.world, "INSIDE", "fridge", apple=1): 0.1}
    space = GoalSpace.of(goals, env.world.home)
    posterior = Posterior(space, env.world.home, 1.0)
    done = LastAction(Step("StandUp", (), 0))
    for _ in range(6):
        posterior.observe(space.scene(env.world), pose(env.world, 0, done))
    assert posterior.probability(1) > 0.9
    moving = Posterior(space, env.world.home, 1.0)
    for tick in range(6):
        moved = replace(pose(env.world, 0, done), place=replace_x(env.world.agents[0].pose, tick))
        moving.observe(space.scene(env.world), moved)
    assert moving.probability(1) == pytest.approx(0.1)


def replace_x(where, metres):
    return where._replace(x=where.x + 0.01 * metres)
