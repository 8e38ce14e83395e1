"""The sides of walls that rooms see: each as long as the wall has one room, or none, behind it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from typing import NamedTuple

from hearth.homes.geometry import OPPOSITE_WALL, Rect, along_x
from hearth.homes.plans.home_shell import shared_wall, span
from hearth.schemas.graph import Spot

CLOCKWISE = ("west", "north", "east", "south")
"""Walls of a room in the order of the corners of its floor."""


class Side(NamedTuple):
    """A stretch of a room's wall.

    Attributes:
        id: of the wall, with its ends in it, as ProcTHOR writes it.
        room: the id of the room that sees it.
        start, end: of its foot, clockwise around the room.
        behind: the id of the wall's side in the room behind it; "" outside.
    """

    id: str
    room: str
    start: Spot
    end: Spot
    behind: str = ""

    @property
    def along(self) -> bool:
        """Return whether it runs from west to east."""
        return abs(self.end[0] - self.start[0]) >= abs(self.end[1] - self.start[1])

    def within(self, rect: Rect) -> tuple[float, float]:
        """Return where a rectangle begins and ends along it, from its start."""
        axis = 0 if self.along else 1
        way = 1 if self.end[axis] >= self.start[axis] else -1
        low, high = sorted(way * (rect[axis + end] - self.start[axis]) for end in (0, 2))
        return round(low, 4), round(high, 4)


def sides(rooms: Mapping[str, Rect]) -> list[Side]:
    """Return all sides of the walls of rooms, by room and clockwise."""
    return [side for room in rooms for wall in CLOCKWISE for side in _of_wall(room, wall, rooms)]


def exterior_id(side: Side) -> str:
    """Return the id of a wall's outer side."""
    return side.id.replace(f"wall|{_number(side.room)}|", "wall|exterior|", 1)


def side_at(walls: Sequence[Side], room: str, rect: Rect, other: str = "") -> Side | None:
    """Return the side of a room's wall that a door or window lies in: the nearest one, before another room if named."""
    found = [side for side in walls if side.room == room and _holds(side, rect)]
    found = [side for side in found if (f"wall|{_number(other)}|" in side.behind if other else not side.behind)]
    return min(found, key=lambda side: _across(side, rect), default=None)


def _holds(side: Side, rect: Rect) -> bool:
    low, high = side.within(rect)
    axis = 0 if side.along else 1
    length = abs(side.end[axis] - side.start[axis])
    return low >= -0.02 and high <= length + 0.02 and _across(side, rect) < 0.2


def _across(side: Side, rect: Rect) -> float:
    axis = 1 if side.along else 0
    return abs(rect.center[axis] - side.start[axis])


def _of_wall(room: str, wall: str, rooms: Mapping[str, Rect]) -> Iterator[Side]:
    rect = rooms[room]
    low, high = span(rect, wall)
    behind = {other: found[1:] for other, each in rooms.items()
              if other != room and (found := shared_wall(rect, each)) is not None and found[0] == wall}  # fmt: skip
    cuts = sorted({low, high, *(end for ends in behind.values() for end in ends)})
    parts = list(pairwise(cuts))
    for start, end in parts if wall in ("west", "north") else reversed(parts):
        other = next((name for name, ends in behind.items() if ends[0] <= (start + end) / 2 <= ends[1]), "")
        at = {"north": rect.z1, "south": rect.z0, "east": rect.x1, "west": rect.x0}[wall]
        name = _id(room, wall, start, end, at)
        back = "" if not other else _id(other, OPPOSITE_WALL[wall], start, end, at)
        first, last = (start, end) if wall in ("west", "north") else (end, start)
        ends = ((first, at), (last, at)) if along_x(wall) else ((at, first), (at, last))
        yield Side(name, room, *ends, back)


def _number(room: str) -> str:
    return room.rpartition("|")[2]


def _id(room: str, wall: str, start: float, end: float, at: float) -> str:
    low, high = ((start, at), (end, at)) if along_x(wall) else ((at, start), (at, end))
    return f"wall|{_number(room)}|{low[0]:.2f}|{low[1]:.2f}|{high[0]:.2f}|{high[1]:.2f}"
