"""The classes of things as a network reads them: their properties, and which action may be done with them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hearth.models.films.clip_data import Instruction
from hearth.models.films.film_arrays import damaged

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge

PERSON = "character"
"""Class of people in masks."""

PLACES = 2
"""Objects of a step at most."""

MOST_CLASSES = 4096


@dataclass(frozen=True)
class ClassTable:
    """Classes by row; row 0 is nothing.

    Attributes:
        ids: numbers of the classes in masks, from row 1.
        names: of the classes, from row 1.
        properties: of the classes, as sorted lists, from row 1.
        actions: that training has, sorted.
        objects: how many objects each of them takes.
        named: rows that are objects in training: things that can be named although they are not visible.
        afforded: (actions, 2, rows) whether an action's first or second object may be of a class.
    """

    ids: tuple[int, ...]
    names: tuple[str, ...]
    properties: tuple[tuple[str, ...], ...]
    actions: tuple[str, ...]
    objects: tuple[int, ...]
    named: tuple[int, ...]
    afforded: NDArray[np.bool_]

    @classmethod
    def of(cls, knowledge: Knowledge, done: Sequence[Instruction]) -> ClassTable:
        """Return the classes of the knowledge and of the instructions of training clips."""
        things = [*knowledge.objects.values()]
        for each in done:
            if len(each.objects) > PLACES or not all(name in knowledge.objects for name in each.objects):
                raise damaged("clips", f"`{each.action}` with {', '.join(each.objects)[:80]} is not an instruction")
        row = {thing.name: number for number, thing in enumerate(things, 1)}
        actions = sorted({each.action for each in done})
        counts = {action: max(len(each.objects) for each in done if each.action == action) for action in actions}
        afforded = np.zeros((len(actions), PLACES, len(things) + 1), np.bool_)
        for number, action in enumerate(actions):
            for place in range(counts[action]):
                afforded[number, place, 1:] = [knowledge.affords(action, place, thing.name) for thing in things]
        for each in done:  # an action of training affords its objects
            for place, name in enumerate(each.objects):
                afforded[actions.index(each.action), place, row[name]] = True
        return cls(
            tuple(thing.id for thing in things),
            tuple(thing.name for thing in things),
            tuple(tuple(sorted(thing.properties)) for thing in things),
            tuple(actions),
            tuple(counts[action] for action in actions),
            tuple(sorted({row[name] for each in done for name in each.objects})),
            afforded,
        )

    def document(self) -> dict[str, Any]:
        """Return the table as JSON."""
        packed = ["".join("01"[bit] for bit in row) for row in self.afforded.reshape(-1, len(self) + 1).astype(int)]
        classes = [[*row] for row in zip(self.ids, self.names, map(list, self.properties), strict=True)]
        actions = [[*row] for row in zip(self.actions, self.objects, strict=True)]
        return {"classes": classes, "actions": actions, "named": [*self.named], "afforded": packed}

    @classmethod
    def read(cls, document: Mapping[str, Any]) -> ClassTable:
        """Return the table of `document`, which may be a stranger's.

        Raises:
            KeyError: a part is missing.
            TypeError, ValueError: a part is of another kind, or does not fit the others.
        """
        ids, names, properties = zip(*document["classes"], strict=True)
        actions, objects = zip(*document["actions"], strict=True)
        size = len(ids) + 1
        bits = np.array([[bit == "1" for bit in row] for row in document["afforded"]], np.bool_)
        fits = (
            len(ids) < MOST_CLASSES and len({*ids}) == len(ids) and len({*names}) == len(names),
            all(type(number) is int and 0 <= number < 1 << 16 for number in ids),
            all(type(each) is str for each in (*names, *actions)) and PERSON in names,
            all(type(number) is int and 0 <= number <= PLACES for number in objects),
            all(type(number) is int and 0 < number < size for number in document["named"]),
            bits.shape == (len(actions) * PLACES, size),
        )
        if not all(fits):
            raise ValueError("the numbers of classes, actions and objects do not fit")
        rows = tuple(tuple(str(name) for name in each) for each in properties)
        named = tuple(document["named"])
        return cls(
            tuple(ids), tuple(names), rows, tuple(actions), tuple(objects), named, bits.reshape(-1, PLACES, size)
        )

    def __len__(self) -> int:
        return len(self.ids)

    @property
    def person(self) -> int:
        """Return the number of people in masks."""
        return self.ids[self.names.index(PERSON)]

    @cached_property
    def rows(self) -> NDArray[np.int64]:
        """Return (65536,) the row of each class number; 0 is the background, whatever class has that number."""
        found = np.zeros(1 << 16, np.int64)
        found[list(self.ids)] = np.arange(1, len(self) + 1)
        found[0] = 0
        return found

    @cached_property
    def traits(self) -> NDArray[np.float32]:
        """Return (rows, traits) whether a class has a property.

        The last is of people, the one before of all classes.
        """
        known = sorted({name for each in self.properties for name in each})
        found = np.zeros((len(self) + 1, len(known) + 2), np.float32)
        for number, each in enumerate(self.properties, 1):
            found[number, [known.index(name) for name in each]] = 1
        found[1:, -2] = 1
        found[self.names.index(PERSON) + 1, -1] = 1
        return found

    def numbers(self, done: Instruction) -> tuple[int, int, int]:
        """Return the numbers of an action and of its objects' rows; -1 for names that training lacks, 0 for none."""
        action = self._action.get(done.action, -1)
        first, second = (*(self._row.get(name, -1) for name in done.objects), 0, 0)[:PLACES]
        return action, first, second

    @cached_property
    def _action(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.actions)}

    @cached_property
    def _row(self) -> dict[str, int]:
        return {name: number for number, name in enumerate(self.names, 1)}
