"""JSON as language models, benchmarks and simulators write it: read as it means, or refused with a typed fault."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.commands import inputs
from hearth.kb.loading.load import default
from hearth.schemas.syntax import print_step
from hearth.storage.rejects import Reject


def programs(path, columns=""):
    """Title and steps of each program, and the code of each reject or fault."""
    found = []
    for given in inputs.read_programs(path, default(), path.name, columns):
        if isinstance(given, Reject):
            found.append(given.code)
        else:
            found.append((given.program.title, [print_step(step) for step in given.program.steps]))
            found += [str(fault.code) for fault in given.faults]
    return found


TEA = ["[Walk] <kettle> (1)", "[SwitchOn] <kettle> (1)"]
MAPPING = '{"WALK": ["kettle"], "SWITCHON": ["kettle"]}'
PLAN = "1. Walk to kettle\n2. Switch on kettle"
ASKED = {"role": "user", "content": "Tea"}
OBJECTS = [{"action": "Walk", "object": "kettle"}, {"action": "SwitchOn", "object": "kettle"}]
CALLED = [{"verb": "walk", "target": "kettle"}, {"verb": "switch_on", "args": ["kettle"]}]
CALLS = [
    {"type": "function", "function": {"name": name, "arguments": json.dumps({"object": "kettle"})}}
    for name in ("walk", "switch_on")
]


@pytest.mark.parametrize(
    ("value", "title"),
    [
        ({"title": "Tea", "steps": TEA}, "Tea"),
        ({"task": "Tea", "plan": OBJECTS}, "Tea"),
        ({"goal": "Tea", "actions": CALLED}, "Tea"),
        ({"tool_calls": CALLS}, ""),
        ({"messages": [ASKED, {"role": "assistant", "content": PLAN}]}, "Tea"),
        ({"conversations": [{"from": "system", "value": "You plan."}, {"from": "human", "value": "Task: Tea"},
                            {"from": "gpt", "value": PLAN}]}, "Tea"),
        ({"conversation": [ASKED, {"role": "assistant", "content": f"Sure:\n{PLAN}"}]}, "Tea"),
        ({"contents": [{"role": "user", "parts": [{"text": "Tea"}]},
                       {"role": "model", "parts": [{"text": PLAN}]}]}, "Tea"),
        ({"messages": [ASKED, {"role": "assistant", "content": None, "tool_calls": CALLS}]}, "Tea"),
        ({"prompt": "Tea", "completion": PLAN}, "Tea"),
        ({"identifier": "7", "llm_output": MAPPING}, ""),
        ({"identifier": "7", "llm_output": f"```json\n{MAPPING}\n```"}, ""),
        ({"identifier": "7", "llm_output": MAPPING.replace('"', "'")}, ""),
        ({"Tea": "Explanation: It is quick.\n\nPlan: 1. walk to kettle 2. switch on kettle 3. Done"}, "Tea"),
        ({"Tea": "Plan: 1. walk to kettle 2. switch on kettle 3. done."}, "Tea"),
        ({"instruction": "Tea", "step": ["Walk to kettle", "Switch on kettle"]}, "Tea"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("indent", [None, 4])
def test_forms_of_models(write, value, title, indent):
    assert programs(write("a.json", json.dumps(value, indent=indent))) == [(title, TEA)]
    assert programs(write("a.jsonl", 2 * f"{json.dumps(value)}\n"))[:1] == [(title, TEA)]


def test_output_of_a_batch_has_the_ids_of_its_requests(write):
    body = {"choices": [{"message": {"role": "assistant", "content": PLAN}}]}
    lines = [json.dumps({"custom_id": f"r{n}", "response": {"status_code": 200, "body": body}}) for n in (1, 2)]
    file = write("a.jsonl", "\n".join(lines))
    assert [steps for _, steps in programs(file)][:1] == [TEA]


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ('{"WALK": ["fridge"], "OPEN": ["fridge"], "WALK": ["milk"], "GRAB": ["milk"]}',
         ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Walk] <milk> (1)", "[Grab] <milk> (1)"]),
        ('{"WALK": ["sofa", "37"], "SIT": ["sofa", 37], "STANDUP": []}',
         ["[Walk] <sofa> (1.37)", "[Sit] <sofa> (1.37)", "[StandUp]"]),
        ('{\n  "PUTBACK": ["soap", "5", "sink", "6"]}', ["[PutBack] <soap> (1.5) <sink> (1.6)"]),
        ('{"WALK": ["chair", "8"], "WALK": ["chair", "9"]}', ["[Walk] <chair> (1.8)", "[Walk] <chair> (2.9)"]),
    ],
)  # fmt: skip
def test_a_mapping_of_actions_keeps_the_order_of_its_repeated_keys(write, text, steps):
    assert programs(write("a.json", text)) == [("", steps)]
    assert programs(write("b.jsonl", json.dumps({"llm_output": text}))) == [("", steps)]


@pytest.mark.parametrize(
    "cut", ['{"WALK": ["fridge"], "OPEN": ["fri', '```json\n{"WALK": ["fridge"],', "{'WALK': ['fridge'"]
)
def test_an_answer_that_is_cut_off_is_a_fault(write, cut):
    assert programs(write("a.jsonl", json.dumps({"id": "1", "output": cut}))) == ["BAD_JSON"]


@pytest.mark.parametrize(
    "value",
    [
        {"1_2": ["walk_towards", "put_on"], "2_1": ["open"]},
        {"wash": ["navigate_to sink_n_01_1 agent_n_01_1"]},
    ],
)
def test_names_of_actions_and_of_wordnet_are_no_programs(write, value):
    assert programs(write("a.json", json.dumps(value))) == ["UNSUPPORTED_FILE"]


ROOM = {"id": 1, "class_name": "kitchen", "category": "Rooms", "properties": [], "states": []}


@pytest.mark.parametrize("key", ["graph", "init_graph", "final_graph"])
def test_a_graph_in_a_wrapper_is_read(write, key):
    from hearth.homes.library import graph_of

    file = write("log.json", json.dumps({key: {"nodes": [ROOM], "edges": []}}, indent=2))
    assert [node.class_name for node in graph_of(file, default()).nodes] == ["kitchen"]
    assert programs(file) in ([], ["BAD_GRAPH"])


def test_a_release_has_no_programs_in_what_lies_beside_it(write):
    write("rel/pkg/README.md", "# Words\n1. Walk to kitchen\n2. Find food\n")
    write("rel/pkg/id2action.json", json.dumps({"1_2": ["Walk to kitchen", "Find food"]}))
    file = write("rel/executable_programs/results/file1_1.txt", "Nap\nRest.\n\n\n[WALK] <bed> (1)\n")
    found = programs(file.parents[2])
    assert all(isinstance(each, str) or each[0] == "Nap" for each in found)
    assert found.count("UNSUPPORTED_FILE") == 2


@pytest.mark.parametrize("text", ['{"nodes": [], "edges": []}', "[]", "Nap\n\n[Sleep]\n"])
def test_replay_says_what_it_takes(write, text):
    result = CliRunner().invoke(app, ["replay", str(write("a.json", text))])
    assert result.exit_code and ".jsonl" in result.output and "download" not in result.output


def test_columns_are_checked_and_those_of_json_are_printed(write):
    file = write("k.jsonl", '{"task":"A","plan":["Sleep"],"note":"x"}\n')
    result = CliRunner().invoke(app, ["check", str(file)])
    assert "program=plan, title=task" in result.stderr
    result = CliRunner().invoke(app, ["check", str(file), "--columns", "title=Task,program=Plans"])
    assert result.exit_code and "`task`" in result.output and "`plan`" in result.output
    assert programs(file, "title=note,program=plan") == [("x", ["[Sleep]"])]


def test_a_key_within_another_is_a_column(write):
    file = write("k.jsonl", '{"name":"A","answer":{"plan":"1. Walk to kettle\\n2. Switch on kettle"}}\n')
    assert programs(file, "program=answer.plan") == [("A", TEA)]


def test_two_keys_that_may_hold_a_program_are_a_warning(write):
    file = write("k.jsonl", '{"task":"A","plan":["Sleep"],"steps":["Wake up"],"program":["Sleep"]}\n')
    result = CliRunner().invoke(app, ["check", str(file)])
    assert "Warning" in result.stderr and "`steps` is taken" in result.stderr
    assert programs(file) == [("A", ["[WakeUp]"])]


def test_a_field_that_is_none_names_the_near_ones(write):
    result = CliRunner().invoke(app, ["check", str(write("x.csv", "task,plan\nA,Sleep\n")), "--columns", "titel=task"])
    assert "no field is called `titel`" in result.output and "did you mean `title`" in result.output


def test_keys_of_a_refusal_are_those_of_the_record(write):
    result = CliRunner().invoke(app, ["check", str(write("a.json", '{"task": "Nap", "colour": "red"}'))])
    assert "its keys are task, colour" in result.output


def test_one_bad_row_stops_nothing(write):
    rows = [
        '{"title": "A", "steps": ["Sleep"]}',
        "{",
        '{"title": 3, "steps": ["Sleep"]}',
        "7",
        '{"title": "B", "steps": ["Sleep"]}',
    ]
    assert [each if isinstance(each, str) else each[0] for each in programs(write("a.jsonl", "\n".join(rows)))] == [
        "A", "BAD_JSON", "BAD_JSON", "BAD_JSON", "B",
    ]  # fmt: skip
