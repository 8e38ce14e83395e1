"""Preconditions: what must be true of an environment for a program to run in it (thesis 5.5.2)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

Key = tuple[str, int]
"""An object of a program: (class name, instance)."""

CHARACTER: Key = ("character", 1)

STATE_OF: dict[str, str] = {
    "closed": "CLOSED",
    "open": "OPEN",
    "is_off": "OFF",
    "is_on": "ON",
    "dirty": "DIRTY",
    "clean": "CLEAN",
    "unplugged": "PLUGGED_OUT",
    "plugged": "PLUGGED_IN",
}
"""Conditions about an object's own state, by the release's names for them."""

NAME_OF = {state: name for name, state in STATE_OF.items()}

RELATION_OF: dict[str, str] = {
    "in": "ON",
    "inside": "INSIDE",
    "location": "INSIDE",
    "atreach": "CLOSE",
    "nearby": "CLOSE",
    "facing": "FACING",
    "holds": "HOLDS_RH",
}
"""Conditions about two objects. `in` is ON, `location` is INSIDE a room, `nearby` is the character's own CLOSE."""

SEATS = ("sitting", "lying", "free", "occupied")
"""Conditions about the character's rest, and about what is on a seat or bed."""

SPOILING = ("apart", "elsewhere", "stowed", "averted", "full_hands", "shut_in", "pet")
"""What perturbing asks for instead: not at reach of the other; in another room than the other; in something closed but
the other; not facing the other; both hands of the character hold something; the doors of the object's room are closed;
a pet is on the seat."""

PETS = ("cat", "dog")
"""What may lie on a seat that is wanted."""

NAMES = (*STATE_OF, *RELATION_OF, *SEATS, *SPOILING, "together")
"""Every condition. `together` is being in one room."""


@dataclass(frozen=True, slots=True)
class Condition:
    """One thing that must hold at the start.

    Attributes:
        name: one of `NAMES`.
        objects: what it is about, in the order of the release's files.
        step: number of the step that needs it, from 0.
        hard: the program can't run without it; a soft one is what its author took for granted (the cup is in the
            cupboard that was opened).
    """

    name: str
    objects: tuple[Key, ...]
    step: int = 0
    hard: bool = True

    @property
    def fact(self) -> tuple[str, tuple[Key, ...]]:
        """The condition itself, whoever needs it."""
        return (self.name, self.objects)

    def __str__(self) -> str:
        return f"{self.name}({', '.join(f'{name} ({instance})' for name, instance in self.objects)})"


@dataclass(frozen=True, slots=True)
class Preconditions:
    """The conditions of a program, each fact once, in the order in which they were found."""

    conditions: tuple[Condition, ...] = ()

    def __iter__(self) -> Iterator[Condition]:
        return iter(self.conditions)

    def __len__(self) -> int:
        return len(self.conditions)

    def has(self, name: str, *objects: Key) -> bool:
        """Whether a fact is among them."""
        return any(c.name == name and c.objects == objects for c in self.conditions)

    def about(self, key: Key) -> tuple[Condition, ...]:
        """The conditions in which an object occurs."""
        return tuple(c for c in self.conditions if key in c.objects)

    def plus(self, *new: Condition) -> Preconditions:
        """With more conditions; a fact that is there already stays as it is, but becomes hard if the new one is."""
        merged = {c.fact: c for c in self.conditions}
        for condition in new:
            known = merged.get(condition.fact)
            merged[condition.fact] = condition if known is None else replace(known, hard=known.hard or condition.hard)
        return Preconditions(tuple(merged.values()))

    def without(self, *gone: Condition) -> Preconditions:
        """Without some conditions."""
        facts = {c.fact for c in gone}
        return Preconditions(tuple(c for c in self.conditions if c.fact not in facts))
