"""Titles above a single step, and titles without steps above other plans: no step is made of them, and none is lent."""

import pytest
from test_forms_of_text import programs

from hearth.pipelines.readers import program_text
from hearth.pipelines.readers.recognition_by_content import recognise

ONE = {
    "apart": ("Watch TV\n\nTurn on the TV.\n", "Watch TV", "[SwitchOn] <television> (1)"),
    "a letter": ("T\nSit down on the sofa.\n", "T", "[Sit] <sofa> (1)"),
    "a letter, apart": ("T\n\nSit down on the sofa.\n", "T", "[Sit] <sofa> (1)"),
    "a verb": ("Relax\n\nSit down on the sofa\n", "Relax", "[Sit] <sofa> (1)"),
    "a verb, not apart": ("Relax\nLie down on the bed.\n", "Relax", "[Lie] <bed> (1)"),
    "a heading": ("# Watch TV\n\nTurn on the TV.\n", "Watch TV", "[SwitchOn] <television> (1)"),
    "a bullet": ("Watch TV\n- Turn on the TV.\n", "Watch TV", "[SwitchOn] <television> (1)"),
    "a bullet, apart": ("Make coffee\n\n* Grab the mug\n", "Make coffee", "[Grab] <mug> (1)"),
    "a number": ("Watch TV\n\n1. Turn on the TV\n", "Watch TV", "[SwitchOn] <television> (1)"),
}


@pytest.mark.parametrize(("text", "title", "step"), ONE.values(), ids=ONE)
def test_a_title_above_one_step_is_no_step(write, knowledge, text, title, step):
    ((found, steps, faults, _),) = programs(write, knowledge, text)
    assert (found, steps, faults) == (title, [step], [])


@pytest.mark.parametrize(
    "text",
    [
        "Walk to the sofa\n\nSit down on the sofa\n",
        "Walk to the sofa\nSit down on the sofa.\n",
        "Walk to the sofa.\n\nSit down on the sofa.\n",
    ],
)
def test_two_steps_are_two_steps(write, knowledge, text):
    ((title, steps, faults, _),) = programs(write, knowledge, text)
    assert (title, steps, faults) == ("", ["[Walk] <sofa> (1)", "[Sit] <sofa> (1)"], [])


def test_an_item_that_is_not_understood_is_a_fault_on_its_line(write, knowledge):
    ((title, steps, faults, _),) = programs(write, knowledge, "Make coffee\n\n- Do the dishes\n")
    assert (title, steps, faults) == ("Make coffee", [], [("NOT_UNDERSTOOD", 3)])


LIST = "- Walk to the kitchen\n- Wash the plate\n"
TITLES = {
    "above bullets": f"Make coffee\n\nDo the dishes\n{LIST}",
    "above bullets, apart": f"Make coffee\n\nDo the dishes\n\n{LIST}",
    "above numbers": "Make coffee\n\nDo the dishes\n1. Walk to the kitchen\n2. Wash the plate\n",
    "of a step's words": f"Watch TV\n\nWash the plate\n{LIST}",
    "an activity": f"Making coffee\n\nDoing dishes\n{LIST}",
}


@pytest.mark.parametrize("text", TITLES.values(), ids=TITLES)
def test_a_title_without_steps_is_refused_and_takes_no_steps_of_another(write, knowledge, text):
    empty, full = programs(write, knowledge, text)
    titles = [line for line in text.split("\n") if line][:2]
    assert [empty[0], full[0]] == titles
    assert (empty[1], empty[2]) == ([], [("EMPTY", 1)])
    assert (full[1], full[2]) == (["[Walk] <kitchen> (1)", "[Wash] <plate> (1)"], [])


@pytest.mark.parametrize("second", ["It is quick.", "Steps", "Here is the plan:", "In the kitchen, every morning"])
def test_a_description_below_a_title_begins_no_program(write, knowledge, second):
    ((title, steps, *_),) = programs(write, knowledge, f"Make coffee\n\n{second}\n{LIST}")
    assert (title, len(steps)) == ("Make coffee", 2)


@pytest.mark.parametrize(
    ("text", "steps"),
    [
        ("Grab the milk\n", ["[Grab] <milk> (1)"]),
        ("turn on the tv", ["[SwitchOn] <television> (1)"]),
        ("- Grab the milk.\n", ["[Grab] <milk> (1)"]),
        ("1. Grab the milk\n", ["[Grab] <milk> (1)"]),
        ("Open the fridge and close it\n", ["[Open] <fridge> (1)", "[Close] <fridge> (1)"]),
    ],
)
def test_the_only_line_of_a_text_is_a_step_where_it_reads_as_one(write, knowledge, text, steps):
    ((title, found, faults, _),) = programs(write, knowledge, text)
    assert (title, found, faults) == ("", steps, [])


@pytest.mark.parametrize("text", ["Make coffee\n", "Breakfast\n", "A lazy evening\n"])
def test_the_only_line_of_a_text_is_a_title_where_it_is_no_step(write, text):
    assert [entry.reader for entry in recognise(write("plan.txt", text), "plan.txt")] == [program_text.NAME]
