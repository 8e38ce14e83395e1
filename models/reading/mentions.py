"""Mentions: the things that a noun phrase of a request speaks of, with their number and their place."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import is_verb, noun_lemmas
from hearth.kb.language.noun_phrases import bare_words, thing_of
from hearth.kb.language.word_tables import lemmas
from hearth.models.reading.request_table import number_in, words

EVERY, SEVERAL = 0, -1
"""Numbers of a mention: all things of a class, and a plural without a number."""

_EVERY = re.compile(
    r"(?:all|every(?: single| last)?|each|whatever|any of)(?: one)?(?: of)?(?: the| my| your| our| these| those)? "
)
_COUNT = re.compile(
    r"(?:the |my |your |our |these |those )?(a couple of|a pair of|both|one|two|three|four|five|six|seven|eight"
    r"|nine|ten"
    r"|\d{1,2}|another)(?: of)?(?: the| my| your| our| these| those)? (?=\S)"
)
_SLICES = re.compile(
    r"(?:[a-z]+|\d+) (?:slices|pieces|bits|drops|spoonfuls|spoons|cans|bottles|cups|glasses|bites|sips) of (?=[a-z]+$)"
)
"""Parts of one thing: two slices of bread are of one loaf."""

_FEW = re.compile(
    r"(?:some|a few|several|a bunch of|a number of|a handful of|a load of|a pile of|a stack of|plenty of) "
)
_DETERMINERS = re.compile(
    r"(?:(?:at least|a (?:bit|drink|bite|sip|drop|spot|pinch|piece|slice|dash|portion|serving|helping|little bit) of"
    r"|slices of|pieces of"
    r"|the rest of|one of|a little|the whole|the|a|an|some|any|my|your|his|her|our|their|its|this|that|these"
    r"|those|whole|entire"
    r"|other|same|which|what)\s+)+"
)
_PRONOUN = re.compile(
    r"(?:it|the thing|that thing|them|they|that|this|those|these|one|ones|both|the both|the two|both of (?:them|those"
    r"|these)|all of them|all of it|each|each of them|each one"
    r"|the (?:first|second|other|last)(?: one)?|that one|this one|some|some of (?:it|them)|the same(?: one)?"
    r"|the (?:two|three|four) of them"
    r"|everything|them all|them both|all)"
)
_PAIRS = re.compile(r"\b(two|three|four|five|\d{1,2}|both) pairs of ")
_OF_THEM = re.compile(r"(two|three|four|five|six|seven|eight|nine|ten|\d{1,2}) of (?:them|these|those)")
_ANOTHER = re.compile(r"(?:another|another one|the other|the other one|a second one|one more|a different one)")
_PLACE = re.compile(
    r" (?:,? ?(?:that|which)(?: is| are|'s| was| were| you find| i left| you can find| lies| stands| sits)? "
    r"|lying |standing "
    r"|sitting |hanging |located |found |kept |stored )?"
    r"(in|inside|on|on top of|from|off|off of|out of|at|by|near|next to|beside|over in|up in|out in|from inside|behind"
    r"|under|above|for|belonging to|over|in front of|close to) (?=\S)"
)
_EXCEPT = re.compile(r",? (?:except(?: for)?|but not|apart from|other than|besides|but(?= the one)) (?=\S)")
_ALL_BEHIND = re.compile(r" (?:all|both|each)$")
_LISTED = re.compile(r",? (?:and|or|as well as|along with|together with|plus|&)(?: also)? |, ")
_RELATIVE = re.compile(
    r"(?<!something)(?<!anything) (?:(?:that|which|who) (?!is |are |was |were |lies |stands |sits )[a-z']+.*"
    r"|(?:that |which )?(?:you|i|we) (?:can|could|have|own|see|find"
    r"|like|left|bought|want|need|got)\b.*|(?:lying|standing|sitting) (?:around|about)|in sight|in the (?:house"
    r"|home|flat))$"
)
_OWN_PART = re.compile(r"(.+)'s ([a-z]+)")
_PART_OF = re.compile(r"(.+?) of (?:the|my|your|our|this|that) (.+)")
_EMPTY_WORDS = (
    "dirty",
    "empty",
    "dusty",
    "tasty",
    "pretty",
    "rusty",
    "misty",
    "thirsty",
    "salty",
    "fruity",
    "nasty",
    "cutty",
)
_LAMP = re.compile(
    r"(?:the |my |your |both )?(desk|bedside|nightstand|table|counter|shelf|bookshelf|dresser) (lamps?|lights?)"
)
_PACKAGE = re.compile(r" (?:carton|bottle|box|jar|packet|pack|bag|tube|tub|container|set|machine|unit|appliance)$")
_RELATION = {"in": "INSIDE", "inside": "INSIDE", "from inside": "INSIDE", "out of": "INSIDE"} | {
    "on": "ON", "on top of": "ON", "off": "ON", "off of": "ON",
}  # fmt: skip
_LONGEST = 8
_MOST_LISTED = 8


@dataclass(frozen=True, slots=True)
class Mention:
    """The things that some words speak of.

    Attributes:
        words: as they were said.
        classes: their classes, in order of preference.
        count: how many; see `EVERY` and `SEVERAL`.
        places: where they are: INSIDE, ON or "" for near, and the classes of the place.
        others: classes and places of things that are left out.
        back: whether they are those of words before, as of `it`.
        is_group: whether a plural means things of all its classes, as `dishes` does.
        another: whether they are others of the kind of which words before were.
    """

    words: str
    classes: tuple[str, ...] = ()
    count: int = 1
    places: tuple[tuple[str, tuple[str, ...]], ...] = ()
    others: tuple[Mention, ...] = ()
    back: bool = False
    is_group: bool = False
    another: bool = False


@lru_cache(maxsize=65_536)
def mentions_in(known: Knowledge, text: str, is_inner: bool = False) -> tuple[Mention, ...]:
    """Return the things of a noun phrase or of a list of them; none where a part is not understood.

    Args:
        known: the knowledge.
        text: in small letters.
        is_inner: whether it is a part of a list, whose last things an `and` joins.
    """
    text = text.strip(" ,")
    text = text.removeprefix("both ") if " and " in text else text
    text = text.removeprefix("either ") if " or " in text else text
    if len(text.split()) > _LONGEST * 3:
        return ()
    if (whole := mention_of(known, text)) is not None:
        return (whole,)
    joints = list(_LISTED.finditer(text))
    if joints and not is_inner and not joints[-1][0].strip(" ,"):
        return ()  # `the fork, faucet` is not a list
    for found in reversed(joints):
        last = mention_of(known, text[found.end() :])
        before = mentions_in(known, text[: found.start()], True) if last else ()
        if last and before and len(before) < _MOST_LISTED:
            if any(each.places for each in before) and not last.places:
                return ()  # `the fork on the table and the knife` are of two clauses
            if last.places and not any(each.places for each in before):
                before = tuple(replace(each, places=last.places) for each in before)
            if found[0].strip(" ,") == "or":
                first = before[-1]
                return (*before[:-1], replace(first, classes=(*first.classes, *last.classes)))
            return (*before, last)
    return ()


@lru_cache(maxsize=65_536)
def mention_of(known: Knowledge, text: str) -> Mention | None:
    """Return the things of one noun phrase; None where it is not understood."""
    text = _PAIRS.sub(r"\1 ", _RELATIVE.sub("", text.strip(" ,")))
    if not text or len(text.split()) > _LONGEST * 2:
        return None
    if (back := _referring(text)) is not None:
        return back
    if text.startswith("everything"):
        text = f"all devices{text.removeprefix('everything')}"
    if _PRONOUN.fullmatch(text):
        return Mention(text, count=SEVERAL, back=True)
    if found := _EXCEPT.search(text):
        left = mention_of(known, text[: found.start()])
        others = mentions_in(known, re.sub(r"^the one\b", left.words if left else "", text[found.end() :]))
        return replace(left, words=text, others=others) if left and others else None
    if re.search(r"[,;:]| and ", text):
        return None
    rest, count = _counted(text)
    if (lamp := _LAMP.fullmatch(rest)) and (place := words().things.get(lamp[1]) or _classes(known, lamp[1])):
        number = EVERY if count == EVERY else SEVERAL if lamp[2].endswith("s") else count or 1
        return Mention(text, words().things["lamp"], number, (("ON", place),), is_group=True)
    if (placed := _placed(known, text, rest, count)) is not None:
        return placed
    if classes := _classes(known, rest):
        if count == 1 and text.startswith(_PAIR) and not known.has(classes[0], "CLOTHES"):
            count = 2
        return Mention(text, classes, _number(known, rest, classes, count), is_group=_is_group(rest))
    if (whole := _whole_of(text, rest)) is not None:
        return mention_of(known, whole)
    if (part := _PART_OF.fullmatch(rest)) and (classes := _classes(known, part[1])) and _classes(known, part[2]):
        return Mention(text, classes, _number(known, part[1], classes, count), is_group=_is_group(part[1]))
    return _in_room(known, text, rest, count) or _part(known, text, rest, count) or _plain(known, text)


def _whole_of(text: str, rest: str) -> str | None:
    """Return the furniture of which words name a part: `the lid of the toilet`, `the toilet's lid`."""
    if (own := _OWN_PART.fullmatch(text)) and own[2] in _PARTS:
        return own[1]
    part = _PART_OF.fullmatch(rest)
    return part[2] if part and part[1].rpartition(" ")[2] in _PARTS else None


def _referring(text: str) -> Mention | None:
    """Return the things of words before that words with a number, or for another of them, stand for."""
    if _ANOTHER.fullmatch(text):
        return Mention(text, back=True, another=True)
    found = _OF_THEM.fullmatch(text)
    return Mention(text, count=number_in(found[1]), back=True) if found else None


def _counted(text: str) -> tuple[str, int | None]:
    """Return a noun phrase without its number, and the number; None where it says none."""
    if found := _ALL_BEHIND.search(text):
        return text[: found.start()], EVERY
    if found := _EVERY.match(text):
        rest = text[found.end() :]
        return (rest, number_in(rest.split()[0])) if rest and number_in(rest.split()[0]) > 1 else (rest, EVERY)
    if found := _SLICES.match(text):
        return text[found.end() :], None
    if (found := _COUNT.match(text)) and number_in(found[1]):
        return text[found.end() :], number_in(found[1])
    if found := _FEW.match(text):
        return text[found.end() :], None
    return text, None


def _number(known: Knowledge, rest: str, classes: tuple[str, ...], count: int | None) -> int:
    if count is not None:
        return count
    return SEVERAL if _is_plural(known, bare_words(rest), classes[0]) else 1


def _is_plural(known: Knowledge, text: str, name: str) -> bool:
    """Return whether a noun phrase is of several; shoes are a pair, and named so."""
    last = text.rpartition(" ")[2]
    singular = [lemma for lemma in noun_lemmas(last) if lemma != last]
    if not singular or name.rpartition("_")[2] == last:
        return last in ("laundry", "clothes", "dishes", "cutlery", "silverware")
    return True


@lru_cache(maxsize=65_536)
def _classes(known: Knowledge, text: str) -> tuple[str, ...]:
    """Return the classes of a noun phrase without number and place."""
    plain = _plain_noun(text)
    if not plain:
        return ()
    table = words().things
    before, space, last = plain.rpartition(" ")
    for name in (plain, *(f"{before}{space}{lemma}" for lemma in noun_lemmas(last))):
        if name in table:
            return tuple(each for each in table[name] if known.object_class(each))
    thing = thing_of(known, plain) or thing_of(known, _PACKAGE.sub("", plain))
    if thing is None:
        return ()
    return (thing, *(each for each in known.stand_ins(thing) if _is_alike(known, thing, each)))


def _is_group(text: str) -> bool:
    """Return whether a noun phrase is one of several classes, as `dishes` is."""
    plain = _plain_noun(text)
    before, space, last = plain.rpartition(" ")
    return any(name in words().groups for name in (plain, *(f"{before}{space}{one}" for one in noun_lemmas(last))))


def _plain_noun(text: str) -> str:
    return _DETERMINERS.sub("", f"{text} ", count=1).strip() if _DETERMINERS.match(f"{text} ") else text


def _is_alike(known: Knowledge, name: str, other: str) -> bool:
    """Return whether a stand-in is the same kind of thing in everyday speech."""
    one, two = known.objects[name].hypernym, known.objects[other].hypernym
    return one == two


def _placed(known: Knowledge, text: str, rest: str, count: int | None) -> Mention | None:
    """Return the things of a noun phrase that says where they are: `the cup on the desk`."""
    for found in _PLACE.finditer(rest):
        classes = _classes(known, rest[: found.start()])
        if not classes:
            continue
        number = _number(known, rest[: found.start()], classes, count)
        is_group = _is_group(rest[: found.start()])
        if found[1] in ("for", "belonging to"):
            return Mention(text, classes, number, is_group=is_group)
        place = mention_of(known, rest[found.end() :])
        if place is None or place.back:
            continue
        relation = _RELATION.get(found[1], "")
        if known.is_room(classes[0]) and not known.is_room(place.classes[0]):
            continue
        return Mention(text, classes, number, ((relation, place.classes), *place.places), is_group=is_group)
    return None


_PAIR = ("a pair of", "the pair of")
_PARTS = frozenset(
    {
        "inside",
        "outside",
        "interior",
        "top",
        "surface",
        "front",
        "drawer",
        "drawers",
        "door",
        "doors",
        "lid",
        "plug",
        "switch",
        "screen",
        "knob",
    }
)


def _part(known: Knowledge, text: str, rest: str, count: int | None) -> Mention | None:
    """Return the things of a noun phrase behind that of their furniture: `the nightstand book`."""
    parts = _plain_noun(rest).split()
    for at in range(len(parts) - 1, 0, -1):
        before, noun = " ".join(parts[:at]), " ".join(parts[at:])
        place = _classes(known, before)
        if not place or known.has(place[0], "GRABBABLE") or known.is_room(place[0]):
            continue
        if noun in _PARTS:
            return Mention(text, place, EVERY if count == EVERY else 1)
        if classes := _classes(known, noun):
            return Mention(
                text, classes, _number(known, noun, classes, count), (("ON", place),), is_group=_is_group(noun)
            )
    return None


_ROOMS = re.compile(
    r"(?:the |my |your |our )?(kitchen|bathroom|bedroom|dining room|living room|lounge|home office|office|study|hallway"
    r"|hall|entrance|entrance hall|kids' room|kids room|children's room|kids bedroom|kid's room)(?:'s)? (?=\S)"
)


def _in_room(known: Knowledge, text: str, rest: str, count: int | None) -> Mention | None:
    """Return the things of a noun phrase that begins with their room: `the kitchen light`."""
    found = _ROOMS.match(rest)
    if not found:
        return None
    inner = mention_of(known, rest[found.end() :])
    if inner is None or inner.back or known.is_room(inner.classes[0]):
        return None
    room = _classes(known, found[1])
    number = inner.count if count is None else count
    return replace(inner, words=text, count=number, places=(("INSIDE", room), *inner.places))


def _plain(known: Knowledge, text: str) -> Mention | None:
    """Return the things of a noun phrase without its first adjective: `the big red cup`."""
    found = re.match(
        r"((?:(?:the|a|an|some|my|your|our|that|this|all|every|each|\w+ of|one|two|three|four|five"
        r"|both) )*)"
                     r"([a-z'-]+),? (?=[a-z])", text)  # fmt: skip
    if not found or not is_adjective(found[2]):
        return None
    if not found[1] and _DETERMINERS.match(text[found.end() :]):
        return None  # `warm the milk` asks for something
    inner = mention_of(known, f"{found[1]}{text[found.end() :]}")
    return replace(inner, words=text) if inner and not inner.back else None


@lru_cache(maxsize=65_536)
def is_adjective(word: str) -> bool:
    """Return whether a word is an adjective, or a participle, and no number."""
    if (
        re.fullmatch(r".*(?:teen|ty|hundred|thousand|million|eleven|twelve|dozen|zero)s?", word)
        and word not in _EMPTY_WORDS
    ):
        return False  # a number is not a quality
    kinds = lemmas(word)
    if "ADJ" in kinds:
        return True
    return is_verb(word) and word.endswith(("ed", "ing")) and word not in ("ironing", "dining", "washing", "cutting")


def refers_back(known: Knowledge, text: str) -> bool:
    """Return whether a text speaks only of things that were spoken of before."""
    return all(each.back for each in mentions_in(known, text))
