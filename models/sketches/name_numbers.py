"""Names as numbers for embeddings: classes, actions, words of texts, and codes; 0 is for none and the unknown."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from hearth.kb.knowledge import Knowledge

CODES = 64
"""Numbers reserved for counts and kinds, before those of names."""


class Words:
    """The numbers of names: codes first, then classes, then actions, then words.

    Attributes:
        classes: names of classes, in order.
        actions: names of actions, in order.
        words: of texts, in order.
    """

    def __init__(self, classes: Sequence[str], actions: Sequence[str], words: Sequence[str] = ()) -> None:
        self.classes, self.actions, self.words = tuple(classes), tuple(actions), tuple(words)
        self._class = {name: n for n, name in enumerate(self.classes, CODES)}
        self._action = {name: n for n, name in enumerate(self.actions, CODES + len(self.classes))}
        self._word = {name: n for n, name in enumerate(self.words, CODES + len(self.classes) + len(self.actions))}

    @classmethod
    def of(cls, knowledge: Knowledge, words: Sequence[str] = ()) -> Words:
        """Return the classes and actions that are known, and some words."""
        return cls(sorted(knowledge.objects), sorted(knowledge.actions), words)

    @cached_property
    def size(self) -> int:
        """Return how many numbers there are."""
        return CODES + len(self.classes) + len(self.actions) + len(self.words)

    def thing(self, name: str) -> int:
        """Return the number of a class."""
        return self._class.get(name, 0)

    def action(self, name: str) -> int:
        """Return the number of an action."""
        return self._action.get(name, 0)

    def word(self, name: str) -> int:
        """Return the number of a word of texts."""
        return self._word.get(name, 0)

    def code(self, number: int) -> int:
        """Return the number for a count or a kind, from 0; great ones are cut."""
        return min(number, CODES - 2) + 1
