"""The words of a request by kinds: phrases of `request_words.yaml` and names of things."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

from hearth.challenges.paraphrase_things import Known, things
from hearth.schemas.yaml_limits import packaged

LONGEST_NAME = 7
"""Words of a thing with its number, at most."""

_WORDS = re.compile(r"[a-z0-9'-]+|[,.:;!?]")
_END = frozenset(".;!?")


class Token(NamedTuple):
    """Some words of a request: their kind, and the thing that they name, if it is `thing`."""

    kind: str
    words: str
    thing: tuple[str, int] = ("", 0)


class RefusedError(Exception):
    """A request that is not understood whole."""


@cache
def _phrases() -> Mapping[str, tuple[str, ...]]:
    """Return the kinds of each phrase, in the order of the file."""
    found: dict[str, tuple[str, ...]] = {}
    data: Mapping[str, Any] = packaged("hearth.challenges", "request_words.yaml")
    for kind, phrases in data.items():
        for phrase in phrases:
            found[phrase] = (*found.get(phrase, ()), kind)
    return found


def tokens(text: str, known: Known) -> Iterator[Token]:
    """Yield the kinds of words, the longest phrase or name first; a name with its number before a phrase as long.

    Raises:
        RefusedError: a word is of no kind.
    """
    words = _WORDS.findall(text.replace("each and every", "every"))
    at, phrases = 0, _phrases()
    while at < len(words):
        for length in range(min(LONGEST_NAME, len(words) - at), 0, -1):
            phrase = " ".join(words[at : at + length])
            named = things(phrase, known) if not re.search(r"[,.:;!?]|\b(?:and|or|nor|with)\b", phrase) else None
            if named and len(named) == 1 and (length > 1 or phrase not in phrases):
                yield Token("thing", phrase, (str(named[0][0]), named[0][1]))
                break
            if phrase in phrases or (length == 1 and not phrase[0].isalnum()):
                yield Token(" ".join(phrases.get(phrase, (phrase,))), phrase)
                break
        else:
            raise RefusedError
        at += length


def sentences(found: list[Token]) -> Iterator[list[Token]]:
    """Part tokens at the marks that end sentences."""
    part: list[Token] = []
    for token in found:
        if token.kind in _END:
            yield part
            part = []
        else:
            part.append(token)
    yield part
