"""Laying a table: a place for everyone who sits at it."""

from collections.abc import Sequence
from typing import NamedTuple

from hearth.homes.geometry import Rect, footprint, front_of
from hearth.homes.plans.shell import Thing, span

AT_TABLE = 0.35
"""A chair no further than this from a table's edge stands at it."""
EDGE = 0.04
BETWEEN = 0.025


class Place(NamedTuple):
    """Where somebody eats: the point of the table's edge before a seat, and the way one looks from there."""

    x: float
    z: float
    front: str


def places(table: Thing, seats: Sequence[Thing]) -> list[Place]:
    """A place for each seat that stands at the table and faces it, in the order of the seats."""
    top = footprint(table.box)
    found = []
    for seat in seats:
        if seat.yaw is None:
            continue
        front, rect = front_of(seat.yaw), footprint(seat.box)
        x, z = rect.center
        gap, edge = {
            "north": (top.z0 - rect.z1, Place(x, top.z0, front)),
            "south": (rect.z0 - top.z1, Place(x, top.z1, front)),
            "east": (top.x0 - rect.x1, Place(top.x0, z, front)),
            "west": (rect.x0 - top.x1, Place(top.x1, z, front)),
        }[front]
        low, high = span(top, front)
        if -0.2 < gap <= AT_TABLE and low < (x if front in ("north", "south") else z) < high:
            found.append(edge)
    return found


def setting(place: Place, sizes: Sequence[tuple[float, float]]) -> list[Rect]:
    """Where the things of one setting lie, given their (width, depth) as the person sees them.

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
        found.append(_turned(place, across, out, width, depth))
    return found


def _turned(place: Place, across: float, out: float, width: float, depth: float) -> Rect:
    """A rectangle from a person's right and forward distances into the room's axes."""
    x, z, front = place
    if front == "north":
        return Rect(x + across, z + out, x + across + width, z + out + depth)
    if front == "south":
        return Rect(x - across - width, z - out - depth, x - across, z - out)
    if front == "east":
        return Rect(x + out, z - across - width, x + out + depth, z - across)
    return Rect(x - out - depth, z + across, x - out, z + across + width)
