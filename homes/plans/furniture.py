"""Places furniture: one function for each key of the plan."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from hearth.homes.geometry import (
    DIRECTIONS,
    OPPOSITE_WALL,
    Rect,
    along_x,
    box_over,
    facing_from,
    footprint,
    front_of,
    turned,
    wall_of,
)  # fmt: skip
from hearth.homes.object_shapes import Form, scaled
from hearth.homes.plans.home_shell import Thing, interior, span, strip
from hearth.homes.plans.plan import Piece, Room
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.yaml_fields import Faults

GAP = 0.03
"""Between furniture and the wall behind it: a socket fits in."""

Standing = tuple[Rect, float]
"""The position of a thing, and the direction that it faces."""


class Placed(NamedTuple):
    """A piece of furniture that has its place."""

    piece: Piece
    thing: Thing


@dataclass(slots=True)
class Furnishing:
    """A room while it is furnished.

    Attributes:
        room: the room.
        inner: the floor between its walls.
        height: of the room.
        placed: what has its place, in the order placed.
    """

    room: Room
    inner: Rect
    height: float
    knowledge: Knowledge
    faults: Faults
    placed: list[Placed] = field(default_factory=list)

    def find(self, name: str) -> Thing | None:
        """Return the last thing placed that other entries call so: by its own name, or by its entry's name or class."""
        for piece, thing in reversed(self.placed):
            if name in (thing.name.partition("/")[2], piece.name or piece.class_name):
                return thing
        return None


class NoPlaceError(Exception):
    """A reason why a piece cannot be placed as the plan says."""


def furnish(room: Room, height: float, knowledge: Knowledge, faults: Faults) -> Furnishing:
    """Place a room's furniture; each entry after those it refers to. Faulty entries are noted and left out."""
    found = Furnishing(room, interior(room), height, knowledge, faults)
    numbers: dict[str, int] = {}
    waiting = [(piece, names_of(piece, numbers)) for piece in room.furniture]
    while ready := [entry for entry in waiting if (name := _reference(entry[0])) is None or found.find(name)]:
        for piece, names in ready:
            try:
                found.placed += stand(piece, names, found)
            except NoPlaceError as why:
                faults.add(Code.NO_PLACE, f"`{piece.class_name}` in {room.name}: {why}", piece.line)
        waiting = [entry for entry in waiting if entry not in ready]
    for piece, _ in waiting:
        message = f"`{piece.class_name}` refers to `{_reference(piece)}`, which {room.name} does not hold"
        known = {name for each in found.placed for name in (each.thing.name.partition("/")[2], each.piece.class_name)}
        faults.add(Code.UNKNOWN_OBJECT, message, piece.line, f"it holds {', '.join(sorted(known)) or 'nothing'}")
    order = {id(piece): number for number, piece in enumerate(room.furniture)}
    found.placed.sort(key=lambda placed: order[id(placed.piece)])
    return found


def shape(piece: Piece, knowledge: Knowledge) -> Form:
    """Return a piece's form with the plan's own sizes."""
    found = scaled(piece.class_name, piece.size, knowledge)
    if found is None:
        raise NoPlaceError(f"nobody knows the size of `{piece.class_name}`")
    return found


def _reference(piece: Piece) -> str | None:
    found = (piece.place.get(key) for key in ("beside", "before", "opposite", "around", "above"))
    return next((name for name in found if name is not None), None)


def names_of(piece: Piece, numbers: dict[str, int]) -> list[str]:
    """Return the names of a piece's things: its own, else its class with a number; `numbers` counts them."""
    base = piece.name or piece.class_name
    names = []
    for _ in range(piece.count):
        numbers[base] = numbers.get(base, 0) + 1
        names.append(base if piece.name and piece.count == 1 else f"{base}.{numbers[base]}")
    return names


def stand(piece: Piece, names: Sequence[str], room: Furnishing) -> list[Placed]:
    """Return an entry's things where the plan puts them in a room; they are not added to it.

    Raises:
        NoPlaceError: they cannot be placed so.
    """
    shaped = shape(piece, room.knowledge)
    place = next((place for key, place in PLACERS.items() if piece.has(key)), None)
    if place is None:
        raise NoPlaceError("the plan does not say where")
    low, where = underside(piece, shaped, room), room.room.name
    return [
        Placed(piece, Thing(f"{where}/{name}", piece.class_name, where, box_over(rect, low, low + shaped.size[1]), yaw,
                            shaped.mount, front=shaped.front, line=piece.line))
        for name, (rect, yaw) in zip(names, place(piece, shaped, room), strict=True)
    ]  # fmt: skip


def underside(piece: Piece, shaped: Form, room: Furnishing) -> float:
    """Return the height at which a piece begins."""
    if "up" in piece.place:
        return float(piece.place["up"])
    if shaped.mount == "ceiling":
        return room.height - shaped.size[1]
    return shaped.up if shaped.mount == "wall" else 0.0


def _yaw(piece: Piece, usual: float) -> float:
    return DIRECTIONS[piece.place["facing"]] if piece.has("facing") else usual


def _target(piece: Piece, key: str, room: Furnishing, side: str) -> tuple[Thing, float]:
    """Return the thing to which a piece refers, and its yaw.

    Raises:
        NoPlaceError: it is not there, or has no such side.
    """
    other = room.find(piece.place[key])
    if other is None or other.yaw is None:
        raise NoPlaceError(f"`{piece.place[key]}` has no {side}")
    return other, other.yaw


def _on_wall(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    wall = piece.place["wall"]
    low, high = span(room.inner, wall)
    yaw = _yaw(piece, facing_from(wall))
    along, out = _extents(shaped, yaw, wall)
    gap = piece.place.get("gap", 0.0)
    total = piece.count * along + (piece.count - 1) * gap
    if piece.has("from_end"):
        start = high - piece.place["from_end"] - total
    elif piece.place.get("at") is not None:
        start = low + piece.place["at"]
    else:
        start = (low + high - total) / 2
    off = 0.0 if shaped.mount == "wall" else GAP
    inner = room.inner.inset(off)
    starts = (start + k * (along + gap) for k in range(piece.count))
    return [(strip(inner, wall, begin, begin + along, out), yaw) for begin in starts]


def _extents(shaped: Form, yaw: float, wall: str) -> tuple[float, float]:
    """Return a thing's extents along a wall and away from it."""
    x, z = turned(shaped.size[0], shaped.size[2], yaw)
    return (x, z) if along_x(wall) else (z, x)


def _in_corner(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    corner = piece.place["corner"]
    north_south, east_west = corner[:5], corner[5:]
    wall = piece.place.get("wall", north_south)
    if wall not in (north_south, east_west):
        raise NoPlaceError(f"the {wall} wall does not reach the {corner} corner")
    yaw = _yaw(piece, facing_from(wall))
    x, z = turned(shaped.size[0], shaped.size[2], yaw)
    inner = room.inner.inset(GAP)
    x0 = inner.x0 if east_west == "west" else inner.x1 - x
    z0 = inner.z0 if north_south == "south" else inner.z1 - z
    if piece.count != 1:
        raise NoPlaceError("a corner holds one")
    return [(Rect(x0, z0, x0 + x, z0 + z), yaw)]


def _beside(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    """Next along the wall that the other has its back to, backs in line; by default on its east or north side."""
    other, turned_to = _target(piece, "beside", room, "side")
    rect, wall = footprint(other.box), wall_of(turned_to)
    side = piece.place.get("side", "east" if along_x(wall) else "north")
    if along_x(side) == along_x(wall):
        raise NoPlaceError(f"{side} of `{other.class_name}` is not beside it")
    yaw = _yaw(piece, turned_to)
    along, out = _extents(shaped, yaw, wall)
    gap = piece.place.get("gap", 0.0)
    forward = side in ("east", "north")
    low, high = span(rect, wall)
    shifts = (gap + k * (along + gap) for k in range(piece.count))
    starts = (high + shift if forward else low - shift - along for shift in shifts)
    return [(strip(rect, wall, start, start + along, out), yaw) for start in starts]


def _before(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    """In front of the other, their middles in line, facing it."""
    other, turned_to = _target(piece, "before", room, "front")
    yaw, gap = _yaw(piece, (turned_to + 180) % 360), piece.place.get("gap", 0.4)
    return _row(footprint(other.box), front_of(turned_to), piece, shaped, yaw=yaw, gap=gap)


def _row(rect: Rect, side: str, piece: Piece, shaped: Form, *, yaw: float, gap: float) -> list[Standing]:
    """Things in a row along the outside of a rectangle's side, spread evenly over its length."""
    along, out = _extents(shaped, yaw, side)
    low, high = span(rect, side)
    step = (high - low) / piece.count
    starts = (low + (k + 0.5) * step - along / 2 for k in range(piece.count))
    return [(strip(rect.inset(-gap), side, start, start + along, -out), yaw) for start in starts]


def _opposite(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    """At the wall that the other faces, their middles in line."""
    other, turned_to = _target(piece, "opposite", room, "front")
    wall = front_of(turned_to)
    yaw = _yaw(piece, facing_from(wall))
    along, out = _extents(shaped, yaw, wall)
    low, high = span(footprint(other.box), wall)
    start = (low + high - along) / 2
    if piece.count != 1:
        raise NoPlaceError("opposite something stands one")
    off = 0.0 if shaped.mount == "wall" else GAP
    return [(strip(room.inner.inset(off), wall, start, start + along, out), yaw)]


def _around(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    """Around the other, facing it: the long sides first, then the ends."""
    other = footprint(_target(piece, "around", room, "side")[0].box)
    gap = piece.place.get("gap", 0.06)
    long_sides = ("north", "south") if other.width >= other.depth else ("east", "west")
    short_sides = ("east", "west") if long_sides[0] == "north" else ("north", "south")
    room_for = max(1, int(max(other.width, other.depth) / (shaped.size[0] + 0.1)))
    sides = dict.fromkeys((*long_sides, *short_sides), 0)
    for k in range(piece.count):
        longs = [side for side in long_sides if sides[side] < room_for]
        free = longs or [side for side in short_sides if sides[side] < 1]
        if not free:
            raise NoPlaceError(f"there is no room for {piece.count} around it; {k} fit")
        sides[min(free, key=lambda side: sides[side])] += 1
    spots: list[Standing] = []
    for side, count in sides.items():
        if count:
            part = Piece(piece.class_name, count=count)
            spots.extend(_row(other, side, part, shaped, yaw=DIRECTIONS[OPPOSITE_WALL[side]], gap=gap))
    return spots


def _above(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    """On the wall behind the other, spread evenly over its width."""
    other, turned_to = _target(piece, "above", room, "back")
    wall = wall_of(turned_to)
    along, out = _extents(shaped, facing_from(wall), wall)
    low, high = span(footprint(other.box), wall)
    step = max((high - low) / piece.count, along)
    first = (low + high) / 2 - step * (piece.count - 1) / 2
    middles = (first + k * step for k in range(piece.count))
    return [(strip(room.inner, wall, at - along / 2, at + along / 2, out), facing_from(wall)) for at in middles]


def _at_spot(piece: Piece, shaped: Form, room: Furnishing) -> list[Standing]:
    """With its middle at a point of the room; several stand in a row eastwards."""
    yaw = _yaw(piece, 180.0)
    x, z = turned(shaped.size[0], shaped.size[2], yaw)
    point = piece.place["spot"]
    east, north = room.inner.center if point is None else (room.inner.x0 + point[0], room.inner.z0 + point[1])
    step = x + piece.place.get("gap", 0.1)
    first = east - step * (piece.count - 1) / 2
    return [(Rect.around(first + k * step, north, x, z), yaw) for k in range(piece.count)]


PLACERS: dict[str, Callable[[Piece, Form, Furnishing], list[Standing]]] = {
    "corner": _in_corner,
    "wall": _on_wall,
    "beside": _beside,
    "before": _before,
    "opposite": _opposite,
    "around": _around,
    "above": _above,
    "spot": _at_spot,
}
"""Ways of placing furniture, by the key of the plan."""
