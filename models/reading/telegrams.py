"""Telegrams: requests of bare names, as `3 books, coffee table` and `blanket: fold, then couch` are."""

from __future__ import annotations

from collections.abc import Sequence

from hearth.kb.knowledge import Knowledge
from hearth.models.reading.mentioned_nodes import Refs, fits
from hearth.models.reading.spoken_things import Clause, Spoken
from hearth.models.reading.usual_places import usual_way

_LAID_ON_SEATS = frozenset({"pillow", "textile"})
_WORN = frozenset({"CLOTHES"})
_FURNITURE = frozenset({"SURFACES", "CONTAINERS"})


def is_unused(clause: Clause, clauses: Sequence[Clause]) -> bool:
    """Return whether a clause only names things with which no other clause does anything."""
    used = {ref for other in clauses if other is not clause for act in other.acts for ref in act.objects}
    return bool(clause.named) and not clause.acts and used.isdisjoint(clause.spoken[0].refs)


def request_of(known: Knowledge, clause: Clause, before: Sequence[Spoken]) -> str:
    """Return the request that a bare name stands for, in plain words; "" where it stands for none.

    Args:
        known: the knowledge.
        clause: with the name and its things.
        before: the things spoken of before, the last first.
    """
    name, words = clause.spoken[0].refs[0].name, clause.named
    if known.is_room(name):
        return f"go to {words}"
    held = next((each for each in before if not each.is_place and _is_movable(known, each.refs)), None)
    is_furniture = not known.has(name, "GRABBABLE") and fits(known, name, _FURNITURE)
    is_seat = known.has(name, "SITTABLE") or known.has(name, "LIEABLE")
    if held and is_furniture and (not is_seat or _is_laid_on_seats(known, held.refs)):
        way = usual_way(known, held.refs[0], clause.spoken[0].refs[0])
        return f"put {'them' if len(held.refs) > 1 else 'it'} {'in' if way == 'PutIn' else 'on'} {words}"
    if is_seat:
        return f"{'sit' if known.has(name, 'SITTABLE') else 'lie'} on {words}"
    if known.has(name, "HAS_SWITCH") and not known.has(name, "GRABBABLE") and not known.has(name, "CONTAINERS"):
        return f"turn on {words}"
    if known.has(name, "CLOTHES"):
        return f"put on {words}"
    return f"grab {words}" if known.has(name, "GRABBABLE") else ""


def names_furniture(known: Knowledge, clause: Clause) -> bool:
    """Return whether a clause only names furniture, on or in which the thing before it may be put."""
    return bool(clause.named) and not known.has(clause.spoken[0].refs[0].name, "GRABBABLE")


def _is_movable(known: Knowledge, refs: Refs) -> bool:
    return all(known.has(ref.name, "GRABBABLE") for ref in refs)


def _is_laid_on_seats(known: Knowledge, refs: Refs) -> bool:
    return all(fits(known, ref.name, _LAID_ON_SEATS) and not fits(known, ref.name, _WORN) for ref in refs)
