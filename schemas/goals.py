"""Goals: counted literals such as `ON(plate, dinnertable): 2` (thesis 6.3, tables B.1, C.2), alternatives and order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from hearth.schemas.literals import Literal, Name
from hearth.schemas.short_repr import brief


@dataclass(frozen=True, slots=True)
class Joined:
    """Goals joined by a word.

    Attributes:
        join: `or` (one of them), `then` (all, in this order), `not`, `exists`, `forall`, `forn` or `forpairs` (of one,
            about things), `always` or `never` (of one, at every time up to the end), `within` (of one, by a tick).
        goals: what is joined.
        variable: of `exists`, `forall`, `forn` and `forpairs`; in the goal it is a term that begins with `?`.
        ticks: of `within`: the last of the ticks in which the goal may be reached, counted from the part before.
        kind: the class of the things that the variable stands for; "" for things of any class.
        number: of `forn`: of how many things the goal is reached, no more and no less.
        other: of `forpairs`: the second variable and the class of its things.
    """

    join: str
    goals: tuple[Goal, ...]
    variable: str = ""
    ticks: int = 0
    kind: str = ""
    number: int = 0
    other: tuple[str, str] = ("", "")

    __repr__ = brief

    def __str__(self) -> str:
        if self.variable:
            pairs = [(self.variable, self.kind), *([self.other] if self.other[0] else [])]
            named = ", ".join(f"{name[1:]}: {kind}" if kind else name[1:] for name, kind in pairs)
            count = f" {self.number}" if self.join == "forn" else ""
            return f"{self.join}{count} {named}. ({self.goals[0]})".replace("?", "")
        if self.join == "within":
            return f"({self.goals[0]}) within {self.ticks}"
        if self.join in ("not", *LASTING):
            return f"{self.join} ({self.goals[0]})"
        return f" {self.join} ".join(f"({goal})" for goal in self.goals)

    def _bound(self, variable: str, node: int) -> Joined:
        return replace(self, goals=tuple(goal.bound(variable, node) for goal in self.goals))


LASTING = ("always", "never")
"""The words of goals about every time up to the end."""

BANS = ("not", *LASTING)
"""The words of parts that are kept or broken: nothing of them is done by and by."""


@dataclass(frozen=True, slots=True)
class Goal:
    """Parts of a goal that must all be reached: literals with their numbers, and parts that are joined by other words.

    Counted are distinct subjects; of a literal about characters, what each of them is related to: `HOLDS(agent, book)`
    counts books. A literal may name an action, `Watch(television)`: counted are the different objects it was done with.
    A negated literal is wanted of all its subjects, whatever its count: `not ON(plate, table)` clears a table.
    """

    counts: tuple[tuple[Literal[Name], int], ...] = ()
    parts: tuple[Joined, ...] = ()

    __repr__ = brief

    @classmethod
    def of(cls, *wanted: Literal[Name] | tuple[Literal[Name], int]) -> Goal:
        """Return a goal from literals, each wanted once unless a count is given."""
        return cls(tuple((each, 1) if isinstance(each, Literal) else each for each in wanted))

    def __iter__(self) -> Iterator[tuple[Literal[Name], int]]:
        return iter(self.counts)

    def __and__(self, other: Goal) -> Goal:
        return Goal(self.counts + other.counts, self.parts + other.parts)

    def literals(self) -> Iterator[tuple[Literal[Name], int]]:
        """Its counted literals and those of its parts."""
        yield from self.counts
        for part in self.parts:
            for goal in part.goals:
                yield from goal.literals()

    def aims(self) -> Iterator[tuple[Literal[Name], int, bool]]:
        """Yield what `literals` does, each with whether more of it that holds is progress: not so in a ban.

        A part `not`, `always` or `never` is kept or broken; nothing of it is done by and by.
        """
        yield from ((literal, number, True) for literal, number in self.counts)
        for part in self.parts:
            for goal in part.goals:
                for literal, number, aims in goal.aims():
                    yield literal, number, aims and part.join not in ("not", *LASTING)

    @property
    def lasts(self) -> bool:
        """Return whether some of its parts are about every time up to the end."""
        return any(part.join in LASTING or any(goal.lasts for goal in part.goals) for part in self.parts)

    @property
    def only_forbids(self) -> bool:
        """Return whether it asks for nothing to be done: all of it are bans, which hold until they are broken."""
        return bool(self.parts) and not self.counts and all(map(_forbids, self.parts))

    def bound(self, variable: str, node: int) -> Goal:
        """Return the goal with a node instead of a variable."""
        counts = ((lit._replace(terms=tuple(node if t == variable else t for t in lit.terms)), n) for lit, n in self)
        parts = (p._bound(variable, node) for p in self.parts)
        return Goal(tuple(counts), tuple(parts))

    def __str__(self) -> str:
        counted = (_text(literal) + (f": {number}" if number != 1 else "") for literal, number in self)
        parts = (f"({part})" if self.counts or self.parts[1:] else str(part) for part in self.parts)
        return " and ".join((*counted, *parts))


def _forbids(part: Joined) -> bool:
    """Return whether a part is about every time, or about acts that are never done; `not OPEN(fridge)` is a state."""
    acts = all(not literal.name.isupper() for goal in part.goals for literal, _ in goal.literals())
    return part.join in LASTING or (part.join == "not" and acts)


def _text(literal: Literal[Name]) -> str:
    """Return a literal; an action in brackets, so that `[Open](fridge)` is not the state."""
    name = literal.name if literal.name.isupper() else f"[{literal.name}]"
    return str(literal._replace(name=name)) if literal.terms else name
