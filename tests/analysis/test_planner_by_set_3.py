"""Household recipes as planning problems of action set 3: solved by Fast Downward, their plans done by our engine."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from recipes.recipe_runs import KNOWN, home, program_of, recipes

from hearth.analysis.planner_agreement import helpful, solve, steps_of
from hearth.datasets.export.pddl_domain import planning_domain
from hearth.datasets.export.pddl_problems import Task, object_names, problem, task_of
from hearth.grounding.grounded_run import LEAST, Trial, attempt
from hearth.schemas.program import Step
from hearth.simulation.engine import Execution
from hearth.simulation.rules import CONSEQUENCES

EVERY = {recipe.title: recipe for recipe in recipes()}


def run_of(title: str) -> Execution:
    found = attempt(program_of(EVERY[title]), home("maple"), 0, CONSEQUENCES, size=LEAST)
    assert isinstance(found, Trial)
    return found.execution


def problem_of(title: str, in_time: bool = False) -> Task:
    task = task_of(run_of(title), title, in_time)
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


def test_what_comes_in_time_is_a_goal_where_it_is_asked_for_and_waits_are_actions():
    task = problem_of("Plain toast", in_time=True)
    assert {"HOT", "COOKED"} <= {state for _, state, holds in task.states if holds}
    waits = {name for name in helpful(task) if name.startswith("await-")}
    assert "await-toaster-toasts" in waits and not waits & {"await-oven-cooks", "await-pan-burns"}
    text = planning_domain(KNOWN, helpful(task), loose=False)
    toasts = text[text.index("(:action await-toaster-toasts") :]
    assert "(inside ?o ?s)" in toasts and "(class-toaster ?s)" in toasts and "(is-cooked ?o)" in toasts
    assert "await-" not in planning_domain(KNOWN.of_set(2))


def test_a_plan_waits_as_long_as_the_process_takes():
    task = problem_of("Plain toast", in_time=True)
    name = "await-toaster-toasts"
    names = object_names(task).values()
    bread, toaster = (next(each for each in names if each.startswith(word)) for word in ("food", "toaster"))
    action = SimpleNamespace(name=name)
    plan = SimpleNamespace(actions=[SimpleNamespace(action=action, actual_parameters=("me", bread, toaster))])
    assert steps_of(task, plan) == (Step("Wait"),) * KNOWN.processes["toaster_toasts"].after


def test_the_domain_has_states_of_set_3_that_acts_ask_for_and_make():
    text = planning_domain(KNOWN, helpful(problem_of("Apple slices")), loose=False)
    cut = text[text.index("(:action Cut") :]
    assert "(is-cut ?o)" in cut[: cut.index("(:action", 5)]
    assert "(is-gone " in text


@pytest.mark.tools
@pytest.mark.parametrize(("title", "acts"), [("Apple slices", {"Cut"}), ("Plain toast", {"SwitchOn", "Wait"})])
def test_a_planner_solves_a_recipe_and_the_engine_does_its_plan(title, acts):
    pytest.importorskip("unified_planning", reason="not installed: pip install unified-planning up-fast-downward")
    pytest.importorskip("up_fast_downward", reason="not installed: pip install up-fast-downward")
    found = solve(problem_of(title, in_time="Wait" in acts))
    assert found.plan and found.ran and found.reached, found.failure
    assert acts <= {step.action for step in found.plan}
