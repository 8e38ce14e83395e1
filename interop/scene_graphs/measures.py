"""Places, sizes and rotations of an entry, found in the fields of its file, along the axes of the file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from hearth.interop.scene_graphs import vectors
from hearth.interop.scene_graphs.entities import Entity, values_of
from hearth.interop.scene_graphs.shape import Shape
from hearth.interop.scene_graphs.vectors import Vector
from hearth.kb.spelling import key_of

WORLD_ALIGNED = ("axisaligned", "aabb", "boundingbox", "bbox")
"""Beginnings of the names of boxes along the axes of the world; other sizes turn with the thing."""

_COORDINATES = ("{}", "c{}", "center{}", "centre{}", "pos{}", "position{}", "{}center", "{}pos")
"""Names of one coordinate that stands among the other fields of an entry; `{}` is its axis."""

_EXTENTS = {
    "width": ("width", "w", "sizex", "sx", "dx"),
    "depth": ("depth", "d", "length", "l", "sizey", "sy", "dy"),
    "height": ("height", "h", "sizez", "sz", "dz"),
}
"""Words for the extents of a thing, and names of numbers among the other fields of an entry."""


class Place(NamedTuple):
    """A point along the axes of a file; `is_flat` where the file has no height for it."""

    point: Vector
    is_flat: bool = False


class Size(NamedTuple):
    """Extents along the axes of a file; `turns` where they turn with the thing."""

    extents: Vector
    turns: bool = False


def place_of(entity: Entity, shape: Shape, up: str = "z") -> Place | None:
    """Return the middle of an entry, or its place; None where the file has none."""
    box = box_of(entity, shape, up)
    if box is not None:
        return Place(box[0], is_flat=box[1][1 if up == "y" else 2] == 0 and _has_flat_corners(entity, shape))
    # The center of a box says more than the place of a model, whose origin may be at its foot.
    names = sorted(shape.fields["position"], key=lambda name: "center" not in name)
    for value in (*values_of(entity, names), *_loose(entity)):
        point = vectors.vector(value) or vectors.translation(value)
        if point is not None:
            return Place(point)
        if (pair := vectors.pair(value)) is not None:
            return Place(vectors.on_floor(pair, up), is_flat=True)
    return None


def _loose(entity: Entity) -> Iterator[list[Any]]:
    """Yield coordinates that stand among the other fields of an entry: `x`, `y`, `z`, or `cx`, `cy`, `cz`."""
    for form in _COORDINATES:
        found = [entity.fields.get(form.format(axis)) for axis in "xyz"]
        if found[0] is not None and found[1] is not None:
            yield found if found[2] is not None else found[:2]


def size_of(entity: Entity, shape: Shape, up: str = "z") -> Size | None:
    """Return the size of an entry; None where the file has none."""
    box = box_of(entity, shape, up)
    if box is not None:
        return Size(box[1])
    axes = next((found for value in values_of(entity, ["normalizedaxes"]) if (found := vectors.axes(value))), None)
    for name in shape.fields["size"]:
        for value in values_of(entity, [name]):
            extents = vectors.vector(value) or _by_words(value, up)
            if extents is not None and min(extents) >= 0:
                turns = _turns(entity, name)
                return Size(extents, turns) if axes is None else Size(vectors.along_axes(extents, axes))
    extents = _by_words(entity.fields, up)
    return None if extents is None or min(extents) < 0 else Size(extents, turns=True)


def _turns(entity: Entity, name: str) -> bool:
    """Return whether the size of a name is along the thing's own axes; that of a box is, if the box has a rotation."""
    keys = [key for key in entity.fields if key.endswith(name)]
    return any("worldrcenter" in key for key in entity.fields) or not any(key.startswith(WORLD_ALIGNED) for key in keys)


def _by_words(value: Any, up: str) -> Vector | None:
    """Return extents that words name: `{width, depth, height}`, or `{length, width, height}` with the length first."""
    if not isinstance(value, Mapping):
        return None
    low = {key_of(str(key)): each for key, each in value.items()}
    found = {
        side: next((low[name] for name in names if type(low.get(name)) in (int, float)), None)
        for side, names in _EXTENTS.items()
    }
    width, depth, height = found["width"], found["depth"], found["height"]
    if width is None or depth is None:
        return None
    height = 0.0 if height is None else height  # an outline
    if "length" in low and "depth" not in low:
        width, depth = depth, width
    return vectors.vector([width, height, depth] if up == "y" else [width, depth, height])


def box_of(entity: Entity, shape: Shape, up: str = "z") -> tuple[Vector, Vector] | None:
    """Return center and size from corners, or from the lowest and the highest corner."""
    for corners in _corners(entity, shape, up):
        if len(corners) > 2:
            return vectors.around(corners)
    low, high = (
        next((point for value in _ends(entity, shape, end) if (point := vectors.vector(value))), None)
        for end in ("low", "high")
    )
    return vectors.around((low, high)) if low and high else None


def extent_of(entity: Entity, shape: Shape) -> tuple[Vector, Vector] | None:
    """Return center and size of an entry's box, however the file says them; None where it does not."""
    place, size = place_of(entity, shape), size_of(entity, shape)
    return (place.point, size.extents) if place is not None and size is not None else None


def _ends(entity: Entity, shape: Shape, end: str) -> Iterator[Any]:
    """Yield the lowest or the highest corner: a point, or `x_min`, `y_min`, `z_min` among the other fields."""
    yield from values_of(entity, shape.fields[end])
    word = {"low": "min", "high": "max"}[end]
    for form in ("{}" + word, word + "{}"):
        yield [entity.fields.get(form.format(axis)) for axis in "xyz"]


def outline_of(entity: Entity, shape: Shape, up: str = "z") -> list[Vector]:
    """Return the corners of an entry's outline; [] where the file has none."""
    return next((corners for corners in _corners(entity, shape, up) if len(corners) > 2), [])


def _corners(entity: Entity, shape: Shape, up: str) -> Iterator[list[Vector]]:
    for value in values_of(entity, shape.fields["corners"]):
        points = vectors.points(value)
        yield points or [vectors.on_floor(pair, up) for pair in vectors.pairs(value)]


def _has_flat_corners(entity: Entity, shape: Shape) -> bool:
    return any(vectors.pairs(value) for value in values_of(entity, shape.fields["corners"]))


def level_axis(entities: Sequence[Entity], shape: Shape) -> str:
    """Return the axis across which all outlines with three coordinates are level: `y` or `z`; "" where none is."""
    outlines = [vectors.points(value) for entity in entities for value in values_of(entity, shape.fields["corners"])]
    spans = [vectors.around(corners)[1] for corners in outlines if len(corners) > 2]
    level = [axis for axis, at in (("y", 1), ("z", 2)) if spans and all(span[at] == 0 for span in spans)]
    return level[0] if len(level) == 1 else ""


def turn_of(entity: Entity, shape: Shape, up: str, order: str, in_degrees: bool) -> float | None:
    """Return the first rotation of an entry that is one, as our yaw before mirroring; None without one."""
    for value in values_of(entity, shape.fields["rotation"]):
        found = vectors.turn(value, up, order, in_degrees)
        if found is not None:
            return found
    return None
