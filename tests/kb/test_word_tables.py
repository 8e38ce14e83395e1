"""The tables of words give what the libraries give that ship them."""

import random

import lemminflect
import pytest
from spellchecker import SpellChecker

from hearth.kb.language import word_tables
from hearth.kb.language.lexicon import inflections

WORDS = sorted(word for word in word_tables._rows("lemma_lu.csv.gz") if word.islower())
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
    assert word_tables.everyday_words() == set(SpellChecker(language="en").word_frequency.dictionary)
    assert "fridge" in word_tables.everyday_words()


def test_the_libraries_are_not_imported_to_read_their_tables():
    assert {"grabbing", "grabs"} <= set(inflections("grab"))
