"""Mentions of a home's things in a text: the classes, their positions, and the words before them.

Sketches leave out much that their texts say: that a person sits down to type, and first switches the computer on.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property, lru_cache
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.models.interface import Request
from hearth.models.sketches.name_numbers import Words
from hearth.models.text.object_mentions import mentions, spellings
from hearth.models.text.text_words import words_of

FEWEST = 4
"""Training texts that have a word at least, so that it is known."""

AROUND = 3
"""Words about a mention that are looked at: two before it and one after it."""

MOST = 6
"""Mentioned classes that the sketch does not name, of which things are offered."""


class Clues:
    """A text that is read in addition to a sketch; without a text nothing is mentioned.

    Args:
        words: of the text, in lower case.
        spelt: spelling -> class.
    """

    def __init__(self, words: Sequence[str] = (), spelt: Mapping[str, str] | None = None) -> None:
        self.words = tuple(words)
        self._spelt = spelt or {}

    @classmethod
    def of(cls, request: Request, knowledge: Knowledge) -> Clues:
        """Return the clues of a request's title and description."""
        return cls(words_of(request), _spelt(knowledge))

    @cached_property
    def places(self) -> dict[str, int]:
        """Return the mentioned classes in the order of their first mention, and its place."""
        found: dict[str, int] = {}
        for place, name in mentions(self.words, self._spelt) if self.words else ():
            found.setdefault(name, place)
        return found

    def place(self, name: str) -> float:
        """Return where a class is mentioned first, from 0 to 1; -1 if it is not."""
        place = self.places.get(name, -1)
        return place / len(self.words) if place >= 0 else -1.0

    def around(self, name: str, numbers: Words) -> list[int]:
        """Return the numbers of the words about the first mention of a class."""
        place = self.places.get(name, -1)
        if place < 0:
            return [0] * AROUND
        words = [self.words[n] if 0 <= n < len(self.words) else "" for n in (place - 1, place - 2, place + 1)]
        return [numbers.word(word) for word in words]

    def bag(self, numbers: Words) -> list[int]:
        """Return the numbers of the known words, each once."""
        return list(dict.fromkeys(number for word in self.words if (number := numbers.word(word))))


NO_CLUES = Clues()


@lru_cache(maxsize=4)
def _spelt(knowledge: Knowledge) -> dict[str, str]:
    return spellings(knowledge, sorted(knowledge.objects))


class TextState(NamedTuple):
    """The progress of a program through its text.

    Attributes:
        place: of the mention that the last step is about, from 0 to 1.
        done: the share of mentioned classes that steps were about.
    """

    place: float
    done: float

    @classmethod
    def of(cls, clues: Clues, classes: Iterable[str]) -> TextState:
        """After steps about these classes, in order."""
        met = [name for name in classes if name in clues.places]
        share = len({*met}) / len(clues.places) if clues.places else 1.0
        return cls(clues.place(met[-1]) if met else 0.0, share)


def frequent(requests: Iterable[Request]) -> tuple[str, ...]:
    """Return the words that some training texts have, sorted."""
    counts = Counter(word for request in requests for word in {*words_of(request)})
    return tuple(sorted(word for word, count in counts.items() if count >= FEWEST))
