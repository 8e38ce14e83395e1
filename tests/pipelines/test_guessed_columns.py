"""Tables whose columns no name explains, whose rows or columns are steps: read by what the cells say, and printed."""

from __future__ import annotations

import json

import pytest
from lamp_plan import CUP, LINES, read

from hearth.commands import inputs
from hearth.kb.language.action_keys import holds_object
from hearth.pipelines.readers import program_tables
from hearth.pipelines.readers.delimited import Rows
from hearth.pipelines.readers.table_heads import begun
from hearth.schemas.syntax import print_step


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


def test_another_column_that_reads_as_steps_is_said(write):
    path = write("a.csv", 'name,morning,evening\nAnn,"walk to lamp, sleep","lie on bed, sleep"\n')
    assert program_tables.table_of(path, {}).columns.rivals == {"program": ["evening"]}


def test_rows_of_a_task_without_numbers_are_steps_and_single_answers_are_not(write):
    text = "what,task,done\nWalk to lamp,Light,yes\nSwitch on lamp,Light,no\nSleep,Nap,yes\nStand up,Nap,\n"
    header, rest = text.split("\n", 1)
    programs, _ = read(write("a.csv", header.replace("what", "step") + "\n" + rest))
    assert [[step for _, step in steps] for _, steps in programs] == [LINES, ["[Sleep]", "[StandUp]"]]
    apart = "task,plan\nLight,Walk to lamp\nNap,Sleep\nLight,Switch on lamp\n"
    assert [len(steps) for _, steps in read(write("b.csv", apart))[0]] == [1, 1, 1]


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
