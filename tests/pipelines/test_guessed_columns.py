"""Tables whose columns no name explains, whose rows or columns are steps: read by what the cells say, and printed."""

from __future__ import annotations

import json

import pytest

from hearth.commands import inputs
from hearth.kb.language.action_keys import holds_object
from hearth.kb.loading.load import default
from hearth.pipelines.readers import program_tables
from hearth.pipelines.readers.delimited import Rows
from hearth.pipelines.readers.table_heads import begun
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import print_step
from hearth.storage.rejects import Reject


def read(path, columns=""):
    """Title, and line and step of each step, of the programs of a file; code and line of each fault."""
    programs, faults = [], []
    for given in inputs.read_programs(path, default(), path.name, columns):
        if isinstance(given, Reject):
            faults += [(fault.code, fault.line) for fault in given.diagnostics]
            continue
        steps = zip(given.program.lines, map(print_step, given.program.steps), strict=True)
        programs.append((given.program.title, list(steps)))
        faults += [(fault.code, fault.line) for fault in given.faults]
    return programs, faults


LAMP = ["Walk to lamp", "Switch on lamp"]
LINES = ["[Walk] <lamp> (1)", "[SwitchOn] <lamp> (1)"]


@pytest.mark.parametrize(
    ("name", "text", "columns"),
    [
        ("a.csv",
         "who,aufgabe,so geht es\nw_12,Light,Walk to lamp; Switch on lamp\n", "program=so geht es, title=aufgabe"),
        ("a.csv", 'Household task,Typed by\nLight,"- Walk to lamp\n- Switch on lamp"\n', "program=Typed by"),
        ("a.tsv", "nr\tTodo\tHow\n1\tLight\tWalk to lamp; Switch on lamp\n", "program=How, title=Todo"),
        ("a.csv",
         "Task;Schritte;Ort\nLight;Walk to lamp -> Switch on lamp;Living room\n", "title=Task, program=Schritte"),
    ],
)  # fmt: skip
def test_a_column_that_reads_as_steps_is_the_program_and_printed(write, capsys, name, text, columns):
    programs, faults = read(write(name, text))
    assert [(title, [step for _, step in steps]) for title, steps in programs] == [("Light", LINES)] and not faults
    printed = capsys.readouterr().err
    assert columns in printed and "its cells read as steps" in printed


def test_a_column_of_another_language_is_not_guessed(write):
    programs, faults = read(write("a.csv", "x,y\nLampe,Zur Lampe gehen; Lampe anschalten\n"))
    assert (programs, faults) == ([], [("BAD_TABLE", 1)])


def test_a_column_of_single_sentences_is_not_the_program(write):
    programs, faults = read(write("a.csv", "x,y\nA1,Walk to lamp\nA2,Find lamp\n"))
    assert (programs, faults) == ([], [("BAD_TABLE", 1)])


STEPS = [("Light", [(2, LINES[0]), (3, LINES[1])]), ("Nap", [(4, "[Sleep]")])]


@pytest.mark.parametrize(
    "text",
    [
        "task,step,instruction\nLight,1,Walk to lamp\nLight,2,Switch on lamp\nNap,1,Sleep\n",
        "id,activity,step_no,step_text\n1,Light,1,Walk to lamp\n2,Light,2,Switch on lamp\n3,Nap,1,Sleep\n",
        "Task,Step #,What\nLight,1,Walk to lamp\n,2,Switch on lamp\nNap,1,Sleep\n",
        "task,no,action\nLight,1,Walk to lamp\nLight,2,Switch on lamp\nNap,1,Sleep\n",
        "title,action,object\nLight,walk,lamp\nLight,switch_on,lamp\nNap,sleep,\n",
        "title,step,verb,arg1\nLight,1,walk,lamp\nLight,2,switch_on,lamp\nNap,1,sleep,\n",
    ],
)
def test_rows_of_one_task_are_one_program(write, capsys, text):
    programs, faults = read(write("a.csv", text))
    assert programs == STEPS and not faults
    assert "Columns of a.csv" in capsys.readouterr().err


def test_a_row_of_steps_that_cannot_be_read_costs_its_step(write):
    text = "task,step,instruction\nLight,1,Walk to lamp\nLight,2,Dance,badly\nLight,3,Yodel\nLight,4,Switch on lamp\n"
    programs, faults = read(write("a.csv", text))
    assert programs == [("Light", [(2, LINES[0]), (5, LINES[1])])]
    assert sorted(faults, key=lambda fault: fault[1]) == [("BAD_TABLE", 3), ("NOT_UNDERSTOOD", 4)]


def test_answers_of_several_people_to_one_task_are_no_steps(write):
    text = 'no,task,plan\n1,Light,"Walk to lamp; Switch on lamp"\n2,Light,"Find lamp; Switch on lamp"\n'
    assert [len(steps) for _, steps in read(write("a.csv", text))[0]] == [2, 2]


@pytest.mark.parametrize("names", ["step1,step2,step3", "Step 1,Step 2,Step 3", "1,2,3", "action_0,action_1,action_2"])
def test_columns_of_steps_are_one_program_a_row(write, names):
    text = f"task,{names}\nLight,Walk to lamp,Switch on lamp,\nNap,Sleep,,\nNothing,,,\n"
    programs, faults = read(write("a.csv", text))
    assert programs == [("Light", [(2, LINES[0]), (2, LINES[1])]), ("Nap", [(3, "[Sleep]")])]
    assert faults == [("EMPTY", 4)]


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


CUP = ["[Walk] <kitchen> (1)", "[Grab] <cup> (1)", "[PutBack] <cup> (1) <table> (1)", "[SwitchOn] <lamp> (1)"]


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


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.csv", ",step\n0,walk to kitchen\n1,grab the cup\n2,put the cup on the table\n3,turn on the lamp\n"),
        ("a.csv", "action\nwalk to kitchen\ngrab the cup\nput the cup on the table\nturn on the lamp\n"),
        ("a.tsv", "id\tverb\tobject\ttarget\n1\tgoto\tkitchen\t\n2\tpick\tcup\t\n3\tput\tcup\ttable\n"
                  "4\tturnon\tlamp\t\n"),
    ],
)  # fmt: skip
def test_rows_of_one_step_without_a_task_are_one_program(write, name, text):
    programs, faults = read(write(name, text))
    assert [[step for _, step in steps] for _, steps in programs] == [CUP] and not faults


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ('0,Light,"walk to lamp, switch on lamp"\n1,Nap,"lie on bed, sleep"\n', [("Light", [1, 1]), ("Nap", [2, 2])]),
        ('1,Light,"1. walk to lamp\n2. switch on lamp"\n2,Nap,"1. sleep"\n', [("Light", [1, 2]), ("Nap", [3])]),
        ("Light;walk to lamp -> switch on lamp\nNap;lie on bed -> sleep\n", [("Light", [1, 1]), ("Nap", [2, 2])]),
        ("walk,lamp\nswitchon,lamp\n", [("", [1, 2])]),
    ],
)
def test_a_table_without_names_of_columns_loses_no_row(write, text, found):
    programs, faults = read(write("a.csv", text))
    assert [(title, [line for line, _ in steps]) for title, steps in programs] == found and not faults
    assert [step for _, step in programs[0][1]] == LINES


def test_a_plan_after_the_words_that_say_so_is_a_plan(write):
    text = 'user,text\n@ann,"my plan: walk to lamp, switch on lamp"\n@bob,"Todays plan: sleep, rule the world, sleep"\n'
    programs, faults = read(write("a.csv", text))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES, ["[Sleep]", "[Sleep]"]]
    assert faults == [("NOT_UNDERSTOOD", 3)] and not any("@" in title for title, _ in programs)
    prose = read(write("b.csv", "task,text\nLight,I walk to the lamp and switch on the lamp.\n"))
    assert prose == ([], [])


@pytest.mark.parametrize("first", ["open,close", "find,object", "1,2", "0,title", "walk,time"])
def test_names_of_columns_that_are_like_actions_are_no_row(write, first):
    assert [line for line, _, _ in table_lines(write("a.csv", f"{first}\nx,y\n"))] == [2]


def table_lines(path):
    rows = Rows(path)
    _, layout, _ = begun(rows, {})
    return list(rows.parsed(layout))


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


def test_another_column_that_reads_as_steps_is_said(write):
    path = write("a.csv", 'name,morning,evening\nAnn,"walk to lamp, sleep","lie on bed, sleep"\n')
    assert program_tables.table_of(path, {}).columns.rivals == {"program": ["evening"]}


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
        ("a.html", "<!DOCTYPE html>\n<ol><li>Walk to lamp</li></ol>\n", "HTML"),
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


def test_rows_of_a_task_without_numbers_are_steps_and_single_answers_are_not(write):
    text = "what,task,done\nWalk to lamp,Light,yes\nSwitch on lamp,Light,no\nSleep,Nap,yes\nStand up,Nap,\n"
    header, rest = text.split("\n", 1)
    programs, _ = read(write("a.csv", header.replace("what", "step") + "\n" + rest))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES, ["[Sleep]", "[StandUp]"]]
    apart = "task,plan\nLight,Walk to lamp\nNap,Sleep\nLight,Switch on lamp\n"
    assert [len(steps) for _, steps in read(write("b.csv", apart))[0]] == [1, 1, 1]


def test_calls_of_tools_among_the_parts_of_a_message(write):
    used = [{"type": "tool_use", "name": name, "input": {"object": "lamp"}} for name in ("walk", "switch_on")]
    programs, faults = read(write("a.json", json.dumps({"role": "assistant", "content": used})))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES] and not faults


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("target_object", "destination_object"),
        ("object_name", "target_receptacle"),
        ("primary object", "secondary object"),
        ("source_item", "target_location"),
        ("first_obj", "second_obj"),
    ],
)
def test_columns_of_several_words_name_the_objects_of_a_step(write, knowledge, first, second):
    text = f"title,step,action,{first},{second}\nTea,1,walk,kitchen,\nTea,2,put,cup,table\n"
    steps = ["[Walk] <kitchen> (1)", "[PutBack] <cup> (1) <table> (1)"]
    records = [{"action": "walk", first: "kitchen"}, {"action": "put", first: "cup", second: "table"}]
    value = json.dumps([{"title": "Tea", "plan": records}])
    for name, content in (("a.csv", text), ("a.json", value)):
        (given,) = inputs.read_programs(write(name, content), knowledge, name)
        assert ([print_step(step) for step in given.program.steps], given.faults) == (steps, ())


@pytest.mark.parametrize("name", ["object_id", "target_time", "from_home", "item_price", "where_from_here"])
def test_other_columns_of_several_words_name_none(name):
    assert not holds_object(name)
