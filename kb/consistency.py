"""Contradictions in the knowledge: facts that are each well formed and cannot all be true."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.knowledge_records import ObjectClass, Placement

TOO_LARGE_TO_CARRY = 2.1
"""Metres: the longest edge of a thing that can be grabbed (a ladder is 2)."""

TOO_BULKY_TO_CARRY = 0.45
"""Cubic metres: the largest volume of a thing that can be grabbed."""

SOFT = frozenset(
    {"garment", "textile", "paper_goods", "waste", "animal", "bag_kind", "food", "cleaning_tool", "window_cover"}
)
"""Kinds that fold, pour or come in parts, so that their size does not say what they fit in."""

UNPLACED = frozenset({"place", "structure", "body_part", "person"})
"""Kinds that are where they are, and need no placement."""


class Finding(NamedTuple):
    """One contradiction.

    Attributes:
        check: which of `CHECKS` found it.
        subject: the class, action or synonym it is about.
        message: what contradicts what.
    """

    check: str
    subject: str
    message: str


def lint(knowledge: Knowledge) -> tuple[Finding, ...]:
    """Every contradiction, in the order of the checks."""
    return tuple(
        Finding(name, subject, message) for name, check in CHECKS.items() for subject, message in check(knowledge)
    )


def _incomplete(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for thing in knowledge.objects.values():
        lacking = [
            name
            for name, there in (("gloss", thing.gloss), ("size", any(thing.size)), ("category", thing.category))
            if not there
        ]
        if lacking:
            yield thing.name, f"has no {' and no '.join(lacking)}"
        for room in thing.rooms:
            if room not in knowledge.rooms:
                yield thing.name, f"is listed in `{room}`, which is not a room"


def _states(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for thing in knowledge.objects.values():
        for state in thing.states:
            group = knowledge.state_groups[knowledge.group_of(state)]
            if group.needs and group.needs.isdisjoint(thing.properties):
                yield thing.name, f"may be {state} but has not {' or '.join(sorted(group.needs))}"


def _carried(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for thing in knowledge.objects.values():
        width, height, depth = thing.size
        too_large = max(thing.size) > TOO_LARGE_TO_CARRY or width * height * depth > TOO_BULKY_TO_CARRY
        if "GRABBABLE" in thing.properties and too_large:
            yield thing.name, f"is GRABBABLE but measures {width:g} x {height:g} x {depth:g} m"


def _fits(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for thing, place, placement in _placements(knowledge):
        if placement.relation != "IN" or place.category == "Rooms":
            continue
        if SOFT.isdisjoint(knowledge.ancestors(thing.name)) and not _goes_in(thing.size, place.size):
            yield thing.name, f"is placed in {place.name}, which is too small for it"


def _goes_in(inner: tuple[float, float, float], outer: tuple[float, float, float]) -> bool:
    """Return whether a box fits in another some way round, leaning or looking out by as much as the box is long."""
    small, large = sorted(inner), sorted(outer)
    return small[0] <= large[0] * 1.1 and small[1] <= large[1] * 1.1 and small[2] <= large[2] * 2


def _carries(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    put, put_in = knowledge.actions["PutBack"].grammar[1], knowledge.actions["PutIn"].grammar[1]
    for thing, place, placement in _placements(knowledge):
        if placement.relation == "NEARBY" or "GRABBABLE" not in thing.properties:
            continue
        if {"structure", "rack"} & set(knowledge.ancestors(place.name)):
            continue  # things hang on walls and racks
        need = put if placement.relation == "ON" else put_in
        if not need.accepts(place.properties, place.name):
            yield thing.name, f"is placed {placement.relation} {place.name}, which the grammar lets nobody do"


def _somewhere(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for thing in knowledge.objects.values():
        placeless = not knowledge.placements(thing.name)
        if placeless and UNPLACED.isdisjoint((thing.name, *knowledge.ancestors(thing.name))):
            yield thing.name, "has no place: nothing says what it is on, in or near"


def _rooms(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for thing, place, placement in _placements(knowledge):
        if placement.room and place.rooms and placement.room not in place.rooms:
            yield thing.name, f"is placed {placement.relation} {place.name} in {placement.room}, where none is found"


def _synonyms(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for thing in knowledge.objects.values():
        for name in thing.synonyms:
            meant = knowledge.object_class(name)
            if meant is None or (meant.same_as or meant.name) != (thing.same_as or thing.name):
                yield name, f"is a synonym of {thing.name} but means {meant.name if meant else 'nothing'}"
        for name in knowledge.stand_ins(thing.name):
            other = knowledge.object_class(name)
            if other is not None and (other.same_as or other.name) == (thing.same_as or thing.name):
                yield thing.name, f"is its own stand-in by the name {name}"


def _words(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    phrases: dict[tuple[str, int], str] = {}
    for action in knowledge.actions.values():
        for words in action.words:
            other = phrases.setdefault((words, action.arity), action.name)
            if other != action.name:
                yield action.name, f"has the phrase `{words}`, as {other} has"


def _named(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for action in knowledge.actions.values():
        for need in (*action.needs, *action.grammar):
            for name in sorted((need.classes | need.also | need.never) - knowledge.objects.keys()):
                yield action.name, f"names `{name}`, which is not a known class"


def _usable(knowledge: Knowledge) -> Iterator[tuple[str, str]]:
    for action in knowledge.actions.values():
        for position, need in enumerate(action.grammar):
            if not any(need.accepts(thing.properties, name) for name, thing in knowledge.objects.items()):
                yield action.name, f"accepts no object as its {action.roles[position]}"


def _placements(knowledge: Knowledge) -> Iterator[tuple[ObjectClass, ObjectClass, Placement]]:
    for name, thing in knowledge.objects.items():
        if not thing.same_as:
            for placement in knowledge.placements(name):
                yield thing, knowledge.objects[placement.destination], placement


CHECKS: dict[str, Callable[[Knowledge], Iterator[tuple[str, str]]]] = {
    "incomplete": _incomplete,
    "state": _states,
    "carried": _carried,
    "size": _fits,
    "carries": _carries,
    "placeless": _somewhere,
    "room": _rooms,
    "synonym": _synonyms,
    "words": _words,
    "class": _named,
    "usable": _usable,
}
"""The checks, by name."""
