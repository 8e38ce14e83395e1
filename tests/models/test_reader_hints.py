"""Hints, telegrams, statements, the room that was spoken of, and instructions of other authors, by the reader."""

from __future__ import annotations

from pathlib import Path

import pytest

from hearth.analysis.everyday_instructions import asking, figures, homes_for, rows_of, start_without, tried
from hearth.models.reading.reader import Reader
from hearth.models.reading.statements import is_statement
from hearth.schemas.goals import Goal
from hearth.simulation.rules import CONSEQUENCES

AUTHORS = ("second", "third", "fourth")


@pytest.fixture(scope="module")
def birch():
    return start_without(Goal(), "birch", "test")


def steps_of(text, world):
    answer = Reader().answer(text, world, CONSEQUENCES)
    steps = () if answer.written is None else answer.written.execution.program.steps
    return [f"{step.action} {' '.join(ref.name for ref in step.objects)}".strip() for step in steps]


@pytest.mark.parametrize(("text", "step"), [
    ("I'm thirsty.", "Drink juice"),
    ("The kitchen counter is filthy.", "Wash kitchen_counter"),
    ("Somebody spilled juice on the kitchen table. Wipe it up.", "Wipe kitchen_table"),
    ("3 books, coffee table.", "PutBack book coffee_table"),
    ("Blanket: fold, then couch.", "PutBack blanket couch"),
    ("Once the blanket is folded, lay it on the sofa.", "Fold blanket"),
    ("clean the stove, then the oven", "Wash oven"),
    ("Turn the radio on, then the tv.", "SwitchOn television"),
    ("Could you take a sponge to the fridge?", "Wash fridge"),
    ("My back hurts. Bring me a pillow.", "Grab pillow"),
    ("I'd appreciate it if you could fold those pants.", "Fold clothes_pants"),
    ("Let's eat, put the plate on the dining table.", "PutBack plate dining_table"),
])  # fmt: skip
def test_requests_without_a_verb_or_a_plain_wish_are_done(text, step, birch):
    assert step in steps_of(text, birch)


@pytest.mark.parametrize(("text", "wrong"), [
    ("Put the letter in the envelope.", "Write"),
    ("Slide the nightstand next to the bed.", "Move dining_table"),
    ("Put the plate on the dining table, I'll eat there tonight.", "Eat"),
    ("Use the soap, the sun's strong.", "SwitchOn"),
    ("Have a nap on the sofa, instead of the bed.", "Lie bed"),
])  # fmt: skip
def test_words_that_ask_for_nothing_change_nothing(text, wrong, birch):
    assert not any(step.startswith(wrong) for step in steps_of(text, birch))


def test_the_window_is_that_of_the_room_that_was_spoken_of():
    world = start_without(Goal(), "maple", "test")
    rooms = {}
    for room in ("bedroom", "living room"):
        written = Reader().answer(f"It smells in the {room}. Open the window.", world, CONSEQUENCES).written
        rooms[room] = {ref.node for step in written.execution.program.steps for ref in step.objects}
    assert rooms["bedroom"] != rooms["living room"]


@pytest.mark.parametrize(("text", "expected"), [
    ("my back hurts", True), ("the sun's strong", True), ("who's there", True), ("we are going to bed", True),
    ("the milk should go in the fridge", False), ("put the cup away", False), ("you can have some juice", False),
    ("nobody may open the oven", False), ("you can't use the oven", False), ("the oven can't be opened", False),
    ("the fridge is off limits", False), ("you are not to touch the stove", False), ("no one touches the tv", False),
    ("the plates belong in the cupboard", False), ("nobody may open the fridge, never", False),
])  # fmt: skip
def test_statements_are_not_wishes(text, expected):
    assert is_statement(text) is expected


@pytest.mark.parametrize("text", [
    "Bring me the milk; nobody may open the oven.",
    "Put a plate on the table. The oven can't be opened.",
    "Put a plate on the table, the fridge is off limits.",
    "Wash the cup if the sink is clean.",
    "Bring me the book unless it is dark.",
])  # fmt: skip
def test_bans_and_conditions_that_are_not_understood_are_refused(text, birch):
    assert steps_of(text, birch) == []


@pytest.mark.parametrize("author", AUTHORS)
def test_instructions_of_other_authors_are_reached(author):
    asked = asking(Reader())
    rows = rows_of(Path(__file__).with_name(f"everyday_{author}_author.jsonl"))[::2]
    one = figures([tried(row, row.instruction, homes_for(row)[0], asked) for row in rows])
    assert one.reached > 0.93 and one.repeats == 0 and one.held == 0
