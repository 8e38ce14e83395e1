"""`the cup from the bathroom`: the place is counted as left out, unless the plan has gone there."""

import pytest

import hearth
from hearth.schemas.failures import Code

AWAY = [
    "Walk to the kitchen\nGrab the cup from the bathroom",
    "Grab the milk from the oven",
    "Open the fridge\nGet the milk out of the oven",
    "Walk to the oven\nOpen the oven\nWalk to the bedroom\nTake the milk from the oven",
    "Walk to the kitchen and grab the cup from the bathroom",
    "Take the milk off the sofa",
]
THERE = [
    "Open the fridge\nTake the milk from the fridge",
    "Walk to the bathroom\nGrab the cup from the bathroom",
    "Walk to the kitchen\nWalk to the fridge\nOpen the fridge\nGrab the milk out of the fridge",
    "Walk to the bathroom\nOpen the cabinet\nGrab the towel from the bathroom",
    "Open the fridge and take the milk from the fridge",
    "Put the cup on the table\nGrab the cup from the table",
    "Walk to the kitchen\nTake the milk from the fridge",  # where milk usually is
    "Grab the bag\nWalk to the bedroom\nTake the book out of the bag",
]


def warned(text):
    plan = hearth.parse_steps("Task\n" + "".join(f"{n}. {line}\n" for n, line in enumerate(text.split("\n"), 1)))
    assert not plan.faults
    return [each for each in plan.warnings if "left out" in each.message or "no step goes there" in each.message]


@pytest.mark.parametrize("text", AWAY)
def test_a_place_at_which_the_plan_is_not_is_left_out_and_counted(text):
    (found,) = warned(text)
    assert (found.code, found.line) == (Code.FUZZY_MATCH, text.count("\n") + 2)


@pytest.mark.parametrize("text", THERE)
def test_a_place_to_which_the_plan_has_gone_is_not_left_out(text):
    assert warned(text) == []
