"""Things of which several were said: after `two plates`, `the plates` and `both plates` are plate 1 and plate 2."""

import re
from collections.abc import Mapping, Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.language.english_lexicon import noun_lemmas
from hearth.kb.language.noun_phrases import thing_of
from hearth.kb.language.pronouns import Mentioned

_LONGEST = 3
_THE = r"(?:the|these|those|my|your|his|her|their|our)"
_NUMBER = r"(?:two|three|four|five|six|seven|eight|nine|ten|\d+)"
_WHOLE = re.compile(
    rf"\b(?:(?:all|each|every one)(?: of)?(?: {_THE}(?: {_NUMBER})?| {_NUMBER}) |(?:each|every)(?: single)? )(?=[a-z])",
    re.IGNORECASE,
)
_ONE = re.compile(rf"\b(?:one|either|any|another)(?: of)?(?: {_THE})?$", re.IGNORECASE)
_SOME = re.compile(rf"\b(?:some|half|most|several|a few|few|many)(?: of)?(?: {_THE})?$", re.IGNORECASE)


def numbers(said: Sequence[Mentioned]) -> dict[str, tuple[int, ...]]:
    """Return the classes of which several things were said, and the numbers of these."""
    for each in said:
        if each.instance > 1 or each.second > 1:
            break
    else:
        return {}
    found: dict[str, set[int]] = {}
    for each in said:
        for name, number in zip(each.names, (each.instance, each.second), strict=False):
            found.setdefault(name, set()).add(number)
    return {name: tuple(sorted(each)) for name, each in found.items() if len(each) > 1}


def without_all(words: str) -> str:
    """Return a clause in which `all of the`, `each` and `every` are `the`."""
    return _WHOLE.sub("the ", words)


def plurals(known: Knowledge, words: str, many: Mapping[str, Sequence[int]]) -> set[str]:
    """Return the classes, of those of which several were said, that a clause names in the plural.

    `each plate` is as many as `the plates`; `one of the plates` is one.
    """
    words = words.lower()
    is_whole = without_all(words) != words
    tokens = without_all(words).split()
    named = ((at, size) for at in range(len(tokens)) for size in range(1, min(_LONGEST, len(tokens) - at) + 1))
    found: set[str] = set()
    for at, size in named:
        last = tokens[at + size - 1].strip(".,;:!?")
        name = thing_of(known, " ".join((*tokens[at : at + size - 1], last)))
        if name and name in many and not _ONE.search(" ".join(tokens[:at])) and (is_whole or _is_plural(known, last)):
            found.add(name)
    return found


def _is_plural(known: Knowledge, word: str) -> bool:
    return any(lemma != word for lemma in noun_lemmas(word))


def is_some(known: Knowledge, words: str, many: Mapping[str, Sequence[int]]) -> bool:
    """Return whether a clause asks for some of several things, and does not say which."""
    tokens = words.lower().split()
    ends = (at for at in range(1, len(tokens)) if _SOME.search(" ".join(tokens[:at])))
    return any(thing_of(known, " ".join(tokens[at : at + size])) in many for at in ends for size in (1, 2, 3))
