"""Pronouns: the things of steps said before that `it`, `them`, `her` and `in there` stand for."""

import re
from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.lexicon import noun_lemmas

_ALONE = r"(?=$| (?:on|in|into|onto|to|with|at|back|away|up|down|off|out|from|over|under|near|next)\b)"
_MANY = rf"\bthem\b|\b(?:these|those){_ALONE}"
PRONOUN = re.compile(rf"\b(?:it|her|him)\b|{_MANY}|\b(?:that|this){_ALONE}|\bthere$", re.IGNORECASE)
_THEM = re.compile(_MANY, re.IGNORECASE)
_THINGS = re.compile(rf"\bit\b|{_MANY}|\b(?:that|this){_ALONE}", re.IGNORECASE)
_PEOPLE = re.compile(r"\b(?:her|him)\b(?=$| (?:on|in|to|with|at)\b)", re.IGNORECASE)
_PUT = r"(?:put|place|drop|set|lay|store|throw|pop|stick|leave|add|insert)(?:s|ing|ped|ting)?"
_PLACED = re.compile(
    rf"({_PUT}(?: back)? .+?)(?: back)?(?P<in> inside| in| (?:in|into|inside) there)"
    rf"|({_PUT} .+?) (?:(?:on|onto) )?there",
    re.IGNORECASE,
)
_CLOSING = re.compile(r"(?:close|shut)\b", re.IGNORECASE)
_PERSON = "PERSON"
_WAYS = "goes"
REMEMBERED = 6
"""Steps of which a pronoun may speak."""


class Mentioned(NamedTuple):
    """A step that was said before.

    Attributes:
        action: the name of its action.
        names: the classes of its things.
        instance: the number of its first thing.
        line: the line of the file on which it was said; 0 on the line that is read.
        second: the number of its second thing.
    """

    action: str
    names: tuple[str, ...]
    instance: int = 1
    line: int = 0
    second: int = 1


def with_place(known: Knowledge, words: str, said: Sequence[Mentioned]) -> str:
    """Return `put it inside`, `put it in there` and `put it there` with the name of the place that is meant."""
    put = _PLACED.fullmatch(words)
    place = _place(known, said, is_in=bool(put["in"])) if put else None
    return f"{put[1] or put[3]} {place}" if put and place else words


def _place(known: Knowledge, said: Sequence[Mentioned], *, is_in: bool) -> str | None:
    """Return the last place of a thing in steps, with `in` or `on` before it; what is open holds things as well."""
    for each in said:
        relation = known.relation_of(each.action)
        if relation == "INSIDE" or each.action == "Pour" or (each.action == "Open" and is_in):
            return f"in {_spelt(each.names[-1])}"
        if relation == "ON" and not is_in:
            return f"on {_spelt(each.names[-1])}"
    return None


def _spelt(name: str) -> str:
    return name.replace("_", " ")


def several(known: Knowledge, words: str, said: Sequence[Mentioned]) -> list[tuple[str, int]]:
    """Return the clauses for each of the things that `them` stands for, with their numbers; none for one thing.

    They are the things of the last act, which a line or several did to one thing after another: `grab two forks`. Where
    lines did it, the last thing alone is meant if it is many, as shoes are.
    """
    if not _THEM.search(words) or PRONOUN.search(_THEM.sub("", words)):
        return []
    named = [each for each in said if each.names]
    acts = [each for each in named if each.action not in known.group(_WAYS)] or named
    last = list(takewhile(lambda each: each.action == acts[0].action, acts))
    if any(each.line != last[0].line for each in last) and _is_many(last[0].names[0]):
        last = [each for each in last if each.line == last[0].line]
    things = dict.fromkeys((each.names[0], each.instance) for each in reversed(last))
    return [(_THEM.sub(_spelt(name), words), number) for name, number in things] if len(things) > 1 else []


def _is_many(name: str) -> bool:
    noun = name.rpartition("_")[2]
    return noun in ("both", "pile") or any(lemma != noun for lemma in noun_lemmas(noun)) or noun.endswith("s")


def referred(known: Knowledge, words: str, said: Sequence[Mentioned]) -> Iterator[str]:
    """Yield a sentence with each thing that its pronoun may stand for, the likeliest first; itself without any."""
    if not PRONOUN.search(words):
        yield words
        return
    of_things, of_people = _THINGS.search(words), _PEOPLE.search(words)
    things = _spoken_of(said, is_closed=bool(_CLOSING.match(words))) if of_things or of_people else ()
    if not things:
        yield words
    for thing in things:
        if of_things:
            yield _THINGS.sub(_spelt(thing), words)
        elif known.has(thing, _PERSON):
            yield _PEOPLE.sub(_spelt(thing), words)


def _spoken_of(said: Sequence[Mentioned], *, is_closed: bool) -> tuple[str, ...]:
    """Return the things of steps, the last first.

    What was opened, or holds another, comes first where something is closed.
    """
    opened = [name for each in said if is_closed and each.action == "Open" for name in each.names]
    places = [each.names[1] for each in said if is_closed and len(each.names) > 1]
    return tuple(dict.fromkeys((*opened, *places, *(name for each in said for name in each.names))))
