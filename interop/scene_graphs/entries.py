"""The entries of a file as things of ours: class, place, size, states, references."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import log
from statistics import median
from typing import Any, NamedTuple

from hearth.homes.geometry import turned
from hearth.homes.object_shapes import Form
from hearth.interop.scene_graphs import vectors
from hearth.interop.scene_graphs.entities import Entity, values_of
from hearth.interop.scene_graphs.measures import level_axis, place_of, size_of, turn_of
from hearth.interop.scene_graphs.shape import Shape
from hearth.interop.scene_graphs.units_of_length import length_unit
from hearth.interop.scene_graphs.vectors import Vector
from hearth.kb.spelling import key_of

FULL_TURN = 6.3
"""Radians: a larger number is an angle in degrees."""

CLEAR = 0.3
"""Difference in the logarithm of heights by which one axis fits clearly better than another."""


@dataclass(frozen=True)
class Entry:
    """A thing or room of a file.

    Attributes:
        entity: as the file has it.
        class_name: of ours.
        place, size: in metres, y upwards; None where the file does not say.
        yaw: as a `Node` has it.
        states: of ours, in the file's order.
        is_flat: whether the file has no height for the place.
    """

    entity: Entity
    class_name: str
    place: Vector | None = None
    size: Vector | None = None
    yaw: float | None = None
    states: tuple[str, ...] = ()
    is_flat: bool = False


@dataclass(frozen=True)
class Units:
    """Units of a file, and why they are assumed.

    Attributes:
        up: the axis that points upwards.
        up_reason: why, in words.
        scale: metres of a unit.
        scale_reason: why, in words; "" for metres.
        scale_fault: why the scale is in doubt; "" where it is not.
        in_degrees: whether rotations that are numbers are in degrees.
        right_handed: whether the axes of a file with y upwards are those of glTF.
        quaternion: the order of the numbers of a rotation.
    """

    up: str
    up_reason: str
    scale: float
    scale_reason: str
    scale_fault: str
    in_degrees: bool
    right_handed: bool = False
    quaternion: str = "xyzw"


def units_of(entities: Sequence[Entity], forms: Sequence[Form | None], shape: Shape, unit_word: str = "") -> Units:
    """Return how the places of some entries are measured: as the shape says, else as the numbers suggest.

    Args:
        entities: things and rooms.
        forms: the form that the class of each has in the knowledge; None where it has none.
        shape: of the file.
        unit_word: the file's own word for its unit of length.
    """
    placed = [place for entity in entities if (place := place_of(entity, shape)) is not None]
    places = [place.point for place in placed if not place.is_flat]
    sizes = [(size_of(entity, shape), each) for entity, each in zip(entities, forms, strict=True)]
    pairs = [(given.extents, known.size) for given, known in sizes if given and known and min(given.extents) > 0]
    length = length_unit([place.point for place in placed], pairs, shape, unit_word)
    scaled = [_times(place, length.metres) for place in places]
    up, reason = shape.up, "the mapping says so"
    if up == "auto":
        up, reason = _up(_Seen(entities, forms, shape, length.metres), scaled)
    turns = [value for entity in entities for value in values_of(entity, shape.fields["rotation"])[:1]]
    numbers = [each for turn in turns for each in (turn if isinstance(turn, list) and len(turn) == 3 else [turn])]
    in_degrees = any(type(value) in (int, float) and abs(value) > FULL_TURN for value in numbers)
    of_habitat = any(key in HABITAT for entity in entities for key in entity.fields)
    order = "wxyz" if of_habitat and shape.quaternion == "xyzw" else shape.quaternion
    return Units(up, reason, *length, in_degrees, of_habitat and up == "y", order)


HABITAT = frozenset({"templatename", "nonuniformscale", "polyloop"})
"""Fields of scenes of Habitat: their axes are those of glTF, and their quaternions begin with w."""


class _Seen(NamedTuple):
    """Entries whose axes are in question, with their forms, the shape of their file, and metres of its unit."""

    entities: Sequence[Entity]
    forms: Sequence[Form | None]
    shape: Shape
    metres: float


def _up(seen: _Seen, places: Sequence[Vector]) -> tuple[str, str]:
    """Return the axis that points upwards, and why: by outlines, by names of fields, by sizes, by places."""
    level = level_axis(seen.entities, seen.shape)
    if level:
        return level, f"the outlines of rooms are level across {level}"
    keys = {key for entity in seen.entities for key in entity.fields}
    if any(key.startswith("axisaligned") for key in keys) or "objecttype" in keys:
        return "y", "AI2-THOR writes it so"
    if HABITAT & keys:
        return "y", "Habitat writes it so"
    if any(key.startswith("pose") or key == "worldpcenter" for key in keys):
        return "z", "poses of robots are written so"
    wrong = {axis: _unlike(seen, axis) for axis in ("y", "z")}
    if abs(wrong["y"] - wrong["z"]) > CLEAR:
        return min(wrong, key=wrong.__getitem__), "so the sizes fit those of the classes"
    off = {axis: _off_floor(seen, axis) for axis in ("y", "z")}
    if min(off.values()) < ON_FLOOR < OFF_FLOOR < max(off.values()):
        return min(off, key=off.__getitem__), "so furniture stands on the floor"
    if len(places) > 2:
        spans = [max(column) - min(column) for column in zip(*places, strict=True)]
        if spans[2] < spans[1] and spans[2] < 4.0:
            return "z", f"the places span {spans[2]:.1f} along z and {spans[1]:.1f} along y"
        return "y", f"the places span {spans[1]:.1f} along y and {spans[2]:.1f} along z"
    flat = any(place.is_flat for each in seen.entities if (place := place_of(each, seen.shape)) is not None)
    return ("z", "places of two numbers are those of a map") if flat else ("y", "nothing in the file says otherwise")


ON_FLOOR, OFF_FLOOR = 0.15, 0.3
"""Metres between furniture and the floor: less than the first stands on it, more than the second does not."""


def _unlike(seen: _Seen, up: str) -> float:
    """Return how far heights are from those of the classes if an axis points upwards."""
    at = "xyz".index(up)
    given = [(size_of(entity, seen.shape, up), form) for entity, form in zip(seen.entities, seen.forms, strict=True)]
    pairs = [(size.extents[at], form.size[1]) for size, form in given if size and form and min(size.extents) > 0]
    return sum(abs(log(height * seen.metres / known)) for height, known in pairs)


def _off_floor(seen: _Seen, up: str) -> float:
    """Return how far the middle one of the pieces of furniture is from the floor if an axis points upwards."""
    at, found = "xyz".index(up), []
    for entity, form in zip(seen.entities, seen.forms, strict=True):
        place = place_of(entity, seen.shape, up) if form is not None and form.mount == "floor" else None
        if place is None or form is None or place.is_flat:
            continue
        size = size_of(entity, seen.shape, up)
        height = size.extents[at] * seen.metres if size is not None and size.extents[at] > 0 else form.size[1]
        found.append(min(abs(place.point[at] * seen.metres - height / 2), abs(place.point[at] * seen.metres)))
    return median(found) if len(found) > 1 else ON_FLOOR


def entry_of(entity: Entity, class_name: str, shape: Shape, units: Units) -> Entry:
    """Return an entry with its place, size, rotation and states."""
    place, size = place_of(entity, shape, units.up), size_of(entity, shape, units.up)
    found = Entry(entity, class_name, states=tuple(dict.fromkeys(states_of(entity, shape))))
    yaw = turn_of(entity, shape, units.up, units.quaternion, units.in_degrees)
    if yaw is not None and units.right_handed:
        # The front of a model of glTF is +z, which is our south; its angles run against ours.
        yaw = round((180.0 - yaw) % 360.0, 2)
    if place is not None:
        point = _times(vectors.upright(place.point, units.up, units.right_handed), units.scale)
        found = replace(found, place=point, is_flat=place.is_flat)
    if size is not None:
        extents = _times(vectors.upright_size(size.extents, units.up), units.scale)
        found = replace(found, size=turned_size(extents, yaw, turns=size.turns))
    return replace(found, yaw=yaw)


def turned_size(size: Vector, yaw: float | None, *, turns: bool) -> Vector:
    """Return the extents along x, y and z of a thing that faces `yaw`, at the nearest right angle."""
    if yaw is None or not turns:
        return size
    width, depth = turned(size[0], size[2], 90.0 * (round(yaw / 90.0) % 4))
    return width, size[1], depth


def _times(values: Vector, scale: float) -> Vector:
    x, y, z = values
    return round(x * scale, 4), round(y * scale, 4), round(z * scale, 4)


def states_of(entity: Entity, shape: Shape) -> Iterator[str]:
    """Yield the states that an entry's flags and words mean."""
    for key, value in entity.fields.items():
        name = next((flag for flag in shape.flags if key == flag or key.endswith("states" + flag)), "")
        if name and isinstance(value, bool):
            yield shape.flags[name][0 if value else 1]
    yield from (state for state in map(_by_word(shape).get, map(key_of, _said(entity, shape))) if state)


def _by_word(shape: Shape) -> dict[str, str]:
    return {key_of(word): state for word, state in shape.states.items()}


def _said(entity: Entity, shape: Shape) -> Iterator[str]:
    """Yield the words that an entry has for its states."""
    for value in values_of(entity, shape.fields["state"]):
        for word in [value] if isinstance(value, str) else value if isinstance(value, list) else []:
            if isinstance(word, str):
                yield word


def unknown_states(entity: Entity, shape: Shape) -> list[str]:
    """Return the words for states of an entry that mean none of ours."""
    return [word for word in _said(entity, shape) if key_of(word) not in _by_word(shape)]


def wanted(entity: Entity, names: Sequence[str]) -> list[str]:
    """Return what an entry's fields of some names refer to: ids, names, phrases."""
    found: list[str] = []
    for value in values_of(entity, names):
        for each in value if isinstance(value, list) else [value]:
            found += [text for text in (_reference(each),) if text]
    return list(dict.fromkeys(found))


def _reference(value: Any) -> str:
    if isinstance(value, Mapping):
        value = next((value[key] for key in ("id", "uid", "name", "label") if key in value), None)
    return str(value).strip() if isinstance(value, str | int) and not isinstance(value, bool) else ""
