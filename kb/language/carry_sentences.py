"""Sentences in which a thing is carried somewhere: one goes there with it, and puts it down when a step says so."""

import re
from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.pronouns import PRONOUN, Mentioned, within_reach

_CARRIED = re.compile(
    r"(?P<verb>carr(?:y|ies|ied|ying)|tak(?:e|es|ing)|took|br(?:ing|ings|inging|ought)"
    r"|transport(?:s|ed|ing)?) (?P<thing>.+?)(?: (?:over|back|along|straight))? to (?P<place>.+)",
    re.IGNORECASE,
)
_HELD = re.compile(r"carr|t(?:ak|ook|ransport)", re.IGNORECASE)
_OPENS = "CAN_OPEN"


def is_carrying(words: str) -> bool:
    """Return whether a clause says that a thing is carried to a place; what it means depends on the steps before."""
    return _CARRIED.match(words) is not None


def carried(known: Knowledge, words: str, said: Sequence[Mentioned]) -> tuple[str, str] | None:
    """Return the walk that a clause asks for, and the words for the carried thing; None where it is put there.

    Nothing is put in a thing that opens before a step opens it. Of other places, `carry` and `take` say where one goes
    with a thing that a step before has named; `bring` says where it is put.
    """
    found = _CARRIED.fullmatch(words.strip(" .,!"))
    place = thing_of(known, found["place"].lower()) if found else None
    if not found or not place or not _is_thing(known, found["thing"]):
        return None
    if known.has(place, _OPENS) or (_is_said(known, found["thing"], said) and _is_way(known, found["verb"], place)):
        return f"walk to {found['place']}", found["thing"]
    return None


def _is_way(known: Knowledge, verb: str, place: str) -> bool:
    return known.is_room(place) or _HELD.match(verb) is not None


def _is_thing(known: Knowledge, words: str) -> bool:
    return PRONOUN.fullmatch(words) is not None or thing_of(known, words.lower()) is not None


def _is_said(known: Knowledge, words: str, said: Sequence[Mentioned]) -> bool:
    name = thing_of(known, words.lower())
    things = [each.names for each in within_reach(said) if each.names]
    return bool(things) if name is None else any(name in names for names in things)
