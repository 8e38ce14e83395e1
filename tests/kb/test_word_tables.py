"""The tables of words give what the libraries give that ship them."""

import random

import lemminflect
import pytest
from spellchecker import SpellChecker

from hearth.kb.language import word_tables
from hearth.kb.language.english_lexicon import inflections

LEMMAS = word_tables._text("lemminflect", "lemma_lu.csv.gz").decode().splitlines()
WORDS = sorted({word for row in LEMMAS if (word := row.split(",")[0]).islower()})
EVERYDAY = SpellChecker(language="en").word_frequency.dictionary
MODALS = ["can", "may", "will", "shall", "must", "ought", "dare", "be", "have", "do", "all", "another", "data", "bless"]


@pytest.mark.parametrize("seed", range(4))
def test_lemmas_and_forms_are_those_of_the_library(seed):
    for word in [*random.Random(seed).sample(WORDS, 1500), *MODALS, "zzzz", ""]:
        if word:
            assert word_tables.lemmas(word) == lemminflect.getAllLemmas(word), word
        for kind in ("NOUN", "VERB"):
            theirs = lemminflect.getAllInflections(word, upos=kind) if word else {}
            forms = {form for spelt in theirs.values() for form in spelt}
            assert set(word_tables.inflected(word, kind)) == forms, (word, kind)


def test_words_of_everyday_english_are_those_of_the_library():
    for word in [
        *random.Random(0).sample(sorted(EVERYDAY), 300),
        *random.Random(1).sample(WORDS, 300),
        "zzzz",
        "",
        "abbé's",
        "don't",
    ]:
        assert word_tables.is_everyday(word) == (word in EVERYDAY), word
    assert word_tables.is_everyday("fridge") and not word_tables.is_everyday('the": 1')


@pytest.mark.parametrize("file", ["lemma_lu.csv.gz", "infl_lu.csv.gz"])
def test_the_tables_are_sorted_by_word(file):
    words = [row.split(b",")[0] for row in word_tables._text("lemminflect", file).splitlines()]
    assert words == sorted(words)


def test_the_libraries_are_not_imported_to_read_their_tables():
    assert {"grabbing", "grabs"} <= set(inflections("grab"))
