"""Goals: counted literals such as `ON(plate, dinnertable): 2` (thesis 6.3, tables B.1, C.2)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from hearth.schemas.literals import Literal, Name


@dataclass(frozen=True, slots=True)
class Goal:
    """Literals with how often each must hold.

    Counted are distinct subjects; of a literal about characters, what each of them is related to: `HOLDS(agent, book)`
    counts books.
    """

    counts: tuple[tuple[Literal[Name], int], ...]

    @classmethod
    def of(cls, *wanted: Literal[Name] | tuple[Literal[Name], int]) -> Goal:
        """A goal from literals, each wanted once unless a count is given."""
        return cls(tuple((each, 1) if isinstance(each, Literal) else each for each in wanted))

    def __iter__(self) -> Iterator[tuple[Literal[Name], int]]:
        return iter(self.counts)
