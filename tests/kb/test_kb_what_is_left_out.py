"""Words that a step has no place for are left out and counted; pronouns stand for what is closed."""

import pytest

from hearth.kb.language.numbered_steps import parse_steps
from hearth.kb.language.reading_modes import Fuzzy
from hearth.schemas.syntax import print_lines


def read(knowledge, *steps, fuzzy=Fuzzy.TYPOS):
    text = "Task: T\n" + "".join(f"Step {number}: {step}\n" for number, step in enumerate(steps, 1))
    found = parse_steps(text, 0, "a.txt", knowledge, fuzzy)
    return list(print_lines(found.program)), found


def test_what_holds_a_thing_is_closed_not_the_thing(knowledge):
    lines, _ = read(knowledge, "Open the fridge", "Put milk in the fridge, then close it")
    assert lines[-1] == "[Close] <fridge> (1)"
    assert read(knowledge, "Put the milk in the fridge", "Close it")[0][-1] == "[Close] <fridge> (1)"


@pytest.mark.parametrize(
    ("sentence", "step", "out"),
    [
        ("Turn off all lights", "[SwitchOff] <light> (1)", "all"),
        ("Find a book on the bookshelf", "[Find] <book> (1)", "on the bookshelf"),
        ("Wash the plate in the sink", "[Wash] <plate> (1)", "in the sink"),
        ("Grab the milk in the fridge", "[Grab] <milk> (1)", "in the fridge"),
        ("Slice the tomato on the table.", "[Cut] <tomato> (1)", "on the table"),
        ("Put the plate on the table in the kitchen", "[PutBack] <plate> (1) <table> (1)", "in the kitchen"),
    ],
)
def test_places_and_all_are_counted(knowledge, sentence, step, out):
    lines, found = read(knowledge, sentence)
    assert lines == [step] and [warning.code for warning in found.warnings] == ["FUZZY_MATCH"]
    assert out in found.warnings[0].message
    assert not read(knowledge, sentence, fuzzy=Fuzzy.OFF)[0]


def test_the_place_from_which_a_thing_is_taken_belongs_to_the_phrase(knowledge):
    lines, found = read(knowledge, "Take the milk out of the fridge", "Grab a mug from the kitchen cabinet")
    assert lines == ["[Grab] <milk> (1)", "[Grab] <mug> (1)"] and not found.warnings


@pytest.mark.parametrize(
    ("sentence", "step", "out"),
    [
        ("Fill the kettle with water from the sink", "[Pour] <water> (1) <kettle> (1)", "from the sink"),
        ("Fill the glass with water from the tap", "[Pour] <water> (1) <glass> (1)", "from the tap"),
        ("Pour milk from the fridge into the glass", "[Pour] <milk> (1) <glass> (1)", "from the fridge"),
        ("Pour the milk from the carton into the glass", "[Pour] <milk> (1) <glass> (1)", "from the carton"),
        ("Put the milk from the fridge on the table", "[PutBack] <milk> (1) <table> (1)", "from the fridge"),
        ("Read the book from the bookshelf", "[Read] <book> (1)", "from the bookshelf"),
        ("Wash the cup in the sink with soap", "[Wash] <cup> (1)", "in the sink with soap"),
    ],
)
def test_where_a_thing_is_from_is_counted_where_nothing_is_taken(knowledge, sentence, step, out):
    lines, found = read(knowledge, sentence)
    assert lines == [step] and out in found.warnings[0].message
    assert not read(knowledge, sentence, fuzzy=Fuzzy.OFF)[0]


@pytest.mark.parametrize(
    "sentence", ["Fill the glass with milk from the moon", "Pour milk from the glass from the cup"]
)
def test_an_unknown_source_is_not_left_out(knowledge, sentence):
    lines, found = read(knowledge, sentence)
    assert not lines and len(found.faults) == 1
