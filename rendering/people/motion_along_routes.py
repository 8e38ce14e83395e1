"""Routes over a floor: polylines with rounded corners, walked with a soft start and stop."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import atan2, cos, degrees, hypot, pi
from typing import NamedTuple

from hearth.schemas.graph import Spot

STARTING = 0.35
"""Seconds in which walking speed is reached, and lost."""

ROUNDED = 0.16
"""Metres on either side over which the corners of a route are rounded."""

AROUND = 0.32
"""Metres before and after a point of a route between which its direction is measured."""


class Place(NamedTuple):
    """A position and direction on the floor."""

    x: float
    z: float
    yaw: float


def angle(start: float, end: float) -> float:
    """Return the smaller angle from one direction to another, degrees."""
    return (end - start + 180) % 360 - 180


def between(a: Spot, b: Spot, share: float) -> Spot:
    """Return a point of a line."""
    return a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share


def eased(share: float) -> float:
    """0 to 1, slow at both ends."""
    return (1 - cos(pi * min(max(share, 0.0), 1.0))) / 2


class Route:
    """A polyline with rounded corners, walked at a speed."""

    def __init__(self, points: Sequence[Spot], speed: float) -> None:
        self.points = [points[0], *(b for a, b in pairwise(points) if hypot(b[0] - a[0], b[1] - a[1]) > 1e-6)]
        self.marks = [0.0]
        for a, b in pairwise(self.points):
            self.marks.append(self.marks[-1] + hypot(b[0] - a[0], b[1] - a[1]))
        self.length = self.marks[-1]
        self.starting = min(STARTING, self.length / speed)
        self.speed = speed
        self.seconds = self.length / speed + self.starting

    def _on_line(self, way: float) -> Spot:
        way = min(max(way, 0.0), self.length)
        for k, (a, b) in enumerate(pairwise(self.points)):
            if way <= self.marks[k + 1] or k == len(self.points) - 2:
                return between(a, b, (way - self.marks[k]) / max(self.marks[k + 1] - self.marks[k], 1e-9))
        return self.points[-1]

    def spot(self, way: float) -> Spot:
        """Return the point after some metres."""
        near = min(ROUNDED, way, self.length - way)
        if near <= 1e-6:
            return self._on_line(way)
        marks = [self._on_line(way + near * share) for share in (-1.0, -0.5, 0.0, 0.5, 1.0)]
        return sum(m[0] for m in marks) / 5, sum(m[1] for m in marks) / 5

    def heading(self, way: float) -> float:
        """Return the direction of walking after some metres, degrees."""
        a, b = self.spot(max(way - AROUND, 0.0)), self.spot(min(way + AROUND, self.length))
        return degrees(atan2(b[0] - a[0], b[1] - a[1]))

    def way(self, time: float) -> float:
        """Metres after some seconds, with soft start and stop."""
        ramp, top = self.starting, self.speed
        if ramp <= 0:
            return self.length
        time = min(max(time, 0.0), self.seconds)
        if time < ramp:
            return top * time * time / (2 * ramp)
        if time > self.seconds - ramp:
            left = self.seconds - time
            return self.length - top * left * left / (2 * ramp)
        return top * (time - ramp / 2)
