"""The Embodied Agent Interface: a wheel read in place, and each rule of its scorer beside ours, on a wheel of ours."""

from __future__ import annotations

import json
import os
import zipfile
from pathlib import Path

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.interop.eai import action_sequencing, goal_interpretation
from hearth.interop.eai.action_sequencing import Fault
from hearth.interop.eai.answer_texts import plan_as_scored, plan_of
from hearth.interop.eai.audit import BY_HASH, EMPTY, GOLD, PASSED_OVER, PLUGS, SEVERAL, wrong_goals, wrong_verdicts
from hearth.interop.eai.goal_planner import GoalPlanner
from hearth.interop.eai.model_table import published, table
from hearth.interop.eai.task_worlds import task_world
from hearth.interop.eai.transition_modelling import compared, compared_as_scored, left_out, operators_of
from hearth.interop.eai.wheel import DATA, PLACE, RESOURCES, ROOT, Answer, Wheel
from hearth.schemas.diagnostics import HearthError

NODES = [
    (1, "bedroom", "Rooms", [], []), (2, "kitchen", "Rooms", [], []), (65, "character", "Characters", [], []),
    (10, "television", "Electronics", ["HAS_SWITCH", "HAS_PLUG"], ["OFF", "PLUGGED_OUT"]),
    (11, "sofa", "Furniture", ["SITTABLE", "SURFACES"], []), (12, "cup", "Props", ["GRABBABLE", "MOVABLE"], []),
    (13, "table", "Furniture", ["SURFACES"], []),
]  # fmt: skip
EDGES = [(65, "INSIDE", 1), (10, "INSIDE", 1), (11, "INSIDE", 1), (12, "INSIDE", 2), (13, "INSIDE", 2), (12, "ON", 13)]
TELEVISION_ON = [{"id": 10, "class_name": "television", "state": "ON"}]
HELD = [{"from_id": 65, "relation_type": "HOLDS_RH", "to_id": 12}]
NEAR = [{"from_id": 65, "relation_type": "CLOSE", "to_id": 12}]
TASKS = {
    "1_1": ([], TELEVISION_ON, ["[PlugIn] <television> (1.10)", "[SwitchOn] <television> (1.10)"]),
    "2_1": (["GRAB", "TOUCH|WATCH"], HELD, ["[Grab] <cup> (1.12)"]),
    "3_1": ([], [], []),
    "4_1": ([], HELD + NEAR, ["[Grab] <cup> (1.12)"]),
}
ANSWERS = {
    "1_1": '```json\n{"WALK": ["television"], "PLUGIN": ["television"], "SWITCHON": ["television"], "SIT": []}\n```',
    "2_1": '{"WALK": ["cup"], "GRAB": ["cup"], "TOUCH": ["cup"]}',
    "3_1": '{"WALK": ["cup"]}',
    "4_1": '{"STANDUP": [], "WALK": ["cup"], "GRAB": ["cup"]}',
}


def graph(states, edges):
    nodes = [{"id": i, "class_name": name, "category": kind, "properties": can, "states": states.get(i, own),
              "prefab_name": None, "bounding_box": None} for i, name, kind, can, own in NODES]  # fmt: skip
    return {"nodes": nodes, "edges": [{"from_id": a, "relation_type": r, "to_id": b} for a, r, b in edges]}


def written(path, answers=ANSWERS, goals=None):
    ends = {"1_1": ({10: ["ON", "PLUGGED_IN"]}, [])}
    ends |= dict.fromkeys(("2_1", "4_1"), ({}, [(65, "HOLDS_RH", 12), (65, "CLOSE", 12), (65, "CLOSE", 13)]))
    records = {
        number: {"vh_goal": {"actions": actions, "goal": goal}, "tl_goal": (goals or {}).get(number, "")}
        for number, (actions, goal, _) in TASKS.items()
    }
    with zipfile.ZipFile(path, "w") as wheel:
        tasks = {"scene_1": {"Watch TV": records}}
        wheel.writestr(f"{RESOURCES}task_state_LTL_formula_accurate.json", json.dumps(tasks))
        for number, (_, _, steps) in TASKS.items():
            states, more = ends.get(number, ({}, []))
            pair = {"init_graph": graph({}, EDGES), "final_graph": graph(states, EDGES + more)}
            wheel.writestr(f"{DATA}init_and_final_graphs/{PLACE}{number}.json", json.dumps(pair))
            walk = [f"[Walk] {' '.join(steps[0].split(' ')[1:])}"] if steps else []
            text = "Watch TV\n\n\n\n" + "\n".join(walk + steps) + "\n"
            wheel.writestr(f"{DATA}executable_programs/{PLACE}{number}.txt", text)
        rows = [{"identifier": number, "llm_output": text} for number, text in answers.items()]
        wheel.writestr(f"{ROOT}llm_response/action_sequence/some-model_outputs.json", json.dumps(rows))
    return path


@pytest.fixture
def wheel(tmp_path):
    return Wheel(written(tmp_path / "small.whl"))


def judged(wheel, knowledge, task, text):
    return action_sequencing.judged(wheel, Answer(task, text), knowledge)


def test_a_wheel_is_read_in_place(wheel):
    assert list(wheel.tasks) == list(TASKS) == list(wheel.programs())
    assert wheel.tasks["2_1"].actions == ("GRAB", "TOUCH|WATCH") and wheel.tasks["3_1"].empty
    assert wheel.models("action_sequencing") == ("some-model",) and wheel.models("goal_interpretation") == ()
    assert wheel.gold("1_1")[0] == "[Walk] <television> (1.10)"


def test_what_is_no_wheel_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "other.whl", "w") as other:
        other.writestr("a.txt", "a")
    for path, code in ((tmp_path / "none.whl", "MISSING_FILE"), (tmp_path / "other.whl", "BAD_TABLE")):
        with pytest.raises(HearthError) as error:
            Wheel(path)
        assert str(error.value.diagnostics[0].code) == code


@pytest.mark.parametrize(
    ("text", "whole", "scored"),
    [
        ('{"WALK": ["a"], "WALK": ["b"]}', [("WALK", ["a"]), ("WALK", ["b"])], [("WALK", ["a"]), ("WALK", ["b"])]),
        ('{"STANDUP": [], "SIT": ["a"]}', [("STANDUP", []), ("SIT", ["a"])], [("SIT", ["a"])]),
        ("I would walk.", None, []),
        ('{"WALK": ["a"], "OPEN": ["b"', None, [("WALK", ["a"])]),
        ("{'WALK': ['a']}<|eot_id|>", [("WALK", ["a"])], [("WALK", ["a"])]),
        ('{"WALK": 3}', None, []),
        ("[" * 100_000, None, []),
    ],
)
def test_answers_as_they_are_and_as_the_scorer_reads_them(text, whole, scored):
    assert plan_of(text) == whole and plan_as_scored(text) == scored


@pytest.mark.parametrize(
    ("task", "text", "fault", "executed", "succeeds"),
    [
        ("1_1", "nothing", Fault.PARSING, False, False),
        ("1_1", '{"WALK": ["fridge"]}', Fault.HALLUCINATION, False, False),
        ("1_1", '{"FLY": ["television"]}', Fault.HALLUCINATION, False, False),
        ("1_1", ANSWERS["1_1"], Fault.HALLUCINATION, False, False),
        ("2_1", '{"WALK": ["cup", "table"]}', Fault.ARGUMENTS, False, False),
        ("2_1", '{"GRAB": ["cup"]}', Fault.MISSING_STEP, False, False),
        ("2_1", '{"WALK": ["cup"], "GRAB": ["cup"], "GRAB": ["cup"], "TOUCH": ["cup"]}', Fault.ADDITIONAL_STEP, True,
         False),
        ("2_1", ANSWERS["2_1"], None, True, True),
    ],
)  # fmt: skip
def test_verdicts_on_plans(wheel, knowledge, task, text, fault, executed, succeeds):
    found = judged(wheel, knowledge, task, text)
    assert found.faults == (() if fault is None else (fault,))
    assert (found.executed, found.succeeds) == (executed, succeeds)


def test_the_order_of_two_actions_decides_by_their_rules(wheel, knowledge):
    found = judged(wheel, knowledge, "2_1", ANSWERS["2_1"])
    assert found.reached and not found.reached_backwards and found.succeeds
    sums = action_sequencing.totals([found], wheel)
    assert (sums.success, sums.success_in_order, sums.success_ours) == (0.0, 100.0, 100.0)


def test_the_audit_names_each_kind_with_a_program(wheel, knowledge):
    goals = {(each.kind, each.task) for each in wrong_goals(wheel, knowledge)}
    assert {(EMPTY, "3_1"), (SEVERAL, "4_1")} <= goals
    found = {(each.kind, each.task): each for each in wrong_verdicts(wheel, knowledge, "some-model")}
    assert {(BY_HASH, "2_1")} <= found.keys() and (GOLD, "2_1") not in found
    assert found[BY_HASH, "2_1"].program == ("[WALK] <cup>", "[GRAB] <cup>", "[TOUCH] <cup>")
    assert not any(kind in (PASSED_OVER, PLUGS) for kind, _ in found)


def test_a_gold_plan_is_unsuccessful_by_their_rules(wheel, knowledge):
    text = '{"WALK": ["cup"], "GRAB": ["cup"]}'
    found = judged(wheel, knowledge, "2_1", text)
    assert found.is_gold and found.executed and not found.reached


def test_goal_interpretation_by_both_rules(wheel, knowledge):
    text = json.dumps({
        "node goals": [{"name": "cup", "state": "CLEAN"}, {"name": "sofa", "state": "ON"}, 3],
        "edge goals": [{"from_name": "character", "relation": "HOLDS_RH", "to_name": "cup"}],
        "action goals": [{"action": "look"}, {"action": "WATCH"}, {"action": "TOUCH"}],
    })  # fmt: skip
    theirs, ours = goal_interpretation.judged(wheel, Answer("2_1", text), knowledge)
    assert theirs["state"] == (0, 1, 0) and theirs["relation"] == (1, 0, 0)
    assert theirs["action"] == (2, 1, 0) and ours["action"] == (1, 2, 1)
    none, missed = goal_interpretation.judged(wheel, Answer("2_1", "no JSON"), knowledge)
    assert none is None and missed["action"] == (0, 0, 2)


GOLD_EFFECT = "(and (on ?o) (not (off ?o)) (forall (?far - object) (when (near ?far) (seen ?far))))"
KNOWN = dict.fromkeys(("on", "off", "near", "seen"), "object_states")


@pytest.mark.parametrize(
    ("text", "theirs", "ours"),
    [
        (GOLD_EFFECT, (4, 0, 0), (4, 0, 0)),
        ("(on ?o)", (0, 1, 4), (1, 0, 3)),
        ("(and (not (off ?o)) (on ?o))", (2, 0, 2), (2, 0, 2)),
        ("(and (forall (?x - object) (when (near ?x) (seen ?x))) (on ?o) (not (off ?o)))", (2, 3, 2), (4, 0, 0)),
        ("(and (on ?o)", (0, 0, 0), (0, 0, 4)),
        ("(" * 5_000 + ")" * 5_000, (0, 0, 0), (0, 0, 4)),
    ],
)
def test_operators_by_both_rules(text, theirs, ours):
    assert compared_as_scored(text, GOLD_EFFECT, KNOWN) == theirs
    assert compared(text, GOLD_EFFECT, KNOWN) == ours


@pytest.mark.parametrize(
    "text", ["(and\\n (on ?o) (not (off ?o)))", "(not (on ?o) (off ?o))", "((on ?o) (and (off ?o)))"]
)
def test_operators_that_are_not_well_formed_count_nothing_by_their_rules(text):
    assert compared_as_scored(text, GOLD_EFFECT, KNOWN) == (0, 0, 0)


def test_operators_of_an_answer():
    text = "(:action walk :parameters (?c) :precondition (and (a ?c)) :effect (near ?c)) (:action cut :parameters (?c"
    found = operators_of(json.dumps({"output": text}))
    assert list(found) == ["walk"] and found["walk"] == ("(and (a ?c))", "(near ?c)")


def test_an_answer_whose_output_is_no_text_is_left_out_by_their_rules():
    lines = ["(:action walk :parameters (?c)", ":precondition (a ?c)", ":effect (near ?c))"]
    assert operators_of(json.dumps({"output": lines})) == {"walk": ("(a ?c)", "(near ?c)")}
    assert left_out(json.dumps({"output": lines})) and not left_out(json.dumps({"output": " ".join(lines)}))
    assert not left_out("(:action walk")


def test_the_table_of_a_wheel_without_answers_is_refused(wheel, knowledge, tmp_path):
    rows = list(table(wheel, knowledge, abilities=["action_sequencing"]))
    assert rows[0]["model"] == "some-model" and rows[0]["published"] is None
    assert len(published()) == 15
    with pytest.raises(HearthError, match="no model"):
        list(table(wheel, knowledge, ["gpt-9"]))


@pytest.mark.parametrize(
    ("task", "steps"),
    [("1_1", ["Walk", "PlugIn", "SwitchOn"]), ("2_1", ["Walk", "Grab", "Touch"]), ("4_1", ["Walk", "Grab", "Walk"])],
)
def test_plans_that_run_and_reach_their_goal(wheel, knowledge, task, steps):
    program, reached = GoalPlanner(task_world(wheel, task, knowledge), knowledge).plan()
    assert reached and [step.action for step in program.steps] == steps


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_commands(tmp_path):
    path = written(tmp_path / "small.whl")
    result = call("challenge", "eai", "audit", path, "--model", "some-model")
    assert result.exit_code == 0 and "the goal asks for nothing" in result.output and "[GRAB] <cup>" in result.output
    page = tmp_path / "audit.md"
    result = call("challenge", "eai", "audit", path, "--model", "some-model", "--out", page)
    assert result.exit_code == 0 and "Task 2_1, Watch TV" in page.read_text() and "    [GRAB] <cup>" in page.read_text()
    result = call("challenge", "eai", "table", path, "--ability", "action_sequencing", "--json")
    assert result.exit_code == 0 and json.loads(result.output)["compared"] == 0
    assert call("challenge", "eai", "table", path, "--ability", "cooking").exit_code == 2
    result = call("challenge", "eai", "plan", path, "--out", tmp_path / "plans.json", "--json")
    assert json.loads(result.output)["reach_their_goal"] == 3
    assert json.loads((tmp_path / "plans.json").read_text())[0]["plan"][0] == "[Walk] <television> (1.10)"
    assert call("challenge", "eai", "table", tmp_path / "no.whl").exit_code == 1


@pytest.mark.slow
def test_every_published_figure_again():
    path = os.environ.get("HEARTH_EAI_WHEEL", "")
    if not Path(path).is_file():
        pytest.skip("HEARTH_EAI_WHEEL names no wheel of virtualhome-eval 0.1.1")
    result = call("challenge", "eai", "table", path, "--json")
    found = json.loads(result.output)
    assert found["compared"] == 90 and found["within_a_point"] == 86
    others = [row for row in found["rows"] if row["agrees"] is False]
    assert {row["ability"] for row in others} == {"subgoal_decomposition"}
    assert all(row["low"] <= row["published"] <= row["high"] and row["by_chance"] for row in others)
