"""Lists of sentences that ask for steps, `You need to open the fridge`, without numbers: each is a step."""

import pytest
from test_forms_of_text import programs

OPEN, CLOSE, CUP, SIT = "[Open] <fridge> (1)", "[Close] <fridge> (1)", "[Grab] <cup> (1)", "[Sit] <sofa> (1)"


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        (
            "Now grab the cup…\nYou need to open the fridge…\nThen go to the sofa…\nMake sure you close the fridge…\n",
            [CUP, OPEN, "[Walk] <sofa> (1)", CLOSE],
        ),
        (
            "Be sure to open the fridge\nEnsure that you close the fridge\nBe sure you sit on the sofa\n",
            [OPEN, CLOSE, SIT],
        ),
        (
            "Go ahead and grab the cup\nYou'll want to open the fridge\nI need you to close the fridge\n",
            [CUP, OPEN, CLOSE],
        ),
        (
            "It is important to open the fridge\nDon't forget to close the fridge\nYou must sit on the sofa\n",
            [OPEN, CLOSE, SIT],
        ),
        (
            "The next thing is to grab the cup\nTry to open the fridge\nRemember to close the fridge\n",
            [CUP, OPEN, CLOSE],
        ),
        (
            "Next you are going to grab the cup\nLet us open the fridge\nSee to it that we close the fridge\n",
            [CUP, OPEN, CLOSE],
        ),
    ],
)
@pytest.mark.parametrize("title", ["", "Task: Cup\n\n"])
def test_requests_are_steps(write, knowledge, title, text, steps):
    ((_, found, faults, warnings),) = programs(write, knowledge, title + text)
    assert (found, faults, warnings) == (steps, [], [])


@pytest.mark.parametrize(
    "line", ["Make sure the fridge is closed", "Make sure you do not open the fridge", "Ensure you are on the sofa"]
)
def test_a_state_and_what_is_not_to_be_done_are_no_steps(write, knowledge, line):
    ((_, found, faults, _),) = programs(write, knowledge, f"1. Grab the cup\n2. {line}\n3. Sit on the sofa\n")
    assert (found, faults) == ([CUP, SIT], [("NOT_UNDERSTOOD", 2)])


def test_a_warning_below_a_step_is_no_step(write, knowledge):
    text = "1. Grab the cup\n   - Make sure you don't spill it.\n2. Sit on the sofa\n"
    assert programs(write, knowledge, text)[0][1:3] == ([CUP, SIT], [])
