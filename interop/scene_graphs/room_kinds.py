"""Classes of rooms that a file only numbers, such as `R0`: inferred from the things in them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from hearth.interop.scene_graphs.class_names import ClassOf, class_of, is_number_only
from hearth.interop.scene_graphs.completion import room_for
from hearth.interop.scene_graphs.entities import Entity
from hearth.interop.scene_graphs.links import Ties, holders
from hearth.interop.scene_graphs.measures import extent_of, place_of
from hearth.interop.scene_graphs.shape import Shape
from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of

ROOM_GROUPS = frozenset({"rooms", "regions", "regionannotations", "areas", "zones"})
"""Names of lists of rooms."""

ROOM_KINDS = frozenset({"room", "roomnodeattributes", "region", "area", "zone"})
"""Words for the kind of an entry that is a room."""

FLOORS = frozenset({"floor", "floors"})
"""Words for the floor of a room."""

_BUILDING = re.compile(r"B\(?\d+\)?")
"""A building of Hydra: `B0`, `B(0)`."""

_ROOM = re.compile(r"(?:R|room|region)[\s_.-]?\(?\d+\)?", re.IGNORECASE)
"""A room that is only numbered: `R0`, `room_2`."""


def classes_of(entities: Sequence[Entity], ties: Ties, shape: Shape, knowledge: Knowledge) -> dict[int, ClassOf]:
    """Return the class of each entry, by its `id()`: of its label; of a room that is only numbered, by its things.

    Of several floors in a file without rooms, each is that of a room.
    """
    found = {id(entity): class_of(entity.label, shape, knowledge) for entity in entities}
    rooms = []
    for entity in entities:
        if not found[id(entity)].by and _BUILDING.fullmatch(entity.label):
            found[id(entity)] = ClassOf("", "building")
        elif not found[id(entity)].by and _is_numbered_room(entity):
            rooms.append(entity)
    if not rooms and not any(knowledge.is_room(each.name) for each in found.values()):
        floors = [each for each in entities if key_of(each.label) in FLOORS and extent_of(each, shape) is not None]
        rooms = floors if len(floors) > 1 else []
    things = _things_in(rooms, entities, ties, found, shape) if rooms else {}
    for room in rooms:
        names = [name for name in things[id(room)] if not knowledge.is_room(name)]
        if names or key_of(room.label) in FLOORS:
            found[id(room)] = ClassOf(room_for(names, knowledge), "things in it")
    return found


def _is_numbered_room(entity: Entity) -> bool:
    """Return whether an entry is a room whose label says nothing but that."""
    kind = key_of(entity.label) in ROOM_KINDS
    said = {key_of(value) for value in entity.fields.values() if isinstance(value, str)}
    is_room = entity.group in ROOM_GROUPS or kind or bool(ROOM_KINDS & said)
    return kind or _ROOM.fullmatch(entity.label) is not None or (is_room and is_number_only(entity.label))


def _things_in(
    rooms: Sequence[Entity], entities: Sequence[Entity], ties: Ties, classes: Mapping[int, ClassOf], shape: Shape
) -> dict[int, list[str]]:
    """Return the classes of the things in each room, by its `id()`: through their holders, else by their places."""
    found: dict[int, list[str]] = {id(room): [] for room in rooms}
    above = holders(ties.ties, lambda entity: id(entity) in found)
    boxes = [(room, box) for room in rooms if (box := extent_of(room, shape)) is not None]
    for entity in entities:
        name = classes[id(entity)].name
        held = [id(holder) for _, holder in above.get(id(entity), [])] if name else []
        place = place_of(entity, shape) if name and not held else None
        for room, (center, size) in boxes if place is not None else ():
            # Things of a room lie over its outline: the axis along which that is flat does not count.
            sides = sorted(zip(size, place.point, center, strict=True)) if place is not None else []
            if all(abs(at - middle) <= extent / 2 for extent, at, middle in sides[1:]):
                held.append(id(room))
        for room_id in held[:1]:
            found[room_id].append(name)
    return found
