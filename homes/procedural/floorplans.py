"""Procedural floor plans: two bands of rooms along a hall, turned and mirrored; every room opens onto the hall."""

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from random import Random
from typing import Any

from hearth.homes.geometry import Rect
from hearth.homes.plans.home_shell import WALL, outer_walls, shared_wall, span
from hearth.homes.plans.plan import OUTSIDE, Doorway, Plan, Room, Window
from hearth.schemas.yaml_limits import packaged

LEAST_ROOMS, MOST_ROOMS = 3, 9

LEAST_SHARED = 1.2
"""Metres of wall that a room shares with the hall at least, for its door."""


@lru_cache(maxsize=1)
def _tables() -> Any:
    return packaged("hearth.data_raw", "floor_plans.yaml")


def floor_plan(name: str, rooms: int, rng: Random) -> Plan:
    """Return a home's rooms, doors and windows, without furniture.

    Args:
        name: of the home.
        rooms: how many, from `LEAST_ROOMS` to `MOST_ROOMS`.
        rng: decides everything.
    """
    classes = rng.choice(_tables()["rooms"][rooms])
    hall, others = classes[0], list(classes[1:])
    rng.shuffle(others)
    rects = _bands(hall, others, rng)
    turn = rng.randrange(4)
    placed = _moved([_turned(rect, turn) for rect in rects])
    names = _names([hall, *others])
    built = [
        Room(n, c, rect, line=i) for i, (n, c, rect) in enumerate(zip(names, [hall, *others], placed, strict=True), 1)
    ]
    doors = _doors(built, rng)
    furnished = tuple(replace(room, windows=_windows(room, built, doors, rng)) for room in built)
    height = round(rng.uniform(2.45, 2.75), 2)
    return Plan(name, furnished, tuple(doors), f"Generated: {rooms} rooms.", height, rng.choice(names))


def _bands(hall: str, others: Sequence[str], rng: Random) -> list[Rect]:
    """Return the hall and the rooms on both its long sides (on one, where the hall is a room to live in)."""
    table, corridor = _tables(), hall == "entrance_hall"
    depth = round(rng.uniform(*table["depth"]["corridor" if corridor else "hub"]), 1)
    half = (len(others) + 1) // 2 if corridor else len(others) // 3
    sides: list[list[Rect]] = []
    for side, classes in ((-1, others[:half]), (1, others[half:])):
        x, band = 0.0, []
        for class_name in classes:
            width = round(rng.uniform(*table["width"][class_name]), 1)
            reach = round(rng.uniform(*table["depth"]["room"]), 1)
            z0, z1 = (depth, depth + reach) if side > 0 else (-reach, 0.0)
            band.append(Rect(x, z0, x + width, z1))
            x += width
        sides.append(band)
    length = max(band[-1].x1 for band in sides if band)
    # The last room may reach beyond the hall's end, as far as its door still finds a wall.
    beyond = min(band[-1].width for band in sides if band) - LEAST_SHARED
    shorter = round(rng.uniform(0.0, max(0.0, min(beyond, 1.5 if corridor else 1.0))), 1)
    length = length - shorter if corridor else max(6.0, length - shorter)
    return [Rect(0.0, 0.0, length, depth), *sides[0], *sides[1]]


def _turned(rect: Rect, turn: int) -> Rect:
    """As drawn, mirrored, on its side, or both."""
    x0, z0, x1, z1 = rect
    return {0: rect, 1: Rect(-x1, z0, -x0, z1), 2: Rect(z0, x0, z1, x1), 3: Rect(-z1, x0, -z0, x1)}[turn]


def _moved(rects: Sequence[Rect]) -> list[Rect]:
    """With the south-west corner at (0, 0), to a tenth of a metre."""
    x, z = min(rect.x0 for rect in rects), min(rect.z0 for rect in rects)
    return [Rect(*(round(v, 1) for v in (r.x0 - x, r.z0 - z, r.x1 - x, r.z1 - z))) for r in rects]


def _names(classes: Sequence[str]) -> list[str]:
    """Return the classes, those that stand there again with a number."""
    counts = (classes[: number + 1].count(name) for number, name in enumerate(classes))
    return [name if count == 1 else f"{name}_{count}" for name, count in zip(classes, counts, strict=True)]


def _doors(rooms: Sequence[Room], rng: Random) -> list[Doorway]:
    """From the hall to every room, and from the hall to the outside at one end."""
    hall, *others = rooms
    doors = [_front_door(hall, others, rng)]
    for room in others:
        shared = shared_wall(hall.rect, room.rect)
        if shared is None:
            continue
        _, start, end = shared
        open_plan = room.class_name in ("living_room", "kitchen", "dining_room") and rng.random() < 0.5
        width = 1.2 if open_plan and end - start > 1.6 else 0.8 if room.class_name == "bathroom" else 0.9
        low, high = WALL + 0.02, end - start - WALL - 0.02 - width
        at = low if rng.random() < 0.4 else high if rng.random() < 0.6 else rng.uniform(low, high)
        hinge = "low" if open_plan or at < (low + high) / 2 else "high"
        doors.append(Doorway((hall.name, room.name), "", round(at, 2), width, not open_plan,
                             "" if open_plan else room.name, hinge, line=1000 + len(doors)))  # fmt: skip
    return doors


def _front_door(hall: Room, others: Sequence[Room], rng: Random) -> Doorway:
    wall = rng.choice(outer_walls(hall.rect, [other.rect for other in others]) or ["south"])
    low, high = span(hall.rect, wall)
    at = round(rng.uniform(0.2, max(0.2, high - low - 1.2)), 2)
    return Doorway((hall.name, OUTSIDE), wall, at, 0.95, True, hall.name, rng.choice(("low", "high")), line=1000)


def _windows(room: Room, rooms: Sequence[Room], doors: Sequence[Doorway], rng: Random) -> tuple[Window, ...]:
    """In the middle of outer walls; small and high in bathrooms, none in corridors, not where the front door is."""
    if room.class_name == "entrance_hall":
        return ()
    taken = [door.wall for door in doors if door.rooms == (room.name, OUTSIDE)]
    walls = outer_walls(room.rect, [other.rect for other in rooms if other is not room])
    outer = [wall for wall in walls if wall not in taken]
    rng.shuffle(outer)
    if room.class_name == "bathroom":
        return tuple(Window(wall, None, 0.6, 0.6, 1.5) for wall in outer[:1])
    found = []
    for wall in outer[: rng.choice((1, 1, 2))]:
        low, high = span(room.rect, wall)
        width = round(min(rng.uniform(1.1, 1.8), 0.45 * (high - low)), 1)
        high_sill = room.class_name in ("kitchen", "dining_room")
        sill, height = (1.15, 1.05) if high_sill else (0.9, 1.2)
        found.append(Window(wall, None, width, height, sill, curtains=2))
    return tuple(found)
