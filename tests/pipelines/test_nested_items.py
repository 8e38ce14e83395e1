"""Bullets and numbers that only head the items below them are no steps and no titles."""

import pytest
from test_forms_of_text import programs

GO, CUP, SOFA, SIT = "Walk to the kitchen", "Grab the cup", "Walk to the sofa", "Sit on the sofa"
STEPS = ["[Walk] <kitchen> (1)", "[Grab] <cup> (1)", "[Walk] <sofa> (1)", "[Sit] <sofa> (1)"]


def listed(mark, first, second, inner="-"):
    return f"{mark} {first}\n   {inner} {GO}\n   {inner} {CUP}\n{mark} {second}\n   {inner} {SOFA}\n   {inner} {SIT}\n"


@pytest.mark.parametrize(
    "heads",
    [
        ("In the kitchen", "In the living room"),
        ("Kitchen", "Living room"),
        ("Getting ready", "Finishing"),
        ("Preparation", "Ending"),
        ("First part", "Second part"),
    ],
)
@pytest.mark.parametrize("mark", ["-", "*", "1."])
def test_parts_of_a_plan_are_neither_steps_nor_plans(write, knowledge, mark, heads):
    ((title, steps, faults, warnings),) = programs(write, knowledge, listed(mark, *heads), "plan.md")
    assert (title, steps, faults, warnings) == ("", STEPS, [], ["NO_STEP"])


@pytest.mark.parametrize("heads", [("Get the cup", "Take a seat"), ("Grab the cup:", "Sit down:")])
def test_a_step_that_its_items_do_is_done_once(write, knowledge, heads):
    text = f"# Rest\n{listed('1.', *heads)}"
    ((title, steps, faults, _),) = programs(write, knowledge, text, "plan.md")
    assert (title, steps, faults) == ("Rest", STEPS, [])


def test_a_step_with_further_steps_below_it_is_a_step(write, knowledge):
    text = "1. Walk to the fridge\n   - Open the fridge\n   - Grab the milk\n2. Close the fridge\n"
    ((_, steps, faults, _),) = programs(write, knowledge, text)
    assert (len(steps), steps[0], faults) == (4, "[Walk] <fridge> (1)", [])


def test_numbers_within_a_step_begin_no_plan(write, knowledge):
    text = f"1. {GO}\n2. Take the cup:\n   1. {CUP}\n   2. Drink from the cup\n3. {SIT}\n"
    ((_, steps, _, _),) = programs(write, knowledge, text)
    assert steps[0] == STEPS[0] and steps[1] == STEPS[1] and steps[-1] == STEPS[3]


def test_bullets_that_name_tasks_are_titles(write, knowledge):
    text = listed("-", "Make tea", "Take a nap").replace("   -", "  -")
    assert [title for title, *_ in programs(write, knowledge, text)] == ["Make tea", "Take a nap"]
