"""Steps in words through validate: mapped, kept with their score, or refused with candidates."""

import json

import pytest

from hearth.kb.language.plans import parse_steps
from hearth.schemas.syntax import print_lines


def parsed(knowledge, *steps):
    text = "Task: T\n" + "".join(f"Step {number}: {step}\n" for number, step in enumerate(steps, 1))
    found = parse_steps(text, 0, "a.txt", knowledge)
    return list(print_lines(found.program)), found


def test_clauses_and_pronouns(knowledge):
    lines, found = parsed(knowledge, "Walk to the fridge", "Open it and grab the milk", "Drink it")
    assert lines == ["[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Grab] <milk> (1)", "[Drink] <milk> (1)"]
    assert found.program.lines == (2, 3, 3, 4)
    assert not found.faults and not found.warnings


def test_what_is_nearly_understood_is_a_warning_with_its_score(knowledge):
    lines, found = parsed(knowledge, "Wlak to kitchen")
    assert lines == ["[Walk] <kitchen> (1)"]
    (warning,) = found.warnings
    assert (warning.code, warning.line, warning.column) == ("FUZZY_MATCH", 2, 9)
    assert "0.85" in warning.message


def test_what_is_not_understood_names_candidates_and_costs_no_neighbour(knowledge):
    lines, found = parsed(knowledge, "Walk to bed", "Put the plat on the tabel", "Ponder quietly about zen", "Sleep")
    assert lines == ["[Walk] <bed> (1)", "[Sleep]"]
    assert [(fault.code, fault.line) for fault in found.faults] == [("AMBIGUOUS", 3), ("NOT_UNDERSTOOD", 4)]
    assert "`Put plate on table`" in found.faults[0].suggestion and found.faults[0].found == "Put the plat on the tabel"


def test_no_steps_is_a_fault(knowledge):
    assert [fault.code for fault in parse_steps("Task: T\n", 0, "a", knowledge).faults] == ["EMPTY"]


def test_all_examples_of_planning_papers_parse(real_data, knowledge):
    texts = set(json.loads((real_data / "language_planner_examples.json").read_text()))
    assert len(texts) == 574
    for text in sorted(texts):
        found = parse_steps(text, 0, "a", knowledge)
        assert not found.faults and not found.warnings
        assert len(found.program.steps) == text.count("\nStep ")


@pytest.mark.parametrize("text", ["Task: T\nStep 1: Walk to bed\nStep 2: Sleep\n"])
def test_through_the_stages(write, built, text):
    build = built(write("model.txt", text))
    build.run("ingest", "validate")
    (row,) = build.rows("validate")
    assert [step["action"] for step in row["steps"]] == ["Walk", "Sleep"]
