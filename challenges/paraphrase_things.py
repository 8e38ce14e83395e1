"""Things as people name them: `my two umbrellas`, `the milk`, `some juice`, `all lamps`."""

from __future__ import annotations

import re
from functools import cache, lru_cache
from typing import Any, NamedTuple

from hearth.challenges.instruction_object_names import EVERY, NUMBERS, Counted, noun, nouns, plural
from hearth.kb.knowledge import Knowledge
from hearth.schemas.yaml_limits import packaged

UNSAID = -1
"""The number of things that is not said, as in `the plates`."""

_EACH = re.compile(r" (?:for each|each|per person|for everybody|for everyone)$")
_BETWEEN = re.compile(r",? and |,? as well as |,? along with |,? together with |,? plus |, | or | nor ")


@cache
def patterns() -> dict[str, Any]:
    """Return the content of `paraphrases.yaml`."""
    found: dict[str, Any] = packaged("hearth.challenges", "paraphrases.yaml")
    return found


class Known(NamedTuple):
    """The names that people's nouns stand for.

    Attributes:
        one: of a thing.
        many: of several.
    """

    one: dict[str, str]
    many: dict[str, str]


@lru_cache(maxsize=8)
def known_nouns(knowledge: Knowledge, names: frozenset[str] = frozenset()) -> Known:
    """Return the nouns of instructions, then other names, then `milk` for `carton of milk`; each means one class."""
    given = nouns(knowledge, names)
    both = given.singular, given.plural
    one, many = ({word: _own(name, knowledge, names) for word, name in words.items()} for words in both)
    classes = [*sorted(names), *knowledge.objects]
    for name in classes:
        spaced = name.replace("_", " ")
        one.setdefault(spaced, _own(name, knowledge, names))
        many.setdefault(plural(spaced), _own(name, knowledge, names))
        if spaced.endswith("s") and not spaced.endswith("ss"):  # `two cards`
            many.setdefault(spaced, _own(name, knowledge, names))
    for spelling in knowledge.object_spellings:
        found = knowledge.object_class(spelling)
        if found is not None and found.name in knowledge.objects:
            one.setdefault(spelling.replace("_", " "), found.name)
            many.setdefault(plural(spelling.replace("_", " ")), found.name)
    for word, name in patterns()["nouns"].items():
        if name in knowledge.objects:
            one.setdefault(word, name)
            many.setdefault(plural(word), name)
    for name in classes:
        _, of, rest = noun(name).partition(" of ")
        if of:
            one.setdefault(rest, name)
            many.setdefault(plural(rest), name)
    return Known(_joined(one), _joined(many))


def _own(name: str, knowledge: Knowledge, names: frozenset[str]) -> str:
    """Return the class of a name, unless a challenge has the name itself."""
    found = None if name in names else knowledge.object_class(name)
    return name if found is None else found.name


def _joined(words: dict[str, str]) -> dict[str, str]:
    """Return nouns, also without their spaces where that is no other noun: `tv stand` is found as `tvstand`."""
    return {**{word.replace(" ", ""): name for word, name in words.items()}, **words}


def _meant(words: str, known: dict[str, str]) -> str | None:
    return known.get(words) or known.get(words.replace(" ", ""))


def things(text: str, known: Known, people: int = 1) -> Counted | None:
    """Return the things of a list with their numbers, `UNSAID` where none is said; None if one is not known."""
    found = []
    for item in _BETWEEN.split(text.strip(" ,")):
        thing = _thing(item.strip(), known, people)
        if thing is None:
            return None
        found.append(thing)
    return tuple(found)


def _thing(text: str, known: Known, people: int) -> tuple[str, int] | None:
    each = _EACH.search(text)
    if each and people < 2:
        return None  # each of how many is not said
    text = _EACH.sub("", text)
    if (of := _ONE_OF.match(text)) and (name := _meant(text[of.end() :], known.many)):
        return name, NUMBERS.index(of[1])
    if part := _PART.fullmatch(text):  # `two packs of pasta`
        counted = _number(part[1].strip()) if part[1] else 1
        vessel = text[: part.start(2)].split()[-2].removesuffix("s")
        name = (
            _meant(f"{part[2]} {vessel}", known.one)
            or _meant(f"{part[2].removesuffix('s')} {vessel}", known.one)
            or _meant(part[2], known.one)
            or _meant(part[2], known.many)
        )
        if name is not None and counted and not _whole(text, known):
            return name, counted
    for words, number in _determined(text):
        if text == f"a pair of {words}" and (name := _meant(words, known.one)):  # one pair of boots
            return name, 1
        several = number > 1 or number in (EVERY, UNSAID)
        name = _meant(words, known.one) if number in (1, UNSAID, EVERY) else None
        if name is not None:
            said = 1 if number == UNSAID else number
            return name, said * (people if each or people > 1 else 1)
        name = _meant(words, known.many) if several else None
        if name is not None:
            return name, number if number in (EVERY, UNSAID) else number * (people if each else 1)
    return None


def _whole(text: str, known: Known) -> bool:
    """Return whether the words with their container are a noun of ours, `bottle of water`."""
    names = (words for words, _ in _determined(text) if " of " in words)
    return any(_meant(words, known.one) or _meant(words, known.many) for words in names)


def _number(words: str) -> int:
    """Return the number of a determiner; 0 where it is none."""
    found = patterns()["numbers"].get(words, 0)
    if found:
        return 1 if found == UNSAID else int(found) if found > 0 else 0
    return NUMBERS.index(words) if words in NUMBERS[1:] else 0


_ONE_OF = re.compile(r"(one|two|three|four) of (?:the|my|our|your) ")
_PART = re.compile(
    r"((?:[a-z]+ )*?)(?:pack|packet|package|box|bottle|carton|pair|piece|sheet|roll|jar|can|tin|bag|tub|tube|slice|bit"
    r"|glass|bar|loaf|block|bunch|set|stick)(?:e?s)? of ([a-z' -]+)"
)


def _determined(text: str) -> list[tuple[str, int]]:
    """Return the ways to part a text into the words of a noun and a number."""
    found = [(text, UNSAID)]
    for words, number in patterns()["numbers"].items():
        if text.startswith(f"{words} "):
            rest = text[len(words) + 1 :]
            found.append((rest, number))
            if number in (UNSAID, EVERY):  # `the three plates`, `all three plates`
                found += _counted(rest)
    return found + _counted(text)


def _counted(text: str) -> list[tuple[str, int]]:
    first, _, rest = text.partition(" ")
    if first in NUMBERS[1:]:
        return [(rest, NUMBERS.index(first))]
    return [(rest, int(first))] if first.isascii() and first.isdigit() and 0 < int(first[:3]) < 100 else []


def place(text: str, known: Known) -> str | None:
    """Return the class of the words for a place."""
    found = things(text, known)
    if not found or len(found) != 1 or found[0][1] not in (1, UNSAID):
        return None
    return str(found[0][0])
