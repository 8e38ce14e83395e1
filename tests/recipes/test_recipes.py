"""Household recipes run by action set 3 and reach their goals in at least six of our seven homes."""

import pytest
from recipes.recipe_runs import KNOWN, home, outcome, program_of, recipes

from hearth.homes import library
from hearth.simulation.goal_text import read_goal

EVERY = {recipe.title: recipe for recipe in recipes()}
FEWEST_HOMES = 6


def test_there_are_many_and_no_two_are_alike():
    assert len(EVERY) == sum(1 for _ in recipes()) >= 200
    assert len({recipe.steps for recipe in EVERY.values()}) == len(EVERY)
    assert len({recipe.goal for recipe in EVERY.values()}) == len(EVERY)


@pytest.mark.parametrize("title", EVERY)
def test_a_recipe_is_read_as_it_is_written_and_uses_its_ingredients(title):
    recipe = EVERY[title]
    program = program_of(recipe)
    used = {ref.name for step in program.steps for ref in step.objects}
    named = {KNOWN.object_class(name).name for name in recipe.ingredients}
    assert named <= used and len(program.steps) >= len(recipe.steps)
    assert read_goal(recipe.goal, home("maple")).counts or read_goal(recipe.goal, home("maple")).parts


@pytest.mark.slow
@pytest.mark.parametrize("title", EVERY)
def test_a_recipe_ends_in_its_goal_in_at_least_six_homes(title):
    recipe = EVERY[title]
    program = program_of(recipe)
    found = {name: outcome(recipe, program, name) for name in library.names()}
    assert sum(not words for words in found.values()) >= FEWEST_HOMES, found


@pytest.mark.parametrize("title", EVERY)
def test_the_goal_of_a_recipe_does_not_hold_before_it(title):
    """A goal that holds without the steps would say nothing of them."""
    recipe = EVERY[title]
    program = program_of(recipe)
    assert outcome(recipe, program.with_steps(program.steps[:1]), "maple")
