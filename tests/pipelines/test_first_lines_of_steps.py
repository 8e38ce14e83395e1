"""First lines that are steps are read as steps, or refused, and never taken for titles in silence."""

import pytest

from hearth.kb.language.program_lines import Kind, header, lines_of_program
from hearth.pipelines.readers.step_texts import numbered

SENTENCES = {
    "First, walk to the kitchen and open the fridge. Take out the eggs and close it.\n"
    "Then grab the pan and put it on the stove. Turn on the stove.": "walk to the kitchen",
    "Open the window. Walk to the bed.\nLie down on the bed. Sleep.": "Open the window",
    "Please grab the towel. Wipe the mirror with it.\nNow drop the towel. Walk to the hall.": "grab the towel",
}
NUMBERED_FROM_0 = {
    "ff: found legal plan as follows\n\nstep    0: WALK BEDROOM\n    1: FIND LAPTOP\n    2: GRAB LAPTOP": "bedroom",
    "step 0: WALK BEDROOM\n1: FIND LAPTOP\n2: GRAB LAPTOP": "bedroom",
    "0: FLY BEDROOM\n1: FIND LAPTOP\n2: GRAB LAPTOP": "BEDROOM",
}
ELEMENTS = {
    '<root>\n  <Action ID="Walk" target="kitchen"/>\n  <Action ID="Teleport" target="moonbase"/>\n'
    '  <Action ID="Grab" target="food_apple"/>\n</root>': 3,
    '<Sequence>\n<Act name="fly" object="moon"/>\n<Act name="walk" object="desk"/>\n'
    '<Act name="grab" object="mug"/>\n</Sequence>': 3,
    '<root>\n<step do="walk" object="desk"/>\n<step do="grab" object="mug"/>\n<port name="x"/>\n</root>': 3,
}


def steps(text):
    return [each.line.text for each in lines_of_program(text) if each.kind is not Kind.TEXT]


@pytest.mark.parametrize("text", SENTENCES)
def test_sentences_of_steps_are_no_title(text):
    assert not header(text).title and SENTENCES[text].lower() in " ".join(steps(text)).lower()


@pytest.mark.parametrize("text", NUMBERED_FROM_0)
def test_the_step_with_the_number_0_is_a_step(text):
    assert len(steps(text)) == 3 and NUMBERED_FROM_0[text] in steps(text)[0]


@pytest.mark.parametrize("text", ELEMENTS)
def test_an_element_like_those_of_steps_is_a_step(text):
    assert len(steps(text)) == ELEMENTS[text]


def test_a_heading_above_listed_steps_is_their_title():
    words = {"title": None, "description": None}
    text, _ = numbered(["# Sweep the floor\n", "1. grab the broom\n", "2. sweep the floor"], words)
    assert text.split("\n") == ["Task: Sweep the floor", "", "Step 1: grab the broom", "Step 2: sweep the floor"]
    text, _ = numbered(["# Sweep the floor", "grab the broom"], {**words, "title": "Clean"})
    assert text.split("\n")[0] == "Task: Clean" and "Sweep the floor" in text


def test_an_owner_may_stand_before_an_action_in_one_word():
    assert len(steps("Morning: WakeUp → StandUp → Walk kitchen → Grab cereal")) == 4
