"""The shell of a home: openings, wall panels, floor and ceiling tiles, doors, windows and curtains."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from math import ceil

from hearth.homes.geometry import DIRECTIONS, OPPOSITE_WALL, Rect, along_x, box_over, facing_from, front_of
from hearth.homes.plans.plan import OUTSIDE, Doorway, Plan, Room, Window
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box
from hearth.schemas.yaml_fields import Faults

WALL = 0.06
"""Half a wall's thickness: each room has its own panels on its side."""
TILE = 2.5
PANEL = 3.0
DOOR_HEIGHT = 2.05
LINTEL = 0.05
"""Least height of wall above an opening."""
LEAF = 0.045
SAME = 0.011
"""Walls closer than this are one wall."""


@dataclass(frozen=True, slots=True)
class Thing:
    """Something of a home with its place.

    Attributes:
        name: unique in the home: `kitchen/fridge.1/milk.1`.
        class_name: of the knowledge.
        room: the name of its room.
        box: where it is.
        yaw: the way it faces; None for a thing without a front.
        mount: as `Form.mount`; `shell` for walls, floors and ceilings; `window` for windows and curtains.
        on, inside: the name of its support or container, or "".
        between: the rooms a doorway joins.
        front: free depth that using it takes, metres.
        line: in the plan; 0 for a thing that the plan implies.
    """

    name: str
    class_name: str
    room: str
    box: Box
    yaw: float | None = None
    mount: str = "shell"
    on: str = ""
    inside: str = ""
    between: tuple[str, ...] = ()
    front: float = 0.0
    line: int = 0


@dataclass(frozen=True, slots=True)
class Opening:
    """A hole in a room's wall, from `start` to `end` along it and from `y0` to `y1` upwards."""

    room: str
    wall: str
    start: float
    end: float
    y0: float
    y1: float
    door: Doorway | None = None
    window: Window | None = None
    number: int = 0


@dataclass(slots=True)
class Shell:
    """Parts of which the rooms are made.

    Attributes:
        things: walls, floors, ceilings, doors, windows, curtains.
        openings: of all walls, a doorway once for each of its rooms.
        kept_free: floor that doors need, with the door's line: (room, rect, line).
    """

    things: list[Thing] = field(default_factory=list)
    openings: list[Opening] = field(default_factory=list)
    kept_free: list[tuple[str, Rect, int]] = field(default_factory=list)


def interior(room: Room) -> Rect:
    """Return the floor between a room's walls."""
    return room.rect.inset(WALL)


def build(plan: Plan, faults: Faults) -> Shell:
    """Return the shell of a plan; openings that do not fit their walls are noted and left out."""
    shell = Shell()
    _check_height(plan, faults)
    for number, door in enumerate(plan.doorways, 1):
        _add_door(plan, door, number, shell, faults)
    for room in plan.rooms:
        for number, window in enumerate(room.windows, 1):
            _add_window(plan, room, window, number, shell=shell, faults=faults)
    _check_openings(shell, faults)
    for room in plan.rooms:
        shell.things.extend(_tiles(plan, room))
        for wall in DIRECTIONS:
            holes = [o for o in shell.openings if o.room == room.name and o.wall == wall]
            shell.things.extend(_panels(plan, room, wall, sorted(holes, key=lambda o: o.start)))
    return shell


def _check_height(plan: Plan, faults: Faults) -> None:
    """Doors need some wall above them."""
    least = DOOR_HEIGHT + LINTEL
    if plan.doorways and plan.height < least:
        faults.add(Code.NO_PLACE, f"doors, {DOOR_HEIGHT:g} m high, do not fit into walls of {plan.height:g} m",
                   plan.doorways[0].line, f"`height:` at least {least:g}")  # fmt: skip


def shared_wall(a: Rect, b: Rect) -> tuple[str, float, float] | None:
    """Return the wall of `a` that it shares with `b`, and from where to where along it; None when they do not touch."""
    sides = (
        ("east", a.x1 - b.x0, a.z0, a.z1, b.z0, b.z1),
        ("west", a.x0 - b.x1, a.z0, a.z1, b.z0, b.z1),
        ("north", a.z1 - b.z0, a.x0, a.x1, b.x0, b.x1),
        ("south", a.z0 - b.z1, a.x0, a.x1, b.x0, b.x1),
    )
    for wall, distance, a0, a1, b0, b1 in sides:
        start, end = max(a0, b0), min(a1, b1)
        if abs(distance) < SAME and end - start > 0.05:
            return wall, start, end
    return None


def outer_walls(rect: Rect, others: Iterable[Rect]) -> list[str]:
    """Return the walls of a room that it shares with none of the others."""
    shared = {found[0] for other in others if (found := shared_wall(rect, other)) is not None}
    return [wall for wall in OPPOSITE_WALL if wall not in shared]


def strip(rect: Rect, wall: str, start: float, end: float, depth: float) -> Rect:
    """Return the strip along one side of a rectangle: `depth` deep inwards from it, or outwards when negative."""
    return band(rect, wall, start, end, 0.0, depth)


def band(rect: Rect, wall: str, start: float, end: float, near: float, far: float) -> Rect:
    """Return the band along one side of a rectangle between two distances inwards from it, outwards when negative."""
    if wall == "north":
        return _ordered(start, rect.z1 - far, end, rect.z1 - near)
    if wall == "south":
        return _ordered(start, rect.z0 + near, end, rect.z0 + far)
    if wall == "east":
        return _ordered(rect.x1 - far, start, rect.x1 - near, end)
    return _ordered(rect.x0 + near, start, rect.x0 + far, end)


def before(rect: Rect, yaw: float, depth: float) -> Rect:
    """Return the floor before a thing that faces that way; within the thing itself when `depth` is negative."""
    side = front_of(yaw)
    return strip(rect, side, *span(rect, side), -depth)


def span(rect: Rect, wall: str) -> tuple[float, float]:
    """From where to where a rectangle's side runs."""
    return (rect.x0, rect.x1) if along_x(wall) else (rect.z0, rect.z1)


def _ordered(x0: float, z0: float, x1: float, z1: float) -> Rect:
    if x0 > x1:
        x0, x1 = x1, x0
    return Rect(x0, z0, x1, z1) if z0 <= z1 else Rect(x0, z1, x1, z0)


def _fit(start: float, end: float, at: float | None, width: float) -> tuple[float, float]:
    begin = (start + end - width) / 2 if at is None else start + at
    return begin, begin + width


def _add_door(plan: Plan, door: Doorway, number: int, shell: Shell, faults: Faults) -> None:
    names = {room.name for room in plan.rooms}
    unknown = [name for name in door.rooms if name not in names and name != OUTSIDE]
    if unknown:
        faults.add(Code.UNKNOWN_OBJECT, f"a door to `{unknown[0]}`, which is not a room of the plan", door.line,
                   f"rooms are {', '.join(sorted(names))}, {OUTSIDE}")  # fmt: skip
        return
    own = [name for name in door.rooms if name != OUTSIDE]
    if door.into and door.into not in own:
        faults.add(Code.UNKNOWN_OBJECT, f"a door of {' and '.join(own)} opens into `{door.into}`", door.line,
                   f"`into:` {' or '.join(own)}")  # fmt: skip
        return
    room = plan.room(door.rooms[0])
    place = _door_wall(plan, door, room, faults)
    if place is None:
        return
    wall, start, end = place
    begin, finish = _fit(start, end, door.at, door.width)
    if begin < start + WALL - SAME or finish > end - WALL + SAME:
        faults.add(Code.NO_PLACE, f"a door {door.width:g} m wide reaches beyond the {end - start:.2f} m of wall that "
                   f"{' and '.join(door.rooms)} share", door.line, "move it by `at`, or make it narrower")  # fmt: skip
        return
    other = _behind(plan, room, wall, begin, finish) if door.rooms[1] == OUTSIDE else None
    if other is not None:
        faults.add(Code.NO_PLACE, f"a door from {room.name} to the {OUTSIDE} leads into a wall of {other.name}",
                   door.line, f"choose an outer wall, or `between: [{room.name}, {other.name}]`")  # fmt: skip
        return
    for name, side in ((door.rooms[0], wall), (door.rooms[1], OPPOSITE_WALL[wall])):
        if name != OUTSIDE:
            shell.openings.append(Opening(name, side, begin, finish, 0.0, DOOR_HEIGHT, door=door, number=number))
            into = name == (door.into or door.rooms[0])
            depth = max(door.width, 0.6) if into and door.leaf else 0.6
            zone = strip(interior(plan.room(name)), side, begin, finish, depth)
            shell.kept_free.append((name, zone, door.line))
    shell.things.extend(_door_things(plan, door, wall, begin, finish))


def _behind(plan: Plan, room: Room, wall: str, begin: float, finish: float) -> Room | None:
    """Return the room on the other side of a stretch of a room's wall; None outside."""
    for other in plan.rooms:
        shared = shared_wall(room.rect, other.rect)
        if other is not room and shared and shared[0] == wall and begin < shared[2] and finish > shared[1]:
            return other
    return None


def _door_wall(plan: Plan, door: Doorway, room: Room, faults: Faults) -> tuple[str, float, float] | None:
    if door.rooms[1] == OUTSIDE:
        if not door.wall:
            faults.add(Code.SYNTAX, f"a door from {room.name} to the {OUTSIDE} needs its `wall`", door.line)
            return None
        return door.wall, *span(room.rect, door.wall)
    found = shared_wall(room.rect, plan.room(door.rooms[1]).rect)
    if found is None:
        faults.add(Code.NO_PLACE, f"{' and '.join(door.rooms)} share no wall for a door", door.line,
                   "move the rooms together, or join others")  # fmt: skip
    return found


def _door_things(plan: Plan, door: Doorway, wall: str, begin: float, finish: float) -> Iterator[Thing]:
    room = plan.room(door.rooms[0])
    outside = door.rooms[1] == OUTSIDE
    hole = strip(interior(room), wall, begin, finish, -WALL if outside else -2 * WALL)
    rooms = tuple(name for name in door.rooms if name != OUTSIDE)
    twins = [other for other in plan.doorways if other.rooms == door.rooms]
    base = f"{room.name}/{door.rooms[1]}" + (f".{twins.index(door) + 1}" if twins[0] != door else "")
    yaw = facing_from(wall)
    passage = rooms if len(rooms) == 2 else ()
    yield Thing(f"{base}/doorjamb", "doorjamb", room.name, box_over(hole, 0, DOOR_HEIGHT), yaw, "door",
                between=passage, line=door.line)  # fmt: skip
    if not door.leaf:
        return
    into = plan.room(door.into) if door.into in rooms else room
    side = wall if into is room else OPPOSITE_WALL[wall]
    yield Thing(f"{base}/door", "maindoor" if outside else "door", room.name,
                box_over(_open_leaf(into, side, door, begin, finish), 0.01, DOOR_HEIGHT - 0.01),
                yaw, "door", between=passage, line=door.line)  # fmt: skip


def _open_leaf(into: Room, wall: str, door: Doorway, begin: float, finish: float) -> Rect:
    """Return where a door's leaf stands when it is open: at right angles to its wall, inside the opening's end."""
    start = begin if door.hinge == "low" else finish - LEAF
    return strip(interior(into), wall, start, start + LEAF, door.width - 0.02)


def _add_window(plan: Plan, room: Room, window: Window, number: int, *, shell: Shell, faults: Faults) -> None:
    inner = interior(room)
    start, end = span(inner, window.wall)
    begin, finish = _fit(start, end, window.at, window.width)
    y1 = window.sill + window.height
    if begin < start - SAME or finish > end + SAME or y1 > plan.height - LINTEL:
        faults.add(Code.NO_PLACE, f"a window of {room.name} reaches beyond its {window.wall} wall", window.line,
                   f"the wall is {end - start:.2f} m by {plan.height:g} m")  # fmt: skip
        return
    other = _behind(plan, room, window.wall, begin, finish)
    if other is not None:
        faults.add(Code.NO_PLACE, f"a window of {room.name} looks into {other.name}", window.line,
                   "put it in an outer wall")  # fmt: skip
        return
    shell.openings.append(Opening(room.name, window.wall, begin, finish, window.sill, y1, window=window, number=number))
    glass = strip(inner, window.wall, begin, finish, -WALL)
    base = f"{room.name}/window.{number}"
    yaw = facing_from(window.wall)
    shell.things.append(
        Thing(base, "window", room.name, box_over(glass, window.sill, y1), yaw, "window", line=window.line)
    )
    shell.things.extend(_curtains(plan, room, window, base, begin=begin, finish=finish))


def _curtains(plan: Plan, room: Room, window: Window, base: str, *, begin: float, finish: float) -> Iterator[Thing]:
    inner = interior(room)
    low, high = span(inner, window.wall)
    width = min(0.4, 0.3 * window.width)
    starts = (begin - 0.1, finish + 0.1 - width)[: window.curtains]
    top = min(window.sill + window.height + 0.12, plan.height - 0.02)
    for k, start in enumerate(starts, 1):
        rect = strip(inner, window.wall, max(low, start), min(high, start + width), 0.08)
        box = box_over(rect, max(0.05, window.sill - 0.2), top)
        yield Thing(f"{base}/curtain.{k}", "curtain", room.name, box, facing_from(window.wall), "window",
                    line=window.line)  # fmt: skip


def _check_openings(shell: Shell, faults: Faults) -> None:
    for i, a in enumerate(shell.openings):
        for b in shell.openings[:i]:
            if (a.room, a.wall) == (b.room, b.wall) and a.start < b.end - SAME and b.start < a.end - SAME:
                owner = a.door or a.window
                faults.add(Code.NO_PLACE, f"two openings overlap in the {a.wall} wall of {a.room}",
                           owner.line if owner else 0,
                           f"the other is {b.start:.2f} to {b.end:.2f} m along it")  # fmt: skip


def _tiles(plan: Plan, room: Room) -> Iterator[Thing]:
    inner = interior(room)
    columns, rows = max(1, ceil(inner.width / TILE - 0.2)), max(1, ceil(inner.depth / TILE - 0.2))
    number = 0
    for j in range(rows):
        for i in range(columns):
            number += 1
            x0, z0 = inner.x0 + inner.width * i / columns, inner.z0 + inner.depth * j / rows
            rect = Rect(x0, z0, x0 + inner.width / columns, z0 + inner.depth / rows)
            yield Thing(f"{room.name}/floor.{number}", "floor", room.name, box_over(rect, -0.1, 0.0), line=room.line)
            yield Thing(f"{room.name}/ceiling.{number}", "ceiling", room.name,
                        box_over(rect, plan.height, plan.height + 0.1), line=room.line)  # fmt: skip


def _panels(plan: Plan, room: Room, wall: str, holes: list[Opening]) -> Iterator[Thing]:
    inner = interior(room)
    # North and south panels fill the corners, so that no two panels overlap.
    start, end = span(room.rect if along_x(wall) else inner, wall)
    pieces: list[tuple[float, float, float, float]] = []
    for hole in holes:
        pieces.extend(_stretch(start, hole.start, plan.height))
        if hole.y0 > 0:
            pieces.append((hole.start, hole.end, 0.0, hole.y0))
        pieces.append((hole.start, hole.end, hole.y1, plan.height))
        start = hole.end
    pieces.extend(_stretch(start, end, plan.height))
    for number, (begin, finish, y0, y1) in enumerate(pieces, 1):
        rect = strip(inner, wall, begin, finish, -WALL)
        name = f"{room.name}/wall.{wall}.{number}"
        yield Thing(name, "wall", room.name, box_over(rect, y0, y1), facing_from(wall), line=room.line)


def _stretch(start: float, end: float, height: float) -> Iterator[tuple[float, float, float, float]]:
    if end - start < 0.01:
        return
    count = max(1, ceil((end - start) / PANEL - 0.1))
    step = (end - start) / count
    for i in range(count):
        yield start + i * step, start + (i + 1) * step, 0.0, height
