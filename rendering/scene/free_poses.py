"""Free positions for things, on and in others, next to the things that stand there already."""

from collections.abc import Iterable
from math import cos, radians, sin
from typing import NamedTuple

from hearth.rendering.models.appearance import Region
from hearth.schemas.graph import Box, Point

STEP = 0.04
"""Metres between candidate positions."""


class Pose(NamedTuple):
    """A box and its direction."""

    box: Box
    yaw: float | None


def lying_flat(size: Point) -> Point:
    """Return the size of a flat thing lying down."""
    w, h, d = size
    return (w, d, h) if h > d else size


def best(
    size: Point, regions: Iterable[Region], support: Pose, others: list[Box], near: tuple[Point, ...], seed: int
) -> Pose:
    """Return the free pose nearest to a character, in the first region that has one; stacked if none has."""
    yaw = support.yaw or 0.0
    fallback: tuple[float, Pose] | None = None
    for region in regions:
        fitted = _fitted(size, region)
        for pose in _candidates(fitted, region, support, yaw, near, seed):
            crowd = sum(overlap(pose.box, other) for other in others)
            if crowd <= 1e-9:
                return pose
            if fallback is None or crowd < fallback[0]:
                fallback = (crowd, pose)
    assert fallback is not None
    return _stacked(fallback[1], others)


def _fitted(size: Point, region: Region) -> Point:
    """Return the size, scaled down to fit the region."""
    room = (region.x1 - region.x0, region.clear, region.z1 - region.z0)
    share = min(1.0, *(max(r, 0.01) / max(s, 1e-6) for r, s in zip(room, size, strict=True)))
    return size[0] * share, size[1] * share, size[2] * share


def _candidates(
    size: Point, region: Region, support: Pose, yaw: float, near: tuple[Point, ...], seed: int
) -> list[Pose]:
    """Candidate poses all over a region, best first."""
    (cx, cy, cz), height = support.box.center, support.box.size[1]
    c, s = cos(radians(yaw)), sin(radians(yaw))
    y = cy - height / 2 + region.y + size[1] / 2 + 0.001
    xs = _ticks(region.x0 + size[0] / 2, region.x1 - size[0] / 2)
    zs = _ticks(region.z0 + size[2] / 2, region.z1 - size[2] / 2)
    found = []
    for i, x in enumerate(xs):
        for k, z in enumerate(zs):
            at = (cx + x * c + z * s, y, cz - x * s + z * c)
            away = min((abs(at[0] - p[0]) + abs(at[2] - p[2]) for p in near), default=0.0)
            middle = abs(x) * 0.3 + abs(z - (region.z0 + region.z1) / 2) * 0.15
            found.append((round(away * 0.7 + middle + 0.02 * ((seed + i * 7919 + k * 104729) % 101) / 101, 6), at))
    w, d = (size[0], size[2]) if abs(c) > abs(s) else (size[2], size[0])
    return [Pose(Box(at, (w, size[1], d)), yaw) for _, at in sorted(found)]


def _ticks(low: float, high: float) -> list[float]:
    if high <= low:
        return [(low + high) / 2]
    count = min(max(1, int((high - low) / STEP)), 40)
    return [low + (high - low) * k / count for k in range(count + 1)]


def overlap(a: Box, b: Box) -> float:
    """Volume of the intersection of two boxes."""
    volume = 1.0
    for p, q, s, t in zip(a.center, b.center, a.size, b.size, strict=True):
        side = (s + t) / 2 - abs(p - q)
        if side <= 1e-4:
            return 0.0
        volume *= min(side, s, t)
    return volume


def _stacked(pose: Pose, others: list[Box]) -> Pose:
    """Return the pose lifted onto things at its position that are small enough to carry it."""
    (x, y, z), size = pose.box.center, pose.box.size
    low = y - size[1] / 2
    tops = [o.center[1] + o.size[1] / 2 for o in others if overlap(pose.box, o) > 1e-9 and o.size[1] < 0.35]
    return Pose(Box((x, max([low, *tops]) + size[1] / 2, z), size), pose.yaw)
