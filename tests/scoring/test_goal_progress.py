"""Goals scored by what a program brought about: doing nothing earns nothing."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.syntax import parse_program
from hearth.scoring.evaluate import evaluate, summarise
from hearth.scoring.line_sequences import read
from hearth.scoring.metrics.goal_progress import Achieved, GoalScore, of_given
from hearth.scoring.metrics.goals import goal_of
from hearth.scoring.prediction_scores import METRICS
from hearth.scoring.predictions import Pair
from hearth.simulation.engine import run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.rules import RULES
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

WALK, GRAB = "[Walk] <cup> (1.20)", "[Grab] <cup> (1.20)"
PUT = "[Walk] <table> (1.10)\n[PutBack] <cup> (1.20) <table> (1.10)"
OPEN = "[Walk] <fridge> (1.11)\n[Open] <fridge> (1.11)"
ON_TV = "[Walk] <television> (1.22)\n[SwitchOn] <television> (1.22)"


@pytest.fixture(scope="module")
def one_on(flat, knowledge):
    """The flat with a second television, which is on."""
    second = replace(next(node for node in flat.nodes if node.id == 22), id=23, states=("ON",))
    edges = (*flat.edges, *(Edge(23, edge.relation, edge.target) for edge in flat.edges if edge.source == 22))
    return World.start(Home.from_graph(EnvironmentGraph((*flat.nodes, second), edges), "two", knowledge))


def ran(world, text, rules=RULES["default"]):
    return run(world, parse_program(text)[0], rules)


def achieved(world, text):
    final = ran(world, text).final
    return Achieved.of(goal_of(world, final), world, final), final


@pytest.mark.parametrize("text", [ON_TV, OPEN, f"{WALK}\n{GRAB}", f"{WALK}\n{GRAB}\n{PUT}", f"{OPEN}\n{WALK}\n{GRAB}"])
def test_the_reference_reaches_its_goal_and_doing_nothing_reaches_none_of_it(one_on, text):
    goal, final = achieved(one_on, text)
    own, nothing = goal.score(final), goal.score(one_on)
    assert own.left and (own.reached, own.fraction, own.whole) == (True, 1, True)
    assert (nothing.gained, nothing.reached, nothing.fraction) == (0, False, 0)


def test_what_another_thing_has_all_along_is_not_brought_about(one_on):
    """`ON(television)` held at the start by the other one: the old reading gives it to whoever does nothing."""
    goal, _ = achieved(one_on, ON_TV)
    nothing = goal.score(one_on)
    assert (nothing.whole, nothing.whole_fraction) == (True, 1)
    assert (nothing.reached, nothing.fraction) == (False, 0)


def test_a_program_that_fails_reaches_nothing(one_on):
    goal, _ = achieved(one_on, ON_TV)
    assert goal.score(None) == GoalScore(1)


def test_of_a_reference_that_only_walks_nothing_is_left(one_on):
    goal, final = achieved(one_on, WALK)
    assert goal.score(final).left == 0


@pytest.mark.parametrize(
    ("goal", "program", "expected"),
    [
        # left, gained, broken, reached
        ("OPEN(fridge) and CLEAN(cup): 2", OPEN, (1, 1, 0, True)),
        ("OPEN(fridge) and CLEAN(cup): 2", WALK, (1, 0, 0, False)),
        ("CLOSED(fridge) and HOLDS(agent, cup)", f"{WALK}\n{GRAB}", (1, 1, 0, True)),
        ("CLOSED(fridge) and HOLDS(agent, cup)", f"{WALK}\n{GRAB}\n{OPEN}", (1, 1, 1, False)),
        ("ON(television): 2", ON_TV, (1, 1, 0, True)),
        ("CLEAN(cup): 2", OPEN, (0, 0, 0, True)),
        ("not OPEN(fridge)", WALK, (0, 0, 0, True)),
        ("GRAB(cup) then HOLDS(agent, cup)", f"{WALK}\n{GRAB}", (1, 1, 0, True)),
    ],
)
def test_of_a_given_goal_only_what_did_not_hold_counts(one_on, goal, program, expected):
    found = of_given(read_goal(goal, one_on.home), one_on, ran(one_on, program))
    assert (found.left, found.gained, found.broken, found.reached) == expected
    assert found.whole == found.reached


@given(st.integers(0, 9), st.integers(0, 9), st.integers(0, 9))
def test_a_fraction_is_whole_just_where_the_goal_is_reached(left, gained, broken):
    found = GoalScore(left, min(gained, left), broken)
    assert 0 <= found.fraction <= 1 and found.reached == (found.fraction == 1)


def scores(world, **row):
    pair = Pair("a", read(row.pop("predicted")), (), 1, row, referenced=False)
    return evaluate([pair], world.home.knowledge, lambda _: world)[0]


def test_goals_of_which_nothing_is_left_are_left_out_and_counted(one_on):
    found = [scores(one_on, predicted=OPEN, goal=goal) for goal in ("CLEAN(cup)", "OPEN(fridge)")]
    assert [METRICS["goal"](each) for each in found] == [None, 1]
    assert [METRICS["goal_whole"](each) for each in found] == [1, 1]
    summary = summarise(found)
    assert (summary.reached_before, summary.unreferenced, summary.means["goal"].mean) == (1, 2, 1)
    assert "lcs_step" not in summary.means and "f1" not in summary.means


def test_a_step_that_affordances_refuse_reaches_nothing_whatever_the_engine_does(one_on):
    text = "[Walk] <kitchen> (1)\n[Scrub] <kitchen> (1)\n" + OPEN
    found = scores(one_on, predicted=text, goal="OPEN(fridge)")
    assert found.execution.final is not None  # the engine runs it
    assert (METRICS["executable"](found), METRICS["goal"](found), METRICS["goal_whole"](found)) == (0, 0, 0)
