"""Hints: steps that a person may have meant, or the word that Hearth does not know."""

import pytest

from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.step_understanding import understand


def suggestion(knowledge, sentence):
    (fault,) = parse_steps(f"Task: T\nStep 1: {sentence}\n", 0, "a.txt", knowledge).faults
    assert fault.message == "could not read this line as a step"
    return fault.suggestion


@pytest.mark.parametrize(
    ("sentence", "word"),
    [
        ("Walk to the rocket", "rocket"), ("Grab the elephant", "elephant"), ("Find a soda", "soda"),
        ("Put the lid on the pot", "lid"), ("Put the milk in the zorb", "zorb"), ("Wash the dishes", "dishes"),
    ],
)  # fmt: skip
def test_an_object_that_is_not_known_is_named(knowledge, sentence, word):
    expected = f"`{word}` is not an object that Hearth knows; `hearth kb find` lists them"
    assert suggestion(knowledge, sentence) == expected
    assert not understand(knowledge, sentence).candidates


@pytest.mark.parametrize("verb", ["Lock", "Feed", "Juggle", "Polish"])
def test_an_action_that_is_not_known_is_named(knowledge, verb):
    expected = f"`{verb.lower()}` is not an action that Hearth knows; `hearth kb export table` lists them"
    assert suggestion(knowledge, f"{verb} the door") == expected


@pytest.mark.parametrize(
    ("sentence", "steps"),
    [
        ("Grab the bowel", ["Grab bowl"]),  # a typo that is a word
        ("Grab the beach towel", ["Grab towel"]),  # the thing that its last word names
        ("Push the power button", ["Push button"]),
        ("Sit on the seat", ["Sit on armchair", "Sit on bench", "Sit on chair"]),  # things of that kind
        ("Pick up the beach towel", ["Grab towel"]),  # the same act in other words
    ],
)
def test_a_hint_has_the_verb_and_a_thing_that_may_be_meant(knowledge, sentence, steps):
    assert suggestion(knowledge, sentence) == f"did you mean {' or '.join(f'`{step}`' for step in steps)}?"


@pytest.mark.parametrize(
    ("sentence", "unknown"),
    [
        ("Turn on the TV with the spaceship", "spaceship"),
        ("Open the jar with a spanner", "spanner"),
        ("Cut the bread using the sprocket", "sprocket"),
        ("Open the can with the can opener", "can"),
    ],
)
def test_an_unknown_tool_or_thing_is_named(knowledge, sentence, unknown):
    assert (
        suggestion(knowledge, sentence)
        == f"`{unknown}` is not an object that Hearth knows; `hearth kb find` lists them"
    )


@pytest.mark.parametrize(
    ("sentence", "step"),
    [
        ("Turn on the stove with the lighter", "Switch on stove"),
        ("Turn on the TV using your phone", "Switch on television"),
        ("Turn on the television by pressing the power button", "Switch on television"),
    ],
)
def test_a_tool_is_no_thing_of_the_hint(knowledge, sentence, step):
    assert suggestion(knowledge, sentence) == f"did you mean `{step}`?"


@pytest.mark.parametrize("sentence", ["Do not touch the stove", "Dont open the fridge", "Never open the door"])
def test_a_line_that_forbids_an_act_is_said_to_do_so(knowledge, sentence):
    assert suggestion(knowledge, sentence) == "this says what not to do: leave the line out"


@pytest.mark.parametrize("sentence", ["Sit on the sofa or the bed", "Walk to the kitchen or bedroom"])
def test_a_line_that_leaves_a_choice_is_said_to_do_so(knowledge, sentence):
    assert suggestion(knowledge, sentence) == "choose one of the two, and name it alone"


@pytest.mark.parametrize("sentence", ["Put it"])
def test_what_is_no_name_is_not_said_to_be_one(knowledge, sentence):
    assert suggestion(knowledge, sentence) == "write one step a line, as in `Walk to kitchen`"


def test_readings_that_are_equally_near_are_named_without_figures(knowledge):
    (fault,) = parse_steps("Task: T\nStep 1: Wash the plante\n", 0, "a.txt", knowledge).faults
    assert fault.code == "AMBIGUOUS"
    assert "`Wash plant`" in fault.suggestion and "(0." not in fault.suggestion


@pytest.mark.parametrize(
    ("sentence", "steps"),
    [
        ("Walk to the counter", ["Walk to bathroom counter", "Walk to kitchen counter"]),
        ("Put the cup on the counter", ["Put cup on bathroom counter", "Put cup on kitchen counter"]),
        ("Wipe the blue counter", ["Wipe bathroom counter", "Wipe kitchen counter"]),
        ("Grab the filter", ["Grab coffee filter"]),
        ("Grab the floss", ["Grab dental floss"]),
    ],
)
def test_a_noun_that_is_the_last_word_of_classes_is_hinted_at(knowledge, sentence, steps):
    assert suggestion(knowledge, sentence) == f"did you mean {' or '.join(f'`{step}`' for step in steps)}?"
