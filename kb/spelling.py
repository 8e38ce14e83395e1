"""Comparison of names, and the known names that a writer of an unknown one may have meant."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

_DROPPED = {ord(letter): None for letter in " _-"}
_LIKENESS = 75
"""Of 100: how like a spelling must be. `Listen` and `LieOn` have 73."""
_BEGINNING = 3
"""Letters that a beginning of a name needs at least: many a name begins with an `s`."""


def key_of(name: str) -> str:
    """Return a name for comparison: case, spaces, hyphens and underscores left out."""
    return name.lower().translate(_DROPPED)


def near_names(name: str, spellings: Mapping[str, str]) -> tuple[str, ...]:
    """Return the names that may be meant, most probable first: at most three.

    Args:
        name: as it was written.
        spellings: every known spelling, as `key_of` gives it -> the name it stands for.
    """
    found = (*_alike(name, spellings), *_begun(name, spellings), *_words(name, spellings))
    return tuple(dict.fromkeys(found))[:3]


def _alike(name: str, spellings: Mapping[str, str]) -> Iterator[str]:
    """Names written much like it."""
    from rapidfuzz import fuzz, process

    close = process.extract(key_of(name), list(spellings), scorer=fuzz.ratio, limit=None, score_cutoff=_LIKENESS)
    return (spellings[key] for key, _, _ in close)


def _begun(name: str, spellings: Mapping[str, str]) -> Iterator[str]:
    """Names of which it is the beginning."""
    key = key_of(name)
    return (known for spelled, known in spellings.items() if len(key) >= _BEGINNING and spelled.startswith(key))


def _words(name: str, spellings: Mapping[str, str]) -> Iterator[str]:
    """Names that are words of it; the last word says most: a kitchen table is a table."""
    words = reversed(re.split(r"[\s_-]+", name))
    return (spellings[key_of(word)] for word in words if key_of(word) in spellings)
