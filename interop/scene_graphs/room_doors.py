"""Walls that rooms of a file share, and the doors in them that the file leaves out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from math import hypot
from typing import NamedTuple

from hearth.homes.geometry import Rect, bottom, box_over, facing_from, footprint
from hearth.homes.plans.home_shell import DOOR_HEIGHT, WALL, shared_wall, strip
from hearth.homes.plans.walkable_floor import HEAD
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY

THICKEST_WALL = 0.7
"""Metres between the floors of two rooms that have a wall in common."""

DEEPEST_OVERLAP = 0.6
"""Metres by which the floors of two rooms may overlap along one axis and still have a wall in common."""

WIDTH, NARROWEST = 0.9, 0.6
"""Metres: usual width of a door, and the least."""

NEAR_DOOR = 0.5
"""Metres between a door of the file and the wall that it belongs to."""

STEP = 0.1
"""Metres between the places in a wall that are tried for a door."""

FREE = 0.6
"""Metres before a door, on either side, that furniture should leave free."""


def with_walls_between(
    rooms: Mapping[int, Rect], farthest: float = THICKEST_WALL, deepest: float = DEEPEST_OVERLAP
) -> dict[int, Rect] | None:
    """Return floors of rooms with a wall of ours between any two that face each other; None where they overlap.

    Args:
        rooms: floors as the file has them.
        farthest: metres of a gap that is closed.
        deepest: metres of an overlap along one axis that is divided between two rooms.
    """
    found = dict(rooms)
    fixed: set[tuple[int, int]] = set()
    pairs = sorted(combinations(rooms, 2), key=lambda pair: max(_gaps(rooms[pair[0]], rooms[pair[1]])))
    for pair in pairs:
        gaps = _gaps(found[pair[0]], found[pair[1]])
        axis = 0 if gaps[0] >= gaps[1] else 1  # along it the two floors lie farther apart
        if gaps[axis] < -deepest:
            return None
        if gaps[axis] <= farthest and gaps[1 - axis] < 0:
            low, high = sorted(pair, key=lambda room: found[room].center[axis])
            if not _is_between(found[low], found[high], [found[room] for room in rooms if room not in pair]):
                found[low], found[high] = _moved_apart(found[low], found[high], axis, (
                    (low, axis + 2) in fixed, (high, axis) in fixed))  # fmt: skip
                fixed |= {(low, axis + 2), (high, axis)}
    return found if all(rect.width > 0 and rect.depth > 0 for rect in found.values()) else None


def _gaps(one: Rect, other: Rect) -> tuple[float, float]:
    """Return how far two rectangles lie apart along x and along z; negative where they overlap."""
    return max(one.x0, other.x0) - min(one.x1, other.x1), max(one.z0, other.z0) - min(one.z1, other.z1)


def _is_between(one: Rect, other: Rect, others: Sequence[Rect]) -> bool:
    """Return whether another room lies in the gap between two that face each other."""
    x0, x1 = sorted((max(one.x0, other.x0), min(one.x1, other.x1)))
    z0, z1 = sorted((max(one.z0, other.z0), min(one.z1, other.z1)))
    return any(Rect(x0, z0, x1, z1).overlap(each) > 0 for each in others)


def _moved_apart(low: Rect, high: Rect, axis: int, fixed: tuple[bool, bool] = (False, False)) -> tuple[Rect, Rect]:
    """Return two rectangles whose sides that face each other are a wall apart, halfway between where they were.

    Args:
        low, high: the rectangle that ends there, and the one that begins there.
        axis: 0 for x, 1 for z.
        fixed: whether the side of each stays, as it is that of another wall.
    """
    if fixed[0] and fixed[1]:
        return low, high
    middle = low[axis + 2] + WALL if fixed[0] else high[axis] - WALL if fixed[1] else (low[axis + 2] + high[axis]) / 2
    end, start = round(middle - WALL, 4), round(middle + WALL, 4)
    return (
        (low._replace(x1=end), high._replace(x0=start))
        if axis == 0
        else (low._replace(z1=end), high._replace(z0=start))
    )


class Doors(NamedTuple):
    """A graph whose doors are between rooms; the doors of the file among them, and those that were made, in words."""

    graph: EnvironmentGraph
    own: list[str]
    made: list[str]


def with_doors(graph: EnvironmentGraph, knowledge: Knowledge) -> Doors:
    """Return a graph whose rooms have boxes with doors that join its rooms.

    A door of the file is between the two rooms in whose wall it is. Rooms that are then still apart get doorways in the
    walls that they share, where most floor before the doorway is free.
    """
    boxes = {node.id: node.box for node in graph.nodes if node.category == ROOM_CATEGORY and node.box is not None}
    rooms = {room: footprint(box) for room, box in boxes.items()}
    if len(rooms) < 2:
        return Doors(graph, [], [])
    names = {node.id: node.class_name for node in graph.nodes}
    standing = [footprint(n.box) for n in graph.nodes if n.box is not None and _is_in_the_way(n, n.box, knowledge)]
    walls = list(_walls(rooms))
    between: dict[int, list[int]] = {}
    for edge in graph.edges:
        if edge.relation == "BETWEEN" and edge.target in rooms:
            between.setdefault(edge.source, []).append(edge.target)
    own: dict[int, Wall] = {}
    for node in graph.nodes if not between else ():
        wall = _wall_of(footprint(node.box), rooms, walls) if node.class_name in DOORS and node.box else None
        if wall is not None:
            own[node.id] = wall
    joined = [wall[:2] for wall in own.values()] + [(pair[0], pair[1]) for pair in between.values() if len(pair) == 2]
    found = _missing(rooms, walls, joined, standing) if own or not between else []
    edges = [Edge(door, "BETWEEN", room) for door, wall in own.items() for room in wall[:2]]
    first, low = max(node.id for node in graph.nodes) + 1, min(bottom(box) for box in boxes.values())
    nodes = []
    for number, ((one, other, side, _, _), (start, end)) in enumerate(found, first):
        hole = strip(rooms[one], side, start, end, -2 * WALL)
        box = box_over(hole, low, low + DOOR_HEIGHT)
        nodes.append(Node(number, "doorjamb", "Doors", box=_rounded(box), yaw=facing_from(side)))
        edges += [Edge(number, "INSIDE", one), Edge(number, "BETWEEN", one), Edge(number, "BETWEEN", other)]
    made = replace(graph, nodes=(*graph.nodes, *nodes), edges=(*graph.edges, *edges))
    words = [[f"{names[wall[0]]} and {names[wall[1]]}" for wall in each] for each in (own.values(), dict(found))]
    return Doors(made, *words)


DOORS = ("door", "doorjamb")
"""Classes of doors of a file."""

Wall = tuple[int, int, str, float, float]
"""Two rooms, the side of the first that faces the second, and from where to where they share it."""

Spot = tuple[float, float]
"""From where to where a door is in a wall."""


def _is_in_the_way(node: Node, box: Box, knowledge: Knowledge) -> bool:
    """Return whether a person has to walk around a thing."""
    if node.category == ROOM_CATEGORY or node.class_name in (*DOORS, CHARACTER_CLASS):
        return False
    return bottom(box) < HEAD and not knowledge.has(node.class_name, "GRABBABLE")


def _walls(rooms: Mapping[int, Rect]) -> Iterator[Wall]:
    """Yield the walls between rooms that are long enough for a door."""
    for one, other in combinations(rooms, 2):
        gaps = _gaps(rooms[one], rooms[other])
        axis = 0 if gaps[0] >= gaps[1] else 1
        if not -DEEPEST_OVERLAP < gaps[axis] <= THICKEST_WALL:
            continue
        low, high = sorted((one, other), key=lambda room: rooms[room].center[axis])
        rects = [rect.inset(-WALL) for rect in _moved_apart(rooms[low], rooms[high], axis)]
        found = shared_wall(*rects)
        if found is not None and found[2] - found[1] - 4 * WALL >= NARROWEST:
            yield low, high, found[0], found[1] + 2 * WALL, found[2] - 2 * WALL


def _wall_of(door: Rect, rooms: Mapping[int, Rect], walls: Sequence[Wall]) -> Wall | None:
    """Return the wall that a door of the file is in, or stands next to; None where it is in none."""
    x, z = door.center

    def away(wall: Wall) -> float:
        one, _, side, start, end = wall
        line = strip(rooms[one], side, start, end, -2 * WALL)
        return hypot(max(line.x0 - x, x - line.x1, 0.0), max(line.z0 - z, z - line.z1, 0.0))

    best = min(walls, key=away, default=None)
    return best if best is not None and away(best) <= NEAR_DOOR else None


def _missing(rooms: Mapping[int, Rect], walls: Sequence[Wall], joined: Sequence[tuple[int, int]],
             standing: Sequence[Rect]) -> list[tuple[Wall, Spot]]:  # fmt: skip
    """Return a door in the longest walls that join rooms which no door joins yet."""
    part = {room: room for room in rooms}
    found: list[tuple[Wall, Spot]] = []

    def join(one: int, other: int) -> bool:
        old, new = part[one], part[other]
        part.update({room: new for room in part if part[room] == old})
        return old != new

    for one, other in joined:
        join(one, other)
    for wall in sorted(walls, key=lambda wall: wall[3] - wall[4]):
        if join(wall[0], wall[1]):
            found.append((wall, _freest(rooms[wall[0]], wall, standing)))
    return found


def _freest(room: Rect, wall: Wall, standing: Sequence[Rect]) -> Spot:
    """Return the spot of a wall before which the least furniture stands, the nearest to the middle of the wall."""
    _, _, side, start, end = wall
    width = min(WIDTH, end - start)
    starts = [start + STEP * number for number in range(int((end - start - width) / STEP + 1.001))]

    def cost(begin: float) -> tuple[float, float]:
        zone = strip(room, side, begin, begin + width, FREE)
        behind = strip(room, side, begin, begin + width, -2 * WALL - FREE)
        taken = sum(zone.overlap(each) + behind.overlap(each) for each in standing)
        return round(float(taken), 3), abs(begin + width / 2 - (start + end) / 2)

    best = min(starts, key=cost)
    begin = round(best, 4)
    return begin, round(begin + width, 4)


def _rounded(box: Box) -> Box:
    (x, y, z), (w, h, d) = ((round(a, 4), round(b, 4), round(c, 4)) for a, b, c in box)
    return Box((x, y, z), (w, h, d))
