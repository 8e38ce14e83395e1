"""The goal that a program reaches by action set 3 has the states that acts and processes bring about."""

import pytest
from recipes.recipe_runs import Recipe, home, program_of

from hearth.grounding.grounded_run import LEAST, Trial, attempt
from hearth.scoring.metrics.goal_progress import Achieved
from hearth.scoring.metrics.goals import goal_of
from hearth.simulation.processes import widened
from hearth.simulation.rules import CONSEQUENCES, DEFAULT
from hearth.simulation.world.world import World

TO_CUP = "Walk to the kitchen. Find the cup. Take the cup"
TO_BREAD = "Walk to the kitchen. Find the bread. Take the bread"
REACHED = {
    "BROKEN(cup)": f"{TO_CUP}. Drop the cup",
    "GONE(food_bread)": f"{TO_BREAD}. Eat the bread. Eat the bread. Eat the bread. Eat the bread",
    "FULL(cup)": "Walk to the kitchen. Find the milk. Take the milk. Find the cup. Pour the milk in the cup",
    "WET(cup)": f"{TO_CUP}. Walk to the sink. Rinse the cup",
    "CUT(food_bread)": "Walk to the kitchen. Find the knife. Take the knife. Find the bread. Cut the bread",
    "HOT(pot)": "Walk to the kitchen. Find the pot. Take the pot. Walk to the stove. Put the pot on the stove. "
    "Switch on the stove. Wait. Wait. Wait. Wait. Wait",
    "COOKED(food_egg)": "Walk to the kitchen. Find the egg. Take the egg. Find the frying pan. "
    "Put the egg in the frying pan. Take the frying pan. Walk to the stove. Put the frying pan on the stove. "
    "Switch on the stove. Wait. Wait. Wait. Wait. Wait. Wait. Wait. Wait. Wait. Wait",
    "FOLDED(towel)": "Walk to the bathroom. Find the towel. Take the towel. Fold the towel",
    "WRITTEN(paper)": "Walk to the living room. Find the pen. Take the pen. Find the paper. Write on the paper",
}


def run_of(steps: str) -> Trial:
    found = attempt(
        program_of(Recipe("t", (), tuple(steps.split(". ")), "")), home("maple"), 0, CONSEQUENCES, size=LEAST
    )
    assert isinstance(found, Trial), found
    assert found.execution.executable, found.execution.failure
    return found


@pytest.mark.parametrize("literal", REACHED)
def test_a_goal_has_the_state_and_the_program_reaches_it(literal):
    execution = run_of(REACHED[literal]).execution
    start, final = execution.worlds[0], execution.final
    goal = goal_of(start, final)
    assert literal in {str(each) for each, _ in goal}
    narrow = World.start(start.home)
    assert widened(narrow) == start
    assert goal_of(narrow, final) == goal
    score = Achieved.of(goal, narrow, final)
    assert score.score(final).gained == sum(score.wanted) > 0
    assert score.score(start).gained == 0


def test_worlds_of_set_2_have_goals_without_further_states():
    start = World.start(home("maple"))
    found = attempt(
        program_of(Recipe("t", (), tuple(f"{TO_CUP}. Drop the cup".split(". ")), "")), home("maple"), 0, DEFAULT
    )
    assert isinstance(found, Trial)
    assert "BROKEN" not in str(goal_of(start, found.execution.final))
