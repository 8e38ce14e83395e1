"""Asking and answering for the price of a tick."""

from __future__ import annotations

import pytest
from small_tasks import ALLOWED, start, wanted

from hearth.agents.communication import Answering, Asking
from hearth.agents.expected_time_helper import ExpectedTime
from hearth.agents.goal_posterior import Posterior
from hearth.agents.goal_space import GoalSpace
from hearth.agents.human_like import HumanLike
from hearth.challenges.episode_loop import Player, play
from hearth.schemas.agent_messages import Message, read
from hearth.schemas.literals import Literal
from hearth.simulation.observation.views import pose


@pytest.fixture(scope="module")
def world(maple):
    return start(maple, {"plate": 3, "fork": 3, "apple": 3}, seed=3)


def goals_of(world):
    """Goals that begin alike: who watches learns late which it is."""
    return {
        wanted(world, "ON", "coffee_table", plate=1, fork=3): 0.25,
        wanted(world, "ON", "coffee_table", plate=3, apple=3): 0.25,
        wanted(world, "ON", "desk", plate=1, apple=3): 0.25,
        wanted(world, "INSIDE", "fridge", plate=1, fork=2): 0.25,
    }


def episode(world, goal, main, helper, messages=True):
    players = [Player(main, goal), Player(helper, None)]
    return play(world, goal, players, 1, actions=ALLOWED, partial=False, messages=messages)


def said(done):
    return [(n, message) for tick in done.said for n, message in tick.items()]


@pytest.mark.parametrize("number", [0, 1, 3])
def test_a_question_is_answered_by_a_part_of_the_goal(world, number):
    goal = list(goals_of(world))[number]
    done = episode(world, goal, Answering(), Asking(lambda home: goals_of(world)))
    told = said(done)
    assert done.success and told[0] == (1, Message())
    agent, answer = told[1]
    assert agent == 0 and dict(goal)[answer.wanted] >= answer.count > 0


def test_who_speaks_does_nothing_else_in_that_tick(world):
    goal = next(iter(goals_of(world)))
    done = episode(world, goal, Answering(), Asking(lambda home: goals_of(world)))
    spoken = [(tick, said) for tick, said in zip(done.env.ticks, done.said, strict=True) if said]
    assert spoken and all(agent not in tick.instructions for tick, said in spoken for agent in said)


def test_who_gets_no_answer_asks_once(world):
    goal = next(iter(goals_of(world)))
    done = episode(world, goal, HumanLike(), Asking(lambda home: goals_of(world)))
    assert done.success and said(done) == [(1, Message())]


def test_who_is_certain_does_not_ask(world):
    goal = next(iter(goals_of(world)))
    assert not said(episode(world, goal, Answering(), Asking(lambda home: {goal: 1.0})))


def test_where_it_is_not_allowed_nothing_is_said(world):
    goal = next(iter(goals_of(world)))
    done = episode(world, goal, Answering(), Asking(lambda home: goals_of(world)), messages=False)
    assert done.success and not said(done)


def test_an_answer_weighs_the_goals_that_lack_just_that(world):
    goals = goals_of(world)
    space = GoalSpace.of(goals, world.home)
    posterior = Posterior(space, world.home, 1.0)
    posterior.observe(space.scene(world), pose(world, 0))
    literal, count = next(iter(list(goals)[3]))
    posterior.answered(space.predicates.index(literal), count)
    assert posterior.probability(3) > 0.99


def test_asking_saves_time(world):
    def ticks(make):
        return sum(
            episode(world, goal, Answering(), make(lambda home: goals_of(world))).ticks for goal in goals_of(world)
        )

    assert ticks(Asking) < ticks(ExpectedTime)


def test_messages_are_read_as_they_were_written():
    for message in (Message(), Message(Literal("ON", ("plate", 72)), 2)):
        assert read(str(message)) == message
    for text in (
        "",
        "ask",
        "Tell",
        "Tell ON(plate, 72)",
        "Tell ON(plate, 72) 2 ",
        "Tell on(a, 1) 1",
        "Tell ON(a, 1) 9999",
    ):
        assert read(text) is None
