"""The planning domain and its problems: read by unified-planning, solved by Fast Downward, run here."""

from __future__ import annotations

from pathlib import Path

import pytest

import hearth
from hearth.analysis.planner_agreement import STEP, agreement, chosen, dispensable, executed, helpful, solve
from hearth.datasets.export.formats import export
from hearth.datasets.export.pddl_domain import TO_DOOR, planning_domain
from hearth.datasets.export.pddl_problems import Task, object_names, problem, tasks
from hearth.datasets.export.program_batches import Wanted
from hearth.kb.loading.load import default
from hearth.schemas.graph import Edge
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import run
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import extended
from hearth.simulation.world.world import World

MILK = "release:batch-1/file1_1"


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


@pytest.fixture(scope="module")
def task(ds):
    return next(iter(tasks(ds, Wanted((MILK,)))))


def test_one_problem_a_program_is_chosen_from_all_over_a_dataset(ds, monkeypatch):
    names = list(ds)
    spread = [name for start in range(min(STEP, len(names))) for name in names[start::STEP]]
    found = [task for name in spread for task in list(tasks(ds, Wanted((name,))))[:1]]
    for asked in (1, 3, 1_000):
        monkeypatch.setattr("hearth.analysis.planner_agreement.ASKED", asked)
        assert [task.name for task in chosen(ds, 7)] == [task.name for task in found[:7]]


def test_every_execution_that_changes_something_gets_a_problem(ds, tmp_path):
    number = export(ds, "pddl", tmp_path / "out")
    assert number == len(list((tmp_path / "out/problems").glob("*.pddl"))) > 0
    text = (tmp_path / "out/domain.pddl").read_text()
    executed = {action.name for action in default().actions.values() if action.executed}
    planned = executed - default().group("unplanned") | {TO_DOOR}
    assert {line.split()[1] for line in text.splitlines() if "(:action" in line} == planned


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
    actions = default().actions
    for name, others in dispensable(default()).items():
        assert others or name == "TurnTo"
        for other in others:
            mine, theirs = ({str(check.formula) for check in actions[each].preconditions} for each in (name, other))
            assert theirs <= mine
            assert {str(effect) for effect in actions[name].effects} == {str(e) for e in actions[other].effects}
    facing = {str(effect.literal.name) for effect in actions["TurnTo"].effects}
    assert facing == {"FACING"}
    needs = (name for name, a in actions.items() for c in a.preconditions if "acing" in str(c.formula) and a.effects)
    assert not list(needs)


def test_plans_are_judged_by_the_engine(task):
    useless = executed(task, "SOLVED", ())
    assert useless.ran and not useless.reached
    impossible = executed(task, "SOLVED", (Step("Open", (ObjectRef("nothing", 1, task.objects[0]),)),))
    assert not impossible.ran and impossible.failure
    assert "Walk" in helpful(task) and not set(helpful(task)) & {
        *dispensable(default()),
        *default().group("unplanned"),
        "Watch",
    }


@pytest.mark.tools
def test_planner_and_engine_agree(ds):
    pytest.importorskip("unified_planning", reason="not installed: pip install unified-planning up-fast-downward")
    pytest.importorskip("up_fast_downward", reason="not installed: pip install up-fast-downward")
    found = agreement(ds, 4, workers=2)
    assert (found.problems, found.solved, found.ran, found.reached) == (4, 4, 4, 4), found.disagreements


@pytest.mark.tools
def test_the_planner_works_in_a_folder_of_its_own(task, tmp_path, monkeypatch):
    pytest.importorskip("up_fast_downward", reason="not installed: pip install up-fast-downward")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "output.sas").mkdir()
    assert solve(task).reached
    assert Path.cwd() == tmp_path


def behind_two_doors(maple):
    """Somebody in the bathroom, the door between bedroom and living room closed, which lies in the living room."""
    room = {maple.classes[i]: maple.ids[i] for i in range(len(maple)) if maple.rooms >> i & 1}
    inside = {edge.source: edge for edge in World.start(maple).edges() if edge.relation == "INSIDE"}
    parted = {maple.index[room["bedroom"]], maple.index[room["living_room"]]}
    door = next(maple.ids[i] for i in indices(maple.doors) if {*indices(maple.between[i])} == parted)
    assert inside[door].target == room["living_room"]
    (character,) = (maple.ids[i] for i in indices(maple.characters))
    here = Edge(character, "INSIDE", room["bathroom"])
    home = extended(maple, [], [here], [inside[character]], {door: ["CLOSED", "CLEAN"]})
    return Task("far", World.start(home), (character, door, *room.values()), ((door, "OPEN", True),), ())


def test_a_door_is_walked_to_from_any_room_on_this_side(maple):
    text = problem(behind_two_doors(maple))
    facts = sorted(line.split() for line in text.splitlines() if "this-side" in line)
    sides = {(start.rsplit("_", 1)[0], side.rstrip(")").rsplit("_", 1)[0]) for _, _, start, side in facts}
    near = {("bathroom", "bedroom"), ("bedroom", "bedroom")}
    assert sides == near | {("kitchen", "living_room"), ("living_room", "living_room")}


@pytest.mark.tools
def test_a_plan_opens_a_door_two_rooms_away(maple):
    pytest.importorskip("unified_planning", reason="not installed: pip install unified-planning up-fast-downward")
    pytest.importorskip("up_fast_downward", reason="not installed: pip install up-fast-downward")
    found = solve(behind_two_doors(maple))
    assert found.plan and found.ran and found.reached, found.failure
    assert [step.action for step in found.plan] == ["Walk", "Open"]


@pytest.mark.tools
def test_the_whole_domain_is_read(ds, task):
    reader = pytest.importorskip(
        "unified_planning.io", reason="not installed: pip install unified-planning"
    ).PDDLReader()
    parsed = reader.parse_problem_string(planning_domain(default()), problem(task))
    assert len(parsed.actions) == 41 and len(parsed.all_objects) == len(task.objects)
