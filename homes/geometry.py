"""Rectangles, directions and boxes of a floor plan.

Metres; x grows eastwards, y upwards, z northwards. Yaw is in degrees about y from +z (north) towards +x (east).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from hearth.schemas.graph import Box

DIRECTIONS: dict[str, float] = {"north": 0.0, "east": 90.0, "south": 180.0, "west": 270.0}
_FACING = {degrees: name for name, degrees in DIRECTIONS.items()}
OPPOSITE_WALL = {"north": "south", "south": "north", "east": "west", "west": "east"}
EPSILON = 1e-6


class Rect(NamedTuple):
    """A rectangle on the floor: west, south, east and north bounds."""

    x0: float
    z0: float
    x1: float
    z1: float

    @classmethod
    def around(cls, x: float, z: float, width: float, depth: float) -> Rect:
        """Return the rectangle of that extent with its middle at a point."""
        return cls(x - width / 2, z - depth / 2, x + width / 2, z + depth / 2)

    @classmethod
    def over(cls, rects: Iterable[Rect]) -> Rect:
        """Return the smallest rectangle over some others."""
        x0, z0, x1, z1 = zip(*rects, strict=True)
        return cls(min(x0), min(z0), max(x1), max(z1))

    @property
    def width(self) -> float:
        """Extent from west to east."""
        return self.x1 - self.x0

    @property
    def depth(self) -> float:
        """Extent from south to north."""
        return self.z1 - self.z0

    @property
    def center(self) -> tuple[float, float]:
        """The middle, as (x, z)."""
        return (self.x0 + self.x1) / 2, (self.z0 + self.z1) / 2

    def reach(self, direction: str) -> float:
        """Return how far it reaches in a direction: its bound there, counted that way."""
        west, south, east, north = self
        return {"west": -west, "south": -south, "east": east, "north": north}[direction]

    def inset(self, margin: float) -> Rect:
        """Smaller by `margin` on every side (larger when negative)."""
        return Rect(self.x0 + margin, self.z0 + margin, self.x1 - margin, self.z1 - margin)

    def overlap(self, other: Rect) -> float:
        """Return the area both cover, in square metres."""
        width = min(self.x1, other.x1) - max(self.x0, other.x0)
        depth = min(self.z1, other.z1) - max(self.z0, other.z0)
        return max(0.0, width) * max(0.0, depth)

    def contains(self, other: Rect, slack: float = 0.005) -> bool:
        """Return whether the other lies within, give or take `slack`."""
        west_south = other.x0 >= self.x0 - slack and other.z0 >= self.z0 - slack
        return west_south and other.x1 <= self.x1 + slack and other.z1 <= self.z1 + slack

    def holds(self, x: float, z: float) -> bool:
        """Return whether a point lies within."""
        return self.x0 <= x <= self.x1 and self.z0 <= z <= self.z1


def along_x(wall: str) -> bool:
    """Return whether a wall runs from west to east."""
    return wall in ("north", "south")


def facing_from(wall: str) -> float:
    """Return the yaw of a thing with its back to that wall."""
    return DIRECTIONS[OPPOSITE_WALL[wall]]


def wall_of(yaw: float) -> str:
    """Return the wall that a thing of this yaw turns its back to."""
    return OPPOSITE_WALL[front_of(yaw)]


def front_of(yaw: float) -> str:
    """Return the direction a thing of this yaw faces, or faces most."""
    return _FACING[90.0 * (round(yaw / 90.0) % 4)]


def footprint(box: Box) -> Rect:
    """Return the floor a box stands over."""
    (x, _, z), (w, _, d) = box
    return Rect.around(x, z, w, d)


def bottom(box: Box) -> float:
    """Return the height of a box's underside."""
    return box.center[1] - box.size[1] / 2


def top(box: Box) -> float:
    """Return the height of a box's upper side."""
    return box.center[1] + box.size[1] / 2


def box_over(rect: Rect, y0: float, y1: float) -> Box:
    """Return the box over a rectangle between two heights, to a tenth of a millimetre."""
    x, z = rect.center
    return Box(_rounded((x, (y0 + y1) / 2, z)), _rounded((rect.width, y1 - y0, rect.depth)))


def _rounded(values: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z = values
    return round(x, 4) + 0.0, round(y, 4) + 0.0, round(z, 4) + 0.0


def intrusion(a: Box, b: Box) -> float:
    """Return how deep two boxes stand in each other, in metres; 0 or less when they do not."""
    return min((sa + sb) / 2 - abs(ca - cb) for ca, cb, sa, sb in zip(a.center, b.center, a.size, b.size, strict=True))


def turned(width: float, depth: float, yaw: float) -> tuple[float, float]:
    """Return a thing's extents along x and z when it faces `yaw` (a multiple of 90 degrees)."""
    return (width, depth) if yaw % 180 == 0 else (depth, width)
