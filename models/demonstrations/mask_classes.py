"""The classes of masks by the numbers of a vocabulary: their properties, and which other classes they may stand for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.kb.knowledge import Knowledge
from hearth.models.text.step_vocabulary import StepVocabulary

MOST_SERVED = 8
"""Classes at most that a class may stand for, itself included."""


@dataclass(frozen=True)
class MaskClasses:
    """Classes in the order of a vocabulary, whose numbers begin at 1.

    Attributes:
        ids: numbers of the classes in masks; 0 for one that no mask has.
        properties: of the classes, sorted.
        serves: numbers of the classes that each may stand for, itself first: a `kitchen_table` is a `table`, too.
        person: class number of people in masks.
    """

    ids: tuple[int, ...]
    properties: tuple[tuple[str, ...], ...]
    serves: tuple[tuple[int, ...], ...]
    person: int

    @classmethod
    def of(cls, knowledge: Knowledge, vocabulary: StepVocabulary) -> MaskClasses:
        """Return the classes of the knowledge and the vocabulary."""
        things, numbers = knowledge.objects, vocabulary.class_numbers
        serves: dict[str, list[int]] = {name: [number] for name, number in numbers.items()}
        for name, number in numbers.items():
            for other in sorted(knowledge.same_class(name)):
                if other != name and other in serves and len(serves[other]) < MOST_SERVED:
                    serves[other].append(number)
        return cls(
            tuple(things[name].id if name in things else 0 for name in numbers),
            tuple(tuple(sorted(things[name].properties)) if name in things else () for name in numbers),
            tuple(tuple(serves[name]) for name in numbers),
            things["character"].id,
        )

    def document(self) -> dict[str, Any]:
        """Return the classes as JSON."""
        return {"ids": [*self.ids], "properties": [[*each] for each in self.properties],
                "serves": [[*each] for each in self.serves], "person": self.person}  # fmt: skip

    @classmethod
    def read(cls, document: Mapping[str, Any], classes: int) -> MaskClasses:
        """Return the classes of `document`, which may be a stranger's, for a vocabulary of some classes.

        Raises:
            KeyError: a part is missing.
            TypeError, ValueError: a part is of another kind, or does not fit the others.
        """
        properties = tuple(tuple(str(name) for name in each) for each in document["properties"])
        serves = tuple(tuple(each) for each in document["serves"])
        found = cls(tuple(document["ids"]), properties, serves, document["person"])
        fits = (
            len(found.ids) == len(properties) == len(serves) == classes,
            all(type(number) is int and 0 <= number < 1 << 16 for number in (*found.ids, found.person)),
            all(type(n) is int and 0 < n <= classes for each in serves for n in each),
            all(0 < len(each) <= MOST_SERVED for each in serves),
        )
        if not all(fits):
            raise ValueError("the classes of masks do not fit the vocabulary")
        return found

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """Return (65536,) the vocabulary's number of each class number; 0 for the background and for others."""
        found = np.zeros(1 << 16, np.int64)
        found[list(self.ids)] = np.arange(1, len(self.ids) + 1)
        found[0] = 0
        return found

    @cached_property
    def traits(self) -> NDArray[np.float32]:
        """Return (classes, traits) whether a class has a property.

        The last is of people, the one before of all classes.
        """
        known = sorted({name for each in self.properties for name in each})
        found = np.zeros((len(self.ids), len(known) + 2), np.float32)
        for number, each in enumerate(self.properties):
            found[number, [known.index(name) for name in each]] = 1
        found[:, -2] = 1
        found[[number == self.person for number in self.ids], -1] = 1
        return found

    @cached_property
    def served(self) -> NDArray[np.int64]:
        """Return (classes + 1, MOST_SERVED) `serves` as an array; 0 fills up."""
        found = np.zeros((len(self.ids) + 1, MOST_SERVED), np.int64)
        for number, each in enumerate(self.serves, 1):
            found[number, : len(each)] = each
        return found
