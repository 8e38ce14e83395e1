"""The reading of sentences: word by word, nearly, one of several, or nothing."""

import pytest

from hearth.kb.language.step_understanding import ACCEPTED, understand


@pytest.mark.parametrize(
    ("sentence", "action", "names"),
    [
        ("Walk to the kitchen.", "Walk", ("kitchen",)),
        ("Then, put the milk in the fridge", "PutIn", ("milk", "fridge")),
        ("Turn on the TV", "SwitchOn", ("television",)),
        ("Take off shoes", "PutOff", ("shoes",)),
        ("Sleep", "Sleep", ()),
    ],
)
def test_said_word_by_word(knowledge, sentence, action, names):
    meant = understand(knowledge, sentence).meant
    assert (meant.action.name, meant.names, meant.score) == (action, names, 1)


@pytest.mark.parametrize(
    ("sentence", "action", "names"),
    [
        ("Wlak to kitchen", "Walk", ("kitchen",)),
        ("Grab the coffe cup", "Grab", ("coffee_cup",)),
        ("Pour milk in the glas", "Pour", ("milk", "glass")),
        ("Sleeep", "Sleep", ()),
    ],
)
def test_the_nearest_valid_instruction_keeps_its_score(knowledge, sentence, action, names):
    meant = understand(knowledge, sentence).meant
    assert (meant.action.name, meant.names) == (action, names)
    assert ACCEPTED <= meant.score < 1


def test_what_is_equally_near_to_two_things_is_ambiguous(knowledge):
    found = understand(knowledge, "Put the plat on the tabel")
    assert found.ambiguous
    assert {each.names[0] for each in found.candidates[:2]} == {"plate", "plant"}


def test_the_hopeless_is_not_taken_for_anything(knowledge):
    found = understand(knowledge, "Contemplate the meaning of life")
    assert found.meant is None and not found.ambiguous
