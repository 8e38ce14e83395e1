"""The planning domain and its problems: read by unified-planning, solved by Fast Downward, run here."""

from __future__ import annotations

import pytest

import hearth
from hearth.exports.pddl import object_names, problem, tasks
from hearth.exports.planning import DISPENSABLE, agreement, executed, helpful
from hearth.exports.planning_domain import OMITTED, TO_DOOR, planning_domain
from hearth.exports.reading import Wanted
from hearth.exports.registry import export
from hearth.kb import knowledge as kb
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import run

MILK = "release:batch-1/file1_1"


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


@pytest.fixture(scope="module")
def task(ds):
    return next(iter(tasks(ds, Wanted((MILK,)))))


def test_every_execution_that_changes_something_gets_a_problem(ds, tmp_path):
    number = export(ds, "pddl", tmp_path / "out")
    assert number == len(list((tmp_path / "out/problems").glob("*.pddl"))) > 0
    text = (tmp_path / "out/domain.pddl").read_text()
    executed = {action.name for action in kb.default().actions.values() if action.executed}
    assert {line.split()[1] for line in text.splitlines() if "(:action" in line} == (executed - OMITTED) | {TO_DOOR}


def test_a_goal_is_what_the_execution_changed(ds, task):
    world, (execution,) = task.world, ds[MILK].runs
    assert not task.reached(world)
    final = run(world, ds[MILK].program.bound(execution.bindings())).final
    assert task.reached(final)
    relations = {edge.relation for edge, _ in task.edges}
    assert relations and relations <= {"ON", "INSIDE", "HOLDS_RH", "HOLDS_LH"}
    before = {tuple(edge) for edge in world.edges()}
    assert all((tuple(edge) in before) is not holds for edge, holds in task.edges)
    assert all(world.has_state(node, state) is not holds for node, state, holds in task.states)


def test_things_that_cannot_matter_are_left_out(task):
    names, text = object_names(task), problem(task)
    assert len(names) < len(task.world.home)
    goal = text[text.index("(:goal") :]
    assert {name for name in names.values() if f" {name})" in goal or f" {name} " in goal} <= set(names.values())
    rooms = {task.world.home.ids[i] for i in range(len(task.world.home)) if task.world.home.rooms >> i & 1}
    assert all(f"(inside {name} " in text for node, name in names.items() if node not in rooms)


def test_what_does_the_same_needs_no_more():
    actions = kb.default().actions
    for name, others in DISPENSABLE.items():
        for other in others:
            mine, theirs = ({str(check.formula) for check in actions[each].preconditions} for each in (name, other))
            assert theirs <= mine
            assert {str(effect) for effect in actions[name].effects} == {str(e) for e in actions[other].effects}
    facing = {str(effect.atom.name) for effect in actions["TurnTo"].effects}
    assert facing == {"FACING"}
    needs = (name for name, a in actions.items() for c in a.preconditions if "acing" in str(c.formula) and a.effects)
    assert not list(needs)


def test_plans_are_judged_by_the_engine(task):
    useless = executed(task, "SOLVED", ())
    assert useless.ran and not useless.reached
    impossible = executed(task, "SOLVED", (Step("Open", (ObjectRef("nothing", 1, task.objects[0]),)),))
    assert not impossible.ran and impossible.failure
    assert "Walk" in helpful(task) and not set(helpful(task)) & {*DISPENSABLE, *OMITTED, "Watch"}


@pytest.mark.tools
def test_planner_and_engine_agree(ds):
    pytest.importorskip("unified_planning", reason="not installed: pip install unified-planning up-fast-downward")
    pytest.importorskip("up_fast_downward", reason="not installed: pip install up-fast-downward")
    found = agreement(ds, 4)
    assert (found.problems, found.solved, found.ran, found.reached) == (4, 4, 4, 4), found.disagreements


@pytest.mark.tools
def test_the_whole_domain_is_read(ds, task):
    reader = pytest.importorskip(
        "unified_planning.io", reason="not installed: pip install unified-planning"
    ).PDDLReader()
    parsed = reader.parse_problem_string(planning_domain(kb.default()), problem(task))
    assert len(parsed.actions) == 41 and len(parsed.all_objects) == len(task.objects)
