"""Literals: what may hold in a world, as the knowledge, goals, preconditions and post-conditions all write it."""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeVar

from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import CHARACTER_CLASS

Key = tuple[str, int]
"""An object of a program: (class name, instance)."""

Name = str | int
"""The subject of a goal: a class name, a node id, or `agent` (any character) or `agent:1` (the second by id)."""

CHARACTER: Key = (CHARACTER_CLASS, 1)
"""The character of a program; the second of several is `(CHARACTER_CLASS, 2)`."""

AGENT = "agent"

HANDS = ("HOLDS_RH", "HOLDS_LH")

HOLDS = "HOLDS"
"""Either of `HANDS`."""

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

DONE_OF_SET_3 = ("covered", "folded", "uncovered", "unfolded", "unwrapped", "wrapped")
"""Conditions that an act of action set 3 makes and refuses: what is folded is not folded again."""

STATE_OF_SET_3: dict[str, str] = {
    "broken": "BROKEN",
    "cold": "COLD",
    "cut": "CUT",
    "empty": "EMPTY",
    "full": "FULL",
    "hot": "HOT",
    **{name: name.upper() for name in DONE_OF_SET_3},
}
"""Conditions about an object's own state that only worlds of action set 3 simulate."""

LACK_OF_SET_3: dict[str, tuple[str, ...]] = {"uncut": ("CUT",), "intact": ("BROKEN",)}
"""Conditions that an object is in none of some states, which only worlds of action set 3 simulate."""

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

RENAMED: dict[str, str] = {
    "stowed": "in_closed_container",
    "averted": "facing_away",
    "apart": "not_near",
    "elsewhere": "other_room",
    "shut_in": "doors_closed",
}
"""Conditions whose name in datasets of version 0.1.0 differs, by that name."""

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


class Literal(NamedTuple, Generic[T_co]):
    """A predicate of terms, or its negation.

    A tuple, because post-conditions make and compare thousands a second.

    Attributes:
        name: a state (`OPEN`), a relation (`ON`, `HOLDS`), a condition (`atreach`), or a predicate of the knowledge.
        terms: what it is about. `Key` in pre- and post-conditions, `Name` in goals, `kb.formula.Term` in formulas.
        negated: it holds when the predicate does not.
    """

    name: str
    terms: tuple[T_co, ...] = ()
    negated: bool = False

    def __repr__(self) -> str:
        return brief(self)

    @classmethod
    def of(cls, name: str, *terms: T) -> Literal[T]:
        """`Literal.of("ON", "plate", "table")`."""
        return Literal(name, terms)

    @property
    def subject(self) -> T_co:
        """The first term."""
        return self.terms[0]

    @property
    def target(self) -> T_co | None:
        """The second term; None of a state."""
        return self.terms[1] if len(self.terms) > 1 else None

    @property
    def atom(self) -> Literal[T_co]:
        """The same without its negation."""
        return self._replace(negated=False) if self.negated else self

    def __str__(self) -> str:
        text = f"{self.name}({', '.join(map(_text, self.terms))})"
        return f"not {text}" if self.negated else text


def _text(term: object) -> str:
    return f"{term[0]} ({term[1]})" if isinstance(term, tuple) else str(term)
