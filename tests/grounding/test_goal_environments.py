"""Environments for goals: reachable, not reached, with as many things as are counted."""

import pytest

from hearth.grounding.environments.goal_environments import sample_for_goal
from hearth.homes.lint import lint
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal

PLATES = Literal.of("ON", "plate", "kitchen_table")
GOALS = {
    "nine plates": Goal.of((PLATES, 9)),
    "what is so already": Goal.of(Literal.of("CLOSED", "fridge")),
    "milk, which is there": Goal.of(Literal.of("INSIDE", "milk", "fridge")),
    "what no home has": Goal.of((Literal.of("INSIDE", "giraffe", "fridge"), 2)),
    "hands": Goal.of((Literal.of("HOLDS", "agent", "book"), 2)),
    "several": Goal.of((PLATES, 2), (Literal.of("ON", "fork", "kitchen_table"), 3), Literal.of("CLEAN", "stove")),
}


@pytest.mark.parametrize("name", [name for name in GOALS if name != "what no home has"])
@pytest.mark.parametrize("seed", range(3))
def test_a_goal_can_be_reached_and_is_not(maple, name, seed):
    goal = GOALS[name]
    environment, progress = sample_for_goal(goal, maple, seed)
    assert not progress.satisfied
    assert lint(environment.world.graph(), default()) == ()
    classes = [node.class_name for node in environment.world.graph().nodes]
    for predicate, wanted in goal:
        counted = predicate.target if predicate.subject == "agent" else predicate.subject
        known = maple.knowledge.same_class(counted)
        assert sum(name in known for name in classes) >= wanted


def test_no_goal_is_a_goal_too(maple):
    environment, progress = sample_for_goal(Goal(()), maple, 0)
    assert progress.counts == () and len(environment.nodes) > 0


def test_equal_seeds_give_equal_environments(maple):
    one, same, other = (sample_for_goal(GOALS["several"], maple, seed)[0] for seed in (1, 1, 2))
    assert (one.nodes, one.added, one.states) == (same.nodes, same.added, same.states)
    assert (one.nodes, one.added) != (other.nodes, other.added)


def test_ten_are_too_many(maple):
    found = sample_for_goal(Goal.of((PLATES, 10)), maple, 0)
    assert isinstance(found, Failure) and found.code is Code.NO_PLACE


def test_an_unknown_class_is_an_error(maple):
    with pytest.raises(HearthError, match="giraffe"):
        sample_for_goal(GOALS["what no home has"], maple, 0)
