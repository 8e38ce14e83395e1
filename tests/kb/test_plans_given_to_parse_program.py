"""A plan in words given to `parse_program`: the error names the function that reads plans, and that one does."""

import re

import pytest

import hearth
from hearth.kb.language.reading_modes import Fuzzy


@pytest.mark.parametrize(
    "text",
    [
        "1. Walk to the kitchen\n2. Grab the cup\n",
        "Tea\n1. Walk to the kitchen\n2. Grab the cup\n",
        "- Walk to the kitchen\n- Grab the cup\n",
        "walk('kitchen')\ngrab('cup')\n",
        "Walk to the kitchen\nGrab the cup\n",
    ],
)
def test_the_error_names_the_reader_of_plans(text):
    with pytest.raises(hearth.HearthError) as raised:
        hearth.parse_program(text)
    call = re.findall(r"`([^`]+)`", raised.value.diagnostics[0].suggestion)[0]
    found = eval(call, {"hearth": hearth, "text": text})
    assert [step.action for step in found.program.steps] == ["Walk", "Grab"] and not found.faults


@pytest.mark.parametrize("fuzzy", [*Fuzzy, *map(str, Fuzzy)])
def test_the_reader_of_plans_takes_the_modes_of_reading(fuzzy):
    found = hearth.parse_steps("1. Walk to the kitchin\n2. Zap the tea", fuzzy=fuzzy)
    assert len(found.program.steps) == (fuzzy != "off") and found.faults[-1].line == 2
    assert len(repr(found)) < 400


def test_a_text_that_is_no_plan_is_not_said_to_be_one():
    with pytest.raises(hearth.HearthError) as raised:
        hearth.parse_program("Tea\nI like it.\n")
    assert "parse_steps" not in str(raised.value)
