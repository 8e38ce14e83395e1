"""A house as ProcTHOR writes it, read field by field; every fault has its place in the file and its remedy."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from hearth.interop.scene_graphs.vectors import Vector, vector
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Spot
from hearth.schemas.numbers import FARTHEST

MOST_OBJECTS = 20_000
"""Objects of a house that are read."""

MOST_ROOMS = 200
"""Rooms of a house that are read."""

DEEPEST = 12
"""Objects that may stand in one another."""

EXTENSION = "hearth"
"""Key of our own fields in a house. AI2-THOR ignores keys that it does not know."""


class HouseRoom(NamedTuple):
    """A room: its id, the word for its class, and the corners of its floor."""

    path: str
    id: str
    label: str
    corners: tuple[Spot, ...]
    own: Mapping[str, Any]


class HouseWall(NamedTuple):
    """One side of a wall: its id, its room, the ends of its foot, its height, and whether there is none to see."""

    id: str
    room: str
    start: Spot
    end: Spot
    height: float
    empty: bool


class Hole(NamedTuple):
    """A door or a window: its rooms, the wall it is in, its extent along the wall and upwards, and its own fields."""

    path: str
    id: str
    rooms: tuple[str, str]
    wall: str
    low: Spot
    high: Spot
    has_leaf: bool
    is_open: bool
    own: Mapping[str, Any]


@dataclass(frozen=True)
class HouseObject:
    """An object with its place; `holder` is the id of the object among whose children it stands, or "".

    Attributes:
        path: where it stands in the file.
        id: of the file.
        label: the word for its class: the beginning of the id.
        asset: the id of its model.
        place: the center of its box.
        yaw: degrees.
        holder: the id of the object that it is on or in; "" without one.
        fields: its own values.
        own: our fields.
    """

    path: str
    id: str
    label: str
    asset: str
    place: Vector
    yaw: float
    holder: str
    fields: Mapping[str, Any]
    own: Mapping[str, Any]


@dataclass
class House:
    """A house: rooms, walls, doors, windows, objects, the agent, and the faults of entries that are left out."""

    rooms: list[HouseRoom] = field(default_factory=list)
    walls: dict[str, HouseWall] = field(default_factory=dict)
    doors: list[Hole] = field(default_factory=list)
    windows: list[Hole] = field(default_factory=list)
    objects: list[HouseObject] = field(default_factory=list)
    agent: tuple[Vector, float] | None = None
    own: Mapping[str, Any] = field(default_factory=dict)
    faults: list[Diagnostic] = field(default_factory=list)


def is_house(data: Any) -> bool:
    """Return whether a JSON value is a house: its rooms have floors with corners."""
    rooms = data.get("rooms") if isinstance(data, Mapping) else None
    return isinstance(rooms, list) and any(isinstance(room, Mapping) and "floorPolygon" in room for room in rooms)


def read_house(data: Mapping[str, Any], file: str = "") -> House:
    """Return the house of a JSON value; entries without what they need are faults.

    Raises:
        HearthError: FILE_TOO_LARGE: more rooms or objects than are read; BAD_GRAPH: no room has a floor.
    """
    house = House()
    reader = _Reader(house, file)
    rooms = _entries(data, "rooms")
    if len(rooms) > MOST_ROOMS:
        raise HearthError.of(Code.FILE_TOO_LARGE, f"{len(rooms):,} rooms, where {MOST_ROOMS} are read", file=file,
                             suggestion="write a file for each floor")  # fmt: skip
    for path, each in rooms:
        reader.room(each, path)
    if not house.rooms:
        raise HearthError(house.faults or [reader.fault("rooms", "no room has a floor", "a `floorPolygon` for each")])
    for path, each in _entries(data, "walls"):
        reader.wall(each, path)
    for name, holes in (("doors", house.doors), ("windows", house.windows)):
        for path, each in _entries(data, name):
            reader.hole(each, path, holes)
    metadata = data.get("metadata")
    metadata = metadata if isinstance(metadata, Mapping) else {}
    house.own = _mapping(metadata.get(EXTENSION))
    reader.objects(_entries(data, "objects"))
    reader.objects(_entries(house.own, "objects", f"metadata.{EXTENSION}."))
    agent = _mapping(metadata.get("agent"))
    place = vector(agent.get("position"))
    if place is not None:
        house.agent = place, _turn(agent)
    return house


@dataclass
class _Reader:
    """The reading of one house; faults are noted, and their entries left out."""

    house: House
    file: str
    number: int = 0
    seen: dict[str, str] = field(default_factory=dict)

    def fault(self, path: str, message: str, suggestion: str, code: Code = Code.BAD_GRAPH) -> Diagnostic:
        return Diagnostic(code, f"{path}: {message}", self.file, suggestion=suggestion)

    def leave(self, path: str, message: str, suggestion: str, code: Code = Code.BAD_GRAPH) -> None:
        """Note an entry that is left out."""
        self.house.faults.append(self.fault(path, message, suggestion, code))

    def is_new(self, name: str, path: str) -> bool:
        """Return whether no entry before has an id; one that has is noted, and the second entry left out."""
        if name and name in self.seen:
            message = f"the id `{name}` is that of {self.seen[name]}, too"
            self.leave(path, message, "give each an id of its own", Code.DUPLICATE)
            return False
        self.seen[name] = path
        return True

    def room(self, each: Mapping[str, Any], path: str) -> None:
        found = [vector(corner) for corner in _list(each.get("floorPolygon"))]
        corners = [(corner[0], corner[2]) for corner in found if corner is not None and _is_near(corner)]
        if len(corners) < 4 or len(corners) != len(found):
            self.leave(path, "its floor needs four corners or more, each with x, y and z in metres",
                       "a `floorPolygon` of finite numbers")  # fmt: skip
            return
        name = str(each.get("id") or path)
        if self.is_new(name, path):
            label = each.get("roomType")
            own = _mapping(each.get(EXTENSION))
            self.house.rooms.append(HouseRoom(path, name, label if isinstance(label, str) else "", tuple(corners), own))

    def wall(self, each: Mapping[str, Any], path: str) -> None:
        corners = [corner for corner in map(vector, _list(each.get("polygon"))) if corner is not None]
        name = str(each.get("id") or path)
        if len(corners) < 3 or not all(map(_is_near, corners)):
            self.leave(path, "it needs the corners of its outline", "a `polygon` of finite numbers")
        elif self.is_new(name, path):
            low = min(corner[1] for corner in corners)
            feet = list(dict.fromkeys((x, z) for x, y, z in corners if y <= low + 0.01))
            high = max(corner[1] for corner in corners) - low
            room = each.get("roomId")
            if len(feet) >= 2:
                self.house.walls[name] = HouseWall(
                    name, room if isinstance(room, str) else "", feet[0], feet[1], high, each.get("empty") is True
                )

    def hole(self, each: Mapping[str, Any], path: str, holes: list[Hole]) -> None:
        box = each.get("boundingBox")
        ends = [box.get("min"), box.get("max")] if isinstance(box, Mapping) else _list(each.get("holePolygon"))
        points = [point for point in map(vector, ends) if point is not None]
        name = str(each.get("id") or path)
        if len(points) < 2 or not all(map(_is_near, points)):
            self.leave(path, "it needs the place of its hole in the wall", "a `holePolygon` of two corners")
            return
        if not self.is_new(name, path):
            return
        rooms = [each.get("room0"), each.get("room1")]
        first, second = (room if isinstance(room, str) else "" for room in rooms)
        wall = next((each[key] for key in ("wall0", "wall1") if isinstance(each.get(key), str)), "")
        (x0, y0, _), (x1, y1, _) = points[:2]
        openness = each.get("openness")
        leaf = str(each.get("assetId", "")).startswith("Doorway") or each.get("openable") is True
        holes.append(
            Hole(path, name, (first or second, second or first), wall, (min(x0, x1), min(y0, y1)),
                 (max(x0, x1), max(y0, y1)), leaf, isinstance(openness, int | float) and openness > 0.5,
                 _mapping(each.get(EXTENSION)))
        )  # fmt: skip

    def objects(self, entries: Sequence[tuple[str, Any]]) -> None:
        """Note objects, and those that stand among the children of each."""
        waiting = [(path, each, "", 0) for path, each in reversed(entries)]
        while waiting:
            path, each, holder, depth = waiting.pop()
            self.number += 1
            if self.number > MOST_OBJECTS:
                raise HearthError.of(Code.FILE_TOO_LARGE, f"more than {MOST_OBJECTS:,} objects", file=self.file,
                                     suggestion="write a file for each floor or room")  # fmt: skip
            if depth > DEEPEST:
                self.leave(path, f"it stands in {depth} others", f"{DEEPEST} objects in one another at most")
                continue
            found = self.object(each, path, holder)
            inner = found.id if found is not None else holder
            children = _entries(each, "children", f"{path}.")
            waiting += [(below, child, inner, depth + 1) for below, child in reversed(children)]

    def object(self, each: Mapping[str, Any], path: str, holder: str) -> HouseObject | None:
        """Return an object; None without a place, or with the id of another."""
        place = vector(each.get("position"))
        name = str(each.get("id") or path)
        if place is None or not _is_near(place):
            self.leave(path, "it needs a position of three finite numbers in metres", "`position: {x, y, z}`")
            return None
        if not self.is_new(name, path):
            return None
        own = _mapping(each.get(EXTENSION))
        found = HouseObject(path, name, name.partition("|")[0], str(each.get("assetId") or ""), place, _turn(each),
                            str(own.get("holder", holder)), each, own)  # fmt: skip
        self.house.objects.append(found)
        return found


def _is_near(place: Vector) -> bool:
    return max(map(abs, place)) <= FARTHEST


def _turn(each: Mapping[str, Any]) -> float:
    turn = vector(each.get("rotation"))
    return 0.0 if turn is None else turn[1] % 360.0


def _mapping(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}


def _list(value: Any) -> Sequence[Any]:
    return value if isinstance(value, list) else []


def _entries(data: Mapping[str, Any], name: str, above: str = "") -> list[tuple[str, Mapping[str, Any]]]:
    """Return the mappings of a list, each with its path."""
    return list(_paths(_list(data.get(name)), above + name))


def _paths(entries: Sequence[Any], name: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for number, each in enumerate(entries):
        if isinstance(each, Mapping):
            yield f"{name}[{number}]", each
