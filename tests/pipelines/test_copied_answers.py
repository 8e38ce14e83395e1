"""Copies among crowd answers: nearly the same words, nearly the same program, one answer pasted again and again."""

import pytest

from hearth.pipelines.crowd.copied_answers import Copies, pasted
from hearth.pipelines.readers.reader_items import Item

WORDS = "Walk to the kitchen and open the fridge. Take the milk out and pour yourself a glass of it."
STEPS = [f"[Walk] <thing_{number}> (1)" for number in range(10)]


def answer(number, description, worker="W"):
    cells = {"WorkerId": worker, "Answer.description": description}
    return Item(f"d{number}", "crowd", "a.csv", {"stage": 1, "cells": cells}, line=number)


def written(number, steps, worker="W", described="D1"):
    text = "\n".join(steps)
    cells = {"WorkerId": worker, "Input.description_id": described, "Input.description": "", "Answer.program": text}
    return Item(f"p{number}", "crowd", "b.csv", {"stage": 2, "cells": cells}, line=number)


def refused(items):
    items = list(items)
    copies = Copies(pasted(items))
    return [item.record_id for item in map(copies.checked, items) if item.reader == "refused"]


@pytest.mark.parametrize(
    ("other", "is_copy"),
    [
        (WORDS.upper(), True),
        (WORDS.replace("glass", "cup").replace("open", "shut"), True),
        ("Sit down on the couch and watch the news until you fall asleep there.", False),
        ("Walk to the kitchen and open the window. Wait a while for the air to clear, then close it.", False),
    ],
)
def test_words(other, is_copy):
    assert refused([answer(1, WORDS), answer(2, other, worker="V")]) == (["d2"] if is_copy else [])


def test_programs_of_one_worker_for_one_description():
    nearly = [*STEPS, "[Find] <cup> (1)"]
    items = [written(1, STEPS), written(2, nearly), written(3, nearly, worker="V"), written(4, nearly, described="D2")]
    assert refused(items) == ["p2"]


def test_one_answer_for_many_descriptions_is_refused_every_time():
    same = [written(number, STEPS, described=f"D{number}") for number in range(1, 31)]
    assert refused([*same, written(31, STEPS, worker="V")]) == [f"p{number}" for number in range(1, 31)]
    assert refused(same[:2]) == []


def test_answers_that_are_not_text_are_compared_too():
    broken = [*STEPS, "[Find] <caf\udce9> (1)"]
    assert refused([written(number, broken, described=f"D{number}") for number in range(1, 4)]) == ["p1", "p2", "p3"]
    assert refused([answer(1, f"{WORDS} \udce9"), answer(2, f"{WORDS} \udce9", worker="V")]) == ["d2"]
