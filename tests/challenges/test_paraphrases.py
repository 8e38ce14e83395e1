"""Instructions in other words than ours: read where they are understood whole, else refused; never misread."""

from __future__ import annotations

from pathlib import Path

import pytest

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.instruction_reader import read_instruction
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

FOLDER = Path(__file__).resolve().parents[1] / "golden" / "challenges"
WAH = frozenset({"dinnertable", "coffeetable", "wineglass"})


def pairs(file):
    lines = (FOLDER / file).read_text(encoding="utf-8").splitlines()
    return [tuple(line.split(" | ", 1)) for line in lines if not line.startswith("#")]


def in_order(goal):
    return sorted(str(goal).split(" and "))


def outcome(goal, text, knowledge):
    """The outcome of reading a text: read or refused, and as its goal or as another."""
    names = (
        challenge("wah").grammar.names if any(name in goal for name in WAH) or "INSIDE(apple" in goal else frozenset()
    )
    try:
        return "right" if in_order(read_instruction(text, knowledge, names=names)) == in_order(goal) else "wrong"
    except HearthError:
        return "refused"


@pytest.mark.parametrize(("file", "number"), [("paraphrases.txt", 60), ("more_paraphrases.txt", 64)])
def test_most_are_read_and_none_is_misread(knowledge, file, number):
    """These lines developed the reader; how it reads those of another author is not said by them."""
    found = [outcome(goal, text, knowledge) for goal, text in pairs(file)]
    assert len(found) == number and "wrong" not in found
    assert found.count("right") >= 0.85 * number


def test_requests_of_another_author_are_read(knowledge):
    """At first sight 28 of these 100 were read; `remote` is another name of the class in the goal."""
    found = [(outcome(goal, text, knowledge), text) for goal, text in pairs("requests_of_another_author.txt")]
    assert len(found) == 100 and sum(each == "right" for each, _ in found) >= 90
    assert [text for each, text in found if each == "wrong" and "a remote" not in text] == []


def test_requests_of_a_second_author_are_read(knowledge):
    """At first sight 67 of these 100 were read, and two were misread."""
    found = [(outcome(goal, text, knowledge), text) for goal, text in pairs("requests_of_a_second_author.txt")]
    assert len(found) == 100 and sum(each == "right" for each, _ in found) >= 84
    assert [text for each, text in found if each == "wrong"] == []


def test_requests_by_the_author_of_the_reader_are_read(knowledge):
    """At first sight 47 of these 82 were read."""
    found = [(outcome(goal, text, knowledge), text) for goal, text in pairs("requests_of_a_third_author.txt")]
    assert len(found) == 82 and sum(each == "right" for each, _ in found) >= 69
    assert [text for each, text in found if each == "wrong"] == []


def test_requests_of_a_fourth_author_are_read(knowledge):
    """At first sight 30 of these 96 were read; two goals, of a stove and of a glass of water, say something else."""
    found = [(outcome(goal, text, knowledge), text) for goal, text in pairs("requests_of_a_fourth_author.txt")]
    assert len(found) == 96 and sum(each == "right" for each, _ in found) >= 62
    assert [text.split()[0] for each, text in found if each == "wrong"] == ["Stick", "Apple"]


def test_requests_of_a_fifth_author_are_read(knowledge):
    """At first sight 34 of these 48 were read; a glass of water is water to us, and a glass in two goals."""
    found = [(outcome(goal, text, knowledge), text) for goal, text in pairs("requests_of_a_fifth_author.txt")]
    assert len(found) == 48 and sum(each == "right" for each, _ in found) >= 41
    assert all("glass of water" in text for each, text in found if each == "wrong")


@pytest.mark.parametrize(
    "text",
    [
        "Take the plates off the table.",
        "Put the milk in the fridge while never opening it.",
        "Put the milk in the fridge, because I said never open the oven.",
        "Put the milk in the fridge, where it must not be opened.",
        "Put the milk in the fridge unless it is on the table.",
        "Put the milk in the fridge if the TV is on.",
        "Put a dirty plate in the sink.",
        "Put a plate each on the table.",
        "For three guests, put a plate on the table.",
        "There should be no plates on the table.",
        "Put a plate on the table, not on the sofa.",
        "Hands off the fridge.",
        "Take two plates, one on the table and one in the sink.",
        "Leave the fridge open and the milk in it.",
        "Get the milk out of the fridge.",
        "Put a plate or a cup on the table.",
        "Put a plate on the table or in the sink.",
        "Take the milk or the juice.",
        "Have no milk in your hand.",
        "Don't hold a cup.",
        "The milk should not be on the table.",
        "Sit on the bed with a book.",
        "Put the cup next to the plate.",
        "On the kitchen table, please.",
        "Hold a cup on the table.",
        "Put one more plate on the table.",
    ],
)
def test_what_means_something_else_is_refused(knowledge, text):
    with pytest.raises(HearthError) as caught:
        read_instruction(text, knowledge)
    assert caught.value.diagnostics[0].code is Code.SYNTAX


@pytest.mark.parametrize(
    "text",
    [
        "Vacuum the spaceship. Put a plate on the dining table.",
        "Put a plate on the dining table and polish it.",
        "Put a plate on the dining table carefully.",
        "Where is the milk?",
        "Put it on the table.",
        "Put the plates on the table.",
        "Put all plates on the table.",
        "Two lamps should be off.",
        "Shut a table lamp off.",
        "Put a plate and a unicorn on the table.",
        "Take a plate to the dresser.",
        "Put a plate on the table. Put a plate on the table.",
        "Grab a plate and a fork on the table.",
        "Look at the socks under it.",
        "Thank you!",
        "please " * 90,
        "and " * 190,
        "put a plate and " * 48 + "a fork on the table",
        "put a plate " * 2_000,
        "Put a plate on the \x1b[2Jtable.",
        "Pon un plato sobre la mesa.",
    ],
)
def test_what_is_not_understood_whole_is_refused(knowledge, text):
    with pytest.raises(HearthError) as caught:
        read_instruction(text, knowledge)
    assert caught.value.diagnostics[0].code is Code.SYNTAX


@pytest.mark.parametrize(
    ("text", "goal"),
    [
        ("Take the broom in your hands.", "HOLDS(agent, broom)"),
        ("Find the milk.", "HOLDS(agent, milk)"),
        (
            "I'd love two plates on the kitchen table, and a floor lamp on.",
            "ON(plate, kitchen_table): 2 and ON(floor_lamp)",
        ),
        ("Have a seat on the bed, with a book in your hand.", "ON(agent, bed) and HOLDS(agent, book)"),
        (
            "Kill all table lamps. Whatever you do, don't open the fridge.",
            "not ON(tablelamp) and (not ([Open](fridge)))",
        ),
        ("Dress up the sideboard with two packs of napkins.", "ON(napkin, sideboard): 2"),
        ("Take a book and open it.", "HOLDS(agent, book) and OPEN(book)"),
        ("It's late. Turn off all lamps.", "not ON(lamp)"),
        ("The milk goes in the fridge; the towels, both of them, are fine.", ""),
        ("Set the table for three with a plate and a fork.", "ON(plate, table): 3 and ON(fork, table): 3"),
        ("A cup is dirty, put it in the sink.", "INSIDE(cup, sink)"),
    ],
)
def test_single_forms(knowledge, text, goal):
    if not goal:
        with pytest.raises(HearthError):
            read_instruction(text, knowledge)
        return
    assert str(read_instruction(text, knowledge)) == goal
