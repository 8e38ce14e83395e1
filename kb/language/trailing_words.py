"""Trailing words: what may be left out of a clause without changing the act, in closed classes."""

import re
from collections.abc import Iterator

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.adjectives import without_adjective
from hearth.kb.language.english_lexicon import is_verb, verb_lemmas
from hearth.kb.language.noun_phrases import thing_of, without_source

ADVERBS = (
    "a bit", "a little", "a little bit", "again", "all the way", "aloud", "at once", "briefly", "calmly", "carefully",
    "cautiously", "completely", "easily", "evenly", "finely", "first", "firmly", "fully", "gently", "halfway",
    "immediately", "lightly", "neatly", "now", "once again", "once more", "one more time", "out loud", "patiently",
    "promptly", "properly", "quickly", "quietly", "right away", "roughly", "safely", "securely", "slightly", "slowly",
    "softly", "straight away", "thoroughly", "tightly", "together", "too", "twice", "vigorously", "well", "wide",
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
        r"(?:under|with|in) (?:(?:some|the|cold|hot|warm|running|soapy|lukewarm) )*water",
        rf"(?:for )?(?:{_ABOUT} )?{_NUMBER} (?:more )?{_UNIT}",
        rf"at (?:about |around )?(?:{_HOUR}|noon|midnight|dawn|\d{{1,2}}(?:[:.]\d\d)?)"
        r"(?: ?(?:o['’]clock|[ap]m))?(?: in the (?:morning|afternoon|evening))?",
        r"for (?:some )?(?:fresh air|light|warmth|fun)",
        r"for (?:breakfast|lunch|dinner|later|[a-z]+ing(?: .+)?)",
        r"so (?:that )?(?:you|i|we|it|he|she|they) .+",
        r"in(?:to)? (?:[a-z]+ ){0,2}(?:slices|pieces|cubes|strips|halves|half|chunks|quarters|bits)",
        r"behind (?:you|me|him|her|them|yourself)",
        r"(?:because|since) (?:it|the|you|i|we|he|she|they|there) .+",
    )
)
_TIME = re.compile(r"\s+(?:while|whilst|when|once|as soon as|before|after|until|till) (?=\S+ ?).+$")
"""Time of a step, or its duration."""

_WITHOUT_DOING = re.compile(r"\s+without (?:[a-z]+ )?[a-z]+ing(?: .+)?$")
_SUBORDINATE = re.compile(
    r"(?:while|whilst|when|once|after|before|as soon as|now that|because|since|upon|without|instead of|using|with)"
    r" \S"
)
_THERE = re.compile(r"(?:in|on|at|inside|near|by) (.+)")

_CALLED = re.compile(
    r"((?:call|phone|ring)(?:s|ed|ing)?|rang) (?:up )?((?:(?:a|the|your|my|his|her|our) )?(?:mum|mom|mother|dad|father"
    r"|wife|husband|partner|friends?|brother|sister|boss|doctor|neighbou?r|colleague|family|parents|grandma|grandpa|someone"
    r"|somebody|plumber|police))(?: on (?:the|your|my|his|her) (?:tele)?phone)?"
)
"""A call is made to somebody, who is not an object of the step."""

_STAYS = re.compile(r"(?:leave|leaves|left|leaving|keep|keeps|kept|keeping|let|lets|hold|holds|held|stay|stays)\b")
"""A thing that stays as it is for a time is not acted on."""
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
_ALL = re.compile(r"\b(?:all|each|every)(?: (?:single )?one)? (?:single )?(?:of )?(?=\S)")
"""A step is about one thing, so that its other instances are left out."""

_PLACE = re.compile(
    r"\s+(?:(?:that|which) (?:is|are|was|were) |lying |standing |sitting )?"
    r"(?:inside of|inside|in|on top of|on|under|behind|next to|near|at)\s+(.+)$"
)
_TOWARDS = re.compile(
    r"(?:look|point|gaze|stare|glance|knock|sit|sit down|lie|lie down|type|write)(?:s|ing|ed)? (?:at|on|in) "
)
"""Words before the object of a step; the object is not the place of the step."""

_CLEAN = re.compile(r"((?:wipe|scrub|wash|brush|rinse|dry|lick)(?:s|ed|ing|d)? .+) (clean|dry|spotless)")
_TOOL = re.compile(r"\s+(?:with|using) (.+)$")
_SWITCHED = re.compile(r"(?:turn|switch|power|shut|flick|start)(?:s|es|ed|ing)?\b")
_CONTROLS = frozenset(("remote_control", "lightswitch", "button", "controller"))
"""Controls of other devices; a device with a switch of its own may be meant itself."""

_USING = re.compile(r"(?:use|using|with) (.+?)(?: to|,) (?=[a-z]+ )(.+)")
_CONTENT = re.compile(
    r"((?:write|type|dial)(?:s|d|ing)?|wrote|written|writing|typing)(?: down)?"
    r" (?!on |in |into )(.+?) (?:on|in|into) (.+)"
)
_WATCHED = re.compile(r"(watch(?:es|ed|ing)?) (.+?) on (.+)")
"""The object of the step is what one writes, types, dials or watches on, not what one writes or watches."""

_DIRECTED = re.compile(r"((?:push|pull|move|slide|shift|draw|shove)(?:s|es|d|ed|ing)?) (.+)")
_DIRECTION = re.compile(
    r"(?:(in|out|up|down|back|aside|away|forward|forwards|backwards|apart|closer) (.+)"
    r"|(.+) (in|out|up|down|back|aside|away|forward|forwards|backwards|apart|closer))"
)
_BY_HAND = re.compile(r"(?:both |your |my |his |her |one |the |left |right )*(?:hands?|care)")
_WORKED = frozenset(
    ("break", "brush", "chop", "clean", "comb", "cut", "drink", "dry", "dust", "eat", "hoover", "mix", "mop", "open",
     "polish", "rinse", "scrub", "sew", "shave", "slice", "smash", "spread", "stir", "sweep", "vacuum", "wash",
     "water", "wipe",
     "write")
)  # fmt: skip
"""Verbs after which a tool may be left out; with others, as `cover` or `fill`, it is part of the act."""

_CHANGES = re.compile(
    r"\b(?:not|never|no|without|instead|rather|except|unless|until|if|but|only|avoid|stop|or|cannot|dont)\b|n['’]t\b"
)


def changes_act(text: str) -> bool:
    """Return whether a word makes a sentence ask for something else, as `without` does; then nothing is left out."""
    return bool(_CHANGES.search(text))


def is_subordinate(known: Knowledge, clause: str) -> bool:
    """Return whether a clause in small letters says when, where, why or how the next one is done, and not whether."""
    place = _THERE.fullmatch(clause)
    return _SUBORDINATE.match(clause) is not None or (place is not None and thing_of(known, place[1]) is not None)


def shortened(known: Knowledge, text: str) -> Iterator[tuple[str, str]]:
    """Yield the rest of a clause, and the part left out: an adverb, a duration, a purpose, a tool or an adjective.

    Args:
        known: the grammar.
        text: a clause in small letters.
    """
    yield from _without_time(text)
    if changes_act(text):
        return
    yield from _with_tool(known, text)
    yield from _without_content(known, text)
    yield from _without_manner(text)
    for match in reversed(list(_PURPOSE.finditer(text))):
        if is_verb(match[1]) and thing_of(known, text[match.end() :]) is None:
            yield text[: match.start()], text[match.start() :].strip()
    for match in reversed(list(_ALL.finditer(text))):
        yield text[: match.start()] + text[match.end() :], "all"
    if found := without_source(known, text):
        yield found[0] + found[2], found[1]
    yield from _without_place(known, text)
    yield from without_adjective(known, text)


def _without_time(text: str) -> Iterator[tuple[str, str]]:
    """Yield a clause without what one waits for, and without the time until or at which it is done."""
    if match := _WAITING.fullmatch(text):
        yield match[1], text[match.end(1) :].strip()
    if text.endswith(_INSTEAD):
        yield text.removesuffix(_INSTEAD), _INSTEAD.strip()
    is_act = not _STAYS.match(text)
    for match in filter(None, (_TIME.search(text) if is_act else None, _WITHOUT_DOING.search(text))):
        if not changes_act(text[: match.start()]):
            yield text[: match.start()], match[0].strip()


def _without_content(known: Knowledge, text: str) -> Iterator[tuple[str, str]]:
    """Yield a clause without what is written, watched or pointed, and without the way in which a thing is pushed."""
    for pattern, phrase in ((_CONTENT, "{0} on {2}"), (_WATCHED, "{0} {2}")):
        if (match := pattern.fullmatch(text)) and thing_of(known, match[2]) is None:
            yield phrase.format(*match.groups()), match[2]
    if (match := _DIRECTED.fullmatch(text)) and (way := _DIRECTION.fullmatch(match[2])):
        yield f"{match[1]} {way[2] or way[3]}", way[1] or way[4]
    for pattern in (_WITH_IT, _ASLEEP, _CLEAN):
        if match := pattern.fullmatch(text):
            yield match[1], match[2]
    if match := _CALLED.fullmatch(text):
        yield "call", match[2]
    if match := _POINTED.fullmatch(text):
        yield f"point at {match[2]}", match[1]


def _with_tool(known: Knowledge, text: str) -> Iterator[tuple[str, str]]:
    """Yield a clause without the tool at its end, or before it: `use the knife to cut the bread`."""
    if match := _USING.fullmatch(text):
        act, tool = match[2], match[1]
        if _is_tool(known, tool) and thing_of(known, tool) != thing_of(known, act.partition(" ")[2]):
            yield act, text[: match.start(2)].strip(" ,")
            yield f"{act} with {tool}", "use"
    if not (match := _TOOL.search(text)) or not _is_tool(known, match[1]):
        return
    if (
        _BY_HAND.fullmatch(match[1])
        or _WORKED.intersection(_verbs(text))
        or (_SWITCHED.match(text) and thing_of(known, match[1]) in _CONTROLS)
    ):
        yield text[: match.start()], match[0].strip()


def _without_place(known: Knowledge, text: str) -> Iterator[tuple[str, str]]:
    """Yield a clause without the known place at its end, where a thing is said to be: `the book on the desk`.

    Of two places either may be that of the step, unless the last is a room.
    """
    for start in reversed([match.start() for match in re.finditer(r"\s+(?=\S)", text)]):
        match = _PLACE.match(text, start)
        place = thing_of(known, match[1]) if match else None
        if match and place and (known.is_room(place) or not _PLACE.search(_TOWARDS.sub("", text[:start]))):
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
    if " and " in words:
        return all(thing_of(known, each) is not None for each in words.split(" and "))
    return bool(_BY_HAND.fullmatch(words)) or thing_of(known, words) is not None or words.endswith("cloth")
