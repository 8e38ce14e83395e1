"""Misspelled words of a request, put right where one known word is meant."""

from __future__ import annotations

import re
from functools import cache, lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_english
from hearth.models.reading.request_table import table_words

_WORD = re.compile(r"(?<![a-z'])[a-z]{3,}(?![a-z'])")
_LONG = 7
"""Letters from which two may be wrong."""

FEW = 3
"""Unknown words that a text may have however short it is."""

SEEN = 80
"""Words of a text by which its language is known."""

_FUNCTION_WORDS = [
    "the",
    "and",
    "then",
    "with",
    "from",
    "into",
    "onto",
    "before",
    "after",
    "please",
    "again",
    "don't",
    "for",
    "off",
    "that",
    "when",
    "while",
    "where",
    "there",
    "once",
    "until",
    "both",
    "all",
    "every",
    "some",
    "your",
    "make",
    "sure",
    "first",
    "finally",
    "remember",
    "lastly",
    "usually",
    "always",
    "afterwards",
    "together",
    "because",
    "already",
    "really",
]
"""Words that no table has."""


def spelled(known: Knowledge, text: str) -> str:
    """Return a text in small letters in which words that are not English are the known words next to them.

    A text of which most words are unknown is left as it is: it is in another language, or in none.
    """
    if not _is_english(known, text):
        return text
    return _WORD.sub(lambda found: _corrected(known, found[0]), text)


def corrections(known: Knowledge, text: str) -> tuple[str, ...]:
    """Return the words of a text that `spelled` puts right, each once: `teh = the`."""
    if not _is_english(known, text.lower()):
        return ()
    pairs = ((word, _corrected(known, word)) for word in _WORD.findall(text.lower()))
    return tuple(dict.fromkeys(f"{word} = {new}" for word, new in pairs if new != word))


@lru_cache(maxsize=4096)
def _is_english(known: Knowledge, text: str) -> bool:
    """Return whether at most a few words of a text, or half of them, are unknown."""
    found = _WORD.findall(text)[:SEEN]
    unknown = {word for word in found if word not in _vocabulary(known) and not is_english(word)}
    return len(unknown) <= max(FEW, len(set(found)) // 2)


@lru_cache(maxsize=16_384)
def _corrected(known: Knowledge, word: str) -> str:
    if word in _vocabulary(known) or is_english(word):
        return word
    from rapidfuzz import process
    from rapidfuzz.distance import OSA

    most = 2 if len(word) >= _LONG else 1
    found = process.extract(word, _spellings(known), scorer=OSA.distance, score_cutoff=most, limit=None)
    near = [(distance, sorted(each) != sorted(word), each) for each, distance, _ in found]
    best = sorted(near)
    is_sure = best and (len(best) == 1 or best[0][:2] < best[1][:2])
    return best[0][2] if is_sure else word


@cache
def _vocabulary(known: Knowledge) -> frozenset[str]:
    names = {part for name in known.object_spellings for part in re.split("[^a-z]+", name)}
    return frozenset(word for word in (*table_words(), *names, *_FUNCTION_WORDS) if len(word) > 2)


@cache
def _spellings(known: Knowledge) -> tuple[str, ...]:
    return tuple(sorted(_vocabulary(known)))
