"""Household recipes as planning problems of action set 3: solved by Fast Downward, their plans done by our engine."""

from __future__ import annotations

import pytest
from recipes.recipe_runs import KNOWN, home, program_of, recipes

from hearth.analysis.planner_agreement import helpful, solve
from hearth.datasets.export.pddl_domain import planning_domain
from hearth.datasets.export.pddl_problems import Task, problem, task_of
from hearth.grounding.grounded_run import LEAST, Trial, attempt
from hearth.simulation.engine import Execution
from hearth.simulation.rules import CONSEQUENCES

EVERY = {recipe.title: recipe for recipe in recipes()}


def run_of(title: str) -> Execution:
    found = attempt(program_of(EVERY[title]), home("maple"), 0, CONSEQUENCES, size=LEAST)
    assert isinstance(found, Trial)
    return found.execution


def problem_of(title: str) -> Task:
    task = task_of(run_of(title), title)
    assert task is not None
    return task


def test_a_problem_asks_for_what_acts_bring_about_and_not_for_what_comes_in_time():
    execution = run_of("Egg sandwich")
    task = problem_of("Egg sandwich")
    came = {state for _, state in execution.final.changes(execution.worlds[0]).set_states}
    asked = {state for _, state, holds in task.states if holds}
    assert {"HOT", "COOKED"} & came and not {"HOT", "COOKED"} & asked
    assert task.reached(execution.final) and not task.reached(execution.worlds[0])
    assert ":domain hearth" in problem(task)


def test_the_domain_has_states_of_set_3_that_acts_ask_for_and_make():
    text = planning_domain(KNOWN, helpful(problem_of("Apple slices")), loose=False)
    cut = text[text.index("(:action Cut") :]
    assert "(is-cut ?o)" in cut[: cut.index("(:action", 5)]
    assert "(is-gone " in text


@pytest.mark.tools
@pytest.mark.parametrize(("title", "acts"), [("Apple slices", {"Cut"}), ("A stain on the jacket", {"Scrub"})])
def test_a_planner_solves_a_recipe_and_the_engine_does_its_plan(title, acts):
    pytest.importorskip("unified_planning", reason="not installed: pip install unified-planning up-fast-downward")
    pytest.importorskip("up_fast_downward", reason="not installed: pip install up-fast-downward")
    found = solve(problem_of(title))
    assert found.plan and found.ran and found.reached, found.failure
    assert acts <= {step.action for step in found.plan}
