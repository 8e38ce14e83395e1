"""The words of a request by kinds: phrases of `request_words.yaml` and names of things."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from typing import Any, NamedTuple

from hearth.challenges.instruction_object_names import NUMBERS
from hearth.challenges.paraphrase_things import Known, things
from hearth.models.reading.statements import is_statement
from hearth.schemas.yaml_limits import packaged

LONGEST_NAME = 7
"""Words of a thing with its number, at most."""

_WORDS = re.compile(r"[a-z0-9'-]+|[,.:;!?]")
_REASONS = re.compile(r",? so (?:that )?(?:i|we|you|they|he|she) (?:can|could|will|may)(?: [a-z']+){1,3}(?=[.!?;]|$)")
_PEOPLE = re.compile(
    r"\b(?:for )?(two|three|four|five|six) (people|guests|persons|of us|visitors|friends)\b"
    r"(?: (?:are|will|come|want|have)[^.!?;]*)?,?"
    r"|\bfor (two|three|four|five|six)\b,?"
)
_EACH = re.compile(r"\b(?:for )?each(?: of (?:them|us|you))?(?: (?:needs?|gets?|wants?|should have|has))?\b")
_PIECES = re.compile(
    r"(, so |, and |, but | so (?=(?:could|would|can|i|we|please|make|put|get|take|turn)\b)|[,.:;!?]\s+)"
)
_LEADING = re.compile(r"^(?:(?:and|but|so|oh|right|well|ok|okay|please|now|then|also),? )+")
_CHATS = re.compile(
    r"(?:i want to show|i want the kids"
    r"|when|whenever|while|before|after|once|until|till|if|because|since|as|so that|where|which|who|let's|time for"
    r"|for the|don't ask|just|right|it's|i'll|we'll|we won't|i've|we've|i'm|we're|there'll|thanks|thank you)\b"
)
_FOR_WHOM = re.compile(r" for (?!one\b|two\b|three\b|four\b|each\b)[a-z]+(?=,| and |[.!?]|$)")
_PAIRS = re.compile(r"\b(two|three|four) pairs of ")
_TAILS = re.compile(
    r",? (?:till|until|where|because|since|so (?:that )?(?:i|we|you|they|he|she|it|it's)|i want to|for our|there are) "
    r"[^,.!?;:]*(?=[,.!?;:]|$)"
)
_STATED = re.compile(r"\b(the|a|an|my|your|our|some|two|three|four) (?:nice|fresh|spare|lovely|good) ")
_BOTH = re.compile(r"\bboth (?=(?:the|a|an|my|your|our) [a-z' -]+?(?<!s) and )")
_FORBIDDING = frozenset({"no", "ban", "banned", "open", "shut", "dark", "turn_off"})
_ASKING = frozenset(
    {
        "put",
        "take",
        "hold",
        "fill",
        "dress",
        "wear",
        "turn_on",
        "turn_off",
        "no",
        "ban",
        "banned",
        "open",
        "shut",
        "rest",
        "it",
    }
)
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


def for_people(text: str) -> tuple[str, int]:
    """Return a request without its number of people, and that number, by which things for each of them count.

    Raises:
        RefusedError: people are named, and not that each of them gets something.
    """
    found = _PEOPLE.search(text)
    if not found:
        return text, 1
    if not _EACH.search(text):
        if found[2]:
            raise RefusedError
        return text, 1
    return _EACH.sub(" ", text.replace(found[0], " ")), NUMBERS.index(found[1] or found[3])


def is_aside(sentence: str, known: Known) -> bool:
    """Return whether a sentence names no thing and has no word that asks for something: `the kids are done playing`."""
    grams = _grams(sentence)
    if any(each in known.one or each in known.many for each in grams):
        return False
    kinds = {kind for each in grams for kind in _phrases().get(each, ())}
    return kinds.isdisjoint(_ASKING)


def without_reasons(text: str, known: Known, rooms: frozenset[str] = frozenset()) -> str:
    """Return a request without what asks for nothing: reasons, as `so I can see`, and chat that names no thing."""
    text = _STATED.sub(r"\1 ", _PAIRS.sub(r"\1 ", _BOTH.sub("", _REASONS.sub("", text))))
    text = _TAILS.sub(lambda tail: "" if _is_empty_talk(tail[0], known, rooms) else tail[0], text)
    text = _FOR_WHOM.sub(lambda found: found[0] if _names_things(found[0], known, rooms) else "", text)
    pieces = _PIECES.split(text)
    kept = ""
    for piece, joint in zip(pieces[::2], [*pieces[1::2], ""], strict=True):
        plain = _LEADING.sub("", piece.strip())
        if not is_chat(plain, known, rooms):
            kept += piece + joint
        elif joint.strip()[:1] in (".", "!", "?", ";"):
            kept += joint
    return kept


def is_chat(piece: str, known: Known, rooms: frozenset[str]) -> bool:
    """Return whether a part of a sentence names no thing and asks for nothing: `we're going to bed`."""
    if not piece or not _is_empty_talk(piece, known, rooms):
        return False
    return bool(_CHATS.match(piece)) or is_statement(piece) or is_aside(piece, known)


def _is_empty_talk(piece: str, known: Known, rooms: frozenset[str]) -> bool:
    """Return whether a part names no thing and forbids nothing: `while never opening it` says something."""
    kinds = {kind for each in _grams(piece) for kind in _phrases().get(each, ())}
    return kinds.isdisjoint(_FORBIDDING) and not _names_things(piece, known, rooms)


def _grams(text: str) -> list[str]:
    """Return the runs of words of a text, as long as the longest phrase may be."""
    words = re.findall(r"[a-z0-9'-]+", text)
    return [" ".join(words[at : at + n]) for n in range(1, LONGEST_NAME + 1) for at in range(len(words) - n + 1)]


def _names_things(piece: str, known: Known, rooms: frozenset[str]) -> bool:
    """Return whether a part of a request names a thing; a room alone, as `let's sort the bedroom` has, is none."""
    return any((each in known.one or each in known.many) and each not in rooms for each in _grams(piece))


def tokens(text: str, known: Known, people: int = 1) -> Iterator[Token]:
    """Yield the kinds of words, the longest phrase or name first; a name with its number before a phrase as long.

    Raises:
        RefusedError: a word is of no kind.
    """
    words = _WORDS.findall(text.replace("each and every", "every"))
    at, phrases = 0, _phrases()
    while at < len(words):
        for length in range(min(LONGEST_NAME, len(words) - at), 0, -1):
            phrase = " ".join(words[at : at + length])
            named = (
                things(phrase, known, people) if not re.search(r"[,.:;!?]|\b(?:and|or|nor|with)\b", phrase) else None
            )
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
