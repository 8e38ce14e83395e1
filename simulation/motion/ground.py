"""The ground of a home with geometry: where one stands for each thing, what is near each point, where doors are."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from hearth.homes.from_graph.layout_from_boxes import measured
from hearth.homes.geometry import Rect, bottom
from hearth.homes.object_shapes import form
from hearth.homes.plans import grid_shapes
from hearth.homes.plans.home_shell import WALL, interior, strip
from hearth.homes.plans.layout import Layout
from hearth.homes.plans.walkable_floor import HEAD, REACH, Floor, gaps
from hearth.schemas.graph import Box, Spot
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY
from hearth.simulation.motion.navigation import BODY_RADIUS, Ways, digest_of
from hearth.simulation.motion.stored_distance_fields import StoredWays
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home, Memo
from hearth.simulation.world.moved_edges import INSIDE, NOTHING, ON, Moved
from hearth.simulation.world.world import World

UNTOUCHED = frozenset({ROOM_CATEGORY, CHARACTER_CATEGORY, "Floor", "Floors", "Walls", "Ceiling"})
"""Categories that passing by does not bring anybody close to."""

BESIDE = 0.3
"""Metres from its outline within which one stands for a thing without a front, where there is floor."""

MOST_WAYS = 64
"""Floors whose distance fields are kept."""


class Ground:
    """The floor of a home as its graph's boxes describe it. It knows where things are at the start.

    Attributes:
        home: the home.
        floor: its floor.
        ways: over it; homes of equal floors share them.
        rooms: index of the room that each cell of `ways` lies in, -1 for none.
    """

    def __init__(self, home: Home) -> None:
        self.home = home
        start = World.start(home)
        layout = measured(start.graph(), home.name, home.knowledge)
        self.floor: Floor = layout.floor
        self.ways = _shared(self.floor)
        numbers = [home.index[room.line] for room in layout.plan.rooms]
        here = self.floor.room[self.floor.walkable]
        self.rooms: list[int] = np.where(here < 0, -1, np.asarray(numbers)[here]).tolist()
        self._room_of = [edge_rows.room_of(start, i) for i in range(len(home))]
        self._doorways = dict(_doorways(layout, home, self.ways))
        self._stands: dict[int, tuple[int, ...]] = {}
        self._shut: dict[int, tuple[int, ...]] = {0: ()}
        self._reached: dict[tuple[int, int], int] = {}
        self._numbered: dict[int, list[int]] = {}
        self.near = Memo(self._near)

    def box(self, node: int) -> Box | None:
        """Return the box of a node at the start."""
        return self.home.node(node).box if node < len(self.home) else None

    def stands(self, node: int) -> tuple[int, ...]:
        """Return the cells of the main region at which one stands for a node as it is at the start; none without a box.

        For a thing with a front, the place nearest to it, else those next to it; for a room the one nearest to its
        middle; for a door one on either side. Cells in the node's room go before others; where none is within reach, it
        is the nearest that there is.
        """
        try:
            return self._stands[node]
        except KeyError:
            found = self._stands[node] = tuple(sorted(set(self._found_stands(node))))
            return found

    def every(self) -> list[tuple[int, ...]]:
        """Return the standing places of all nodes that have any, each once."""
        return sorted({self.stands(i) for i in indices(self.home.everything)} - {()})

    def _found_stands(self, node: int) -> list[int]:
        box = self.box(node)
        if box is None or not self.ways.main.any():
            return []
        if self.home.between[node]:
            doorway = self._doorways.get(node, ())
            return [self._nearest(box, room, doorway) for room in indices(self.home.between[node] & self.home.rooms)]
        middle = (box.center[0], box.center[2])
        if self.home.rooms >> node & 1:
            cells = self._main(node)
            return [int(cells[np.hypot(*(self.ways.points[cells] - middle).T).argmin()])]
        cells = self._main(self._room_of[node])
        far = gaps(self.ways.points[cells], box)
        yaw = self.home.node(node).yaw
        if yaw is not None:
            cells = cells[far <= max(REACH, far.min())]
            return [int(cells[np.hypot(*(self.ways.points[cells] - _front(box, yaw)).T).argmin()])]
        return list(map(int, cells[far <= max(BESIDE, far.min() + 1e-6)]))

    def _nearest(self, box: Box, room: int, doorway: tuple[int, ...]) -> int:
        """Return the cell of a room nearest to a door, but not in its doorway, which is not free while it is closed."""
        cells = self._main(room)
        rest = cells[~np.isin(cells, doorway)]
        cells = rest if len(rest) else cells
        return int(cells[gaps(self.ways.points[cells], box).argmin()])

    def _main(self, room: int) -> np.ndarray:
        """Return the cells of the main region in a room; all, where none is in it."""
        own = np.flatnonzero(self.ways.main & (np.asarray(self.rooms) == room))
        return own if len(own) else np.flatnonzero(self.ways.main)

    def shut(self, doors: int) -> tuple[int, ...]:
        """Return the cells in the doorways of doors that are closed."""
        try:
            return self._shut[doors]
        except KeyError:
            cells = sorted({cell for door in indices(doors) for cell in self._doorways.get(door, ())})
            found = self._shut[doors] = tuple(cells)
            return found

    def reached(self, cell: int, doors: int) -> int:
        """Return the nodes at whose standing places one arrives from a cell while these doors are closed."""
        region = self.regions(doors)
        key = region[cell], doors
        if key not in self._reached:
            every = range(len(self.home)) if key[0] > 0 else ()  # no way leads from a cell that is not free
            self._reached[key] = mask_of(i for i in every if any(region[s] == key[0] for s in self.stands(i)))
        return self._reached[key]

    def joined(self, one: int, other: int, doors: int) -> bool:
        """Return whether a way leads from one cell to another while these doors are closed."""
        region = self.regions(doors)
        return region[one] == region[other] > 0

    def regions(self, doors: int) -> list[int]:
        """Return each cell's region, from 1, while some doors are closed; -1 of a cell that is not free."""
        if doors not in self._numbered:
            free = self.floor.walkable.copy()
            free[tuple(self.ways.cells[list(self.shut(doors))].T)] = False
            found = grid_shapes.regions(free)[self.floor.walkable]
            found[found == 0] = -1
            self._numbered[doors] = found.tolist()
        return self._numbered[doors]

    def _near(self, cell: int) -> int:
        return int.from_bytes(self._packed[cell].tobytes(), "little")

    @cached_property
    def _packed(self) -> np.ndarray:
        """Bits (cells, nodes): what stands within reach of a cell, in its room, and not in something."""
        cells = np.zeros((len(self.ways.cells), len(self.home)), bool)
        here = np.asarray(self.rooms)
        inside: dict[int, np.ndarray] = {}
        for i in indices(self.home.everything):
            node = self.home.node(i)
            if node.box is None or node.category in UNTOUCHED or bottom(node.box) > HEAD:
                continue
            rooms = self.home.between[i] & self.home.rooms or (1 << self._room_of[i] if self._room_of[i] >= 0 else 0)
            if not self.home.inside[i] & ~self.home.rooms:
                if rooms not in inside:
                    inside[rooms] = np.flatnonzero(np.isin(here, list(indices(rooms))))
                among = inside[rooms]
                cells[among, i] = gaps(self.ways.points[among], node.box) <= REACH
        return np.packbits(cells, axis=1, bitorder="little")


def _doorways(layout: Layout, home: Home, ways: Ways) -> list[tuple[int, tuple[int, ...]]]:
    """Return the cells between the walls of the doorways by the index of their door."""
    found: dict[int, set[int]] = {}
    for hole in layout.shell.openings:
        if hole.door is not None:
            inner = interior(layout.plan.room(hole.room))
            gap = strip(inner, hole.wall, hole.start - 0.1, hole.end + 0.1, -2 * WALL).inset(-0.001)
            found.setdefault(home.index[hole.door.line], set()).update(_cells(gap, ways))
    return [(door, tuple(sorted(cells))) for door, cells in found.items()]


def _cells(rect: Rect, ways: Ways) -> list[int]:
    x, z = ways.points.T
    inside = (x >= rect.x0) & (x <= rect.x1) & (z >= rect.z0) & (z <= rect.z1)
    return list(map(int, np.flatnonzero(inside)))


def _front(box: Box, yaw: float) -> Spot:
    angle = math.radians(yaw)
    out = max(box.size[0] * abs(math.sin(angle)), box.size[2] * abs(math.cos(angle))) / 2 + BODY_RADIUS
    return (box.center[0] + math.sin(angle) * out, box.center[2] + math.cos(angle) * out)


def distance_to(box: Box, point: Spot) -> float:
    """Metres over the floor from a point to a box's outline; 0 within it."""
    return float(gaps(np.asarray([point]), box)[0])


_WAYS: dict[str, Ways] = {}


def _shared(floor: Floor) -> Ways:
    """Return the ways over a floor, the same for floors that are equal."""
    key = digest_of(floor)
    if key not in _WAYS:
        if len(_WAYS) >= MOST_WAYS:
            _WAYS.pop(next(iter(_WAYS)))
        ways = _WAYS[key] = Ways(floor)
        ways.stored = StoredWays(ways).field
    return _WAYS[key]


class Here:
    """The ground of a home, and which nodes are elsewhere than when it was measured.

    Attributes:
        ground: of the home, or of the one that it was derived from.
        elsewhere: at the home's start: nodes in or on others than when measured, and those without a box.
    """

    def __init__(self, ground: Ground, home: Home) -> None:
        self.ground = ground
        same, base = range(len(ground.home)), ground.home
        changed = (i for i in same if base.on[i] != home.on[i] or base.inside[i] != home.inside[i] or not ground.box(i))
        self.elsewhere = mask_of(changed) | home.everything & -1 << len(base)
        self._last = NOTHING, self.elsewhere
        self._standing: tuple[Moved, dict[int, int], dict[tuple[int, int], int]] = NOTHING, {}, {}

    def displaced(self, world: World) -> int:
        """Return the nodes that are elsewhere now: a removed thing is, and a returned one is not."""
        moved, found = self._last
        if world.moved is not moved:
            found = self.elsewhere
            base = self.ground.home
            for i in indices(_touched(world.moved) & (1 << len(base)) - 1):
                there = base.on[i] == edge_rows.on(world, i) and base.inside[i] == edge_rows.inside(world, i)
                found = found & ~(1 << i) if there and self.ground.box(i) else found | 1 << i
            self._last = world.moved, found
        return found

    def standing(self, world: World) -> dict[int, int]:
        """Return the known places of displaced nodes (see `positions`), for as long as nothing moves."""
        return self._known(world)[1]

    def among(self, world: World) -> dict[tuple[int, int], int]:
        """Return the displaced nodes known to be at some places, for as long as nothing moves."""
        return self._known(world)[2]

    def _known(self, world: World) -> tuple[Moved, dict[int, int], dict[tuple[int, int], int]]:
        if self._standing[0] is not world.moved:
            self._standing = world.moved, {}, {}
        return self._standing


def _touched(moved: Moved) -> int:
    return moved.on | moved.inside | mask_of({key >> 3 for key in moved.extra if key & 7 in (ON, INSIDE)})


def ground_of(home: Home) -> Here | None:
    """Return the ground of a home; None where its rooms have no boxes. A home derived from another shares its ground,
    unless something that stood on the floor is gone.
    """
    known: dict[str, Here | None] = home.worked_out
    try:
        return known["ground"]
    except KeyError:
        pass
    line = [home]
    while (derived := line[-1].base) is not None and "ground" not in derived[0].worked_out:
        line.append(derived[0])
    for each in reversed(line):  # thousands of homes may be derived in a row: no recursion
        each.worked_out["ground"] = _found(each)
    return known["ground"]


def _found(home: Home) -> Here | None:
    """Return the ground of a home; that of the home it was derived from is known."""
    base: Here | None = None if home.base is None else home.base[0].worked_out["ground"]
    if base is not None and not _gone(home, base.ground):
        return Here(base.ground, home)
    rooms = [home.node(i) for i in indices(home.rooms & home.everything)]
    return Here(Ground(home), home) if rooms and all(room.box is not None for room in rooms) else None


def _gone(home: Home, ground: Ground) -> bool:
    gone = home.absent & ~ground.home.absent & (1 << len(ground.home)) - 1
    shapes = (form(home.classes[i], home.knowledge) for i in indices(gone))
    return any(shape is not None and shape.mount == "floor" for shape in shapes)
