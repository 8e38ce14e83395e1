"""Places and sizes of an entry that can't be: numbers that are none, and negative sizes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from typing import Any

from hearth.interop.scene_graphs.entities import Entity, values_of
from hearth.interop.scene_graphs.shape import Shape
from hearth.interop.scene_graphs.vectors import vector

FIELDS = ("position", "size", "low", "high", "rotation")


def geometry_faults(entity: Entity, shape: Shape) -> Iterator[tuple[str, str]]:
    """Yield what is wrong with an entry's places, sizes and rotations, each with its remedy; null is none."""
    for field in FIELDS:
        for value in values_of(entity, shape.fields[field])[:1]:
            numbers = _components(value)
            if bad := [each for each in numbers if not _is_number(each)]:
                yield (
                    f"its {field} has `{str(bad[0])[:40]}`, which is no number",
                    "write finite numbers, or leave it out",
                )
            elif field == "size" and (given := vector(value)) is not None and min(given) < 0:
                yield f"its size is negative: {min(given):g}", "write sizes from 0 upwards, or leave it out"


def _components(value: Any) -> list[Any]:
    """Return the numbers of a place or rotation as they are written; [] where it is none, or all of it is null."""
    if isinstance(value, Mapping):
        low = {str(key).lower(): each for key, each in value.items()}
        found = [low[axis] for axis in "xyzw" if axis in low] if {"x", "y"} <= low.keys() else []
    elif isinstance(value, Sequence) and not isinstance(value, str) and len(value) in (3, 4):
        found = list(value)
    else:
        found = [value] if isinstance(value, float) else []
    nested = any(isinstance(each, list | dict) for each in found)
    return [] if nested or all(each is None for each in found) else found


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and isfinite(value)
