"""Shorthand of typed requests, written out: `pls`, `n`, `w/`, `gonna`, and contractions of a wish."""

from __future__ import annotations

import re
from functools import cache

from hearth.models.reading.request_table import shorthand

_ARROW = re.compile(r" *(?:-+>|=+>|\u2192) *")
_WOULD = re.compile(
    r"\b(i|we|he|she|they)'d (?=(?:really |very much |also )*(?:like|love|prefer|appreciate|want)\b)", re.I
)


def written_out(text: str) -> str:
    """Return a text with its shorthand written out, and with straight apostrophes."""
    text = _ARROW.sub(" to ", text)
    text = _WOULD.sub(r"\1 would ", text.replace("\u2019", "'"))
    return _pattern().sub(lambda found: shorthand()[found[0].lower()], text)


@cache
def _pattern() -> re.Pattern[str]:
    words = "|".join(map(re.escape, sorted(shorthand(), key=len, reverse=True)))
    return re.compile(rf"(?<![\w'&/+-])(?:{words})(?![\w'/+-])", re.IGNORECASE)
