"""The floor that can be walked: what furniture leaves free, as an occupancy grid."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hearth.homes.geometry import Rect, bottom, footprint
from hearth.homes.plans import grid_shapes
from hearth.homes.plans.home_shell import WALL, Shell, Thing, interior, strip
from hearth.homes.plans.plan import Plan
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box
from hearth.schemas.numbers import LONGEST_HOME

CELL = 0.1
"""Metres a cell."""
BODY = 0.2
"""Half the width of someone walking."""
HEAD = 1.8
"""Agents walk under objects that hang higher than this, metres."""
REACH = 0.9
"""Metres from a thing's outline within which it can be handled."""


@dataclass(frozen=True, eq=False)
class Floor:
    """An occupancy grid over a whole home.

    Attributes:
        origin: (x, z) of the grid's south-west corner, metres.
        cell: metres a cell.
        free: bool (columns, rows), x first: nothing stands there.
        walkable: bool, same shape: free, and wide enough around for someone to stand there.
        room: int16, same shape: number of the room in the plan, -1 outside rooms.
    """

    origin: tuple[float, float]
    cell: float
    free: np.ndarray
    walkable: np.ndarray
    room: np.ndarray

    def center(self, i: int, j: int) -> tuple[float, float]:
        """Return the middle of a cell as (x, z)."""
        return self.origin[0] + (i + 0.5) * self.cell, self.origin[1] + (j + 0.5) * self.cell

    def index(self, x: float, z: float) -> tuple[int, int]:
        """Return the cell a point lies in; may lie beyond the grid."""
        return int((x - self.origin[0]) // self.cell), int((z - self.origin[1]) // self.cell)

    def regions(self) -> np.ndarray:
        """Int array: walkable cells that reach each other share a number from 1; others are 0."""
        return grid_shapes.regions(self.walkable)

    @cached_property
    def main(self) -> np.ndarray:
        """Return bool, same shape: the largest region; a character elsewhere on the floor can't leave its pocket."""
        numbered = self.regions()
        sizes = np.bincount(numbered.ravel())
        sizes[0] = 0
        return np.asarray((numbered > 0) & (numbered == sizes.argmax()))

    def distance(self, box: Box, room: int = -1) -> float:
        """Metres from a box's outline to the nearest main cell, in one room if its number is given; inf without any."""
        cells = np.argwhere(self.main if room < 0 else self.main & (self.room == room))
        return float(gaps(np.asarray(self.origin) + (cells + 0.5) * self.cell, box).min(initial=np.inf))


def gaps(points: np.ndarray, box: Box) -> np.ndarray:
    """Metres over the floor from points (n, 2) to a box's outline; 0 within it."""
    (x, _, z), (width, _, depth) = box
    outside = np.abs(points - (x, z)) - (width / 2, depth / 2)
    return np.asarray(np.hypot(*np.maximum(outside, 0.0).T))


def stands_on_floor(thing: Thing) -> bool:
    """Return whether a thing is in the way of someone walking."""
    if thing.mount in ("shell", "flat", "door", "ceiling", "item", "sunk"):
        return False
    return bottom(thing.box) < HEAD and thing.class_name != "curtain" and (
        thing.mount == "floor" or min(thing.box.size[0], thing.box.size[2]) > 0.1
    )  # fmt: skip


LONGEST = LONGEST_HOME
"""Metres of a home at most; the name in 0.2."""


def check_extent(width: float, depth: float) -> None:
    """Refuse a home whose floor is larger than any, before a grid of it takes the memory.

    Raises:
        HearthError: BAD_GRAPH.
    """
    if not (0 < width <= LONGEST_HOME and 0 < depth <= LONGEST_HOME):
        message = f"a home of {width:g} by {depth:g} metres"
        remedy = f"boxes of rooms in metres, up to {LONGEST_HOME:g} in all"
        raise HearthError.of(Code.BAD_GRAPH, message, suggestion=remedy)


def grid(plan: Plan, shell: Shell, things: Iterable[Thing], cell: float = CELL) -> Floor:
    """Return the floor of a furnished plan."""
    x0, z0, x1, z1 = Rect.over(room.rect for room in plan.rooms)
    check_extent(x1 - x0, z1 - z0)
    shape = (round((x1 - x0) / cell + 0.499), round((z1 - z0) / cell + 0.499))

    def part(low: float, high: float, size: int) -> slice:
        first, last = int(low / cell + 0.5 - 1e-6), int(high / cell + 0.5 - 1e-6)
        return slice(max(0, min(first, size)), max(0, min(last, size)))

    def cells(rect: Rect) -> tuple[slice, slice]:
        """Return the cells whose middles lie in a rectangle."""
        return part(rect.x0 - x0, rect.x1 - x0, shape[0]), part(rect.z0 - z0, rect.z1 - z0, shape[1])

    free = np.zeros(shape, bool)
    room_of = np.full(shape, -1, np.int16)
    for number, room in enumerate(plan.rooms):
        room_of[cells(room.rect)] = number
        free[cells(interior(room))] = True
    for opening in shell.openings:
        if opening.door is not None:
            inner = interior(plan.room(opening.room))
            hole = strip(inner.inset(-0.001), opening.wall, opening.start, opening.end, -WALL - cell)
            free[cells(hole)] |= room_of[cells(hole)] >= 0
    for thing in things:
        if stands_on_floor(thing):
            free[cells(footprint(thing.box))] = False
    return Floor((x0, z0), cell, free, grid_shapes.eroded(free, round(BODY / cell)), room_of)
