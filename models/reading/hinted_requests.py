"""Requests that are only hinted at, such as `I'm thirsty` (`hints` of `kb/language/request_words.yaml`)."""

from __future__ import annotations

import re

from hearth.models.reading.request_table import hints

_CLAUSES = re.compile(r"[,.;!?:]+ | and | but | because | so | - ")
_EXCLAMATION = re.compile(
    r"^(?:(?:ugh|oh|oh no|hey|look|gosh|damn|wow|hmm+|yuck|eww?|well|listen|honestly|i think|i see),? )+"
)


def hinted_request(text: str) -> str:
    """Return the request that a text hints at; "" where it hints at none."""
    plain = _EXCLAMATION.sub("", " ".join(text.lower().replace("\u2019", "'").split()).strip(" .!?"))
    for clause in dict.fromkeys((plain, *(each.strip() for each in _CLAUSES.split(plain)))):
        found = ((pattern.fullmatch(clause), request) for pattern, request in hints())
        if request := next((match.expand(request) for match, request in found if match), ""):
            return request
    return ""
