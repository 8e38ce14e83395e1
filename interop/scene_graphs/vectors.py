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
    if len(values) != 3 or any(type(each) not in (int, float) or not isfinite(each) for each in values):
        return None
    x, y, z = map(float, values)
    return x, y, z


def pair(value: Any) -> tuple[float, float] | None:
    """Return two numbers from a list or from a mapping with x and y and no z; None where there are none."""
    if isinstance(value, Mapping):
        low = {str(key).lower(): each for key, each in value.items()}
        value = None if low.get("z") is not None else [low.get("x"), low.get("y")]
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != 2:
        return None
    found = _numbers([*value, 0])
    return None if found is None else found[:2]


def on_floor(point: tuple[float, float], up: str) -> Vector:
    """Return a point of a floor plan as a place at the height of the floor."""
    first, second = point
    return (first, 0.0, second) if up == "y" else (first, second, 0.0)


def translation(value: Any) -> Vector | None:
    """Return the place of a pose: the last column of a matrix of four rows, or the first three of 6 or 7 numbers."""
    if not isinstance(value, Sequence) or isinstance(value, str):
        return None
    if len(value) == 4 and all(isinstance(row, Sequence) and len(row) == 4 for row in value):
        return _numbers([row[3] for row in value[:3]])
    return _numbers(value[:3]) if len(value) in (6, 7) else None


def axes(value: Any) -> list[Vector] | None:
    """Return three axes from nine numbers; None where there are none."""
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != 9:
        return None
    found = [_numbers(value[start : start + 3]) for start in (0, 3, 6)]
    return [each for each in found if each is not None] if None not in found else None


def along_axes(extents: Vector, directions: Sequence[Vector]) -> Vector:
    """Return the extents along x, y and z of a box whose sides run along some directions."""
    x, y, z = (
        sum(extent * abs(direction[at]) for extent, direction in zip(extents, directions, strict=True))
        for at in range(3)
    )
    return x, y, z


def points(value: Any) -> list[Vector]:
    """Return the points of a list of them, or of `{points: [...]}`; [] where it is none."""
    found = [vector(each) for each in _listed(value)]
    return [each for each in found if each is not None] if None not in found else []


def pairs(value: Any) -> list[tuple[float, float]]:
    """Return the points of an outline on a floor plan; [] where it is none."""
    found = [pair(each) for each in _listed(value)]
    return [each for each in found if each is not None] if None not in found else []


def _listed(value: Any) -> Sequence[Any]:
    if isinstance(value, Mapping):
        value = next((value[key] for key in ("points", "vertices", "corners") if key in value), None)
    return value if isinstance(value, Sequence) and not isinstance(value, str) else []


def around(corners: Iterable[Vector]) -> tuple[Vector, Vector]:
    """Return centre and size of the box around some points."""
    columns = list(zip(*corners, strict=True))
    lows, highs = [min(column) for column in columns], [max(column) for column in columns]
    x, y, z = ((low + high) / 2 for low, high in zip(lows, highs, strict=True))
    w, h, d = (high - low for low, high in zip(lows, highs, strict=True))
    return (x, y, z), (w, h, d)


def upright(place: Vector, up: str, right_handed: bool = False) -> Vector:
    """Return a place with y upwards. A place with z upwards has x forwards and y to the left, as robots have it.

    Args:
        place: along the axes of the file.
        up: the axis that points upwards in the file.
        right_handed: whether axes with y upwards are those of glTF, where z points away from north.
    """
    x, y, z = place
    if up == "y":
        return (x, y, -z) if right_handed else place
    return -y, z, x


def upright_size(size: Vector, up: str) -> Vector:
    """Return the size of a box with y upwards."""
    w, d, h = size
    return size if up == "y" else (d, h, w)


def turn(value: Any, up: str, order: str, in_degrees: bool) -> float | None:
    """Return a rotation as our yaw, degrees about y from +z, clockwise as seen from above; None where it is none.

    Args:
        value: a number, Euler angles in degrees with x, y and z, a list of three angles, a quaternion, or a pose of
            six or seven numbers that ends in one of the last two.
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
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) in (6, 7):
        value = value[3:]
    if isinstance(value, Sequence) and not isinstance(value, str) and len(value) == 3:
        about = value[1 if up == "y" else 2]
        return _angle(about, up, order, in_degrees) if type(about) in (int, float) else None
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
