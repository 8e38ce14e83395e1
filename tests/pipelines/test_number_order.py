"""Numbers of steps in an order of their own: the text keeps its order, and a warning stands on the line."""

from __future__ import annotations

import json

import pytest

from hearth.commands import inputs
from hearth.kb.language.recognition_knowledge import recognizing
from hearth.kb.loading.load import default

MIXED = ["1. Walk to the fridge", "3. Close the fridge", "2. Open the fridge"]
LATE = ["3. Walk to the fridge", "4. Open the fridge"]
FORMS = {
    "plan.txt": lambda steps: "Cool\n" + "\n".join(steps),
    "plan.md": lambda steps: "# Cool\n\n" + "\n".join(steps),
    "texts.jsonl": lambda steps: json.dumps({"title": "Cool", "plan": "\n".join(steps)}),
    "lists.jsonl": lambda steps: json.dumps({"title": "Cool", "steps": steps}),
}


def read(tmp_path, name, text):
    file = tmp_path / name
    file.write_text(text)
    with recognizing(default()):
        (found,) = inputs.read_programs(file, default(), name)
    return [step.action for step in found.program.steps], [(each.line, each.message) for each in found.warnings]


@pytest.mark.parametrize("form", FORMS)
def test_numbers_out_of_order_keep_the_order_of_the_text_and_warn(tmp_path, form):
    steps, said = read(tmp_path, form, FORMS[form](MIXED))
    assert steps == ["Walk", "Close", "Open"]
    assert ["step 2 stands below step 3" in message for _, message in said] == [True]
    assert said[0][0] == {"plan.txt": 4, "plan.md": 5}.get(form, 1)


@pytest.mark.parametrize("form", FORMS)
def test_a_plan_that_begins_above_one_warns(tmp_path, form):
    steps, said = read(tmp_path, form, FORMS[form](LATE))
    assert steps == ["Walk", "Open"]
    assert ["the first step has the number 3" in message for _, message in said] == [True]


def test_an_answer_of_one_step_that_begins_above_one_warns(tmp_path):
    chat = (
        "Human: How do I drink milk?\nAI:\n1. Walk to the fridge\n2. Open the fridge\n"
        "Human: Also close it.\nAI:\n3. Close the fridge\n"
    )
    steps, said = read(tmp_path, "chat.txt", chat)
    assert steps == ["Close"] and [line for line, _ in said] == [7]


@pytest.mark.parametrize(
    "text",
    [
        "Cool\n1. Walk to the fridge\n2. Open the fridge",
        "Cool\n1. Walk to the fridge\n1. Open the fridge\n1. Close the fridge",
        "Cool\n0. Walk to the fridge\n1. Open the fridge",
        "Cool\n1. Walk to the fridge\n   1. Open the fridge\n   2. Close the fridge\n2. Walk to the bed",
    ],
)
def test_numbers_in_order_say_nothing(tmp_path, text):
    assert read(tmp_path, "plan.txt", text)[1] == []
