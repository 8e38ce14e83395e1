"""Phrasings: usual ways of asking for a step, in addition to the synonyms of actions, and the words of actions."""

import re
from collections.abc import Iterator

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import verb_lemmas
from hearth.kb.language.noun_phrases import thing_of

_GOING = "go walk move head come step navigate proceed continue return travel pop nip wander stroll"
_PUTTING = "put place set lay stick leave position deposit pop"
_SELF = "(?:(?:your|my|him|her|it|one)self|themselves|ourselves)"
_WAY = (
    "(?:(?:back|over|on|up|down|straight|right|through|across|along|upstairs|downstairs|inside|out|off|round|around)"
    " ){0,2}"
)
_POWER = r"(?:wall|wall socket|socket|outlet|wall outlet|power outlet|electrical outlet|power socket|mains|plug)"
_CARRYING = "move bring carry transfer take return"
_ITS_PLACE = (
    r"(?:in|into|to|at|on)? ?"
    r"(?:(?:its|their|the) (?:(?:usual|original|right|proper|own) )?(?:place|spot)|where (?:it|they) belongs?)"
)
_TAKEN_OUT = r"(?:out (?!of )(.+)|(.+) out)"
"""A thing is taken out of where it is; a dog is taken for a walk."""

_USUAL: tuple[tuple[str, str, str], ...] = (
    (_GOING, rf"(?:{_SELF} )?{_WAY}(?:to|into|inside) (.+)", "walk to {0}"),
    ("get", rf"(?:{_SELF} )?{_WAY}to (.+)", "walk to {0}"),
    ("move walk go head step", r"towards? (.+)", "walk towards {0}"),
    ("get hop climb jump crawl slip step", r"(?:back )?(?:in|into) (.+)", "get into {0}"),
    ("hop climb jump crawl slip", r"(?:back )?out of (.+)", "get out of {0}"),
    ("climb", r"up (?:on |onto )?(.+)", "climb {0}"),
    ("glance stare peek peer gaze", r"(?:at|in|into|out of|out|through|inside) (.+)", "look at {0}"),
    ("kick slip pull", r"(?:off (.+)|(.+) off)", "take off {0}"),
    ("slip pull throw", r"(?:on (.+)|(.+) on)", "put on {0}"),
    ("turn put", r"(?:out (.+)|(.+) out)", "switch off {0}"),
    ("approach", r"(.+)", "walk to {0}"),
    ("exit", r"(.+)", "leave {0}"),
    ("head go make", r"(?:for|straight for) (.+)", "walk to {0}"),
    ("make", r"(?:your|my|his|her|their|its|our|the) way (?:over |back )?(?:to|into) (.+)", "walk to {0}"),
    ("take get grab remove fetch pull pick lift retrieve collect",
     r"(?:up |out )?(.+? (?:out of|out from|off of|off|from) .+)",
     "grab {0}"),
    ("retrieve collect snatch obtain gather", r"(?:up )?(.+)", "grab {0}"),
    ("gather", r"(.+) up", "grab {0}"),
    ("pick grab", r"(.+) up", "grab {0}"),
    ("pick grab lift take", r"(.+?) up (?:from|off of|off) (.+)", "grab {0} from {1}"),
    ("pick choose", r"(?!up )(.+)", "grab {0}"),
    ("pick choose", r"out (.+)", "grab {0}"),
    ("get", r"(?:a )?hold of (.+)", "grab {0}"),
    ("grab get fetch take", rf"{_SELF} (.+)", "grab {0}"),
    ("grab get fetch", r"(?:me|us|him|her|them) (.+)", "grab {0}"),
    ("take get pull bring", _TAKEN_OUT, "grab {0}"),
    ("turn switch shut flick flip click power", r"(?:back )?(on|off) (.+)", "switch {0} {1}"),
    ("turn switch shut flick flip click power", r"(.+?) (?:back )?(on|off)", "switch {1} {0}"),
    ("activate start", r"(?:up )?(.+)", "switch on {0}"),
    ("boot power start", r"(?:up (.+)|(.+) up)", "switch on {0}"),
    ("deactivate", r"(.+)", "switch off {0}"),
    ("shut power", r"(?:down (.+)|(.+) down)", "switch off {0}"),
    ("plug", rf"(?:in )?(.+?) (?:back )?in(?:to (?:the|a|an) {_POWER})?", "plug in {0}"),
    ("plug", rf"in (.+?) (?:at|to|into) (?:the|a|an) {_POWER}", "plug in {0}"),
    ("plug", r"back in (.+)", "plug in {0}"),
    ("take", r"(.+) off", "take off {0}"),
    ("put", r"(.+) on", "put on {0}"),
    ("put", r"(.+) (?:back|away)", "put back {0}"),
    ("put return bring take", rf"(.+?)(?: back| away)? {_ITS_PLACE}", "put back {0}"),
    # Nothing is said about a place: the thing is let go of where one is.
    ("put set lay place", r"(?:down (.+)|(.+) down)", "release {0}"),
    (f"{_PUTTING} insert store pack", r"(?:down )?(.+?)(?: down)? (?:into|inside of|inside) (.+)", "put {0} in {1}"),
    (f"{_PUTTING} insert store pack return", r"(?:down )?(.+?) (?:down |back |away )?in (.+)", "put {0} in {1}"),
    (_PUTTING, r"(.+) (?:onto|on top of|upon) (.+)", "put {0} on {1}"),
    (_PUTTING, r"(?:down )?(.+?) (?:down |back |away )?(?:on|onto|on top of) (.+)", "put {0} on {1}"),
    ("put lay place", r"(.+) over (.+)", "put {0} on {1}"),
    (_CARRYING, r"(.+?) (?:back )?(?:on|onto|on top of) (.+)", "put {0} on {1}"),
    (_CARRYING, r"(.+?) (?:back )?(?:in|into|inside) (.+)", "put {0} in {1}"),
    ("drop insert slip", r"(.+) (?:into|inside|in) (.+)", "put {0} in {1}"),
    ("wring", r"(?:out (.+)|(.+) out)", "squeeze {0}"),
    ("wipe dry dust", r"(?:(?:down|off|up) (.+)|(.+) (?:down|off|up))", "wipe {0}"),
    ("rinse", r"(?:off|out) (.+)|(.+) (?:off|out)", "rinse {0}"),
    ("shake", r"(?:out (.+)|(.+) out)", "shake {0}"),
    ("chop slice", r"(?:up (.+)|(.+) up)", "cut {0}"),
    ("fold lift open sweep cut", r"(.+) up", "{verb} {0}"),
    ("eat drink sip", r"(?:a|an|the|your|my|some|another) (?:glass|cup|mug|bottle|bowl|plate|can) of (.+)",
     "{verb} {0}"),
    ("eat drink", r"(?:up (.+)|(.+) up)", "{verb} {0}"),
    ("water", r"(.+)", "pour water into {0}"),
    ("fill", r"(?:up )?(.+) with (.+)", "pour {1} into {0}"),
    ("fill", r"(?:up )?(.+?)(?: up)? (?:from|at|under|in) the (?:tap|faucet|sink)", "pour water into {0}"),
    ("pour", r"(.+) (?:in|onto|on|over) (.+)", "pour {0} into {1}"),
    ("pour", r"(.+) down (.+)", "pour {0} into {1}"),
    ("throw toss", r"(.+?) (?:away )?(?:in|into|on|onto|to|at) (.+)", "throw {0} at {1}"),
    ("spread smear rub", r"(.+) (?:onto|over) (.+)", "spread {0} on {1}"),
    ("squeeze squirt apply", r"(.+) (?:on|onto|to) (.+)", "spread {0} on {1}"),
    ("take have", r"(?:a|your|my) seat (on|in|at) (.+)", "sit {0} {1}"),
    ("sit plop plonk flop", rf"(?:{_SELF} )?(?:back )?(?:down )?(?:on|onto|upon|in|at) (.+)", "sit on {0}"),
    ("lie lay", rf"(?:{_SELF} )?(?:back |down )*(?:on|onto|upon|in|into) (.+)", "lie on {0}"),
    ("get stand", r"(?:back )?up", "stand up"),
    ("take have", r"(?:another |a )(?:quick |big |small |long )?(?:look at|glance at) (.+)", "look at {0}"),
    ("look", r"(?:in|into|out of|out|through|inside|over|down at|up at) (.+)", "look at {0}"),
    ("take have", r"(?:another |a )(?:big |small )?(?:sip|gulp|swig|drink) (?:of|from) (.+)", "drink {0}"),
    ("take have", r"(?:another |a )(?:big |small )?bite (?:of|from|out of) (.+)", "eat {0}"),
    ("take have", r"(?:a )(?:quick |short |long )?nap", "sleep"),
    ("get", r"some sleep", "sleep"),
    ("pull push slide draw slam swing", r"(.+) (?:shut|closed)", "close {0}"),
    ("pull push slide draw swing", r"(?:(.+) open|open (.+))", "open {0}"),
    ("pull push slide draw swing", r"(?:shut|closed) (.+)", "close {0}"),
)  # fmt: skip
"""The first words of a phrasing, what follows, and the step; a phrasing is tried where its verb stands."""


def _by_verb() -> dict[str, tuple[tuple[re.Pattern[str], str], ...]]:
    found: dict[str, list[tuple[re.Pattern[str], str]]] = {}
    for verbs, rest, phrase in _USUAL:
        for verb in verbs.split():
            found.setdefault(verb, []).append((re.compile(rest), phrase))
    return {verb: tuple(phrasings) for verb, phrasings in found.items()}


_PHRASINGS = _by_verb()
PHRASED = frozenset(_PHRASINGS)
"""Verbs of phrasings."""

_ALIVE = ("animal", "person")
_RISING = ("get", "stand", "rise")
_RISEN = re.compile(r"(?:back )?up (?:from|off|out of) (.+)")
_INTO = re.compile(r"(?:back )?(?:in)?to (.+)")
"""Objects on wheels move in this way."""

_BROUGHT = re.compile(r"(.+?)(?: over| back)? to (.+)")
_SURFACE, _SWITCH, _SEAT, _BED = "SURFACES", "HAS_SWITCH", "SITTABLE", "LIEABLE"
_LEFT = re.compile(r"(off|out of) (.+)")
_IN = re.compile(r"(?:back )?(?:in|into) (.+)")
_BEDDING = ("get", "hop", "climb", "jump", "crawl", "slip", "fall", "step")
"""Verbs of going to bed: one lies in it, where a tub or a shower is entered."""

_PUT_ON = ("put", "pop", "stick")
_SWITCHED = re.compile(r"(.+) (on|off)")
"""A thing and how it is to be, as notes have it: `lights off`."""

_DRAWN = re.compile(r"(?:out|up) (.+)|(.+) (?:out|up)")
_ON = re.compile(r"on (.+)|(.+?) on")


def phrasings(known: Knowledge, text: str, *, is_inflected: bool = True) -> Iterator[str]:
    """Yield other words for a clause: its verb without inflection, and the usual phrasings as Hearth says them.

    Args:
        known: the grammar.
        text: a clause in small letters.
        is_inflected: whether its verb may be a form; one that reads exactly is none, and needs no lexicon.
    """
    if (match := _SWITCHED.fullmatch(text)) and (thing := thing_of(known, match[1])) and known.has(thing, _SWITCH):
        yield f"switch {match[2]} {thing.replace('_', ' ')}"
    first, _, rest = text.partition(" ")
    lemmas = verb_lemmas(first) if is_inflected else ()
    for verb in (first, *(lemma for lemma in lemmas if lemma != first)):
        if verb != first:
            yield f"{verb} {rest}".rstrip()
        for pattern, phrase in _PHRASINGS.get(verb, ()):
            if match := pattern.fullmatch(rest):
                if pattern.pattern == _TAKEN_OUT and (_is_alive(known, rest) or _is_drawn(known, verb, rest)):
                    continue
                groups = [group for group in match.groups() if group is not None]
                yield phrase.format(*groups, verb=verb)
        yield from _placed(known, verb, rest)


def _is_alive(known: Knowledge, words: str) -> bool:
    thing = known.object_class(thing_of(known, words.removeprefix("out ").removesuffix(" out")) or "")
    return thing is not None and thing.hypernym in _ALIVE


def _is_drawn(known: Knowledge, verb: str, rest: str) -> bool:
    """Return whether what is pulled out is a seat, which stays where it is used."""
    match = _DRAWN.fullmatch(rest) if verb == "pull" else None
    return match is not None and known.has(thing_of(known, match[1] or match[2]) or "", _SEAT)


def _by_property(known: Knowledge, verb: str, rest: str) -> Iterator[str]:
    """Yield the phrasings that depend on the use of a thing: a device is not worn, a seat is not taken."""
    if _is_drawn(known, verb, rest):
        yield _DRAWN.sub(r"pull \1\2", rest)
    if verb in _BEDDING and (match := _IN.fullmatch(rest)) and (thing := thing_of(known, match[1])):
        yield from [f"lie on {thing.replace('_', ' ')}"] if known.has(thing, _BED) else []
    if verb in _PUT_ON and (match := _ON.fullmatch(rest)) and (thing := thing_of(known, match[1] or match[2])):
        yield from [f"switch on {thing.replace('_', ' ')}"] if known.has(thing, _SWITCH) else []
    if verb == "get" and (match := _LEFT.fullmatch(rest)) and (thing := thing_of(known, match[2])):
        yield from ["stand up"] if known.has(thing, _SEAT) and (match[1] == "off" or not known.has(thing, _BED)) else []


def _placed(known: Knowledge, verb: str, rest: str) -> Iterator[str]:
    """Yield the phrasings that depend on the thing in them: a room is entered, what has a top has things put on it."""
    yield from _by_property(known, verb, rest)
    if verb == "enter" and (room := thing_of(known, rest)) and known.is_room(room):
        yield f"walk to {rest}"
    if verb == "roll" and (match := _INTO.fullmatch(rest)) and (thing := thing_of(known, match[1])):
        yield from [f"walk to {match[1]}"] if known.is_room(thing) else []
    if verb in _RISING and (match := _RISEN.fullmatch(rest)) and thing_of(known, match[1]):
        yield "stand up"
    if verb in _CARRYING.split() and (match := _BROUGHT.fullmatch(rest)) and (place := thing_of(known, match[2])):
        yield f"put {match[1]} {'on' if known.has(place, _SURFACE) else 'in'} {match[2]}"
