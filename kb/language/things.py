"""Things in words: the class that a noun phrase is, as `both plates`, `the fridge door`, `the milk in the fridge`."""

import re
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.lexicon import noun_lemmas

_DETERMINERS = re.compile(
    r"(?:(?:the|a|an|one|some|any|my|your|his|her|our|their|its|this|that|these|those|one['’]s)\s+(?:of\s+)?)+"
)
_PARTITIVE = re.compile(
    r"(?:\d+(?:[.,/]\d+)? ?(?:k?g|m?l|cl|dl|oz|lbs?|grams?|kilos?|lit(?:er|re)s?|ounces?|pounds?)\b"
    r"(?: of)?\s+"
    r"|(?:pair|slice|piece|bit|loaf|bunch|handful|sheet|bar|stick|couple|drop|spoonful|scoop|pinch|lot)s? of\s+)"
)
"""Amounts, parts and numbers of a thing that are the thing itself; a cup of tea is not, as a cup is a thing as well."""

_POSSESSIVE = re.compile(r"(?<=s)['’](?=\s)|['’](?=s\s)")
_SOURCE = re.compile(r"\s+(?:out of|out from|off of|off|from|from inside|from under|from behind)\s+")
"""Before the place from which a thing is taken; a step has no such place, as its world says where the thing is."""
_PARTS = re.compile(r"(?: door| doors| lid)$")
_OPENED = "CAN_OPEN"


@lru_cache(maxsize=65_536)
def thing_of(known: Knowledge, words: str) -> str | None:
    """Return the class that some words mean; None where they mean none.

    The thing may be in the plural, after an article or a possessive, and before the known place from which it is taken;
    a thing that opens is also its door.
    """
    name = _named(known, words)
    if name is not None:
        return name
    for place in _SOURCE.finditer(words):
        name = _named(known, words[: place.start()])
        if name is not None and thing_of(known, words[place.end() :]) is not None:
            return name
    return None


def _named(known: Knowledge, words: str) -> str | None:
    bare = _POSSESSIVE.sub("", _without(_DETERMINERS, words))
    bare = _without(_DETERMINERS, _without(_PARTITIVE, bare))
    for name in (words, bare, *_singular(bare)):
        if name and (thing := known.object_class(name)):
            return thing.name
    whole = _PARTS.sub("", bare)
    thing = known.object_class(whole) if whole != bare else None
    return thing.name if thing and known.has(thing.name, _OPENED) else None


def _without(beginning: re.Pattern[str], words: str) -> str:
    return words[match.end() :] if (match := beginning.match(words)) else words


def _singular(words: str) -> tuple[str, ...]:
    before, space, last = words.rpartition(" ")
    return tuple(before + space + lemma for lemma in noun_lemmas(last) if lemma != last)
