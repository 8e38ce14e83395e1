"""Conditions of the places from which a program's author takes things: `take the milk out of the fridge`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from hearth.grounding.preconditions.conditions import Condition
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Key, Literal
from hearth.schemas.program import Program, Step

_OPENS = "Open"


def source_conditions(program: Program, sources: Sequence[tuple[int, str]], known: Knowledge) -> tuple[Condition, ...]:
    """Return what holds at the start where things are taken from the places that their author names.

    A thing that an earlier step handles is wherever that step left it. A place that no step before opens is open.

    Args:
        program: each object has an instance.
        sources: numbers of steps, each with the class of a place (see `kb.language.named_sources`).
        known: which places hold things, and which bear them.
    """
    return tuple(
        dict.fromkeys(each for number, place in sources for each in _conditions(program, number, place, known))
    )


def _conditions(program: Program, number: int, place: str, known: Knowledge) -> Iterator[Condition]:
    thing, before = program.steps[number].objects[0].key, program.steps[:number]
    moves = known.group("takes") | known.group("puts")
    handled = {key for step in before if step.action in moves for key in _keys(step)}
    if known.is_room(place) or thing in handled or known.same_class(place) == known.same_class(thing[0]):
        return
    there = _key(program, place, known)
    if known.has(place, "CONTAINERS"):
        yield Condition(Literal("inside", (thing, there)), number)
        if known.has(place, "CAN_OPEN") and not any(step.action == _OPENS and there in _keys(step) for step in before):
            yield Condition(Literal("open", (there,)), number)
    elif known.has(place, "SURFACES"):
        yield Condition(Literal("in", (thing, there)), number)


def _key(program: Program, place: str, known: Knowledge) -> Key:
    """Return the first object of the program that is such a place, or a place that the program does not name."""
    same = known.same_class(place)
    return next((ref.key for ref in program.objects() if ref.name in same), (place, 1))


def _keys(step: Step) -> tuple[Key, ...]:
    return tuple(ref.key for ref in step.objects)
