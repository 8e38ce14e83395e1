"""Places, sizes and rotations as other projects write them, turned into ours: metres, y upwards, x to the right."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import atan2, degrees, isfinite
from typing import Any

Vector = tuple[float, float, float]


def vector(value: Any) -> Vector | None:
    """Return three numbers from a list or from a mapping with x, y and z; None where there are none."""
    if isinstance(value, Mapping):
        value = [value.get(axis, value.get(axis.upper())) for axis in "xyz"]
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != 3:
        return None
    return _numbers(value)


def _numbers(values: Sequence[Any]) -> Vector | None:
    if any(type(each) not in (int, float) or not isfinite(each) for each in values):
        return None
    x, y, z = map(float, values)
    return x, y, z


def points(value: Any) -> list[Vector]:
    """Return the points of a list of them; [] where it is none."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return []
    found = [vector(each) for each in value]
    return [each for each in found if each is not None] if None not in found else []


def around(corners: Iterable[Vector]) -> tuple[Vector, Vector]:
    """Return centre and size of the box around some points."""
    columns = list(zip(*corners, strict=True))
    lows, highs = [min(column) for column in columns], [max(column) for column in columns]
    x, y, z = ((low + high) / 2 for low, high in zip(lows, highs, strict=True))
    w, h, d = (high - low for low, high in zip(lows, highs, strict=True))
    return (x, y, z), (w, h, d)


def upright(place: Vector, up: str) -> Vector:
    """Return a place with y upwards. A place with z upwards has x forwards and y to the left, as robots have it."""
    x, y, z = place
    return place if up == "y" else (-y, z, x)


def upright_size(size: Vector, up: str) -> Vector:
    """Return the size of a box with y upwards."""
    w, d, h = size
    return size if up == "y" else (d, h, w)


def turn(value: Any, up: str, order: str, in_degrees: bool) -> float | None:
    """Return a rotation as our yaw, degrees about y from +z, clockwise as seen from above; None where it is none.

    Args:
        value: a number, Euler angles in degrees with x, y and z, or a quaternion.
        up: the axis that points upwards in the file.
        order: of a quaternion in a list: `xyzw` or `wxyz`.
        in_degrees: whether a number is in degrees; else in radians.
    """
    angle = _angle(value, up, order, in_degrees)
    if angle is None or not isfinite(angle):
        return None
    return round((angle if up == "y" else -angle) % 360.0, 2)


def _angle(value: Any, up: str, order: str, in_degrees: bool) -> float | None:
    if type(value) in (int, float):
        return float(value) if in_degrees else degrees(value)
    if isinstance(value, Mapping) and "w" in {str(key).lower() for key in value}:
        low = {str(key).lower(): each for key, each in value.items()}
        return _of_quaternion([low.get(axis) for axis in "xyzw"], up)
    if isinstance(value, Mapping):
        about = value.get(up, value.get(up.upper()))
        return float(about) if type(about) in (int, float) else None
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) == 4:
        four = list(value) if order == "xyzw" else [*value[1:], value[0]]
        return _of_quaternion(four, up)
    return None


def _of_quaternion(four: Sequence[Any], up: str) -> float | None:
    if any(type(each) not in (int, float) for each in four):
        return None
    x, y, z, w = map(float, four)
    if up == "y":
        return degrees(atan2(2 * (w * y + x * z), w * w + z * z - x * x - y * y))
    return degrees(atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z))
