"""Steps in JSON, YAML, HTML and XML, under any keys and in any nesting: read with their titles and places."""

from __future__ import annotations

import json

import pytest
from lamp_plan import CUP, LAMP, LINES, read

from hearth.commands import inputs
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError

ROWS = [{"task": "Light", "step": 1, "text": LAMP[0]}, {"task": "Light", "step": 2, "text": LAMP[1]},
        {"task": "Nap", "step": 1, "text": "Sleep"}]  # fmt: skip


@pytest.mark.parametrize(
    "rows",
    [
        ROWS,
        [{"task_id": row["task"], "step_id": row["step"], "instruction": row["text"]} for row in ROWS],
        [{"goal": row["task"], "index": row["step"], "action": row["text"]} for row in ROWS],
    ],
)
def test_lines_of_json_with_a_step_each_are_joined(write, rows):
    programs, faults = read(write("a.jsonl", "".join(json.dumps(row) + "\n" for row in rows)))
    assert [steps for _, steps in programs] == [[(1, LINES[0]), (2, LINES[1])], [(3, "[Sleep]")]] and not faults
    listed, _ = read(write("a.json", json.dumps(rows)))
    assert [[step for _, step in steps] for _, steps in listed] == [LINES, ["[Sleep]"]]


def numbered(template):
    return {template.format(n): step for n, step in enumerate(LAMP, 1)}


@pytest.mark.parametrize(
    "record",
    [
        {"task": "Light", **numbered("step{}")},
        {"task": "Light", **numbered("Step {}")},
        {"task": "Light", "plan": numbered("{}")},
        {"task": "Light", "plan": {"steps": LAMP}},
        {"task": "Light", "plan": [{"step": n, "text": text} for n, text in enumerate(LAMP)]},
        {"task": "Light", "steps": [{"step": n, "description": text} for n, text in enumerate(LAMP)]},
        {"task": "Light", "steps": [{"id": n, "instruction": text} for n, text in enumerate(LAMP)]},
        {"task": "Light", "steps": [{"step_number": n, "content": text, "why": "so"} for n, text in enumerate(LAMP)]},
        {"task": "Light", "steps": [{"text": text} for text in LAMP]},
        {"task": "Light", "plan": [{"action": "walk", "arg1": "lamp"}, {"action": "switch_on", "arg1": "lamp"}]},
        {"task": "Light", "plan": [{"verb": "walk", "args": ["lamp"]}, {"verb": "switch on", "args": ["lamp"]}]},
        {"task": "Light", "plan": [{"name": "walk", "arguments": {"object": "lamp"}},
                                   {"name": "switch_on", "arguments": {"object": "lamp"}}]},
        {"task": "Light", "plan": [["walk", "lamp"], ["switch_on", "lamp"]]},
        {"task": "Light", "steps": "1. Walk to lamp 2. Switch on lamp"},
        {"task": "Light", "steps": ["(walk_towards character lamp)", "(switch_on character lamp)"]},
        {"task": "Light", "schritte": LAMP},
        {"task": "Light", "by": "w_1", "so": "Walk to lamp; Switch on lamp"},
    ],
)  # fmt: skip
def test_steps_of_a_record_by_other_keys(write, record):
    for name, text in (("a.json", json.dumps(record)), ("a.jsonl", json.dumps(record) + "\n" + json.dumps(record))):
        programs, faults = read(write(name, text))
        assert {(title, *(step for _, step in steps)) for title, steps in programs} == {
            ("Light", *LINES)
        } and not faults


@pytest.mark.parametrize(
    "value",
    [
        {"data": {"title": "Light", "steps": LAMP}},
        {"plan": {"title": "Light", "steps": LAMP}},
        {"plans": [{"id": 1, "task": "Light", "plan": LAMP}, {"id": 2, "task": "Light", "plan": LAMP}]},
        {"1": {"title": "Light", "steps": LAMP}, "2": {"title": "Light", "steps": LAMP}},
        {"Light": {"1": LAMP[0], "2": LAMP[1]}},
    ],
)
def test_the_title_beside_nested_steps_is_theirs(write, value):
    programs, faults = read(write("a.json", json.dumps(value)))
    assert {(title, *(step for _, step in steps)) for title, steps in programs} == {("Light", *LINES)} and not faults


@pytest.mark.parametrize(
    ("action", "names", "step"),
    [
        ("put_on", ["cup", "table"], "[PutBack] <cup> (1) <table> (1)"),
        ("put_on", ["shoes"], "[PutOn] <shoes> (1)"),
        ("pour_into", ["milk", "glass"], "[Pour] <milk> (1) <glass> (1)"),
        ("take_from", ["milk", "fridge"], "[Grab] <milk> (1)"),
        ("walk_to", ["kitchen"], "[Walk] <kitchen> (1)"),
    ],
)
def test_a_word_between_two_objects_is_read_there(write, action, names, step):
    programs, faults = read(write("a.json", json.dumps({"plan": [{"action": action, "args": names}]})))
    assert [[step for _, step in steps] for _, steps in programs] == [[step]] and not faults


def test_lists_under_numbers_are_programs(write):
    programs, faults = read(write("a.json", json.dumps({"1": LAMP, "2": ["Sleep"]})))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES, ["[Sleep]"]] and not faults


@pytest.mark.parametrize("key", ["steps", "program"])
def test_an_unknown_action_among_known_ones_is_a_fault_and_no_title(write, key):
    steps = [{"action": "tickle", "object": "lamp"}, {"action": "switch_on", "object": "lamp"}]
    programs, faults = read(write("a.json", json.dumps({key: steps}, indent=1)))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES[1:]] and faults == [("NOT_UNDERSTOOD", 4)]
    assert "tickle" not in programs[0][0]


@pytest.mark.parametrize(
    "steps",
    [
        [["goto", "kitchen"], ["pickup", "cup"], ["PLACE", "cup", "table"], ["turnon", "lamp"]],
        [{"action": "GoTo", "object": "kitchen"}, {"action": "PickUp", "object": "cup"},
         {"action": "put", "object": "cup", "target": "table"}, {"action": "toggle_on", "object": "lamp"}],
        [{"skill": "navigate", "params": {"to": "kitchen"}}, {"skill": "pick", "params": {"object": "cup"}},
         {"skill": "place", "params": ["cup", "table"]}, {"skill": "switch on", "params": {"object": "the lamp"}}],
        [{"goto": "kitchen"}, {"pick": "cup"}, {"place": ["cup", "table"]}, {"turn_on": "lamp"}],
        [{"verb": "goto", "noun": "kitchen"}, {"verb": "take", "noun": "cup", "from": "fridge"},
         {"verb": "put", "noun": "cup", "on": "table"}, {"verb": "activate", "noun": "lamps"}],
    ],
)  # fmt: skip
def test_actions_as_programs_name_them(write, steps):
    programs, faults = read(write("a.json", json.dumps({"title": "A", "plan": steps})))
    assert [[step for _, step in steps] for _, steps in programs] == [CUP] and not faults


@pytest.mark.parametrize(("place", "step"), [("fridge", "PutIn"), ("table", "PutBack"), ("bowl", "PutIn")])
def test_what_is_put_goes_in_what_is_hollow_and_on_what_is_flat(write, place, step):
    value = {"title": "A", "plan": [{"action": "put", "args": ["milk", place]}, {"action": "put", "object": "cup"}]}
    programs, faults = read(write("a.json", json.dumps(value, indent=1)))
    assert [line for _, line in programs[0][1]] == [f"[{step}] <milk> (1) <{place}> (1)"]
    assert [code for code, _ in faults] == ["NOT_UNDERSTOOD"]


def test_answers_in_lists_have_the_title_that_stands_above_them(write):
    answers = [{"index": 0, "generated": "1. walk to lamp\n2. switch on lamp"}, {"index": 1, "generated": "1. sleep"}]
    nested = {"model": "m", "data": [{"task": "Light", "outputs": answers}]}
    listed = {"prompt": "Light", "outputs": [["walk to lamp", "switch on lamp"], ["lie on bed", "sleep"]]}
    for value in (nested, listed):
        programs, faults = read(write("a.json", json.dumps(value)))
        assert [title for title, _ in programs] == ["Light", "Light"] and not faults
        assert [step for _, step in programs[0][1]] == LINES
    named = {"name": "my runs", "data": [{"steps": ["Sleep"]}, {"steps": ["Sleep"]}]}
    assert "my runs" not in [title for title, _ in read(write("b.json", json.dumps(named)))[0]]


def test_a_list_of_actions_is_one_program_with_the_name_of_its_file(write):
    steps = [{"verb": "GoTo", "noun": "lamp"}, {"verb": "tickle", "noun": "lamp"}, {"verb": "turnon", "noun": "lamp"}]
    programs, faults = read(write("night_light.json", json.dumps(steps, indent=1)))
    assert [(title, [step for _, step in steps]) for title, steps in programs] == [("night light", LINES)]
    assert faults == [("NOT_UNDERSTOOD", 7)]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "a.html",
            "<!DOCTYPE html>\n<h1>Light</h1>\n<ul>\n<li>Walk to lamp</li><li>Switch on lamp</li>\n</ul>\n",
        ),
        (
            "a.xml",
            '<?xml version="1.0"?>\n<plan task="Light">\n<step>Walk to lamp</step>\n<step>Switch on lamp</step>',
        ),
    ],
)
def test_steps_that_html_and_xml_mark_are_read(write, name, text):
    programs, faults = read(write(name, text))
    assert [(title, [step for _, step in steps]) for title, steps in programs] == [("Light", LINES)] and not faults


def test_an_object_of_plans_on_a_line_each_loses_none(write):
    plans = {"light": "walk to lamp, switch on lamp", "nap": "lie on bed, sleep"}
    for value in (plans, {"tasks": plans}):
        programs, faults = read(write("a.json", json.dumps(value)))
        assert [title for title, _ in programs] == ["light", "nap"] and not faults
        assert [step for _, step in programs[0][1]] == LINES


def test_comments_in_json_keep_the_places_of_steps(write):
    text = '// "notes"\n{ // of\n"title": "A", /* the\n first */ "steps": ["Sleep", "tickle lamp",], // all\n}\n'
    for given in (text, text.replace("{", "[{", 1).replace("\n}", "\n}]")):
        programs, faults = read(write("a.json", given))
        assert programs == [("A", [(4, "[Sleep]")])] and faults == [("NOT_UNDERSTOOD", 4)]


def test_pairs_of_an_action_and_its_object_are_steps_also_beside_one_that_is_not_known(write):
    value = {"title": "A", "llm_output": [["WALK", "lamp"], ["REBOOT", "lamp"], ["SWITCHON", "lamp"]]}
    programs, faults = read(write("a.json", json.dumps(value, indent=1)))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES] and faults == [("NOT_UNDERSTOOD", 9)]


@pytest.mark.parametrize(("text", "line"), [('[\n{"title": "A", "steps": ["Sleep"]},\n{"title": "B",,}\n]', 3),
                                            ('{"title": "A", "steps": ["Sleep"]}\n{"title": NaN}\n', 2)])  # fmt: skip
def test_a_record_that_is_no_json_is_one_fault_at_its_place(write, text, line):
    programs, faults = read(write("a.json", text))
    assert [title for title, _ in programs] == ["A"] and faults == [("BAD_JSON", line)]


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        ("- Walk to lamp\n- Switch on lamp\n", [1, 2]),
        ("Light:\n  - Walk to lamp\n  - 'Switch on lamp'\n", [2, 3]),
        ("# plans\n- title: Light\n  steps:\n    - Walk to lamp\n    - Switch on lamp\n", [4, 5]),
        ("task: Light\nplan:\n  1: Walk to lamp\n  2: Switch on lamp\n", [3, 4]),
        ("task: Light\nplan:\n- step: 1\n  text: Walk to lamp\n- step: 2\n  text: Switch on lamp\n", [4, 6]),
        ("task: Light\nplan: |\n  1. Walk to lamp\n  2. Switch on lamp\n", [3, 4]),
        ("task: Light\nplan:\n- {action: walk, object: lamp}\n- {action: switch_on, object: lamp}\n", [3, 4]),
    ],
)
def test_plans_in_yaml_are_read_as_those_in_json(write, text, lines):
    programs, faults = read(write("Light.yaml", text))
    assert programs == [("Light", list(zip(lines, LINES, strict=True)))] and not faults


def test_a_fault_in_yaml_stands_at_its_place(write):
    file = write("a.yaml", "task: Light\nplan: |\n   1. Walk to lamp\n   2. Yodel\n")
    (given,) = inputs.read_programs(file, default(), file.name)
    assert [(fault.line, fault.column) for fault in given.faults] == [(4, 7)]
    assert read(write("b.yaml", "task: Light\nplan: [Walk to lamp\n"))[1] == [("BAD_TABLE", 3)]


@pytest.mark.parametrize(
    ("name", "text", "form"),
    [
        ("settings.yaml",
         "name: CI\ndescription: Build\njobs:\n  build:\n    steps:\n    - name: x\n      run: y\n", "YAML"),
        ("a.html", "<!DOCTYPE html>\n<div>Walk to lamp</div>\n", "HTML"),
        ("a.xml", '<?xml version="1.0"?>\n<plan><step>Walk to lamp</step></plan>\n', "XML"),
        ("a.txt", "{\\rtf1 Walk to lamp}\n", "RTF"),
    ],
)  # fmt: skip
def test_a_form_that_is_not_read_is_named(write, name, text, form):
    with pytest.raises(HearthError) as error:
        read(write(name, text))
    assert [fault.code for fault in error.value.diagnostics] == ["UNSUPPORTED_FILE"] and form in str(error.value)


def test_an_alias_that_stands_for_much_is_refused(write):
    text = "a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
        f"{new}: &{new} [{', '.join([f'*{old}'] * 10)}]\n" for old, new in zip("abcdefg", "bcdefgh", strict=True)
    )
    assert read(write("a.yaml", text)) == ([], [("FILE_TOO_LARGE", 1)])


@pytest.mark.parametrize(
    "value",
    [
        {"task": "Light", "response": {"plan": LAMP}},
        {"task": "Light", "response": {"content": "1. Walk to lamp\n2. Switch on lamp"}},
        {"runs": {"one": {"goal": "Light", "trajectory": LAMP}, "two": {"goal": "Light", "trajectory": LAMP}}},
        {"Light": {"description": "Evening.", "steps": LAMP}, "light": {"title": "Light", "steps": LAMP}},
        {"task": "Light", "plan": [{"walk": "lamp"}, {"switch_on": ["lamp"]}]},
        {"high_level_goal": "Light", "low_level_plan": LAMP},
    ],
)
def test_a_record_within_an_object_has_the_title_beside_it(write, value):
    programs, faults = read(write("a.json", json.dumps(value)))
    assert {(title, *(step for _, step in steps)) for title, steps in programs} == {("Light", *LINES)} and not faults


def test_an_object_among_records_that_is_none_is_a_fault(write):
    value = {"runs": [{"goal": "Light", "plan": LAMP}, {"goal": "Nap", "answer": None}]}
    programs, faults = read(write("a.json", json.dumps(value, indent=1)))
    assert [title for title, _ in programs] == ["Light"] and [code for code, _ in faults] == ["EMPTY"]


def test_calls_of_tools_among_the_parts_of_a_message(write):
    used = [{"type": "tool_use", "name": name, "input": {"object": "lamp"}} for name in ("walk", "switch_on")]
    programs, faults = read(write("a.json", json.dumps({"role": "assistant", "content": used})))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES] and not faults
