"""The numbered vocabulary of a model of texts: words, actions, classes of objects, and the classes of each action."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.models.interface import Request, Steps
from hearth.models.text.object_mentions import mentions, spellings
from hearth.models.text.text_words import words_of
from hearth.schemas.program import ObjectRef, Step

PAD, UNKNOWN = 0, 1
"""Numbers of no word, and of a word that was not in training."""

END = 0
"""Number of the end of a program, in the place of an action; of no object, in the place of a class."""


@dataclass(frozen=True)
class StepVocabulary:
    """Numbers of words, actions and classes, from 1 for actions and classes, from 2 for words.

    Attributes:
        words: of the training texts that occur at least twice, sorted.
        actions: those that are executed or occur in training, sorted.
        arity: of each action.
        classes: all of the knowledge and of training, sorted: a text can give a class that no training program has.
        takes: for each action and argument, the numbers of the classes that it takes by the grammar, or in training.
        spelt: spelling -> class.
    """

    words: tuple[str, ...]
    actions: tuple[str, ...]
    arity: tuple[int, ...]
    classes: tuple[str, ...]
    takes: tuple[tuple[tuple[int, ...], ...], ...]
    spelt: Mapping[str, str]

    @classmethod
    def of(cls, examples: Iterable[tuple[Request, Steps]], knowledge: Knowledge) -> StepVocabulary:
        """Return the vocabulary of training examples."""
        pairs = list(examples)
        counts = Counter(word for request, _ in pairs for word in set(words_of(request)))
        used = {(step.action, place, ref.name) for _, steps in pairs for step in steps
                for place, ref in enumerate(step.objects)}  # fmt: skip
        arity = {name: action.arity for name, action in knowledge.actions.items() if action.executed}
        arity |= {step.action: len(step.objects) for _, steps in pairs for step in steps}
        actions = sorted(arity)
        classes = sorted(set(knowledge.objects) | {name for _, _, name in used})
        takes = tuple(
            tuple(
                tuple(number for number, name in enumerate(classes, 1)
                      if (action, place, name) in used or knowledge.affords(action, place, name))
                for place in range(arity[action])
            )
            for action in actions
        )  # fmt: skip
        return cls(
            tuple(sorted(word for word, count in counts.items() if count > 1)),
            tuple(actions),
            tuple(arity[action] for action in actions),
            tuple(classes),
            takes,
            spellings(knowledge, classes),
        )

    @classmethod
    def read(cls, document: Mapping[str, Any]) -> StepVocabulary:
        """Return the vocabulary of `document`, which may be a stranger's.

        Raises:
            KeyError: a part is missing.
            TypeError, ValueError: a part is of another kind, or does not fit the others.
        """
        takes = tuple(tuple(tuple(found) for found in places) for places in document["takes"])
        lists = {name: tuple(document[name]) for name in ("words", "actions", "arity", "classes")}
        found = cls(**lists, takes=takes, spelt=dict(document["spelt"]))
        if wrong := [name for name, fits in found._fits().items() if not fits]:
            raise ValueError(f"the vocabulary's {wrong[0]} does not fit the rest of it")
        return found

    def read_closed(self, document: Iterable[Iterable[Any]]) -> tuple[tuple[int, int, int], ...]:
        """Return a closed list of steps as numbers, which may be a stranger's.

        Raises:
            TypeError, ValueError: a row is not a step of this vocabulary.
        """
        found = tuple((int(action), int(first), int(second)) for action, first, second in document)
        for action, *numbers in found:
            takes = self.arity[action - 1] if 0 < action <= len(self.actions) else -1
            if [number > 0 for number in numbers] != [place < takes for place in range(2)] or takes < 0:
                raise ValueError("a step of the closed list is none of the vocabulary")
            if max(numbers) > len(self.classes) or min(numbers) < 0:
                raise ValueError("a step of the closed list has an object that the vocabulary lacks")
        return found

    def _fits(self) -> dict[str, bool]:
        """Return whether each part fits the others."""
        last = len(self.classes)
        return {
            "words": _names(self.words),
            "actions": _names(self.actions),
            "classes": _names(self.classes),
            "arity": len(self.arity) == len(self.actions) and all(type(n) is int and 0 <= n <= 2 for n in self.arity),
            "takes": [len(places) for places in self.takes] == list(self.arity)
            and all(type(n) is int and 0 < n <= last for places in self.takes for found in places for n in found),
            "spelt": all(isinstance(word, str) for word in self.spelt) and {*self.spelt.values()} <= {*self.classes},
        }

    def document(self) -> dict[str, Any]:
        """Return the vocabulary as JSON."""
        return asdict(self)

    def read_words(self, words: Sequence[str]) -> list[int]:
        """Return the numbers of words; `UNKNOWN` for others."""
        return [self._words.get(word, UNKNOWN) for word in words]

    def mentioned(self, words: Sequence[str]) -> list[tuple[int, int]]:
        """Return the places of the classes that a text mentions, and their numbers."""
        return [(place, self.class_numbers[name]) for place, name in mentions(words, self.spelt)]

    def numbers(self, step: Step) -> tuple[int, int, int] | None:
        """Return a step as the numbers of its action and two classes, 0 for none.

        The result is None if the vocabulary lacks a part.
        """
        names = [ref.name for ref in step.objects]
        action = self.action_numbers.get(step.action)
        classes = [self.class_numbers.get(name) for name in names]
        if action is None or None in classes or len(names) != self.arity[action - 1]:
            return None
        first, second, *_ = (*(number or 0 for number in classes), 0, 0)
        return action, first, second

    def step(self, action: int, first: int, second: int) -> Step:
        """Return the step of some numbers; objects have number 1 of their class."""
        names = [self.classes[number - 1] for number in (first, second)[: self.arity[action - 1]]]
        return Step(self.actions[action - 1], tuple(ObjectRef(name) for name in names))

    @cached_property
    def _words(self) -> dict[str, int]:
        return {word: number for number, word in enumerate(self.words, UNKNOWN + 1)}

    @cached_property
    def action_numbers(self) -> dict[str, int]:
        """Action -> its number."""
        return {name: number for number, name in enumerate(self.actions, 1)}

    @cached_property
    def class_numbers(self) -> dict[str, int]:
        """Class -> its number."""
        return {name: number for number, name in enumerate(self.classes, 1)}


def _names(given: Sequence[Any]) -> bool:
    """Return whether these are different texts."""
    return all(isinstance(name, str) for name in given) and len({*given}) == len(given)
