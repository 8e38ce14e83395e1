"""Trailing words: what may be left out of a clause without changing the act, in closed classes."""

import re
from collections.abc import Iterator

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.adjectives import without_adjective
from hearth.kb.language.lexicon import is_verb, verb_lemmas
from hearth.kb.language.things import thing_of

ADVERBS = (
    "again", "briefly", "calmly", "carefully", "completely", "easily", "first", "firmly", "fully", "gently",
    "immediately", "lightly", "now", "once again", "once more", "one more time", "patiently", "properly", "quickly",
    "quietly", "safely", "securely", "slowly", "softly", "thoroughly", "too", "twice", "well",
)  # fmt: skip
"""Adverbs that say how a step is done, before the verb or at the end."""

_MANNER = "|".join(ADVERBS)
_ABOUT = r"(?:about|around|approximately|roughly|at least|another|a good)"
_NUMBER = (
    r"(?:a|an|one|two|three|four|five|six|seven|eight|nine|ten|fifteen|twenty|thirty|forty|\d+|a few|several|some"
    r"|a couple of|half an)"
)
_HOUR = "one|two|three|four|five|six|seven|eight|nine|ten|eleven|twelve"
_UNIT = r"(?:sec(?:ond)?|min(?:ute)?|hour|moment|while|bit|time)s?"
_ENDINGS = tuple(
    re.compile(rf"\s+{ending}$")
    for ending in (
        rf"(?:{_MANNER})",
        rf"(?:for )?(?:{_ABOUT} )?{_NUMBER} (?:more )?{_UNIT}",
        rf"at (?:about |around )?(?:{_HOUR}|noon|midnight|dawn|\d{{1,2}}(?:[:.]\d\d)?)"
        r"(?: ?(?:o['’]clock|[ap]m))?(?: in the (?:morning|afternoon|evening))?",
        r"for (?:breakfast|lunch|dinner|later|[a-z]+ing(?: .+)?)",
        r"so (?:that )?(?:you|i|we|it|he|she|they) .+",
    )
)
_BEGINNING = re.compile(rf"(?:{_MANNER})\s+")
_WAITING = re.compile(r"((?:wait|pause)(?:s|ed|ing|d)?) (?:until|till|for) .+")
"""The object of waiting may be left out, even where it is a condition."""

_INSTEAD = " instead"
"""At the end of a step it says only that another one was thought of; `instead of` names the other."""

_WITH_IT = re.compile(
    r"((?:walk|go|run|move|head|return|come|take|bring|grab|carry|leave)(?:s|ing|ed)? .+?)"
    r"\s+(?:along )?(with (?:it|them|you|me))"
)
"""Held objects go along, and taken objects are with the character."""

_ASLEEP = re.compile(r"((?:fall|falls|fell|falling) asleep|sleep|sleeps|slept|nap|naps) ((?:on|in|at) .+)")
_POINTED = re.compile(r"(?:point|aim)(?:s|ing|ed)? (?!at |to )(.+) (?:at|to|towards?) (.+)")

_PURPOSE = re.compile(r"\s+(?:in order to|so as to|to) (?=([a-z]+)(?: |$))")
_ALL = re.compile(r"\ball (?:of )?(?=\S)")
"""A step is about one thing, so that its other instances are left out."""

_PLACE = re.compile(r"\s+(?:inside of|inside|in|on top of|on|under|behind|next to|near|at)\s+(.+)$")
_TOOL = re.compile(r"\s+(?:with|using) (.+)$")
_BY_HAND = re.compile(r"(?:both |your |my |his |her |one )?(?:hands?|care)")
_WORKED = frozenset(
    ("brush", "chop", "clean", "comb", "cut", "dry", "dust", "mix", "mop", "open", "polish", "rinse", "scrub", "shave",
     "slice", "stir", "sweep", "wash", "water", "wipe")
)  # fmt: skip
"""Verbs after which a tool may be left out; with others, as `cover` or `fill`, it is part of the act."""

_CHANGES = re.compile(
    r"\b(?:not|never|no|without|instead|rather|except|unless|until|if|but|only|avoid|stop|or|cannot|dont)\b|n['’]t\b"
)


def changes_act(text: str) -> bool:
    """Return whether a word makes a sentence ask for something else, as `without` does; then nothing is left out."""
    return bool(_CHANGES.search(text))


def shortened(known: Knowledge, text: str) -> Iterator[tuple[str, str]]:
    """Yield the rest of a clause, and the part left out: an adverb, a duration, a purpose, a tool or an adjective.

    Args:
        known: the grammar.
        text: a clause in small letters.
    """
    if match := _WAITING.fullmatch(text):
        yield match[1], text[match.end(1) :].strip()
    if text.endswith(_INSTEAD):
        yield text.removesuffix(_INSTEAD), _INSTEAD.strip()
    if changes_act(text):
        return
    for pattern in (_WITH_IT, _ASLEEP):
        if match := pattern.fullmatch(text):
            yield match[1], match[2]
    if match := _POINTED.fullmatch(text):
        yield f"point at {match[2]}", match[1]
    yield from _without_manner(text)
    for match in reversed(list(_PURPOSE.finditer(text))):
        if is_verb(match[1]) and thing_of(known, text[match.end() :]) is None:
            yield text[: match.start()], text[match.start() :].strip()
    if (match := _TOOL.search(text)) and _WORKED.intersection(_verbs(text)) and _is_tool(known, match[1]):
        yield text[: match.start()], match[0].strip()
    for match in reversed(list(_ALL.finditer(text))):
        yield text[: match.start()] + text[match.end() :], "all"
    yield from _without_place(known, text)
    yield from without_adjective(known, text)


def _without_place(known: Knowledge, text: str) -> Iterator[tuple[str, str]]:
    """Yield a clause without the known place at its end, where a thing is said to be: `the book on the desk`.

    Of two places either may be that of the step, unless the last is a room.
    """
    for start in reversed([match.start() for match in re.finditer(r"\s+(?=\S)", text)]):
        match = _PLACE.match(text, start)
        place = thing_of(known, match[1]) if match else None
        if match and place and (known.is_room(place) or not _PLACE.search(text[:start])):
            yield text[:start], match[0].strip()


def _without_manner(text: str) -> Iterator[tuple[str, str]]:
    """Yield a clause without an adverb before it, or what may stand at its end."""
    if match := _BEGINNING.match(text):
        yield text[match.end() :], match[0].strip()
    for ending in _ENDINGS:
        if match := ending.search(text):
            yield text[: match.start()], match[0].strip()


def _verbs(text: str) -> tuple[str, ...]:
    first = text.partition(" ")[0]
    return (first, *verb_lemmas(first))


def _is_tool(known: Knowledge, words: str) -> bool:
    return bool(_BY_HAND.fullmatch(words)) or thing_of(known, words) is not None or words.endswith("cloth")
