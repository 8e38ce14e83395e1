"""Plans as Python: loops over literals are unrolled; what decides while it runs is refused, with the whole plan."""

import json

import pytest
from test_forms_of_text import programs

from hearth.kb.language.numbered_steps import parse_steps

CUPS = ["[Grab] <cup> (1)", "[PutBack] <cup> (1) <table> (1)"]
BODY = "        grab('cup')\n        put('cup', 'table')\n"


def plan(head, body=BODY, name="tidy"):
    return f"def {name}():\n    walk('table')\n    {head}\n{body}"


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        (plan("for i in range(2):"), [*CUPS, *CUPS]),
        (plan("for i in range(1, 5, 2):"), [*CUPS, *CUPS]),
        (plan("for _ in range(0):") + "    sleep()\n", ["[Sleep]"]),
        (plan("for x in ['cup', 'plate']:", "        grab(x)\n"), [CUPS[0], "[Grab] <plate> (1)"]),
        (plan('for x in ("cup",):', "        grab(x)\n"), CUPS[:1]),
        (plan("for x in ['cup', 'plate']: grab(x)", ""), [CUPS[0], "[Grab] <plate> (1)"]),
        (
            plan("for x in ['cup', 'mug']:", "        for y in ['desk', 'table']:\n            put(x, y)\n"),
            [f"[PutBack] <{x}> (1) <{y}> (1)" for x in ("cup", "mug") for y in ("desk", "table")],
        ),
        (plan("for i in [1, 2]:"), [*CUPS, *CUPS]),
        (plan("for i in (1, 2):", "        if True:\n            grab('cup')\n"), CUPS[:1] * 2),
        (plan("if True:"), CUPS),
        (plan("if True: grab('cup')", ""), CUPS[:1]),
        (plan("if (True):") + "    else:\n        fly('moon')\n    sleep()\n", [*CUPS, "[Sleep]"]),
        (plan("x = find('mug')", "    grab(x)\n"), ["[Find] <mug> (1)", "[Grab] <mug> (1)"]),
        (plan("cup = find('mug')", "    grab(cup)\n"), ["[Find] <mug> (1)", "[Grab] <mug> (1)"]),
        (plan("return sleep()", ""), ["[Sleep]"]),
    ],
)
def test_what_is_written_out_is_read(write, knowledge, text, steps):
    ((title, found, faults, _),) = programs(write, knowledge, text, "plan.py")
    assert (title, found, faults) == ("tidy", ["[Walk] <table> (1)", *steps], [])


@pytest.mark.parametrize(
    ("text", "lines"),
    [
        (plan("while dirty('cup'):"), [3]),
        (plan("while True:"), [3]),
        (plan("if cup.is_dirty:"), [3]),
        (plan("if False:"), [3]),
        (plan("if True and dirty:"), [3]),
        (plan("for i in [1, x]:"), [3]),
        (
            plan("if 'cup' in hands:") + "    else:\n        walk('sink')\n    for x in things:\n        grab(x)\n",
            [3, 8],
        ),
        (plan("try:") + "    except Exception:\n        walk('sink')\n", [3]),
        (plan("with hands:"), [3]),
        (plan("for x in things:"), [3]),
        (plan("for x, y in [('cup', 'sink')]:"), [3]),
        (plan("for i in range(n):"), [3]),
        (plan("for i in range(10_000):"), [3]),
        (plan("for i in range(2):", "        if i:\n            grab('cup')\n"), [4]),
        (plan("for i in range(2):", "        grab('cup')\n        break\n"), [5]),
        (plan("grab('cup') if x else grab('mug')", ""), [3]),
        (plan("grab('cup') and put('cup', 'table')", ""), [3]),
        (plan("[grab(x) for x in things]", ""), [3]),
        (plan("grab(f'{x}')", ""), [3]),
        (plan("tidy()", ""), [3]),
        (plan("return True", "    grab('cup')\n"), [3]),
        ("def tidy(thing):\n    walk('table')\n    grab(thing)\n", [3]),
        ("def fetch():\n    grab('cup')\n\ndef tidy():\n    walk('table')\n    fetch()\n    fetch()\n", [6, 7]),
        ("def tidy():\n    walk('table')\n    fetch()\n\ndef fetch():\n    grab('cup')\n", [3]),
        ("def fetch():\n    grab('cup')\n\nwalk('table')\nfetch()\nfetch()\n", [5, 6]),
        ("walk('table')\nfor x in things:\n    grab(x)\n", [2]),
    ],
)
def test_what_decides_while_it_runs_is_a_fault_and_leaves_no_program(write, knowledge, text, lines):
    ((_, steps, faults, _),) = programs(write, knowledge, text, "plan.py")
    assert (steps, faults) == ([], [("SYNTAX", line) for line in lines])


def test_the_fault_says_why_and_what_to_write(knowledge):
    (fault,) = parse_steps(plan("while dirty('cup'):"), 0, "plan.py", knowledge).faults
    assert (fault.line, fault.column, fault.found) == (3, 5, "while dirty('cup'):")
    assert "until something changes" in fault.message and "one below another" in fault.suggestion


@pytest.mark.parametrize(
    "tail", ["\ntidy()\n", "\nif __name__ == '__main__':\n    tidy()\n", "\n# run it\nrobot.tidy()\n"]
)
def test_a_function_that_the_code_starts_once_is_a_plan(write, knowledge, tail):
    ((title, steps, faults, _),) = programs(write, knowledge, plan("sleep()", "") + tail, "plan.py")
    assert (title, steps, faults) == ("tidy", ["[Walk] <table> (1)", "[Sleep]"], [])


def test_functions_that_only_stand_for_actions_are_no_plans(write, knowledge):
    text = "def walk(place):\n    pass\n\ndef sleep(): ...\n\n" + plan("sleep()", "")
    ((title, steps, faults, _),) = programs(write, knowledge, text, "plan.py")
    assert (title, steps, faults) == ("tidy", ["[Walk] <table> (1)", "[Sleep]"], [])


def test_functions_that_call_none_are_a_plan_each(write, knowledge):
    text = plan("sleep()", "") + "\n" + plan("grab('cup')", "", "fetch") + "\ntidy()\nfetch()\n"
    found = programs(write, knowledge, text, "plan.py")
    assert [(title, len(steps), faults) for title, steps, faults, _ in found] == [("tidy", 2, []), ("fetch", 2, [])]


def test_two_functions_in_one_record_are_refused(knowledge):
    text = plan("sleep()", "") + "\n" + plan("grab('cup')", "", "fetch")
    found = parse_steps(text, 0, "", knowledge)
    assert (found.program.steps, [fault.line for fault in found.faults]) == ((), [5])


@pytest.mark.parametrize("key", ["plan", "predicted", "answer"])
def test_a_loop_in_a_string_of_json_is_read_as_in_a_file(write, knowledge, key):
    code = "for i in range(2):\n    grab('cup')\n    put('cup', 'table')\n"
    text = json.dumps({"title": "Tidy", key: code}) + "\n"
    ((_, found, faults, _),) = programs(write, knowledge, text, "plans.jsonl")
    assert (found, faults) == ([*CUPS, *CUPS], [])
