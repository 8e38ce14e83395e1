"""Classes of objects that a text mentions, and the words that mention them: a model may copy these classes."""

from collections.abc import Mapping, Sequence

from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of

LONGEST = 3
"""Words of the longest name that is looked for."""

_ENDINGS = (("ies", "y"), ("ves", "f"), ("ves", "fe"), ("es", ""), ("s", ""))
"""Endings of plurals, and the ending of the singular."""


def spellings(knowledge: Knowledge, classes: Sequence[str]) -> dict[str, str]:
    """Return every spelling of the classes, as `key_of` gives it, and the class; `food_salt` is spelt `salt`, too."""
    known = set(classes)
    found = {key: name for key, name in knowledge.object_spellings.items() if name in known}
    for name in classes:
        plain = key_of(name.removeprefix("food_").removeprefix("clothes_").removesuffix("_both"))
        found.setdefault(plain, name)
    return found


def mentions(words: Sequence[str], known: Mapping[str, str]) -> list[tuple[int, str]]:
    """Return the places of mentioned classes in a text: of the first word of each, the longest names first.

    Args:
        words: of the text, in lower case.
        known: spelling -> class.
    """
    found = []
    place = 0
    while place < len(words):
        length = next((size for size in range(LONGEST, 0, -1) if _class(words[place : place + size], known)), 0)
        if length:
            found.append((place, _class(words[place : place + length], known)))
        place += max(length, 1)
    return found


def _class(words: Sequence[str], known: Mapping[str, str]) -> str:
    """Return the class that some words name, or ""."""
    key = "".join(words)
    singular = (key.removesuffix(old) + new for old, new in _ENDINGS if key.endswith(old) and len(key) > len(old) + 2)
    return next((known[each] for each in (key, *singular) if each in known), "")
