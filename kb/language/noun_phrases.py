"""Things in words: the class that a noun phrase is, as `both plates`, `the fridge door`, `the milk in the fridge`."""

import re
from collections.abc import Iterator
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_noun, noun_lemmas

_DETERMINERS = re.compile(
    r"(?:(?:the|a few|few|a|an|one|some|any|several|my|your|his|her|our|their|its|this|that|these|those"
    r"|one['’]s)\s+(?:of\s+)?)+"
)
_PARTITIVE = re.compile(
    r"(?:\d+(?:[.,/]\d+)? ?(?:k?g|m?l|cl|dl|oz|lbs?|grams?|kilos?|lit(?:er|re)s?|ounces?|pounds?)\b"
    r"(?: of)?\s+"
    r"|(?:rest|half|remainder|edge|side) of\s+"
    r"|(?:pair|slice|piece|bit|loaf|bunch|handful|sheet|bar|stick|drop|spoonful|scoop|pinch|lot|carton|can"
    r"|tin|packet|pack|roll|tube|tub|stack|pile|load|set|bottle(?! of (?:the )?water))s? of\s+)"
)
"""Amounts, parts and numbers of a thing that are the thing itself; a cup of tea is not, as a cup is a thing as well."""

_OWNER = re.compile(
    r"(?:the |my |your |his |her |our |their )?(?:mum|mom|mother|dad|father|wife|husband|partner|friend|brother|sister"
    r"|son|daughter|roommate|flatmate|neighbou?r|guest|grandma|grandpa|granny|nan|man|woman|boy|girl|child|kid|baby"
    r"|everyone|someone|somebody|user|person|owner)(?:['’]s|s['’])\s+"
)
"""People to whom things belong; a dog's bed is not a person's."""

_POSSESSIVE = re.compile(r"(?<=s)['’](?=\s)|['’](?=s\s)")
SOURCE = re.compile(r"\s+(?:out of|out from|off of|off|from|from inside|from under|from behind)\s+")
"""Before the place from which a thing is taken; a step has no such place, as its world says where the thing is."""
_VESSEL = re.compile(r"(?:the|a|an|its|their) (?:bag|bottle|box|can|carton|jar|jug|pack|packet|pitcher|tin|tub|tube)")
"""Packages, which are the thing in them: the milk from the carton is a carton of milk."""

_NEXT_PLACE = re.compile(r" (?:in|into|on|onto|to|over|with|using)(?= )")
_PARTS = re.compile(r"(?:the )?(?:doors?|lid) of (?:the |a )?(.+)|(.+?) (?:doors?|lid)")
_OPENED = "CAN_OPEN"
_LONGEST = 3
"""Words of a name at most."""


@lru_cache(maxsize=65_536)
def thing_of(known: Knowledge, words: str) -> str | None:
    """Return the class that some words mean; None where they mean none.

    The thing may be in the plural, after an article or a possessive, and before the known place from which it is taken;
    a thing that opens is also its door.
    """
    name = _named(known, words)
    if name is not None:
        return name
    for place in SOURCE.finditer(words):
        name = _named(known, words[: place.start()])
        if name is not None and thing_of(known, words[place.end() :]) is not None:
            return name
    return None


def is_taken_from(known: Knowledge, words: str) -> bool:
    """Return whether a noun phrase says from where its thing is taken, `water from the tap`."""
    return SOURCE.search(words) is not None and _named(known, words) is None


def without_source(known: Knowledge, words: str) -> tuple[str, str, str] | None:
    """Return words without the known place from which a thing is taken, that place, and the words behind it."""
    for place in reversed(list(SOURCE.finditer(words))):
        end = _NEXT_PLACE.search(words, place.end())
        at = end.start() if end else len(words)
        source = words[place.end() : at]
        if thing_of(known, source) is not None or _VESSEL.fullmatch(source):
            return words[: place.start()], words[place.start() : at].strip(), words[at:]
    return None


def _named(known: Knowledge, words: str) -> str | None:
    for name in _names(words):
        if name and (thing := known.object_class(name)):
            return thing.name
    part = _PARTS.fullmatch(bare_words(words))
    thing = known.object_class(part[1] or part[2]) if part else None
    return thing.name if thing and known.has(thing.name, _OPENED) else None


def _names(words: str) -> Iterator[str]:
    """Yield the names that some words may be, the likeliest first; only the later ones need the lexicon."""
    plain = _without(_DETERMINERS, words.removeprefix("of "))
    bare = _bare(plain)
    yield from (words, bare)
    yield from _singular(bare)
    yield plain.replace("'s ", " ").replace("’s ", " ")
    owned = _without(_OWNER, plain)
    yield _bare(owned) if owned != plain else ""
    yield _plural(bare)


def bare_words(words: str) -> str:
    """Return a noun phrase without article, possessive and amount."""
    return _bare(_without(_DETERMINERS, words.removeprefix("of ")))


def _plural(words: str) -> str:
    """Return the plural of a name, as some classes are named in the plural alone: a shoe."""
    return f"{words}s" if is_noun(words.rpartition(" ")[2]) else ""


def _bare(words: str) -> str:
    return _without(_DETERMINERS, _without(_PARTITIVE, _POSSESSIVE.sub("", words)))


def _without(beginning: re.Pattern[str], words: str) -> str:
    return words[match.end() :] if (match := beginning.match(words)) else words


def _singular(words: str) -> tuple[str, ...]:
    before, space, last = words.rpartition(" ")
    return tuple(before + space + lemma for lemma in noun_lemmas(last) if lemma != last)


def things_in(known: Knowledge, text: str) -> tuple[str, ...]:
    """Return the classes that a text in small letters names, in its order."""
    words, at, found = text.split(), 0, []
    while at < len(words):
        sizes = range(min(_LONGEST, len(words) - at), 0, -1)
        size, name = next(
            ((n, name) for n in sizes if (name := thing_of(known, " ".join(words[at : at + n])))), (1, "")
        )
        found += [name] if name else []
        at += size
    return tuple(found)
