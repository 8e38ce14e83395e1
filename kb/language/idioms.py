"""Idioms: a verb and a noun that together name an act, as `take a shower`, in which nothing is taken."""

import re

_TAKE = r"tak(?:e|es|ing)|took|taken|have|has|had|having"
_LIGHT = rf"{_TAKE}|get|gets|getting|got|grab|grabs|grabbed|grabbing|fetch"
_ACTS = (
    "bath", "bite", "break", "breath", "breather", "dip", "glance", "leak", "listen", "look", "nap", "peek", "rest",
    "ride", "seat", "shave", "shower", "sip", "sleep", "snooze", "stroll", "swim", "walk", "workout",
)  # fmt: skip
"""Nouns of acts of which a light verb makes one; some are names of things, too."""

_TAKEN = ("bow", "call", "care", "photo", "picture", "place", "selfie", "stand", "step", "time", "trip", "turn")
"""Nouns that are acts after `take` and `have` only."""

_DETERMINER = "(?:a|an|another|some|your|my|his|her|their|one)"
_HOW = "(?:(?:long|short|quick|little|hot|cold|warm|nice|deep|good|brief|relaxing) )*"
_IDIOM = re.compile(
    rf"(?:(?:{_LIGHT}) (?:{_DETERMINER} )?{_HOW}(?:{'|'.join(_ACTS)})"
    rf"|(?:{_TAKE}) {_DETERMINER} {_HOW}(?:{'|'.join(_TAKEN)}))s?(?: (?!from|off|out|down).+)?"
)


_EXCHANGED = re.compile(
    r"replac(?:e|es|ed|ing) (?:the|a|an|your|my|his|her|their)? ?(?:old |empty |dead |burnt out |broken )?"
    r"(?:light ?bulbs?|bulbs?|batter(?:y|ies)|bin bags?|garbage bags?|trash bags?|toilet (?:paper|rolls?)|paper towels?"
    r"|(?:coffee )?filters?)(?: .*)?"
)


def is_exchange(text: str) -> bool:
    """Return whether a clause in small letters asks for another thing of a kind, not for the same one put back."""
    return _EXCHANGED.fullmatch(text) is not None


def is_idiom(text: str) -> bool:
    """Return whether a clause in small letters is an act that its verb alone does not say."""
    return _IDIOM.fullmatch(text) is not None
