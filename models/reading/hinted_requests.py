"""Requests that are only hinted at, such as `I'm thirsty` (`hints` of `kb/language/request_words.yaml`)."""

from __future__ import annotations

from hearth.models.reading.request_table import hints


def hinted_request(text: str) -> str:
    """Return the request that a text hints at; "" where it hints at none."""
    plain = " ".join(text.lower().replace("\u2019", "'").split()).strip(" .!?")
    found = ((pattern.fullmatch(plain), request) for pattern, request in hints())
    return next((match.expand(request) for match, request in found if match), "")
