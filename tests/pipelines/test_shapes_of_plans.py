"""Plans in many shapes: each is read, or what is not is refused, and nothing becomes another step."""

import json
from pathlib import Path

import pytest

from hearth.commands.inputs import read_programs
from hearth.kb.language.counted_lines import counting_of
from hearth.kb.language.forms.log_heads import head_of
from hearth.kb.language.operator_step_syntax import operator_step
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import print_step
from hearth.storage.rejects import Reject

LAMP = ["[Walk] <desk> (1)", "[Find] <lamp> (1)", "[SwitchOn] <lamp> (1)"]
_ROWS = [json.loads(line) for line in Path(__file__).with_name("shapes.jsonl").read_text("utf-8").splitlines()]
SHAPES = {row["name"]: row for row in _ROWS}
"""Plans of one lamp as people, language models, planners and tools write them."""

NOT_YET = frozenset(row["name"] for row in _ROWS if not row["is_read"])
"""Shapes of which some line is refused."""


def read(write, knowledge, file, text):
    """Return title and steps of each program of a file, and the lines of the faults."""
    programs, faults = [], []
    try:
        for found in read_programs(write(file, text), knowledge, file):
            if isinstance(found, Reject):
                faults += found.diagnostics
                continue
            faults += found.faults
            programs.append((found.program.title or "", list(map(print_step, found.program.steps))))
    except HearthError as error:
        faults += error.diagnostics
    return programs, [fault.line for fault in faults]


@pytest.mark.parametrize("name", sorted(SHAPES.keys() - NOT_YET))
def test_a_plan_in_this_shape_is_read(write, knowledge, name):
    shape = SHAPES[name]
    programs, _ = read(write, knowledge, shape["file"], shape["text"])
    assert [step for _, steps in programs for step in steps] == shape["steps"]


@pytest.mark.parametrize("name", sorted(NOT_YET))
def test_a_shape_that_is_not_known_gives_faults_and_no_other_steps(write, knowledge, name):
    shape = SHAPES[name]
    programs, faults = read(write, knowledge, shape["file"], shape["text"])
    steps = [step for _, steps in programs for step in steps]
    assert set(steps) <= set(shape["steps"]) and faults


@pytest.mark.parametrize(
    ("file", "text", "titles"),
    [
        (
            "a.ini",
            "[light]\nstep1 = walk to the desk\nstep2 = find the lamp\n\n[nap]\nstep1 = walk to bed\n",
            ["light", "nap"],
        ),
        ("a.md", "# All of them\n\n## Light\n1. walk to desk\n\n## Nap\n1. walk to bed\n2. sleep\n", ["Light", "Nap"]),
        ("a.txt", "Sequence: light\n|-- Walk(desk)\n`-- Find(lamp)\n", ["light"]),
        ("a.md", '**Task:** light\n\nSo:\n```json\n[{"action": "find", "object": "lamp"}]\n```\n', ["light"]),
        (
            "a.jsonl",
            '{"messages": [{"role": "user", "content": "Write a plan for: Light"},'
            ' {"role": "assistant", "content": "1. walk to desk\\n2. find lamp"}]}\n',
            ["Light"],
        ),
    ],
)
def test_the_title_is_that_of_the_section(write, knowledge, file, text, titles):
    programs, faults = read(write, knowledge, file, text)
    assert [title for title, steps in programs if steps] == titles and not faults


def test_conditions_beside_predictions_are_no_title(write, knowledge):
    (found,), _ = read(write, knowledge, "a.csv", "goal,prediction\nON(lamp),walk to desk; switch on lamp\n")
    assert found[0] != "ON(lamp)" and len(found[1]) == 2


def test_a_row_without_its_plan_is_a_fault_of_its_line(write, knowledge):
    programs, faults = read(write, knowledge, "a.csv", "task,plan\nNap,\nLight,walk to desk; switch on lamp\n")
    assert [title for title, _ in programs] == ["Light"] and faults == [2]


def test_a_section_without_steps_is_no_part_of_the_next(write, knowledge):
    text = "# Plans\n\n## Light\n\n## Nap\n- walk to bed\n- sleep\n"
    programs, faults = read(write, knowledge, "a.md", text)
    assert [(title, len(steps)) for title, steps in programs] == [("Light", 0), ("Nap", 2)] and faults == [3]


def test_orders_that_are_not_understood_are_faults_of_their_lines(write, knowledge):
    text = "Ann: Walk to the desk.\nRobot: Done.\nAnn: Now levitate the lamp.\nAnn: Great, switch on the lamp.\n"
    programs, faults = read(write, knowledge, "a.txt", text)
    assert programs[0][1] == [LAMP[0], LAMP[2]] and faults == [3]


def test_it_is_not_what_another_spoke_of(write, knowledge):
    text = "Ann: I walk to the desk.\nAnn: I find the lamp.\nBo: And your book?\nAnn: I grab it.\n"
    text += "Ann: I switch on the lamp.\n"
    programs, faults = read(write, knowledge, "a.txt", text)
    assert programs[0][1] == LAMP and faults == [4]


def test_a_word_behind_a_cell_says_where_a_thing_is_put(write, knowledge):
    text = "| # | Action | Object | Target |\n|---|---|---|---|\n| 1 | put | book | on desk |\n| 2 | grab | lamp | |\n"
    programs, faults = read(write, knowledge, "a.md", text)
    assert programs[0][1] == ["[PutBack] <book> (1) <desk> (1)", "[Grab] <lamp> (1)"] and not faults


@pytest.mark.parametrize("text", ["Note[1]", "Kitchen (old)", "Task: walk", "open the door", "Rest=[1]"])
def test_words_with_brackets_are_no_step_unless_their_action_is_known(text):
    assert operator_step(text) == ""


@pytest.mark.parametrize(
    "text", ["robot1: walk to desk\nrobot2: walk to bed", "2 eggs\n3 cups", "Task 1: rest\nTask 2: nap"]
)
def test_other_numbers_are_no_counts(text):
    assert counting_of(text.split("\n")) is None


@pytest.mark.parametrize("piece", ["[10:00] ", "INFO:", "2024-01-01 10:00 - ", "[a1] ", "a.b-"])
def test_the_head_of_a_line_has_few_parts(piece):
    """Each part is looked for once: a line of a hundred of them is not searched again from each."""
    assert head_of(piece * 100).end <= 12 * len(piece)


def test_repeated_heads_do_not_multiply_the_work():
    assert head_of("[10:00] " * 5_000).end < 100


@pytest.mark.parametrize(
    "text",
    [
        "<think>It is dark.</think>\nLight\n1. walk to the desk\n2. find the lamp\n",
        "<think>It is dark.\nFirst the desk.</think>\nLight\n1. walk to the desk\n2. find the lamp\n",
        "<think>\nIt is dark.\n</think>\n\n**Light**\n\n1. walk to the desk\n2. find the lamp\n",
        "<thinking>Dark. OK.</thinking>Here is a plan for **Light**:\n\n1. walk to the desk\n2. find the lamp\n",
    ],
)
def test_a_thought_is_no_title(write, knowledge, text):
    assert read(write, knowledge, "a.txt", text) == ([("Light", LAMP[:2])], [])
