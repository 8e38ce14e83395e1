"""Rows that are steps: rows of one title belong together, wherever they stand, and numbers order them."""

from __future__ import annotations

import json

import pytest

from hearth.commands import inputs
from hearth.kb.language.recognition_knowledge import recognizing
from hearth.kb.loading.load import default
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items
from hearth.pipelines.ingest import read as read_item
from hearth.pipelines.readers import step_rows_by_task
from hearth.pipelines.validate import process
from hearth.storage.rejects import Reject

TEA = ["Walk to the kitchen", "Open the fridge", "Close the fridge"]
TEA2 = ["Walk to the kitchen", "Open the oven", "Close the oven"]
NAP = ["Walk to the bedroom", "Lie on the bed"]
WORDS = {"Walk to the": "walk", "Open the": "open", "Close the": "close", "Lie on the": "lie"}


@pytest.fixture(autouse=True)
def recognized():
    with recognizing(default()):
        yield


def lines_of(form, rows):
    """Return rows of a title, a number (or none) and a step in a form."""
    if form == "jsonl":
        return "".join(json.dumps({"task": title, "step": n, "text": step}) + "\n" for title, n, step in rows)
    if form == "json":
        return json.dumps([{"task": title, "step": n, "text": step} for title, n, step in rows])
    if form == "number.csv":
        return "task,number,step\n" + "".join(f"{title},{n},{step}\n" for title, n, step in rows)
    if form == "plain.csv":
        return "task,step\n" + "".join(f"{title},{step}\n" for title, _, step in rows)
    split = [(title, n, *step.rsplit(" ", 1)) for title, n, step in rows]
    number = form == "action.csv"
    head = "task,step,action,object\n" if number else "task,action,object\n"
    return head + "".join(
        f"{title},{f'{n},' if number else ''}{WORDS[act]},{thing}\n" for title, n, act, thing in split
    )


def read(tmp_path, form, rows):
    file = tmp_path / f"rows.{form}"
    file.write_text(lines_of(form, rows))
    found = list(inputs.read_programs(file, default(), file.name))
    programs = [each for each in found if not isinstance(each, Reject)]
    said = [each for given in programs for each in given.warnings]
    refused = [fault for each in found if isinstance(each, Reject) for fault in each.diagnostics]
    return {each.program.title: [step.action for step in each.program.steps] for each in programs}, said, refused


def numbered(title, steps, order=None):
    return [(title, n, steps[n - 1]) for n in order or range(1, len(steps) + 1)]


BOTH = {"Tea": ["Walk", "Open", "Close"], "Nap": ["Walk", "Lie"]}
NUMBERED = ["jsonl", "json", "number.csv", "action.csv"]
UNNUMBERED = ["plain.csv", "bare.csv"]


def mixed(tea, nap):
    return [tea[0], nap[0], tea[1], nap[1], tea[2]]


@pytest.mark.parametrize("form", NUMBERED)
def test_numbered_rows_of_tasks_that_alternate_belong_together(tmp_path, form):
    found, said, refused = read(tmp_path, form, mixed(numbered("Tea", TEA), numbered("Nap", NAP)))
    assert (found, said, refused) == (BOTH, [], [])


@pytest.mark.parametrize("form", NUMBERED)
def test_numbers_order_the_rows_and_a_warning_says_so(tmp_path, form):
    rows = [*numbered("Tea", TEA, (1, 3, 2)), *numbered("Nap", NAP)]
    found, said, refused = read(tmp_path, form, rows)
    assert (found, refused) == (BOTH, [])
    assert ["step 2 stands below step 3" in each.message for each in said] == [True]
    assert said[0].line == {"jsonl": 3, "json": 1}.get(form, 4)


@pytest.mark.parametrize("form", UNNUMBERED)
def test_rows_without_numbers_that_alternate_are_one_program_with_a_warning(tmp_path, form):
    found, said, refused = read(tmp_path, form, mixed(numbered("Tea", TEA), numbered("Nap", NAP)))
    assert (found, refused) == (BOTH, [])
    assert [(each.line, "begins again" in each.message) for each in said] == [(4, True), (5, True)]


@pytest.mark.parametrize("form", NUMBERED)
def test_numbers_that_begin_again_begin_another_program(tmp_path, form):
    file = tmp_path / f"rows.{form}"
    file.write_text(lines_of(form, numbered("Tea", TEA) + numbered("Tea", TEA2)))
    found = list(inputs.read_programs(file, default(), file.name))
    assert [len(each.program.steps) for each in found] == [3, 3]


@pytest.mark.parametrize("form", ["jsonl", "action.csv"])
def test_a_number_that_is_there_twice_is_refused_and_never_a_program_of_its_own(tmp_path, form):
    found, _, refused = read(tmp_path, form, [*numbered("Tea", TEA), ("Nap", 1, NAP[0]), ("Tea", 2, TEA[1])])
    assert found == {"Tea": BOTH["Tea"], "Nap": ["Walk"]}
    assert ["twice" in each.message for each in refused] == [True]


def test_a_title_far_below_its_rows_is_a_program_of_its_own_with_a_warning(tmp_path, monkeypatch):
    monkeypatch.setattr(step_rows_by_task, "MOST_WAITING", 3)
    rows = [*numbered("Tea", TEA[:2]), *numbered("Nap", NAP), ("Tea", 3, TEA[2])]
    file = tmp_path / "rows.jsonl"
    file.write_text(lines_of("jsonl", rows))
    found = list(inputs.read_programs(file, default(), file.name))
    last = found[-1]
    assert last.program.title == "Tea" and [each.line for each in last.warnings] == [5]


def test_steps_of_a_list_are_ordered_by_their_numbers(tmp_path):
    steps = [{"step": n, "text": TEA[n - 1]} for n in (2, 1, 3)]
    file = tmp_path / "plan.json"
    file.write_text(json.dumps([{"title": "Tea", "steps": steps}]))
    (found,) = inputs.read_programs(file, default(), file.name)
    assert [step.action for step in found.program.steps] == BOTH["Tea"]
    assert ["step 1 stands below step 2" in each.message for each in found.warnings] == [True]


def test_build_stores_the_warning_and_publishes_no_part_of_a_program(tmp_path):
    file = tmp_path / "rows.csv"
    file.write_text(lines_of("plain.csv", mixed(numbered("Tea", TEA), numbered("Nap", NAP))))
    rows = [row for _, item in items(labelled([str(file)])) for row in read_item(item)]
    stored = [each for row in rows for each in process(row, default())]
    assert {row["title"]: [step["action"] for step in row["steps"]] for row in stored} == BOTH
    assert all("begins again" in row["warnings"][0]["message"] for row in stored)
