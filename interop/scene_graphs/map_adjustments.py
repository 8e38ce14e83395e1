"""Maps whose walls run askew to their axes, and rooms whose places are corners: both are put right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan2, cos, degrees, hypot, radians, sin

from hearth.homes.geometry import Rect
from hearth.interop.scene_graphs import vectors
from hearth.interop.scene_graphs.entries import Entry, Units
from hearth.kb.knowledge import Knowledge

LEAST_TURN = 5.0
"""Degrees: maps that are less askew stay."""

AGREEMENT = 0.8
"""Least length of the mean direction of all things, folded to a quarter turn: 1 if all agree."""

FEWEST = 3
"""Things with a rotation from which a map's rotation is known."""


def straightened(entries: Sequence[Entry]) -> tuple[list[Entry], float]:
    """Return entries turned about the origin so that most things stand along the axes, and by how many degrees.

    Sizes stay: they are those of things at the nearest right angle.
    """
    turns = [radians(4 * entry.yaw) for entry in entries if entry.yaw is not None and entry.place is not None]
    if len(turns) < FEWEST:
        return list(entries), 0.0
    east, north = (sum(map(part, turns)) / len(turns) for part in (sin, cos))
    askew = round(degrees(atan2(east, north)) / 4, 1)
    if hypot(east, north) < AGREEMENT or abs(askew) < LEAST_TURN:
        return list(entries), 0.0
    return [_turned(entry, -askew) for entry in entries], -askew


def _turned(entry: Entry, angle: float) -> Entry:
    """Return an entry turned about the origin, clockwise as seen from above."""
    if entry.place is None:
        return entry
    x, y, z = entry.place
    east, north = sin(radians(angle)), cos(radians(angle))
    place = (round(x * north + z * east, 4), y, round(z * north - x * east, 4))
    return replace(entry, place=place, yaw=None if entry.yaw is None else round((entry.yaw + angle) % 360.0, 2))


def with_middles(entries: Sequence[Entry], units: Units, knowledge: Knowledge) -> tuple[list[Entry], list[str]]:
    """Return entries with the middles of rooms, and the rooms whose places are their corners in the file.

    Places of rooms on a floor plan are corners if more things are in the rooms so.
    """
    rooms = [e for e in entries if e.is_flat and e.place and e.size and knowledge.is_room(e.class_name)]
    things = [e.place for e in entries if e.place is not None and not knowledge.is_room(e.class_name)]
    shifted = {id(entry): _from_corner(entry, units) for entry in rooms}
    if _held(things, list(shifted.values())) <= _held(things, rooms):
        return list(entries), []
    return [shifted.get(id(entry), entry) for entry in entries], [entry.class_name for entry in rooms]


def _held(places: Sequence[vectors.Vector], rooms: Sequence[Entry]) -> int:
    """Return the number of places that are in a room."""
    rects = [Rect.around(e.place[0], e.place[2], e.size[0], e.size[2]) for e in rooms if e.place and e.size]
    return sum(any(rect.holds(place[0], place[2]) for rect in rects) for place in places)


def _from_corner(entry: Entry, units: Units) -> Entry:
    """Return a room whose place is the corner where both coordinates of its file are lowest, with its middle."""
    if entry.place is None or entry.size is None:
        return entry
    x, _, z = vectors.upright((1.0, 1.0, 1.0), units.up, units.right_handed)
    place = entry.place
    return replace(entry, place=(place[0] + x * entry.size[0] / 2, place[1], place[2] + z * entry.size[2] / 2))
