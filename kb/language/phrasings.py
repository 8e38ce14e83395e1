"""Phrasings: usual ways of asking for a step, in addition to the synonyms of actions, and the words of actions."""

import re
from collections.abc import Iterator

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.lexicon import verb_lemmas
from hearth.kb.language.things import thing_of

_GOING = "go walk move head come step navigate proceed return travel"
_PUTTING = "put place set lay stick leave"
_CARRYING = "move bring carry transfer take return"
_ITS_PLACE = (
    r"(?:in|into|to|at|on)? ?"
    r"(?:(?:its|their|the) (?:(?:usual|original|right|proper|own) )?(?:place|spot)|where (?:it|they) belongs?)"
)
_TAKEN_OUT = r"(?:out (.+)|(.+) out)"
"""A thing is taken out of where it is; a dog is taken for a walk."""

_USUAL: tuple[tuple[str, str, str], ...] = (
    (_GOING, r"(?:back |over |on |up |down |straight |right )?(?:to|into|inside) (.+)", "walk to {0}"),
    ("head go make", r"(?:for|straight for) (.+)", "walk to {0}"),
    ("make", r"(?:your|my|his|her|their|its|our|the) way (?:over |back )?(?:to|into) (.+)", "walk to {0}"),
    ("take get grab remove fetch pull pick lift", r"(?:up |out )?(.+? (?:out of|out from|off of|off|from) .+)",
     "grab {0}"),
    ("pick grab", r"(.+) up", "grab {0}"),
    ("pick choose", r"(?!up )(.+)", "grab {0}"),
    ("pick choose", r"out (.+)", "grab {0}"),
    ("get", r"(?:a )?hold of (.+)", "grab {0}"),
    ("grab get fetch take", r"(?:yourself|myself|himself|herself|itself|themselves|ourselves) (.+)", "grab {0}"),
    ("take get pull bring", _TAKEN_OUT, "grab {0}"),
    ("turn switch shut", r"(.+) (on|off)", "switch {1} {0}"),
    ("plug", r"(.+) in(?:to the (?:wall|socket|outlet))?", "plug in {0}"),
    ("take", r"(.+) off", "take off {0}"),
    ("put", r"(.+) on", "put on {0}"),
    ("put", r"(.+) (?:back|away)", "put back {0}"),
    ("put return bring take", rf"(.+?)(?: back| away)? {_ITS_PLACE}", "put back {0}"),
    # Nothing is said about a place: the thing is let go of where one is.
    ("put set lay place", r"(?:down (.+)|(.+) down)", "release {0}"),
    (f"{_PUTTING} insert store pack", r"(.+) (?:into|inside of|inside) (.+)", "put {0} in {1}"),
    (f"{_PUTTING} insert store pack return", r"(.+?) (?:back |away )?in (.+)", "put {0} in {1}"),
    (_PUTTING, r"(.+) (?:onto|on top of|upon) (.+)", "put {0} on {1}"),
    (_PUTTING, r"(.+?) (?:down |back |away )?(?:on|onto|on top of) (.+)", "put {0} on {1}"),
    (_CARRYING, r"(.+?) (?:back )?(?:on|onto|on top of) (.+)", "put {0} on {1}"),
    (_CARRYING, r"(.+?) (?:back )?(?:in|into|inside) (.+)", "put {0} in {1}"),
    ("drop insert slip", r"(.+) (?:into|inside|in) (.+)", "put {0} in {1}"),
    ("wring", r"(?:out (.+)|(.+) out)", "squeeze {0}"),
    ("wipe", r"(?:(?:down|off) (.+)|(.+) (?:down|off))", "wipe {0}"),
    ("fold", r"(.+) up", "fold {0}"),
    ("water", r"(.+)", "pour water into {0}"),
    ("fill", r"(?:up )?(.+) with (.+)", "pour {1} into {0}"),
    ("pour", r"(.+) (?:in|onto|on|over) (.+)", "pour {0} into {1}"),
    ("throw toss", r"(.+?) (?:away )?(?:in|into|on|onto|to|at) (.+)", "throw {0} at {1}"),
    ("spread smear rub", r"(.+) (?:onto|over) (.+)", "spread {0} on {1}"),
    ("squeeze squirt apply", r"(.+) (?:on|onto|to) (.+)", "spread {0} on {1}"),
    ("take have", r"(?:a|your|my) seat (?:on|in|at) (.+)", "sit on {0}"),
    ("sit", r"(?:back )?(?:down )?(?:on|onto|upon|in|at) (.+)", "sit on {0}"),
    ("lie lay", r"(?:back |down )*(?:on|onto|upon|in|into) (.+)", "lie on {0}"),
    ("get stand", r"(?:back )?up", "stand up"),
    ("take have", r"(?:another |a )(?:quick |big |small |long )?(?:look at|glance at) (.+)", "look at {0}"),
    ("look", r"(?:in|into|out of|out|through|inside|over|down at|up at) (.+)", "look at {0}"),
    ("take have", r"(?:another |a )(?:big |small )?(?:sip|gulp|swig|drink) (?:of|from) (.+)", "drink {0}"),
    ("take have", r"(?:another |a )(?:big |small )?bite (?:of|from|out of) (.+)", "eat {0}"),
    ("take have", r"(?:a )(?:quick |short |long )?nap", "sleep"),
    ("get", r"some sleep", "sleep"),
    ("pull push slide draw slam swing", r"(.+) (?:shut|closed)", "close {0}"),
    ("pull push slide draw swing", r"(.+) open", "open {0}"),
)  # fmt: skip
"""The first words of a phrasing, what follows, and the step; a phrasing is tried where its verb stands."""


def _by_verb() -> dict[str, tuple[tuple[re.Pattern[str], str], ...]]:
    found: dict[str, list[tuple[re.Pattern[str], str]]] = {}
    for verbs, rest, phrase in _USUAL:
        for verb in verbs.split():
            found.setdefault(verb, []).append((re.compile(rest), phrase))
    return {verb: tuple(phrasings) for verb, phrasings in found.items()}


_PHRASINGS = _by_verb()
_ALIVE = ("animal", "person")
_RISING = ("get", "stand", "rise")
_INTO = re.compile(r"(?:back )?(?:in)?to (.+)")
"""Objects on wheels move in this way."""

_BROUGHT = re.compile(r"(.+?)(?: over| back)? to (.+)")
_SURFACE = "SURFACES"


def phrasings(known: Knowledge, text: str) -> Iterator[str]:
    """Yield other words for a clause: its verb without inflection, and the usual phrasings as Hearth says them.

    Args:
        known: the grammar.
        text: a clause in small letters.
    """
    first, _, rest = text.partition(" ")
    for verb in (first, *(lemma for lemma in verb_lemmas(first) if lemma != first)):
        if verb != first:
            yield f"{verb} {rest}".rstrip()
        for pattern, phrase in _PHRASINGS.get(verb, ()):
            if match := pattern.fullmatch(rest):
                if pattern.pattern == _TAKEN_OUT and _is_alive(known, rest):
                    continue
                groups = [group for group in match.groups() if group is not None]
                yield phrase.format(*groups)
        yield from _placed(known, verb, rest)


def _is_alive(known: Knowledge, words: str) -> bool:
    thing = known.object_class(thing_of(known, words.removeprefix("out ").removesuffix(" out")) or "")
    return thing is not None and thing.hypernym in _ALIVE


def _placed(known: Knowledge, verb: str, rest: str) -> Iterator[str]:
    """Yield the phrasings that depend on the place in them: a room is entered, what has a top has things put on it."""
    if verb == "enter" and (room := thing_of(known, rest)) and known.is_room(room):
        yield f"walk to {rest}"
    if verb == "roll" and (match := _INTO.fullmatch(rest)) and (thing := thing_of(known, match[1])):
        yield from [f"walk to {match[1]}"] if known.is_room(thing) else []
    if verb in _RISING and rest.startswith("up from ") and thing_of(known, rest.removeprefix("up from ")):
        yield "stand up"
    if verb in _CARRYING.split() and (match := _BROUGHT.fullmatch(rest)) and (place := thing_of(known, match[2])):
        yield f"put {match[1]} {'on' if known.has(place, _SURFACE) else 'in'} {match[2]}"
