"""Helpers that are not told the goal: the posterior, NOPA's values, handing over, bringing back."""

import math
from dataclasses import replace

import numpy as np
import pytest
from small_tasks import ALLOWED, start, target, wanted

from hearth.agents.belief import Place
from hearth.agents.empowerment import Empowerment
from hearth.agents.expected_time import ExpectedTime
from hearth.agents.goal_space import Edge, GoalSpace
from hearth.agents.helping_plans import USUAL_WEIGHTS, HelpingPlans, Weights, _Leg
from hearth.agents.human_like import HumanLike
from hearth.agents.nopa import Nopa
from hearth.agents.online_registry import ONLINE
from hearth.agents.posterior import FAR, ActionModel, Posterior
from hearth.agents.prospects import Planner
from hearth.challenges.play import Player
from hearth.challenges.play import play as played_by
from hearth.homes.library import load_graph
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HOLDS, Literal
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import legal
from hearth.simulation.env import Env
from hearth.simulation.observation.views import LastAction, pose
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home

PLAIN = sorted(name for name, kind in ONLINE.items() if not kind.network and not name.startswith("nopa_k"))
"""Helpers that need no network, which knows one grammar only."""

COUNTS = {"plate": 3, "fork": 3, "apple": 3}


@pytest.fixture(scope="module")
def home(knowledge):
    return Home.from_graph(load_graph("maple", knowledge), "maple", knowledge)


@pytest.fixture
def world(home):
    return start(home, COUNTS, seed=3)


class Nobody:
    """Stands still."""

    def reset(self, observation, goal, seed):
        pass

    def act(self, observation, legal):
        return None


def play(world, goal, agents, seed=0, limit=250):
    """An episode in which everybody sees everything, and only the first is told the goal."""
    players = [Player(agents[0] or Nobody(), goal), Player(agents[1] or Nobody(), None)]
    return played_by(world, goal, players, seed, actions=ALLOWED, partial=False, limit=limit)


def goals_of(world):
    """A toy grammar: what may be wanted, with its probability."""
    return {
        wanted(world, "ON", "desk", plate=2): 0.3,
        wanted(world, "ON", "coffee_table", plate=1, fork=1): 0.3,
        wanted(world, "INSIDE", "fridge", apple=2): 0.2,
        wanted(world, "ON", "coffee_table", apple=1, fork=2): 0.2,
    }


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


class Plain:
    """The posterior, goal by goal and thing by thing."""

    def __init__(self, goals, home, model):
        self.goals, self.home, self.model = list(goals), home, model
        self.weights = dict(goals)
        self.pursued, self.last, self.places = {}, None, None

    def observe(self, world, other, costs, trips, space):
        step = other.last and (other.last.instruction, other.last.failure)
        if step and self.places and step != self.last:
            self.weigh(step[0])
        self.last = step
        places = space.places(world)
        if places == self.places:
            return
        self.places, self.last = places, None
        me = self.me = self.home.index[other.node]
        rows = list(dict.fromkeys(literal for goal in self.goals for literal, _ in goal))
        for goal in self.goals:
            lacking = self.lacking(goal, places)
            if not lacking or any(self.too_few(goal, literal, places) for literal in lacking):
                self.weights[goal] = 0.0
            found = {}
            for number, thing in enumerate(space.things):
                for literal in lacking:
                    row = rows.index(literal)
                    if number in self.able(literal, costs[row]):
                        saved = self.saved(goal, literal, number, row, costs, trips)
                        worth = math.exp(-self.model.rationality * (costs[row, number] - saved))
                        found[thing] = found.get(thing, 0.0) + worth
            held = {t: v for t, v in found.items() if places[space.things.index(t)] == (HOLDS, me)}
            found = held or found
            total = sum(found.values())
            self.pursued[goal] = {t: v / total for t, v in found.items()} if total else {}
        self.normalise()
        self.things = space.things

    def saved(self, goal, literal, number, row, costs, trips):
        """A round trip, or, of more things than are needed, the dearest of the cheapest that are."""
        me = self.me

        def trip(n):
            return costs[row, n] if self.places[n] == (HOLDS, me) else trips[row, n]

        met = sum(self.counts(literal, t, p) for t, p in zip(self.all, self.places, strict=True))
        cheapest = sorted(map(trip, self.able(literal, costs[row])))[: dict(goal)[literal] - met]
        return min(trip(number), cheapest[-1])

    def too_few(self, goal, literal, places):
        """Whether a goal wants more of some things than there are."""
        return dict(goal)[literal] > sum(self.counts(literal, thing, None) for thing in self.all)

    def able(self, literal, costs):
        return [
            n for n, thing in enumerate(self.all)
            if self.counts(literal, thing, None)
            and not self.counts(literal, thing, self.places[n])
            and costs[n] < FAR
        ]  # fmt: skip

    def counts(self, literal, thing, place):
        fits = bool(self.home.instances(literal.subject) >> thing & 1)
        return fits and (place is None or place == (literal.name, self.home.index[literal.target]))

    def lacking(self, goal, places):
        return [
            literal for literal, number in goal
            if sum(self.counts(literal, t, p) for t, p in zip(self.all, places, strict=True)) < number
        ]  # fmt: skip

    def weigh(self, step):
        known, nodes = self.home.knowledge, [self.home.index[ref.node] for ref in step.objects]
        name = step.action
        if not nodes or known.state_of(name) == "CLOSED":
            return
        before = dict(zip(self.all, self.places, strict=True))
        for goal in self.goals:
            pursued, match = self.pursued[goal], {}
            for thing in pursued:
                held = before[thing] == (HOLDS, self.me)
                ends = {
                    self.home.index[literal.target]
                    for literal in self.lacking(goal, self.places)
                    if self.counts(literal, thing, None)
                }
                if name == "Grab":
                    match[thing] = thing == nodes[0]
                elif name in known.group("puts"):
                    match[thing] = thing == nodes[0] and nodes[1] in ends
                elif held:
                    match[thing] = nodes[0] in ends
                else:
                    match[thing] = nodes[0] in (thing, before[thing][1])
            explained = sum(pursued[t] * match[t] for t in pursued)
            self.weights[goal] *= (1 - self.model.slip) * explained + self.model.slip / len(self.all)
            if explained > 0:
                self.pursued[goal] = {t: pursued[t] * match[t] / explained for t in pursued}
        self.normalise()

    def normalise(self):
        total = sum(self.weights.values())
        self.weights = {goal: weight / total for goal, weight in self.weights.items()}


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
    """What NOPA thinks of the first tick, with every goal as a particle."""
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


def holding(world, name):
    """An environment in which the second character holds something."""
    goal = Goal.of(Literal(HOLDS, ("agent:1", name)))
    players = [Player(Nobody(), None), Player(HumanLike(), goal)]
    env = played_by(world, goal, players, 0, actions=ALLOWED, partial=False).env
    (thing,) = indices(env.world.agents[1].held)
    return env, thing


def decided(helper, env):
    helper.reset(env.observe(1), None, 0)
    helper.act(env.observe(1), legal(env.world, 1, env.rules))
    return helper.subgoal


def test_what_is_wanted_nobody_knows_where_is_handed_over(home):
    """Figure 7-5a: both goals want the only apple, in places that are equally probable; watching teaches nothing, since
    the one who is helped can do nothing without it.
    """
    world = start(home, {"plate": 3, "apple": 1})
    env, apple = holding(world, "apple")
    goals = {
        wanted(world, "INSIDE", "fridge", apple=1): 0.5,
        wanted(world, "ON", "coffee_table", apple=1): 0.5,
    }
    assert decided(ExpectedTime(lambda home: goals), env) == Edge(HOLDS, apple, env.world.agents[0].index)


def test_what_is_not_wanted_is_brought_back(home):
    """Figure 7-5b: what it has taken is of no use for any goal."""
    env, apple = holding(start(home, {"apple": 2}), "apple")
    goals = {wanted(env.world, "ON", "desk", plate=2): 1.0, wanted(env.world, "ON", "desk", apple=1): 0.0}
    helper = ExpectedTime(lambda home: goals)
    helper.reset(env.observe(1), None, 0)
    desk = env.world.home.index[target(env.world, "desk")]
    helper.first_places[apple] = Place("ON", desk)
    helper.act(env.observe(1), legal(env.world, 1, env.rules))
    assert helper.subgoal == Edge("ON", apple, desk)


def test_who_waits_wants_what_the_helper_has(home):
    """Two goals want plates, one the only apple, too, which the helper holds: who does nothing waits for it."""
    env, _ = holding(start(home, {"plate": 2, "apple": 1}), "apple")
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


@pytest.mark.parametrize("name", ["expected_time", "asking", "nopa", "nopa_no_return", "likeliest"])
def test_what_the_helper_holds_alone_is_brought_in_the_end(home, name):
    """Nobody can reach the goal without what the helper has taken."""
    env, _ = holding(start(home, {"plate": 3, "apple": 1}), "apple")
    goals = {
        wanted(env.world, "ON", "desk", plate=2): 0.85,
        wanted(env.world, "INSIDE", "fridge", apple=1): 0.1,
        wanted(env.world, "ON", "coffee_table", apple=1): 0.05,
    }
    done = play(env.world, list(goals)[1], [HumanLike(), ONLINE[name].make(lambda home: goals)], 0)
    assert done.success


@pytest.mark.parametrize("name", ["expected_time", "nopa", "nopa_no_return"])
def test_who_has_both_hands_full_before_a_closed_door_puts_something_down_once(home, name):
    """Nobody else opens the fridge: it does not walk to and fro between a place to put things and the fridge."""
    world = start(home, {"apple": 2, "plate": 1})
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
