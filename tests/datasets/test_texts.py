"""Texts in one piece are those of a list."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.datasets.format.compact_texts import Letters, Texts, letter

some = st.lists(st.text(st.characters(exclude_categories=["Cs"]), max_size=5) | st.sampled_from(["", "a", "é", "😀"]))


@given(some)
def test_they_are_those_of_a_list(texts):
    found = Texts(texts)
    assert list(found) == texts and len(found) == len(texts)
    assert [found[place] for place in range(-len(texts), len(texts))] == texts * 2
    assert list(found[1:3]) == texts[1:3]
    for beyond in (len(texts), -len(texts) - 1):
        with pytest.raises(IndexError):
            found[beyond]
    found.append("ü")
    assert found[-1] == "ü"


@given(some)
def test_their_order_is_that_of_strings_and_keeps_equal_ones_in_order(texts):
    assert Texts(texts).order().tolist() == sorted(range(len(texts)), key=texts.__getitem__)


@given(some, st.text(max_size=2))
def test_one_is_found_in_order(texts, other):
    names = sorted({*texts})
    found = Texts(names)
    assert [found.find(name) for name in names] == list(range(len(names)))
    assert found.find(other) == (names.index(other) if other in names else None)


def test_letters_are_characters_that_differ():
    numbers = [0, 1, 0xD7FF, 0xD800, 0xE000, 1_000_000]
    letters = [letter(number) for number in numbers]
    assert letters == sorted(letters) and [each.encode().decode() for each in letters] == letters
    of = Letters()
    assert of.text(("walk", "sofa")) == of.text(["walk", "sofa"]) != of.text(["sofa", "walk"])
    assert len(of) == 2 and of.text(()) == ""
