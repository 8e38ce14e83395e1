"""Clauses that lack an object, `Sit down`: the question left open, an example, and the seat to which a step went."""

import re
from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import chain
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import Action
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.phrasings import phrasings
from hearth.kb.language.pronouns import Mentioned
from hearth.kb.language.sentence_openings import verb_phrase
from hearth.kb.language.step_phrases import parses

_LINKS = ("", "on ", "to ", "in ", "into ", "at ", "with ")
_THING = "zzthing"
"""A name in the place of the object; not a word."""

_EVERYDAY = (
    "table", "bread", "chair", "bed", "television", "fridge", "book", "water", "cup", "shoes", "door", "phone", "child",
)  # fmt: skip
"""Things of most homes, for examples: the first that affords an act is taken."""

_PLACES = ("table", "fridge", "cup", *_EVERYDAY)
_MOST_WORDS = 6
_RESTED = re.compile(r"\b(?:sit|sits|sat|sitting|lie|lies|lay|lying|seat|seated|down)\W*$", re.IGNORECASE)
_RESTS, _GOES, _LOOKS = "rests", "goes", "looks"


class Missing(NamedTuple):
    """A clause without one of the objects of its action.

    Attributes:
        question: the open question, in words.
        phrase: the clause with `{}` for the object, `sit down on the {}`.
        action: the action.
        names: the objects that it names, and None for the one that is missing.
    """

    question: str
    phrase: str
    action: Action
    names: tuple[str | None, ...]

    def example(self, known: Knowledge, said: Sequence[Mentioned]) -> str:
        """Return the clause with an object: the last one said that affords the action, else one of most homes."""
        place = self.names.index(None)
        mentioned = chain.from_iterable(each.names for each in said)
        usual = _PLACES if place else _EVERYDAY
        named = (name for name in chain(mentioned, usual, known.objects) if name not in self.names)
        thing = next((name for name in named if known.affords(self.action.name, place, name)), "thing")
        sentence = self.phrase.format(thing.replace("_", " "))
        return sentence[:1].upper() + sentence[1:]


def missing(known: Knowledge, words: str) -> Missing | None:
    """Return the object that a clause lacks; None for a clause that lacks more than one, or something else."""
    text = " ".join(verb_phrase(words).lower().strip(" .!?,;:").split())
    return _missing(known, text) if text and len(text.split()) <= _MOST_WORDS else None


@lru_cache(maxsize=4096)
def _missing(known: Knowledge, text: str) -> Missing | None:
    for link in _LINKS:
        for said in (f"{text} {link}{_THING}", f"{text} {link}the {_THING}"):
            for action, names in _read(known, said):
                things = tuple(None if name == _THING else thing_of(known, name.replace("_", " ")) for name in names)
                is_whole = bool(link) or action.name not in known.group(_LOOKS)
                if is_whole and things.count(None) == 1 and _THING in names and _are_afforded(known, action, things):
                    return Missing(f"{text} {link}what?", f"{text} {link}the {{}}", action, things)
    return None


def _read(known: Knowledge, text: str) -> Iterator[tuple[Action, tuple[str, ...]]]:
    for phrasing in (text, *phrasings(known, text)):
        yield from parses(known, phrasing)


def _are_afforded(known: Knowledge, action: Action, names: Sequence[str | None]) -> bool:
    return all(name is None or known.affords(action.name, place, name) for place, name in enumerate(names))


def may_lack_seat(words: str) -> bool:
    """Return whether a line may end with an act of rest whose seat only the step before it names."""
    return _RESTED.search(words) is not None


def gone_to(known: Knowledge, words: str, said: Sequence[Mentioned]) -> str:
    """Return a clause that lacks the seat or bed with the one to which the step before it went; else nothing.

    `Walk to the sofa`, `Sit down` is a sofa to sit on, as `it` would be. What one opens or takes there may be anything.
    """
    if not said or not said[0].names or said[0].action not in known.group(_GOES) or not may_lack_seat(words):
        return ""
    lacking = missing(known, words)
    if lacking is None or lacking.action.name not in known.group(_RESTS):
        return ""
    thing = said[0].names[-1]
    return lacking.phrase.format(thing.replace("_", " ")) if known.affords(lacking.action.name, 0, thing) else ""
