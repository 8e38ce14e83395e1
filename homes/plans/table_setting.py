"""Laying a table: a place for everyone who sits at it."""

from collections.abc import Sequence
from typing import NamedTuple

from hearth.homes.geometry import OPPOSITE_WALL, Rect, along_x, footprint, front_of
from hearth.homes.plans.home_shell import Thing, band, span

AT_TABLE = 0.35
"""A chair no further than this from a table's edge stands at it."""
EDGE = 0.04
BETWEEN = 0.025


class Place(NamedTuple):
    """A place at a table.

    The table, the side of it in front of a seat, and the position of the seat's middle along that side.
    """

    table: Rect
    side: str
    along: float


def places(table: Thing, seats: Sequence[Thing]) -> list[Place]:
    """Return a place for each seat that stands at the table and faces it, in the order of the seats."""
    top = footprint(table.box)
    found = []
    for seat in seats:
        if seat.yaw is None:
            continue
        front, rect = front_of(seat.yaw), footprint(seat.box)
        side = OPPOSITE_WALL[front]
        (low, high), along = span(top, side), rect.center[0 if along_x(side) else 1]
        if -0.2 < -rect.reach(front) - top.reach(side) <= AT_TABLE and low < along < high:
            found.append(Place(top, side, along))
    return found


def setting(place: Place, sizes: Sequence[tuple[float, float]]) -> list[Rect]:
    """Return where the things of one setting lie, given their (width, depth) as the person sees them.

    The first lies before the person, the second to its left, the third to its right, the others beyond, from right to
    left.
    """
    first_width, first_depth = sizes[0]
    found = []
    beyond = first_width / 2
    for number, (width, depth) in enumerate(sizes):
        out = EDGE
        if number == 0:
            across = -width / 2
        elif number in (1, 2):
            gap = first_width / 2 + BETWEEN
            across = -gap - width if number == 1 else gap
        else:
            across, out = beyond - width, EDGE + first_depth + BETWEEN
            beyond -= width + BETWEEN
        # A person at the north or the east side has the west or the south on the right.
        start = place.along + across if place.side in ("south", "east") else place.along - across - width
        found.append(band(place.table, place.side, start, start + width, out, out + depth))
    return found
