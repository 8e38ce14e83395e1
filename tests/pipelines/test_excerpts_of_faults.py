"""Excerpts of faults: the text at the place is shown and underlined, however far right, folded or doubled it is."""

import json

import pytest

from hearth.commands import grouped_faults, output
from hearth.commands.inputs import read_programs
from hearth.schemas.text_decoding import decode

STEPS = ["walk to the kitchen"] * 18 + ["fly to the moon", "grab the blorb"]
NUMBERED = " ".join(f"{number}. {step}" for number, step in enumerate(STEPS, 1))


def faults(write, knowledge, name, text):
    (given,) = read_programs(write(name, text), knowledge, name)
    return given.faults


def underlined(fault):
    """The words above the marks that a terminal shows."""
    *_, source, marks = output.explain(fault).split("\n")
    start = marks.index("^")
    return source[start : start + marks.count("^")]


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.txt", f"Task: Long\nPlan: {NUMBERED}\n"),
        ("b.txt", "Task: Long\n" + "; ".join(STEPS) + "\n"),
        ("c.csv", 'task,plan\nLong,"' + "; ".join(STEPS) + '"\n'),
        ("d.json", json.dumps({"task": "Long", "plan": "; ".join(STEPS)})),
        ("e.jsonl", json.dumps({"task": "Long", "plan": NUMBERED}) + "\n"),
        ("f.yaml", "task: Long\nplan: " + "; ".join(STEPS) + "\n"),
        ("g.py", "walk('kitchen')\n" + " " * 230 + "fly('moon')\n"),
    ],
)
def test_the_words_at_a_far_place_are_shown(write, knowledge, name, text):
    found = faults(write, knowledge, name, text)
    assert found and all(fault.column > 200 for fault in found)
    for fault in found:
        shown = underlined(fault)
        assert shown.strip() and text.split("\n")[fault.line - 1][fault.column - 1 :].startswith(shown)


def test_different_words_at_far_places_are_no_equal_faults(write, knowledge):
    text = "Task: Long\n" + "; ".join([*STEPS[:18], "polish the moon", "dust the moon"]) + "\n"
    found = faults(write, knowledge, "a.txt", text)
    assert len(found) == 2 and len(grouped_faults.groups(found)) == 2


@pytest.mark.parametrize(
    "text",
    [
        "task: Tea\nplan: >\n  Walk to the kitchen.\n  Fly to the moon.\n",
        "task: Tea\nplan: >-\n    Walk to the kitchen.\n    Fly to the moon.\n",
        "task: Tea\nplan: >-\n  1. Walk to the kitchen\n\n  2. Fly to the moon\n",
        "task: Tea\nplan: >+\n  1. Walk to the kitchen\n\n\n  2. Fly to the moon\n\n",
        "task: Tea\nplan: |\n  Walk to the kitchen\n  Fly to the moon\n",
        "task: Tea\nplan: Walk to the kitchen.\n  Fly to the moon.\n",
        'task: Tea\nplan: "Walk to the kitchen.\n  Fly to the moon."\n',
        "- task: Tea\n  plan: >\n    Walk to the kitchen.\n    Fly to the moon.\n",
    ],
)
def test_a_fault_in_joined_lines_of_yaml_stands_in_its_own_line(write, knowledge, text):
    (fault,) = faults(write, knowledge, "a.yaml", text)
    lines = str(decode(text.encode(), "")).split("\n")
    assert fault.line == next(n for n, line in enumerate(lines, 1) if "Fly" in line)
    assert lines[fault.line - 1][fault.column - 1 :].startswith(("Fly to the moon", "2. Fly"))


@pytest.mark.parametrize("line", ['("grab", "blorb", "zork")', '("put", "blorb", "zork")', '["fly", "blorb"]'])
def test_a_tuple_of_python_has_one_fault(write, knowledge, line):
    text = f'plan = [\n  ("walk", "kitchen"),\n  {line},\n  ("open", "fridge"),\n]\n'
    (fault,) = faults(write, knowledge, "a.py", text)
    assert (fault.line, fault.column, underlined(fault)) == (3, 3, f"{line},")


def test_a_call_has_one_fault(write, knowledge):
    (fault,) = faults(write, knowledge, "a.py", "walk('kitchen')\nput('blorb', 'zork')\nopen('fridge')\n")
    assert (fault.line, fault.code) == (2, "UNKNOWN_OBJECT")
