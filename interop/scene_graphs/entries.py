"""The entries of a file as things of ours: class, place, size, states, references."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import log
from typing import Any

from hearth.interop.scene_graphs import vectors
from hearth.interop.scene_graphs.entities import Entity, values_of
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
    """

    entity: Entity
    class_name: str
    place: Vector | None = None
    size: Vector | None = None
    yaw: float | None = None
    states: tuple[str, ...] = ()


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
    """

    up: str
    up_reason: str
    scale: float
    scale_reason: str
    scale_fault: str
    in_degrees: bool


def units_of(entities: Sequence[Entity], usual: Sequence[Vector | None], shape: Shape, unit_word: str = "") -> Units:
    """Return how the places of some entries are measured: as the shape says, else as the numbers suggest.

    Args:
        entities: things and rooms.
        usual: the size that each has in the knowledge, height second; None where it has none.
        shape: of the file.
        unit_word: the file's own word for its unit of length.
    """
    places = [place for entity in entities if (place := _place(entity, shape)) is not None]
    sizes = [(_size(entity, shape), size) for entity, size in zip(entities, usual, strict=True)]
    pairs = [(given, known) for given, known in sizes if given and known and min(given) > 0]
    length = length_unit(places, pairs, shape, unit_word)
    pairs = [(_times(given, length.metres), known) for given, known in pairs]
    places = [_times(place, length.metres) for place in places]
    up, reason = (shape.up, "the mapping says so") if shape.up != "auto" else _up(entities, places, pairs)
    turns = [value for entity in entities for value in values_of(entity, shape.fields["rotation"])[:1]]
    in_degrees = any(type(value) in (int, float) and abs(value) > FULL_TURN for value in turns)
    return Units(up, reason, *length, in_degrees)


def _up(
    entities: Sequence[Entity], places: Sequence[Vector], sizes: Sequence[tuple[Vector, Vector]]
) -> tuple[str, str]:
    """Return the axis that points upwards, and why: by names of fields, by known sizes, by the lowest span."""
    keys = {key for entity in entities for key in entity.fields}
    if any(key.startswith("axisaligned") for key in keys) or "objecttype" in keys:
        return "y", "AI2-THOR writes it so"
    if any(key.startswith("pose") or key == "worldpcenter" for key in keys):
        return "z", "poses of robots are written so"
    wrong = {axis: sum(abs(log(given[at] / known[1])) for given, known in sizes) for axis, at in (("y", 1), ("z", 2))}
    if abs(wrong["y"] - wrong["z"]) > CLEAR:
        return min(wrong, key=wrong.__getitem__), "so the sizes fit those of the classes"
    if len(places) > 2:
        spans = [max(column) - min(column) for column in zip(*places, strict=True)]
        if spans[2] < spans[1] and spans[2] < 4.0:
            return "z", f"the places span {spans[2]:.1f} along z and {spans[1]:.1f} along y"
        return "y", f"the places span {spans[1]:.1f} along y and {spans[2]:.1f} along z"
    return "y", "nothing in the file says otherwise"


def entry_of(entity: Entity, class_name: str, shape: Shape, units: Units) -> Entry:
    """Return an entry with its place, size, rotation and states."""
    place, size = _place(entity, shape), _size(entity, shape)
    found = Entry(entity, class_name, states=tuple(dict.fromkeys(states_of(entity, shape))))
    turn = next(iter(values_of(entity, shape.fields["rotation"])), None)
    if place is not None:
        place = _times(vectors.upright(place, units.up), units.scale)
    if size is not None:
        size = _times(vectors.upright_size(size, units.up), units.scale)
    yaw = None if turn is None else vectors.turn(turn, units.up, shape.quaternion, units.in_degrees)
    return replace(found, place=place, size=size, yaw=yaw)


def _times(values: Vector, scale: float) -> Vector:
    x, y, z = values
    return round(x * scale, 4), round(y * scale, 4), round(z * scale, 4)


def _box(entity: Entity, shape: Shape) -> tuple[Vector, Vector] | None:
    """Return centre and size from corners, or from the lowest and the highest corner."""
    for value in values_of(entity, shape.fields["corners"]):
        corners = vectors.points(value)
        if len(corners) > 2:
            return vectors.around(corners)
    low, high = (
        next((point for value in values_of(entity, shape.fields[end]) if (point := vectors.vector(value))), None)
        for end in ("low", "high")
    )
    return vectors.around((low, high)) if low and high else None


def _place(entity: Entity, shape: Shape) -> Vector | None:
    box = _box(entity, shape)
    if box is not None:
        return box[0]
    # The centre of a box says more than the place of a model, whose origin may be at its foot.
    names = sorted(shape.fields["position"], key=lambda name: "center" not in name)
    found = (vectors.vector(value) for value in values_of(entity, names))
    return next((place for place in found if place is not None), None)


def _size(entity: Entity, shape: Shape) -> Vector | None:
    box = _box(entity, shape)
    if box is not None:
        return box[1]
    found = (vectors.vector(value) for value in values_of(entity, shape.fields["size"]))
    return next((size for size in found if size is not None and min(size) >= 0), None)


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
