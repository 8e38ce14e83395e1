"""Pronouns: the things of steps said before that `it`, `them`, `her` and `in there` stand for."""

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import takewhile
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import noun_lemmas

_ALONE = r"(?=$| (?:on|in|into|onto|to|with|at|back|away|up|down|off|out|from|over|under|near|next)\b)"
_NUMBER = r"(?:two|three|four|five|six|seven|eight|nine|ten|\d+)"
_MANY = (
    rf"them(?: (?:both|all){_ALONE})?\b|(?:these|those)(?: (?:both|all))?{_ALONE}|both(?!$){_ALONE}"
    rf"|(?:both|each(?: one)?|every one)(?: of)? (?:them|these|those){_ALONE}"
    rf"|all(?: {_NUMBER}{_ALONE}|(?: {_NUMBER})?(?: of)? (?:them|these|those){_ALONE})|the {_NUMBER} of them\b"
)
_BOTH = re.compile(r"([a-z]+(?: (?:up|down|off|out|on|away))?) both", re.IGNORECASE)
"""An act on both of two things; elsewhere at the end, as in `hands both`, the word belongs to a name."""

PRONOUN = re.compile(rf"\b(?:(?:it|her|him)\b|(?:that|this){_ALONE}|there$|{_MANY})", re.IGNORECASE)
_COUNTED = re.compile(
    rf"\b(?:both(?!$)|(?<=them )both|(?:all|the) (?P<number>{_NUMBER}))(?: of (?:them|these|those))?{_ALONE}",
    re.IGNORECASE,
)
_NUMBERS = {"two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10}
_THEM = re.compile(rf"\b(?:{_MANY})", re.IGNORECASE)
_THINGS = re.compile(rf"\b(?:it\b|(?:that|this){_ALONE}|{_MANY})", re.IGNORECASE)
_PEOPLE = re.compile(r"\b(?:her|him)\b(?=$| (?:on|in|to|with|at)\b)", re.IGNORECASE)
_PUT = r"(?:put|place|drop|set|lay|store|throw|pop|stick|leave|add|insert)(?:s|ing|ped|ting)?"
_PLACED = re.compile(
    rf"({_PUT}(?: back)? .+?)(?: back)?(?P<in> inside| in| (?:in|into|inside) there)"
    rf"|({_PUT} .+?) (?:(?:on|onto) )?there"
    rf"|({_PUT} (?:it|them|these|those|both)) (?:(?P<into>in|into|inside)|on|onto) it",
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
        words: the line as it was said.
    """

    action: str
    names: tuple[str, ...]
    instance: int = 1
    line: int = 0
    second: int = 1
    words: str = ""


UNREAD = "?"
"""The action of a line that was not understood; without a thing, the line may have named any."""

EARLIER = "..."
"""The action that ends the steps of which a pronoun may speak; nouns may speak of the things behind it."""


@lru_cache(maxsize=65_536)
def has_pronoun(words: str) -> bool:
    """Return whether a clause speaks of things that it does not name."""
    return PRONOUN.search(words) is not None


def within_reach(said: Sequence[Mentioned]) -> list[Mentioned]:
    """Return the steps of which a pronoun may speak: those since the last line that may have named another thing."""
    return list(takewhile(lambda each: each.names or each.action not in (UNREAD, EARLIER), said))


def is_hidden(words: str, said: Sequence[Mentioned]) -> bool:
    """Return whether a pronoun of some words may mean a thing of a line that was not understood."""
    if not has_pronoun(words):
        return False
    return next((each.action for each in said if each.action in (UNREAD, EARLIER) and not each.names), "") == UNREAD


def with_place(known: Knowledge, words: str, said: Sequence[Mentioned]) -> str:
    """Return `put it inside`, `put it in there` and `put it there` with the name of the place that is meant."""
    words = _of_both(words) if words.endswith("both") else words
    put = _put(words)
    place = _place(known, said, is_in=put[1]) if put else None
    return f"{put[0]} {place}" if put and place else words


@lru_cache(maxsize=65_536)
def _put(words: str) -> tuple[str, bool] | None:
    """Return how a clause begins that puts a thing `there`, and whether it is put in that place."""
    put = _PLACED.fullmatch(words)
    return (put[1] or put[3] or put[4], bool(put["in"] or put["into"])) if put else None


def _of_both(words: str) -> str:
    """Return `wash both` as `wash them both`."""
    return f"{words[:-4]}them both" if words.endswith("both") and _BOTH.fullmatch(words) else words


def _place(known: Knowledge, said: Sequence[Mentioned], *, is_in: bool) -> str | None:
    """Return the last place of a thing in steps, with `in` or `on` before it; what is open holds things as well.

    The thing to which one went last is a place, too, where it is hollow or has a top.
    """
    for each in within_reach(said):
        if each.action in known.group(_WAYS) and each.names:
            place = _reached(known, each.names[-1], is_in=is_in)
            if place or known.is_room(each.names[-1]):
                return place
            continue
        relation = known.relation_of(each.action)
        if relation == "INSIDE" or each.action == "Pour" or (each.action == "Open" and is_in):
            return f"in {_spelt(each.names[-1])}"
        if relation == "ON" and not is_in:
            return f"on {_spelt(each.names[-1])}"
    return None


def _reached(known: Knowledge, name: str, *, is_in: bool) -> str | None:
    """Return the thing to which one went as a place; None where things are not put there."""
    if not is_in and known.has(name, "SURFACES"):
        return f"on {_spelt(name)}"
    return f"in {_spelt(name)}" if known.has(name, "CONTAINERS") or known.has(name, "RECIPIENT") else None


def _spelt(name: str) -> str:
    return name.replace("_", " ")


def several(known: Knowledge, words: str, said: Sequence[Mentioned]) -> list[tuple[str, str, int]]:
    """Return the clauses for each of the things that `them` stands for, with their classes and numbers; none for one.

    They are the things of the last act, which a line or several did to one thing after another: `grab two forks`. Where
    lines did it, the last thing alone is meant if it is many, as shoes are.
    """
    if not has_pronoun(words) or not _THEM.search(words) or PRONOUN.search(_THEM.sub("", words)):
        return []
    named = [each for each in within_reach(said) if each.names]
    acts = [each for each in named if each.action not in known.group(_WAYS)] or named
    last = list(takewhile(lambda each: each.action == acts[0].action, acts))
    if any(each.line != last[0].line for each in last) and _is_many(last[0].names[0]):
        last = [each for each in last if each.line == last[0].line]
    things = dict.fromkeys((each.names[0], each.instance) for each in reversed(last))
    return [(_THEM.sub(_spelt(name), words), name, number) for name, number in things] if len(things) > 1 else []


def count_meant(words: str) -> int:
    """Return how many things a clause speaks of: 2 for `both`, 3 for `all three of them`; 0 where it says no number."""
    found = _COUNTED.search(_of_both(words)) if "both" in words or "all" in words or "of them" in words else None
    if not found:
        return 0
    number = (found["number"] or "two").lower()
    return _NUMBERS.get(number) or int(number)


def _is_many(name: str) -> bool:
    noun = name.rpartition("_")[2]
    return noun in ("both", "pile") or any(lemma != noun for lemma in noun_lemmas(noun)) or noun.endswith("s")


def referred(known: Knowledge, words: str, said: Sequence[Mentioned]) -> Iterator[str]:
    """Yield a sentence with each thing that its pronoun may stand for, the likeliest first; itself without any."""
    if not has_pronoun(words):
        yield words
        return
    of_things, of_people = _THINGS.search(words), _PEOPLE.search(words)
    things = _spoken_of(within_reach(said), is_closed=bool(_CLOSING.match(words))) if of_things or of_people else ()
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
