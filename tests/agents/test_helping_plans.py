"""Plans that help with several goals at once: NOPA's values, both hands, and what a plan fetches."""

import pytest
from online_tasks import COUNTS, goals_of
from small_tasks import start, wanted

from hearth.agents.goal_posterior import Posterior
from hearth.agents.goal_space import Edge, GoalSpace
from hearth.agents.helping_plans import USUAL_WEIGHTS, HelpingPlans, Weights, _Leg
from hearth.agents.nopa import Nopa
from hearth.agents.partner_plans import Planner
from hearth.schemas.literals import HOLDS
from hearth.simulation.env import Env
from hearth.simulation.observation.views import pose


@pytest.fixture
def world(maple):
    return start(maple, COUNTS, seed=3)


def test_the_value_of_an_edge_is_equation_7_1():
    """w_r p max(L_M - L_H, 0) - w_c L_H - w_m change, with p .5, L_M 20, L_H 6: .5 * 14 - .5 * 6 - 2 = 2."""
    edge, plans = Edge("ON", 1, 2), HelpingPlans.__new__(HelpingPlans)
    plans._weights, plans._expected, plans._held = Weights(reward=1.0, cost=0.5, moves=2.0), {edge: 20.0}, []
    plans._times, plans._probability = lambda legs: [6.0], lambda edge, brought: 0.5
    legs = [_Leg(2, 1, edge)]
    assert plans._value(legs) == pytest.approx(2.0)
    plans._held = [edge.thing]  # it is away from its first place as it is
    assert plans._value(legs) == pytest.approx(4.0)
    plans._expected[edge] = 4.0
    assert plans._value(legs) == pytest.approx(-3.0)


def weighed(world, goals, weights=USUAL_WEIGHTS):
    """Return NOPA's values in the first tick, with every goal as a particle."""
    env = Env(partial=False)
    env.restore(world)
    view = env.observe(1)
    helper = Nopa(lambda home: goals)
    helper.reset(view, None, 0)
    helper.look(view)
    planner = helper.planner()
    prospects = [
        (share, goal, planner.prospect(goal, 0.0))
        for share, goal in zip(goals.values(), helper.space.wanted, strict=True)
    ]
    return HelpingPlans(helper, view, prospects, weights), helper


def test_a_second_thing_is_needed_only_where_a_goal_wants_two(world):
    goals = {wanted(world, "ON", "desk", plate=1): 0.75, wanted(world, "ON", "desk", plate=2): 0.25}
    plans, helper = weighed(world, goals)
    one, other, *_ = (edge for edge in helper.space.row_at if edge.thing in plans._places)
    assert plans._probability(one, {one.thing}) == pytest.approx(1.0)
    assert plans._probability(other, {one.thing, other.thing}) == pytest.approx(0.25)


def test_both_hands_are_used_where_two_are_wanted(world):
    goals = {wanted(world, "ON", "desk", plate=2): 1.0}
    both, one = (weighed(world, goals, Weights(hands=hands))[0].values for hands in (2, 1))
    assert max(both, key=both.get).target == -1 != max(one, key=one.get).target
    assert max(both.values()) > max(one.values())


def test_a_plan_fetches_the_nearest_and_brings_it(world):
    goals = goals_of(world)
    space = GoalSpace.of(goals, world.home)
    other = pose(world, 0)
    posterior = Posterior(space, world.home, 1.0)
    posterior.observe(space.scene(world), other)
    planner = Planner(space, space.scene(world), world.agents[0].index, other, posterior.distances)
    found = planner.prospect(space.wanted[0], 200.0)
    brought = [edge for edge in found.edges if edge.relation == "ON"]
    assert len(brought) == 2 and not found.later
    assert all(found.edges[edge] > found.edges[Edge(HOLDS, edge.thing, world.agents[0].index)] for edge in brought)
    near = planner.prospect(space.wanted[0], 1.0)
    assert not near.edges and {edge.target for edge in near.later} == {brought[0].target}
