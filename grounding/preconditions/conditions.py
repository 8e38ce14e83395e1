"""Preconditions: what must be true of an environment for a program to run in it (thesis 5.5.2)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from hearth.schemas.literals import Key, Literal
from hearth.schemas.short_repr import brief
from hearth.schemas.spoken_words import spoken


@dataclass(frozen=True, slots=True)
class Condition:
    """One thing that must hold at the start.

    Attributes:
        literal: a predicate of `simulation.literal_truth`; its objects stand in the order of the release's files.
        step: number of the step that needs it, from 0.
        hard: the program can't run without it; a soft one is a default that its author assumed (the cup is in the
            cupboard that was opened).
    """

    literal: Literal[Key]
    step: int = 0
    hard: bool = True

    @property
    def name(self) -> str:
        """Conditions that must hold."""
        return self.literal.name

    @property
    def objects(self) -> tuple[Key, ...]:
        """Its objects."""
        return self.literal.terms

    def instead(self, name: str) -> Condition:
        """Another condition on the same objects, for the same step."""
        return Condition(self.literal._replace(name=name), self.step)

    def __str__(self) -> str:
        return str(self.literal)

    def in_words(self) -> str:
        """For people: `cup (1) is on table (1)`."""
        subject, *others = (f"{spoken(name)} ({instance})" for name, instance in self.objects)
        return " ".join((subject, "is", _IN_WORDS.get(self.name, self.name), *others[: self.name not in _ABOUT_ONE]))


_ABOUT_ONE = ("in_closed_container",)
"""Conditions whose second object only says which place was meant."""

_IN_WORDS = {
    "is_on": "switched on", "is_off": "switched off", "plugged": "plugged in", "full_hands": "full-handed",
    "doors_closed": "behind closed doors", "pet": "under a pet", "in": "on", "location": "in",
    "atreach": "within reach of", "nearby": "within reach of", "facing_away": "facing away from", "holds": "held by",
    "together": "in the same room as", "other_room": "in another room than", "not_near": "out of reach of",
    "in_closed_container": "in something closed", "uncut": "not cut",
}  # fmt: skip
"""The part of a condition's meaning that its name alone does not give."""


@dataclass(frozen=True, slots=True)
class Preconditions:
    """The conditions of a program, each literal once, in the order in which they were found."""

    conditions: tuple[Condition, ...] = ()

    __repr__ = brief

    def __iter__(self) -> Iterator[Condition]:
        return iter(self.conditions)

    def __len__(self) -> int:
        return len(self.conditions)

    def has(self, name: str, *objects: Key) -> bool:
        """Return whether a condition is among them."""
        wanted = Literal(name, objects)
        return any(c.literal == wanted for c in self.conditions)

    def about(self, key: Key) -> tuple[Condition, ...]:
        """Return the conditions in which an object occurs."""
        return tuple(c for c in self.conditions if key in c.objects)

    def plus(self, *new: Condition) -> Preconditions:
        """With more conditions; one that is there already stays as it is, but becomes hard if the new one is."""
        merged = {c.literal: c for c in self.conditions}
        for condition in new:
            known = merged.setdefault(condition.literal, condition)
            if condition.hard and not known.hard:
                merged[condition.literal] = replace(known, hard=True)
        return Preconditions(tuple(merged.values()))

    def without(self, *removed: Condition) -> Preconditions:
        """Without some conditions."""
        literals = {c.literal for c in removed}
        return Preconditions(tuple(c for c in self.conditions if c.literal not in literals))
