"""Acts and clauses that were read, and the things that they speak of, for the pronouns of later ones."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

from hearth.models.reading.mentioned_nodes import Refs
from hearth.models.reading.request_table import ActTemplate
from hearth.schemas.literals import Literal, Name

ANY_ACT = ""
"""The action of a ban on any act with some things."""

NO_ACT = "?"
"""The action of a ban that names no act of ours: no program does it, and it is said."""


class Act(NamedTuple):
    """Something to do.

    Attributes:
        action: its name.
        objects: its things.
        words: the clause that asks for it.
        optional: whether it is left out where it cannot be done.
    """

    action: str
    objects: Refs
    words: str
    optional: bool = False


class Spoken(NamedTuple):
    """Things that were spoken of together.

    Attributes:
        refs: the things.
        action: what was done with them first.
        is_place: whether they were the place of others.
    """

    refs: Refs
    action: str
    is_place: bool = False


class Clause(NamedTuple):
    """A clause that is understood.

    Attributes:
        acts: that it asks for.
        goals: what is to hold at the end besides.
        spoken: its things, the last first.
        forbidden: acts that are not to be done.
        named: the words of a clause that only names things, as telegrams do; "" of others.
    """

    acts: tuple[Act, ...] = ()
    goals: tuple[Literal[Name], ...] = ()
    spoken: tuple[Spoken, ...] = ()
    forbidden: tuple[Act, ...] = ()
    named: str = ""


def together(bound: Sequence[tuple[ActTemplate, list[Refs]]]) -> Iterator[list[tuple[ActTemplate, list[Refs]]]]:
    """Yield the acts that are done with each of several things in turn, as grabbing and putting down are."""
    group: list[tuple[ActTemplate, list[Refs]]] = []
    for act, refs in bound:
        many = [each for each in refs if len(each) > 1]
        if group and many and many[0] in group[-1][1] and len(many[0]) > 1:
            group.append((act, refs))
            continue
        if group:
            yield group
        group = [(act, refs)]
    if group:
        yield group


def bound(goal: Literal[str], things: Mapping[str, Refs], named: Mapping[str, Refs]) -> Iterator[Literal[Name]]:
    """Yield a goal of the table about each of its things."""
    (term,) = goal.terms
    refs = things.get(term) or named.get(term, ())
    yield from (Literal(goal.name, (ref.node if ref.node is not None else ref.name,), goal.negated) for ref in refs)


def spoken_of(
    acts: Sequence[Act],
    things: Mapping[str, Refs],
    way: Sequence[ActTemplate],
    is_back: Collection[str] = (),
    named: Mapping[str, Refs] = {},
) -> tuple[Spoken, ...]:
    """Return the things of acts, the last first; of a table's row, those of its slots, and then of its classes.

    What a pronoun stood for comes first: the next one stands for the same.
    """
    if not things:
        return tuple(Spoken((ref,), act.action, at > 0) for act in reversed(acts) for at, ref in enumerate(act.objects))
    found = []
    for name, refs in things.items():
        uses = [(act.action, at) for act in way for at, (names, _) in enumerate(act.arguments) if names == (name,)]
        is_place = (bool(uses) and uses[0][1] > 0) or name in "pdqz"
        found.append(Spoken(refs, uses[0][0] if uses else "", is_place and name not in is_back))
    found.sort(key=lambda each: any(things[name] == each.refs for name in is_back))
    others = (Spoken(refs, "", True) for refs in dict.fromkeys(named.values()) if refs not in things.values())
    return (*reversed(found), *others)
