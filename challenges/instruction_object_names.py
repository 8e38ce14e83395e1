"""Names of things in instructions: classes as nouns, with numbers, and the classes that nouns stand for."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import AGENT, Name
from hearth.schemas.yaml_limits import packaged

Counted = tuple[tuple[Name, int], ...]
"""Names of things, each with how many of it; 0 for every one."""

NUMBERS = ("", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
EVERY = 0
"""The number that stands for every thing of a class."""

_PREFIXES = re.compile(r"^(food|clothes)_")
_VOWEL = re.compile(r"[aeio]|u(?=[mn][^i])")
_NODE, _VARIABLE, _PERSON = "object ", "thing ", "person "

ANYBODY = "anybody"
"""The word for an agent that no number names."""


@cache
def wordings() -> dict[str, Any]:
    """Return the content of `instruction_wordings.yaml`."""
    found: dict[str, Any] = packaged("hearth.challenges", "instruction_wordings.yaml")
    return found


def noun(name: Name) -> str:
    """Return the noun of a class, or the words for a node, a variable or an agent."""
    if isinstance(name, int):
        return f"{_NODE}{name}"
    if name.startswith("?"):
        return f"{_VARIABLE}{name[1:]}"
    if name == AGENT:
        return ANYBODY
    if name.startswith(f"{AGENT}:"):
        return f"{_PERSON}{name.partition(':')[2]}"
    given = wordings()["nouns"].get(name)
    return str(given) if given else _PREFIXES.sub("", name).replace("_", " ")


def label(name: str) -> str:
    """Return the words for a class without an amount: `milk` where the noun is `carton of milk`."""
    words = str(wordings()["nouns"].get(name) or _PREFIXES.sub("", name).replace("_", " "))
    return words.partition(" of ")[2] if name in wordings()["nouns"] and " of " in words else words


def plural(words: str) -> str:
    """Return the plural of a noun; of `carton of milk`, `cartons of milk`."""
    head, of, rest = words.partition(" of ")
    before, space, last = head.rpartition(" ")
    return f"{before}{space}{_plural(last)}{of}{rest}"


def _plural(word: str) -> str:
    irregular = wordings()["plurals"].get(word)
    if irregular:
        return str(irregular)
    if re.search(r"(s|x|z|ch|sh)$", word):
        return f"{word}es"
    return f"{word[:-1]}ies" if re.search(r"[^aeiou]y$", word) else f"{word}s"


def named(name: Name, number: int = 1) -> str:
    """Return a thing with its number: `a plate`, `two plates`, `every plate`; a node or variable has no article."""
    words = noun(name)
    if isinstance(name, int) or name.startswith(("?", AGENT)):
        return words if number == 1 else f"every {words}" if number == EVERY else f"{_number(number)} {words}"
    if number == EVERY:
        return f"every {words}"
    if number > 1:
        return f"{_number(number)} {plural(words)}"
    return f"{'an' if _VOWEL.match(words) else 'a'} {words}"


def the(name: Name) -> str:
    """Return a thing as a place: `the table`; a node, variable or agent has no article."""
    words = noun(name)
    return words if words == ANYBODY or words.startswith((_NODE, _VARIABLE, _PERSON)) else f"the {words}"


def listed(things: Counted) -> str:
    """Return some things as a list: `two plates, a fork and a cup`."""
    *first, last = [named(name, number) for name, number in things]
    return f"{', '.join(first)} and {last}" if first else last


def are(things: Counted) -> str:
    """Return the verb of a list: `is` for one thing, and for every one of some things."""
    several = len(things) > 1 and any(number != EVERY for _, number in things)
    return "are" if several or any(number > 1 for _, number in things) else "is"


def _number(number: int) -> str:
    return NUMBERS[number] if number < len(NUMBERS) else str(number)


@dataclass(frozen=True)
class Nouns:
    """The names that nouns stand for.

    Attributes:
        singular, plural: name of each noun; each noun has one name.
    """

    singular: Mapping[str, str]
    plural: Mapping[str, str]

    def things(self, text: str) -> Counted | None:
        """Return the things of a list (see `listed`); None if one of them is not known."""
        found = tuple(map(self._thing, re.split(r", | and ", text)))
        return None if None in found else tuple(each for each in found if each is not None)

    def place(self, text: str) -> Name | None:
        """Return the name that the words for a place stand for; None if there is none."""
        return self._meant(re.sub(r"^(the|a|an) ", "", text), self.singular)

    def _thing(self, text: str) -> tuple[Name, int] | None:
        first, _, rest = text.partition(" ")
        number = _read_number(first)
        if number is None:
            number, rest = 1, text
        name = self._meant(rest, self.singular if number <= 1 else self.plural)
        return None if name is None else (name, number)

    def _meant(self, words: str, known: Mapping[str, str]) -> Name | None:
        if words == ANYBODY:
            return AGENT
        for prefix in (_NODE, _VARIABLE, _PERSON):
            rest = words.removeprefix(prefix)
            if rest != words:
                return _special(prefix, rest)
        return known.get(words)


def _read_number(word: str) -> int | None:
    if word in ("a", "an"):
        return 1
    if word == "every":
        return EVERY
    if word in NUMBERS[1:]:
        return NUMBERS.index(word)
    return int(word) if word.isascii() and word.isdigit() and int(word[:9]) > 0 else None


def _special(prefix: str, rest: str) -> Name | None:
    if prefix == _NODE:
        return int(rest) if rest.isascii() and rest.isdigit() and len(rest) < 10 else None
    if prefix == _VARIABLE:
        return f"?{rest}"
    return f"{AGENT}:{rest}"


@lru_cache(maxsize=8)
def nouns(knowledge: Knowledge, names: frozenset[str] = frozenset()) -> Nouns:
    """Return the names that nouns stand for.

    Args:
        knowledge: whose classes there are.
        names: of a challenge; where two names have one noun, these come first.
    """
    own = [*knowledge.objects]
    others = {name for each in own for name in knowledge.same_class(each)} | set(wordings()["nouns"])
    every = [*sorted(others - set(own)), *own, *sorted(names)]
    words = {name: noun(name) for name in every}
    return Nouns({words[name]: name for name in every}, {plural(words[name]): name for name in every})
