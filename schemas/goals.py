"""Goals: counted predicates such as `ON(plate, dinnertable): 2` (thesis 6.3, tables B.1, C.2)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Predicate:
    """A relation or state that is to hold.

    Attributes:
        name: a relation (`ON`, `INSIDE`, `HOLDS`, `CLOSE`, `FACING`) or a state (`CLEAN`).
        subject: class name, node id, or `agent` / `agent:1`.
        target: the same for relations; None for states.
    """

    name: str
    subject: str | int
    target: str | int | None = None

    def __str__(self) -> str:
        arguments = (self.subject,) if self.target is None else (self.subject, self.target)
        return f"{self.name}({', '.join(map(str, arguments))})"


@dataclass(frozen=True, slots=True)
class Goal:
    """Predicates with how many distinct subjects must satisfy each."""

    counts: tuple[tuple[Predicate, int], ...]

    @classmethod
    def of(cls, *predicates: Predicate | tuple[Predicate, int]) -> Goal:
        """A goal from predicates, each wanted once unless a count is given."""
        return cls(tuple(p if isinstance(p, tuple) else (p, 1) for p in predicates))

    def __iter__(self) -> Iterator[tuple[Predicate, int]]:
        return iter(self.counts)
