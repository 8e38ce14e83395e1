"""A plan in words given to `parse_program`: the error names the function that reads plans, and that one does."""

import re
from importlib import import_module

import pytest

import hearth


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
    call, module, _, known, source = re.findall(r"`([^`]+)`", raised.value.diagnostics[0].suggestion)[:5]
    names = {"text": text, "parse_steps": import_module(module).parse_steps}
    names["known"] = eval(known, {"default": import_module(source).default})
    assert len(eval(call, names).program.steps) == 2


def test_a_text_that_is_no_plan_is_not_said_to_be_one():
    with pytest.raises(hearth.HearthError) as raised:
        hearth.parse_program("Tea\nI like it.\n")
    assert "numbered_steps" not in str(raised.value)
