"""Every failure has a sentence that says why, and its code stands at the end."""

from __future__ import annotations

import re

import pytest

from hearth.schemas.failure_words import REMEDIES, SPECIAL, WHY, listed, sentence, step_number, why
from hearth.schemas.failures import Code, Failure
from hearth.schemas.syntax import parse_program

STEP = "[Grab] <milk> (1.143)"
JARGON = re.compile(r"\bedge|\bhop\b|\btick\b|[{}]|, [,.]|  |None|it has some|can't be placed")


def failed(code, *names, expected="", actual="", action="Grab", agent=0):
    ids = tuple(range(100, 100 + len(names)))
    return Failure(code, 2, agent, action, ids, names, expected, actual)


@pytest.mark.parametrize("code", Code)
def test_every_code_has_a_sentence(code):
    for failure in (failed(code), failed(code, "milk", "mini_fridge"), Failure(code)):
        said = sentence(failure, 3, STEP)
        assert said.startswith(f"step 3 failed: {STEP}: ") and said.endswith(f" ({code})"), said
        assert not JARGON.search(said) and "_" not in said.removesuffix(f"({code})").replace(STEP, ""), said
        assert len(why(failure)) > 10


def test_the_tables_name_codes_once():
    assert set(WHY) == set(Code)
    assert set(REMEDIES) <= set(Code) and all(code in WHY for code, _ in SPECIAL)


@pytest.mark.parametrize(
    ("failure", "said"),
    [
        (failed(Code.INSIDE_CLOSED, "milk", "fridge"), "the milk is inside the fridge, which is closed"),
        (failed(Code.NOT_CLOSE, "milk"), "the character is not near the milk; walk to it first"),
        (failed(Code.NO_FREE_HAND, "cup", "milk", "juice"), "both hands are full: they hold the milk and the juice"),
        (failed(Code.OCCUPIED, "bed", "cat"), "there is no room left on the bed: the cat is on it"),
        (failed(Code.NOT_HOLDING, "bread", expected="a knife in a hand"), "the character holds no knife"),
        (failed(Code.DOOR_CLOSED, "door", "bath_room"), "a closed door is in the way to the bath room"),
        (failed(Code.UNBOUND, "shower", actual="it has none"), "the home has no shower"),
        (failed(Code.UNBOUND, "cup", actual="77, which the home lacks"), "the home has no node 77 (cup)"),
        (failed(Code.UNBOUND, "cup", actual="no node"), "the cup is bound to nothing in the home"),
        (failed(Code.UNKNOWN_AGENT, actual="1 in this home", agent=3), "there is no character 3: the home has 1"),
        (failed(Code.NO_ROOM, "attic", expected="a home with a attic", actual="elm has none"), "a attic; elm"),
        (failed(Code.NO_PATH, expected="1 m of free floor ahead", actual="0.20 m"), "floor ahead, and there is 0.20 m"),
        (
            failed(Code.CONFLICT, "cup", actual="HELD_BY_OTHER after what the other did in this tick"),
            "another character holds the cup, after the other character's act in the same step",
        ),
        (failed(Code.NO_PLACE, "cup", expected="a thing", actual="another"), "no place for the cup: it takes a thing"),
    ],
)  # fmt: skip
def test_sentences_name_what_is_at_fault(failure, said):
    assert said in sentence(failure)


def test_what_usually_helps_gives_way_to_what_helps_here():
    failure = failed(Code.NOT_CLOSE, "milk")
    assert sentence(failure, 1, STEP, "walk to the fridge first").endswith("; walk to the fridge first (NOT_CLOSE)")
    assert sentence(failure) == "the character is not near the milk; walk to it first (NOT_CLOSE)"


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ([], "something"),
        (["cup"], "the cup"),
        (["cup", "tea_bag"], "the cup and the tea bag"),
        (list("abcd"), "the a, the b, the c and the d"),
        (list("abcde"), "the a, the b, the c, the d and 1 more thing"),
        (list("abcdef"), "the a, the b, the c, the d and 2 more things"),
    ],
)
def test_names_are_listed(names, said):
    assert listed(names) == said


def test_steps_of_one_tick_are_told_apart_by_their_agents():
    program, _ = parse_program("T\n\n\n[Walk] <a> (1)\n<char0> [Walk] <a> (1) | <char1> [Walk] <b> (1)\n[Sleep]\n")
    numbers = [
        step_number(program, Failure(Code.SITTING, tick, agent)) for tick, agent in ((0, 0), (1, 0), (1, 1), (2, 0))
    ]
    assert numbers == [1, 2, 3, 4]
