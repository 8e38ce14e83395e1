"""Rectangles that a floor with right angles is made of: a room of ours is one rectangle."""

from __future__ import annotations

from collections.abc import Sequence

from hearth.homes.geometry import Rect
from hearth.schemas.graph import Spot

STRAIGHT = 0.02
"""Metres that the ends of a side may differ across it."""

MOST_CORNERS = 60
"""Corners of a floor that are read."""


def rectangles(corners: Sequence[Spot]) -> list[Rect]:
    """Return the rectangles of a floor, the largest first; [] where its corners are not right angles.

    The largest rectangle within it is the first one, then the largest in the rest of it.
    """
    if len(corners) > MOST_CORNERS or any(not _is_straight(a, b) for a, b in _sides(corners)):
        return []
    xs, zs = (_apart(sorted(corner[axis] for corner in corners)) for axis in (0, 1))
    inside = {
        (i, j)
        for i in range(len(xs) - 1)
        for j in range(len(zs) - 1)
        if _holds(corners, ((xs[i] + xs[i + 1]) / 2, (zs[j] + zs[j + 1]) / 2))
    }
    found: list[Rect] = []
    while inside:
        cells, rect = _largest(inside, xs, zs)
        inside -= cells
        found.append(rect)
    return found


def _sides(corners: Sequence[Spot]) -> list[tuple[Spot, Spot]]:
    return list(zip(corners, (*corners[1:], corners[0]), strict=True))


def _is_straight(a: Spot, b: Spot) -> bool:
    return min(abs(a[0] - b[0]), abs(a[1] - b[1])) <= STRAIGHT


def _apart(values: Sequence[float]) -> list[float]:
    """Return ascending values without those next to another."""
    found = [values[0]]
    for value in values:
        if value - found[-1] > STRAIGHT:
            found.append(value)
    return found


def _holds(corners: Sequence[Spot], point: Spot) -> bool:
    """Return whether a floor holds a point: a line to the east crosses its sides an odd number of times."""
    x, z = point
    crossed = [a for a, b in _sides(corners) if (a[1] > z) != (b[1] > z) and (a[0] + b[0]) / 2 > x]
    return len(crossed) % 2 == 1


def _largest(
    inside: set[tuple[int, int]], xs: Sequence[float], zs: Sequence[float]
) -> tuple[set[tuple[int, int]], Rect]:
    """Return the cells and the outline of the largest rectangle of cells; of equal ones the one farthest south-west."""
    best: tuple[float, int, int, int, int] = (0.0, 0, 0, 0, 0)
    for i, j in sorted(inside):
        upper = len(zs) - 1
        last = i
        while (last, j) in inside:
            end = j
            while end < upper and (last, end) in inside:
                end += 1
            upper = end
            area = (xs[last + 1] - xs[i]) * (zs[upper] - zs[j])
            if area > best[0] + 1e-9:
                best = area, i, j, last + 1, upper
            last += 1
    _, i, j, last, upper = best
    cells = {(a, b) for a in range(i, last) for b in range(j, upper)}
    return cells, Rect(xs[i], zs[j], xs[last], zs[upper])
