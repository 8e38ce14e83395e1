"""Records that kernels read and write: of a home, of a task and of a world, padded to the sizes of a bucket.

Shapes of nested arrays are part of a type, so kernels are compiled once a bucket; hence few buckets.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

ADDED = 64
"""Nodes that a task may add to its home, agents included: one word of a set."""

MOST_AGENTS = 2
"""Agents of one world. Records have room for all of them, so that kernels are the same for one and for two."""

MOST_SETS = 40
"""Sets of nodes that never change, of one task."""

MOST_LITERALS = 12
"""Literals of one goal."""

MOST_DOORS = 8
"""Doors of one home; tables have a row for each set of closed doors."""


class Bucket(NamedTuple):
    """The sizes to which homes are padded.

    Attributes:
        name: for messages.
        words: words of 64 nodes of a home, without those that a task adds.
        doors, rooms, cells: of a home.
        grid: cells of a floor's grid along each axis, border included.
        regions: parts that closed doors divide the floor into, and one for the cells of closed doorways.
        movable: things of a home that can be grabbed.
        targets: different sets of cells at which one stands for something.
        stands: cells of all these sets together.
    """

    name: str
    words: int
    doors: int
    rooms: int
    cells: int
    grid: int
    regions: int
    movable: int
    targets: int
    stands: int

    @property
    def width(self) -> int:
        """Words of a set of nodes."""
        return self.words + 1

    @property
    def nodes(self) -> int:
        """Nodes that a set has room for."""
        return 64 * self.width

    @property
    def first_added(self) -> int:
        """Index of the first node that a task adds."""
        return 64 * self.words


BUCKETS = (
    Bucket("small", 6, 4, 6, 4608, 144, 16, 224, 256, 6400),
    Bucket("medium", 9, 7, 8, 6144, 152, 16, 288, 352, 9216),
    Bucket("large", 11, MOST_DOORS, 10, 8192, 176, 24, 352, 448, 12288),
)
"""From small to large; a batch takes the first that has room for all its homes."""


def home_type(b: Bucket) -> np.dtype[np.void]:
    """Return the record of a home: all that never changes in it, whatever the task."""
    n, sets, w = 64 * b.words, 1 << b.doors, b.width
    every = b.nodes
    return np.dtype(
        [
            # By node: number of its room, its door, its slot as a movable thing; where it stands; seat limits.
            ("room_number", "i2", (every,)), ("door_number", "i2", (every,)), ("slot", "i2", (every,)),
            ("on", "i2", (every,)), ("inside", "i2", (every,)), ("room", "i2", (every,)),
            ("measured", "i2", (every, 3)), ("box", "f8", (every, 3)), ("target", "i2", (every,)),
            ("limits", "i2", (every, 2)),
            # By node, as sets: edges between things at the start.
            ("close", "u8", (n, w)), ("bears", "u8", (n, w)), ("contents", "u8", (n, w)), ("facing", "u8", (n, w)),
            # By room.
            ("room_node", "i2", (b.rooms,)), ("room_nodes", "u8", (b.rooms, w)), ("room_doors", "u8", (b.rooms, w)),
            ("between", "i4", (b.doors,)), ("rooms", "i8"), ("nodes", "i8"),
            # By room and closed doors: rooms that are reached, rooms that no closed door keeps from it, and things.
            ("reached_rooms", "i4", (b.rooms, sets)), ("open_rooms", "i4", (b.rooms, sets)),
            ("walkable", "u8", (b.rooms, sets, w)),
            # The floor: its grid, and by cell the middle, the room, the things near it, the doors in whose way it is.
            ("origin", "f8", (3,)), ("grid", "i2", (b.grid, b.grid)), ("middle", "f8", (b.cells, 2)), ("cells", "i8"),
            ("cell_room", "i2", (b.cells,)), ("near", "u8", (b.cells, w)), ("main", "u1", (b.cells,)),
            ("shut", "i4", (b.cells,)), ("region", "i2", (sets, b.cells)), ("reached", "u8", (sets, b.regions, w)),
            ("first_stand", "i4", (b.targets + 1,)), ("stands", "i2", (b.stands,)),
        ],
        align=True,
    )  # fmt: skip


def world_type(b: Bucket) -> np.dtype[np.void]:
    """Return the record of a world: all that changes in it."""
    w, agents = b.width, MOST_AGENTS
    return np.dtype(
        [
            ("states", "u8", (8, w)),  # of things; the agents' own are `posture`
            ("lifted", "u8", (w,)),  # things whose edges at the start no longer count
            ("carried", "u8", (w,)),  # things whose FACING edges do not count either
            ("fresh", "u8"),  # added things that are CLOSE to those of `task.added_close`
            ("rows", "u8", (agents, 5, w)),  # the agents' own edges: `CLOSE` ... `CONTENTS` of `kernels.set_words`
            ("pose", "f8", (agents, 3)), ("stride", "f8", (agents,)),
            ("seed", "u8"), ("task", "i4"), ("tick", "i4"), ("episode", "i4"), ("total", "i4"), ("waiting", "i4"),
            ("place", "i2", (b.movable + ADDED, 4)),  # of lifted things: ON, in, room, CLOSE to
            ("room", "i2", (agents,)), ("hands", "i2", (agents, 2)), ("last", "i4", (agents, 2)),
            ("counts", "i2", (MOST_LITERALS,)), ("posture", "u1", (agents,)), ("possible", "u1", (agents,)),
            ("met", "u1"), ("restated", "u1"),
        ],
        align=True,
    )  # fmt: skip


def task_type(b: Bucket) -> np.dtype[np.void]:
    """Return the record of a task: its home, its sets, its goal and the world in which it starts."""
    w = b.width
    return np.dtype(
        [
            ("home", "i4"), ("agents", "i8"), ("literals", "i4"), ("agent", "i2", (MOST_AGENTS,)),
            ("added_limits", "i2", (ADDED, 2)), ("added_close", "u8", (ADDED, w)), ("sets", "u8", (MOST_SETS, w)),
            ("kind", "i2", (MOST_LITERALS,)), ("wanted", "i2", (MOST_LITERALS,)),
            ("rewarded", "i2", (MOST_LITERALS,)), ("negated", "u1", (MOST_LITERALS,)),
            ("by_target", "u1", (MOST_LITERALS,)),
            ("subjects", "u8", (MOST_LITERALS, w)), ("targets", "u8", (MOST_LITERALS, w)),
            ("start", world_type(b)),
        ],
        align=True,
    )  # fmt: skip
