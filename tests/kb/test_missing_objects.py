"""Clauses without an object: the fault says what is missing, and a seat to which one went is taken and counted."""

import pytest

from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.reading_modes import Fuzzy
from hearth.schemas.syntax import print_lines


def read(knowledge, *steps, fuzzy=Fuzzy.TYPOS):
    text = "Task: T\n" + "".join(f"Step {number}: {step}\n" for number, step in enumerate(steps, 1))
    found = parse_steps(text, 0, "a.txt", knowledge, fuzzy)
    return list(print_lines(found.program)), found


@pytest.mark.parametrize(
    ("sentence", "question", "example"),
    [
        ("Sit down", "sit down on what?", "Sit down on the chair"),
        ("Then lie down.", "lie down on what?", "Lie down on the bed"),
        ("Take a seat", "take a seat on what?", "Take a seat on the chair"),
        ("Open", "open what?", "Open the fridge"),
        ("Pick up", "pick up what?", "Pick up the bread"),
        ("Put the cup", "put the cup on what?", "Put the cup on the table"),
        ("Fill the kettle", "fill the kettle with what?", "Fill the kettle with the water"),
        ("You should walk", "walk to what?", "Walk to the table"),
        ("Turn on", "turn on what?", "Turn on the television"),
    ],
)
def test_a_missing_object_is_asked_for_with_an_example(knowledge, sentence, question, example):
    lines, found = read(knowledge, sentence)
    (fault,) = found.faults
    assert (lines, fault.line, fault.code) == ([], 2, "NOT_UNDERSTOOD")
    assert (fault.message, fault.suggestion) == (f"an object is missing: {question}", f"name it, as in `{example}`")
    assert len(read(knowledge, example)[0]) == 1


def test_the_example_is_a_thing_of_the_plan_where_one_affords_the_act(knowledge):
    _, found = read(knowledge, "Walk to the sofa", "Grab the cup", "Sit down")
    assert found.faults[0].suggestion == "name it, as in `Sit down on the sofa`"


@pytest.mark.parametrize("sentence", ["Fly", "Blorf", "Relax", "Sit down comfortably on the moon", "Greetings"])
def test_what_lacks_more_than_an_object_is_not_asked_for(knowledge, sentence):
    assert not any("missing" in fault.message for fault in read(knowledge, sentence)[1].faults)


RESTS = {
    ("Walk to the sofa", "Sit down"): "[Sit] <sofa> (1)",
    ("Go to bed", "Lie down"): "[Lie] <bed> (1)",
    ("Walk to the chair", "Take a seat"): "[Sit] <chair> (1)",
    ("Walk to the sofa and sit down",): "[Sit] <sofa> (1)",
    ("Walk to the bench, then sit",): "[Sit] <bench> (1)",
    ("Walk to the sofa. Sit down.",): "[Sit] <sofa> (1)",
}


@pytest.mark.parametrize(("sentences", "step"), RESTS.items(), ids=map(" / ".join, RESTS))
def test_one_rests_where_the_step_before_went_and_that_is_counted(knowledge, sentences, step):
    lines, found = read(knowledge, *sentences)
    assert lines[-1] == step and not found.faults
    (warning,) = found.warnings
    assert warning.code == "FUZZY_MATCH" and "added: the place to which the step before goes" in warning.message
    assert read(knowledge, *sentences, fuzzy=Fuzzy.OFF)[1].faults


@pytest.mark.parametrize(
    "sentences",
    [
        ("Walk to the kitchen", "Sit down"),
        ("Walk to the fridge", "Sit down"),
        ("Walk to the sofa", "Grab the cup", "Sit down"),
        ("Walk to the sofa", "Lie in wait"),
        ("Walk to the fridge", "Open"),
        ("Walk to the sofa", "Blorf the cat", "Sit down"),
    ],
)
def test_nothing_is_added_where_the_step_before_went_to_no_seat(knowledge, sentences):
    lines, found = read(knowledge, *sentences)
    assert found.faults and not any("[Sit]" in line or "[Lie]" in line for line in lines)


@pytest.mark.parametrize(
    ("line", "steps", "faults"),
    [
        ("Walk to the kitchen. Grab the filter. Open the fridge.", ["[Walk]", "[Open]"], ["Grab the filter"]),
        ("Open the fridge. Blorf the milk.", ["[Open]"], []),
        ("Walk to the fridge. Open it. Hug the milk.", ["[Walk]", "[Open]"], ["Hug the milk"]),
        ("Open the fridge. It is cold.", ["[Open]"], []),
        ("Open the fridge. Be careful.", ["[Open]"], []),
    ],
)
def test_a_sentence_behind_a_step_that_asks_for_another_is_no_explanation(knowledge, line, steps, faults):
    lines, found = read(knowledge, line)
    assert [each.split()[0] for each in lines] == steps
    assert [fault.found for fault in found.faults] == faults
