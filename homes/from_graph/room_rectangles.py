"""Rooms of a graph as rectangles: side by side where a door joins them, apart everywhere."""

from collections.abc import Iterator, Mapping, Sequence

from hearth.homes.geometry import Rect
from hearth.homes.plans.home_shell import shared_wall

DOOR_WALL = 1.2
"""Metres of wall that two rooms share at least for a door between them."""
STEP = 0.4
BRANCHES = 10
"""Places tried for a room, the most compact first."""
MOST_TRIES, FEWER_TRIES = 400, 100
"""Places tried before the first door is given up, and before each further one."""

RoomPair = tuple[int, int]
FloorSize = tuple[float, float]


def packed(sizes: Mapping[int, FloorSize], doors: Sequence[RoomPair]) -> tuple[dict[int, Rect], tuple[RoomPair, ...]]:
    """Return a rectangle for every room, and the pairs whose door found no common wall.

    Args:
        sizes: (width, depth) by room; a room may be turned.
        doors: pairs of rooms that a door joins.
    """
    wanted = list(dict.fromkeys((min(pair), max(pair)) for pair in doors))
    missed: list[RoomPair] = []
    while True:
        search = _Search(sizes, wanted, FEWER_TRIES if missed else MOST_TRIES)
        found = search.place({}, search.order)
        if found is not None:
            return found, tuple(missed)
        missed.append(wanted.pop())


class _Search:
    """Depth first, room by room along the doors."""

    def __init__(self, sizes: Mapping[int, FloorSize], doors: Sequence[RoomPair], tries: int) -> None:
        self.sizes = sizes
        self.joined: dict[int, list[int]] = {room: [] for room in sizes}
        for one, other in doors:
            self.joined[one].append(other)
            self.joined[other].append(one)
        self.order = self._order()
        self.left = tries

    def _order(self) -> list[int]:
        """Each room after one it has a door to, where there is one; the one with most doors first."""
        order: list[int] = []
        by_doors = sorted(self.sizes, key=lambda room: (-len(self.joined[room]), room))
        for start in by_doors:
            waiting = [start]
            while waiting:
                room = waiting.pop(0)
                if room not in order:
                    order.append(room)
                    waiting += sorted(self.joined[room], key=by_doors.index)
        return order

    def place(self, placed: dict[int, Rect], rest: Sequence[int]) -> dict[int, Rect] | None:
        """All rooms, or None where that can't be."""
        if not rest:
            return placed
        room, *others = rest
        if not placed:
            width, depth = self.sizes[room]
            return self.place({room: Rect(0.0, 0.0, width, depth)}, others)
        for rect in sorted(self._places(room, placed), key=lambda rect: _sprawl(rect, placed))[:BRANCHES]:
            self.left -= 1
            if self.left < 0:
                return None
            found = self.place({**placed, room: rect}, others)
            if found is not None:
                return found
        return None

    def _places(self, room: int, placed: Mapping[int, Rect]) -> Iterator[Rect]:
        near = [other for other in self.joined[room] if other in placed]
        width, depth = self.sizes[room]
        for anchor in near[:1] or placed:
            for size in dict.fromkeys(((width, depth), (depth, width))):
                for rect in _beside(placed[anchor], *size):
                    apart = all(rect.inset(0.005).overlap(other) == 0 for other in placed.values())
                    if apart and all(_door_fits(rect, placed[other]) for other in near):
                        yield rect


def _beside(rect: Rect, width: float, depth: float) -> Iterator[Rect]:
    """Rectangles of a size along the four sides of another."""
    for k in range(int((rect.width + width - 2 * DOOR_WALL) / STEP) + 1):
        x = round(rect.x0 - width + DOOR_WALL + k * STEP, 2)
        yield Rect(x, rect.z1, x + width, rect.z1 + depth)
        yield Rect(x, rect.z0 - depth, x + width, rect.z0)
    for k in range(int((rect.depth + depth - 2 * DOOR_WALL) / STEP) + 1):
        z = round(rect.z0 - depth + DOOR_WALL + k * STEP, 2)
        yield Rect(rect.x1, z, rect.x1 + width, z + depth)
        yield Rect(rect.x0 - width, z, rect.x0, z + depth)


def _door_fits(one: Rect, other: Rect) -> bool:
    shared = shared_wall(one, other)
    return shared is not None and shared[2] - shared[1] >= DOOR_WALL - 0.01


def _sprawl(rect: Rect, placed: Mapping[int, Rect]) -> tuple[float, Rect]:
    """Return the floor that the home takes with a room there, its lawn included."""
    rects = [rect, *placed.values()]
    width = max(r.x1 for r in rects) - min(r.x0 for r in rects)
    depth = max(r.z1 for r in rects) - min(r.z0 for r in rects)
    return round(width * depth + (width - depth) ** 2 / 4, 3), rect
