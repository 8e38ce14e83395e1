"""The requests that the words of a clause may be, and the wordings of a clause that mean the same."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_verb, verb_lemmas
from hearth.kb.language.word_tables import lemmas
from hearth.models.reading.mentioned_nodes import fits
from hearth.models.reading.mentions import mentions_in
from hearth.models.reading.request_table import Pattern, Request, requests, words

_WHERE = re.compile(
    r"(?:to|on|in|into|near|by|over|up|out|and|back|home|online|outside|through|around|for|down|inside|next"
    r"|stand|close to)\b"
)


_ADVERB = re.compile(r"\b[a-z]{3,}ly\b")

_PLACES = frozenset("pyd")
"""Slots of one thing: places, vessels and devices."""


@lru_cache(maxsize=4096)
def matches(known: Knowledge, text: str) -> tuple[tuple[Request, Pattern, Mapping[str, str]], ...]:
    """Return the requests that a clause may be, with the words of their slots: those whose things are of their kind."""
    found = []
    for request in requests():
        for pattern in request.patterns:
            match = pattern.pattern.fullmatch(text)
            if match and all(
                match[name] is None or _may_be(known, match[name], needs, is_one=name in _PLACES)
                for name, needs in pattern.needs.items()
            ):
                found.append((request, pattern, match.groupdict("")))
    return tuple(found)


def _may_be(known: Knowledge, text: str, needs: frozenset[str], *, is_one: bool) -> bool:
    mentions = mentions_in(known, text)
    return 0 < len(mentions) <= (1 if is_one else len(mentions)) and all(
        each.back or any(fits(known, name, needs) for name in each.classes) for each in mentions
    )


@lru_cache(maxsize=4096)
def is_manner(word: str) -> bool:
    """Return whether a word is an adverb that changes nothing of a request, as `briefly` is."""
    return set(lemmas(word)) == {"ADV"} and word != "only"


@lru_cache(maxsize=4096)
def plain_words(text: str) -> str:
    """Return a clause without courtesy, and without openings such as `could you`."""
    table = words()
    text = _ADVERB.sub(lambda found: "" if is_manner(found[0]) else found[0], table.courtesy.sub(" ", text.lower()))
    text = " ".join(text.split()).strip(' ,;:.!?-"')
    while (found := table.openings.match(text)) and found.end():
        text = text[found.end() :].strip(" ,")
    first, _, rest = text.partition(" ")
    if first == "go" and rest and is_verb(rest.partition(" ")[0]) and not _WHERE.match(rest):
        text = rest
    return re.sub(r" +([,;])", r"\1", text)


@lru_cache(maxsize=4096)
def variants(text: str) -> tuple[str, ...]:
    """Return the wordings of a clause: with its verb in the base form, and without endings that change nothing."""
    found: dict[str, None] = {}
    for each in _shortened(text):
        found.setdefault(each)
        for base in _based(each):
            found.setdefault(base)
    return tuple(found)


def _shortened(text: str) -> Iterator[str]:
    yield text
    shorter = [text]
    for _ in range(3):
        found = [left for each in shorter for pattern in words().endings if (left := pattern.sub("", each)) != each]
        shorter = [each.strip(" ,") for each in dict.fromkeys(found) if each.strip(" ,")]
        yield from shorter


def _based(text: str) -> Iterator[str]:
    first, space, rest = text.partition(" ")
    for lemma in verb_lemmas(first):
        if lemma != first:
            yield f"{lemma}{space}{rest}"
