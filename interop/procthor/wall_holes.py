"""Doors and windows of a house as those of a plan: the wall of a rectangle, and the hole's extent along it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from hearth.homes.geometry import DIRECTIONS, Rect, along_x
from hearth.homes.plans.home_shell import WALL, interior, shared_wall, span
from hearth.homes.plans.plan import OUTSIDE, Doorway, Room, Window
from hearth.interop.procthor.house import Hole, HouseWall

NARROWEST = 0.5
"""Metres of a hole that somebody can walk through."""

LINED_UP = 0.25
"""Metres between a wall of a house and the side of the room that it stands on."""


class Stretch(NamedTuple):
    """A part of a line along a wall: whether it runs along x, its two ends along it, and its place across it."""

    along: bool
    start: float
    end: float
    at: float


@dataclass(frozen=True)
class Piece:
    """A rectangle of a room of a house: the room's number, and the room of a plan that it becomes."""

    number: int
    room: Room


def stretch(hole: Hole, wall: HouseWall) -> Stretch:
    """Return where a hole lies: it is measured from the first end of its wall's foot towards the second."""
    (x0, z0), (x1, z1) = wall.start, wall.end
    along = abs(x1 - x0) >= abs(z1 - z0)
    first, last, at = (x0, x1, z0) if along else (z0, z1, x0)
    way = 1 if last >= first else -1
    ends = sorted((first + way * hole.low[0], first + way * hole.high[0]))
    return Stretch(along, round(ends[0], 4), round(ends[1], 4), at)


def doorway(hole: Hole, where: Stretch, pieces: Sequence[Sequence[Piece]], line: int) -> Doorway | None:
    """Return a door between the rectangles that meet at it, or out of the one that it is in; None at none of them.

    Args:
        hole: the door.
        where: of it.
        pieces: the rectangles of its first room, and of its second one; once for a door to the outside.
        line: of the doorway.
    """
    into, hinge = str(hole.own.get("into", "")), str(hole.own.get("hinge", "low"))
    for one in pieces[0]:
        for other in pieces[1] if len(pieces) > 1 else ():
            shared = shared_wall(one.room.rect, other.room.rect)
            if shared is not None and _is_at(one.room.rect, shared[0], where, shared[1:]):
                start, width = _fitted(where, shared[1], shared[2])
                names = (one.room.name, other.room.name)
                return None if width < NARROWEST else Doorway(
                    names, at=start, width=width, leaf=hole.has_leaf, into=into if into in names else "",
                    hinge=hinge if hinge in ("low", "high") else "low", line=line)  # fmt: skip
        if len(pieces) == 1:
            for wall in DIRECTIONS:
                sides = span(one.room.rect, wall)
                if _is_at(one.room.rect, wall, where, sides):
                    start, width = _fitted(where, *sides)
                    return Doorway((one.room.name, OUTSIDE), wall, start, width, hole.has_leaf, "",
                                   hinge if hinge in ("low", "high") else "low", line)  # fmt: skip
    return None


def window(hole: Hole, where: Stretch, pieces: Sequence[Piece], line: int) -> tuple[Piece, Window] | None:
    """Return the rectangle that a window is in, and the window; None in none of them."""
    for piece in pieces:
        for wall in DIRECTIONS:
            if _is_at(piece.room.rect, wall, where, span(piece.room.rect, wall)):
                low, high = span(interior(piece.room), wall)
                start, end = max(low, where.start), min(high, where.end)
                sill = max(0.0, hole.low[1])
                return piece, Window(
                    wall, round(start - low, 4), round(end - start, 4), round(hole.high[1] - sill, 4), sill, line=line
                )
    return None


def _is_at(rect: Rect, wall: str, where: Stretch, ends: tuple[float, float]) -> bool:
    """Return whether the middle of a hole lies in a wall of a rectangle, between two ends along it."""
    if along_x(wall) != where.along:
        return False
    line = {"north": rect.z1, "south": rect.z0, "east": rect.x1, "west": rect.x0}[wall]
    return abs(line - where.at) <= LINED_UP and ends[0] <= (where.start + where.end) / 2 <= ends[1]


def _fitted(where: Stretch, low: float, high: float) -> tuple[float, float]:
    """Return the start of a hole behind the beginning of a wall, and its width: within the walls at both ends."""
    start, end = max(where.start, low + WALL), min(where.end, high - WALL)
    return round(start - low, 4), round(end - start, 4)


def open_sides(pieces: Sequence[Piece], walls: Mapping[str, HouseWall]) -> Iterator[tuple[Piece, Piece, float, float]]:
    """Yield the rectangles between which no wall stands, with the start of the gap along the shared wall and its width.

    These are rectangles of one room, and those at a wall that is empty.
    """
    empty = [stretch(_whole(wall), wall) for wall in walls.values() if wall.empty]
    for index, one in enumerate(pieces):
        for other in pieces[index + 1 :]:
            shared = shared_wall(one.room.rect, other.room.rect)
            if shared is None:
                continue
            ends = shared[1:]
            found = [each for each in empty if _is_at(one.room.rect, shared[0], each, ends)]
            if one.number == other.number:
                found = [Stretch(along_x(shared[0]), *ends, 0.0)]
            if found:
                start, width = _fitted(found[0], *ends)
                if width >= NARROWEST:
                    yield one, other, start, width


def _whole(wall: HouseWall) -> Hole:
    """Return a wall as a hole as long as itself."""
    (x0, z0), (x1, z1) = wall.start, wall.end
    length = max(abs(x1 - x0), abs(z1 - z0))
    return Hole("", wall.id, (wall.room, wall.room), wall.id, (0.0, 0.0), (length, wall.height), False, True, {})
