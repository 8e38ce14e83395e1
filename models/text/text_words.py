"""Words of descriptions: how a text becomes the words that models see."""

import re

from hearth.models.interface import Request

LONGEST = 120
"""Words of a text that are read; of our longest description, and 1.5 times as many."""

_WORD = re.compile(r"[^\W\d_]+(?:'[^\W\d_]+)?|\d+")

BREAK = "|"
"""Stands between the title and the description."""


def words(text: str) -> list[str]:
    """Return the words of a text in lower case, without punctuation (thesis 4.3.2).

    `Don't TURN it` is don't, turn, it.
    """
    return [found.group().lower() for found in _WORD.finditer(text[: LONGEST * 20])]


def words_of(request: Request) -> list[str]:
    """Return the words of the title, a break, and the words of the description, at most `LONGEST` of them."""
    title, description = words(request.title), words(request.description)
    return [*title, BREAK, *description][:LONGEST] if title else description[:LONGEST]
