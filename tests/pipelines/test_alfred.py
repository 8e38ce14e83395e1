"""Trajectories of ALFRED: descriptions of people, and plans as programs that run and reach their goal."""

from __future__ import annotations

import json
import zipfile
from collections import Counter

import pytest

import hearth
from hearth.interop.alfred_goals import alfred_goal
from hearth.kb.loading.load import default
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.pipelines.readers.alfred_steps import UnreadableStepError, steps_of
from hearth.simulation.goal_trace import Trace
from hearth.simulation.rules import CONSEQUENCES
from hearth.storage.rejects import Reject

KNOWN = default()


def action(name, *args, index=0, **planned):
    return {"discrete_action": {"action": name, "args": list(args)}, "high_idx": index,
            "planner_action": {"action": name, **planned}}  # fmt: skip


def low(index, *names):
    return [{"api_action": {"action": name}, "high_idx": index} for name in names]


OVEN = ["Microwave", [1.0, 2.0, 3.0]]
HEATED = {
    "task_type": "pick_heat_then_place_in_recep",
    "pddl_params": {"object_target": "Apple", "parent_target": "GarbageCan", "mrecep_target": ""},
    "scene": {"floor_plan": "FloorPlan1"},
    "plan": {
        "high_pddl": [
            action("GotoLocation", "fridge"),
            action("PickupObject", "apple", index=1, objectId="Apple|1", coordinateReceptacleObjectId=["Fridge", [1]]),
            action("GotoLocation", "microwave", index=2),
            action("HeatObject", "apple", index=3, objectId="Microwave|1", coordinateReceptacleObjectId=OVEN),
            action("GotoLocation", "garbagecan", index=4),
            action("PutObject", "apple", "garbagecan", index=5, objectId="Apple|1",
                   coordinateReceptacleObjectId=["GarbageCan", [2]]),
            action("NoOp", index=6),
        ],
        "low_actions": [*low(1, "OpenObject", "PickupObject", "CloseObject"), *low(5, "PutObject")],
    },
    "turk_annotations": {"anns": [
        {"assignment_id": "A1", "task_desc": "Throw out a hot apple.", "high_descs": ["Go to it.", "Take it."]},
        {"assignment_id": "A2", "task_desc": "Heat an apple.", "high_descs": ["Walk to the fridge."]},
    ]},
}  # fmt: skip


def reads(path):
    return [row for _, item in items(labelled([str(path)])) for row in read(item, "s", "salt")]


def test_a_trajectory_is_a_program_and_a_description_for_each_annotator(tmp_path):
    (tmp_path / "traj_data.json").write_text(json.dumps(HEATED))
    program, further = reads(tmp_path / "traj_data.json")
    assert (program["kind"], further["kind"]) == ("program", "description")
    assert program["title"] == "Throw out a hot apple." and program["description"] == "Go to it. Take it."
    assert program["scene"] == "FloorPlan1"
    assert {"A1", "A2"}.isdisjoint({program["worker"], further["worker"]}) and program["worker"] != further["worker"]
    assert program["text"].splitlines()[:4] == ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Grab] <food_apple> (1)",
                                                "[Close] <fridge> (1)"]  # fmt: skip


def test_a_program_reaches_the_goal_of_its_task_that_did_not_hold_before():
    program = hearth.parse_program("\n".join(steps_of(HEATED["plan"], KNOWN)))
    home = hearth.home("maple", KNOWN.of_set(3))
    environment, execution = hearth.sample(program, home, 0, rules=CONSEQUENCES)
    goal, trace = hearth.read_goal(alfred_goal(HEATED, KNOWN), environment.world.home), Trace.of(execution)
    assert execution.executable and trace.reached(goal) and not trace.reached(goal, 0, 0)


def test_two_things_of_one_class_have_two_numbers():
    given = {"coordinateReceptacleObjectId": ["Desk", [1]]}
    high = [
        action(name, *args, objectId=key, **given)
        for key in ("Pen|1", "Pen|2")
        for name, args in (("PickupObject", ["pen"]), ("PutObject", ["pen", "desk"]))
    ]
    plan = {"low_actions": [], "high_pddl": high}
    assert steps_of(plan, KNOWN) == ["[Grab] <pen> (1)", "[PutBack] <pen> (1) <desk> (1)",
                                     "[Grab] <pen> (2)", "[PutBack] <pen> (2) <desk> (1)"]  # fmt: skip


def test_what_was_cut_is_the_same_thing():
    plan = {"low_actions": [], "high_pddl": [
        action("SliceObject", "bread", objectId="Bread|1|2"),
        action("PickupObject", "bread", objectId="Bread|1|2|BreadSliced_3")]}  # fmt: skip
    assert steps_of(plan, KNOWN)[-1] == "[Grab] <food_bread> (1)"


@pytest.mark.parametrize("plan, words", [
    ({}, "high_pddl"), ({"high_pddl": [3]}, "discrete_action"), ({"high_pddl": [action("Fly", "moon")]}, "Fly"),
    ({"high_pddl": [action("PickupObject", "rocket")]}, "rocket"),
    ({"high_pddl": [action("PutObject", "pen")]}, "receptacle"),
])  # fmt: skip
def test_a_plan_with_no_counterpart_is_refused_in_words(plan, words):
    with pytest.raises(UnreadableStepError, match=words):
        steps_of(plan, KNOWN)


@pytest.mark.parametrize("change", [
    {"turk_annotations": {}}, {"turk_annotations": {"anns": [3]}},
    {"turk_annotations": {"anns": [{"task_desc": 3, "high_descs": []}]}}, {"plan": {"high_pddl": [None]}},
])  # fmt: skip
def test_a_damaged_trajectory_is_a_reject(tmp_path, change):
    (tmp_path / "traj_data.json").write_text(json.dumps({**HEATED, **change}))
    found = reads(tmp_path / "traj_data.json")
    assert any(isinstance(row, Reject) for row in found)


def test_the_sample_is_read_whole(real_data):
    sample = real_data / "alfred-sample.zip"
    if not sample.is_file():
        pytest.skip(f"no sample of ALFRED in {real_data}")
    rows = reads(sample)
    kinds = Counter("reject" if isinstance(row, Reject) else row["kind"] for row in rows)
    with zipfile.ZipFile(sample) as archive:
        said = sum(len(json.loads(archive.read(name))["turk_annotations"]["anns"]) for name in archive.namelist())
    assert kinds["program"] + kinds["description"] == said >= 1800
    assert kinds["program"] >= 580 and kinds["program"] + kinds["reject"] == 600
