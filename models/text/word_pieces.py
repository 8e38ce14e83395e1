"""The pieces of words that a BERT model reads (WordPiece, uncased), by the list of pieces in its folder."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Mapping
from pathlib import Path

FIRST, LAST, UNKNOWN = "[CLS]", "[SEP]", "[UNK]"
"""The marks around a text, and for a word that has no pieces."""

LONGEST = 100
"""Characters of a word that is taken apart."""


def pieces_of(file: Path) -> dict[str, int]:
    """Return the numbers of the pieces in a list, `vocab.txt`."""
    return {piece: number for number, piece in enumerate(file.read_text(encoding="utf-8").split("\n")) if piece}


def numbered(text: str, pieces: Mapping[str, int], most: int) -> list[int]:
    """Return the numbers of a text's pieces between the two marks, `most` at most."""
    found = [pieces[piece] for word in _words(text) for piece in _taken_apart(word, pieces)]
    return [pieces[FIRST], *found[: most - 2], pieces[LAST]]


def _words(text: str) -> Iterator[str]:
    """Yield the words of a text without accents and capitals; a punctuation mark is a word."""
    word = ""
    for letter in unicodedata.normalize("NFD", text.lower()):
        kind = unicodedata.category(letter)
        alone = kind[0] in "PS" and (kind[0] == "P" or letter.isascii())
        if kind == "Mn" or (kind[0] == "C" and not letter.isspace()):
            continue
        if alone or letter.isspace():
            if word:
                yield word
            word = ""
            if alone:
                yield letter
        else:
            word += letter
    if word:
        yield word


def _taken_apart(word: str, pieces: Mapping[str, int]) -> list[str]:
    """Return the longest pieces of a word, from its beginning; later ones are marked by `##`."""
    found: list[str] = []
    start = 0
    while start < len(word) <= LONGEST:
        mark = "##" if start else ""
        ends = range(len(word), start, -1)
        end = next((end for end in ends if mark + word[start:end] in pieces), start)
        if end == start:
            return [UNKNOWN]
        found.append(mark + word[start:end])
        start = end
    return found or [UNKNOWN]
