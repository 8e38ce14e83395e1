"""The usual place of a thing in a home, where it is put away."""

from __future__ import annotations

from hearth.kb.knowledge import Knowledge
from hearth.models.reading.mentioned_nodes import Refs, Scene
from hearth.schemas.program import ObjectRef

_ACTIONS = {"IN": "PutIn", "ON": "PutBack"}
_NEVER = frozenset(
    {
        "floor",
        "sink",
        "dishwasher",
        "washing_machine",
        "bed",
        "trashcan",
        "garbage_can",
        "bag",
        "basket",
        "box",
        "microwave",
        "oven",
        "stove",
        "toaster",
    }
)


_COOKED_ON = frozenset({"stove"})
"""Containers on which things are put, as a pot is on a stove that is one with its oven."""


def usual_place(scene: Scene, thing: ObjectRef) -> tuple[str, Refs]:
    """Return the act by which a thing is put away, and its place; no act where the home has no place for it.

    Things are put where it is most usual, and into furniture rather than on it.
    """
    places = [
        (-each.weight - 2 * (each.relation == "IN"), -each.weight, n, each)
        for n, each in enumerate(scene.known.placements(thing.name))
        if each.relation in _ACTIONS and each.destination not in _NEVER and _is_furniture(scene, each.destination)
    ]
    for _, _, _, each in sorted(places):
        refs = scene.some((each.destination,), 1)
        if refs and refs[0].name not in _NEVER:
            return _ACTIONS[each.relation], refs
    return "", ()


def usual_way(known: Knowledge, thing: ObjectRef, place: ObjectRef) -> str:
    """Return the act by which a thing is put in or on a place, as is usual for it there."""
    if place.name in _COOKED_ON:
        return "PutBack"
    is_in, is_on = (
        known.has(place.name, "CONTAINERS") or known.has(place.name, "RECIPIENT"),
        known.has(place.name, "SURFACES"),
    )
    if is_in and is_on:
        usual = [each for each in known.placements(thing.name) if each.destination == place.name]
        weights = {_ACTIONS[each.relation]: each.weight for each in usual if each.relation in _ACTIONS}
        return max(sorted(weights, reverse=True), key=lambda each: weights[each]) if weights else "PutBack"
    return "PutIn" if is_in else "PutBack"


def _is_furniture(scene: Scene, name: str) -> bool:
    return not scene.known.has(name, "GRABBABLE") and not scene.known.is_room(name) and scene.has(name)
