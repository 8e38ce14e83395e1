"""The constants of a home as a record, each read from Hearth's own functions: nothing here repeats a rule."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.actions import doors
from hearth.simulation.arrays.record_types import ADDED, BUCKETS, Bucket, home_type
from hearth.simulation.motion.ground import Ground, ground_of
from hearth.simulation.observation import reach
from hearth.simulation.observation.containment import in_room
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import NOTHING
from hearth.simulation.world.states import CLOSED
from hearth.simulation.world.world import World

NEVER = -2
"""A place at which nothing can be: so a node that was not measured is never as measured."""


class HomeShape:
    """A home with geometry, and the indices that its nodes have in records.

    Attributes:
        home: without the nodes that tasks add.
        here: its ground.
        ground: the same without a task.
        targets: different sets of cells at which one stands for something.
        doors, rooms, movable: indices of nodes, ascending.
    """

    def __init__(self, home: Home) -> None:
        here = ground_of(home)
        if here is None:
            raise _unfit(home, "has no geometry", "a home with boxes, such as ours")
        self.home, self.here = home, here
        self.ground: Ground = here.ground
        self.targets = self.ground.every()
        self.doors = list(indices(home.doors & home.everything))
        self.rooms = list(indices(home.rooms & home.everything))
        self.movable = list(indices(home.able("Grab") & home.everything & ~home.characters))
        _check(home)

    def needs(self) -> dict[str, int]:
        """Return the sizes that a bucket must have at least."""
        ways = self.ground.ways
        closed = sum(1 << door for door in self.doors)
        return {
            "words": -(-len(self.home) // 64),
            "doors": len(self.doors),
            "rooms": len(self.rooms),
            "cells": len(ways.cells),
            "grid": max(ways.number.shape) + 2,
            "regions": 1 + max(max(self.ground.regions(each)) for each in (0, closed)),
            "movable": len(self.movable),
            "targets": len(self.targets),
            "stands": sum(map(len, self.targets)),
        }


def bucket_of(shapes: Sequence[HomeShape]) -> Bucket:
    """Return the first bucket that has room for all homes.

    Raises:
        HearthError: BAD_ARGUMENT: one of them is too large.
    """
    for bucket in BUCKETS:
        if all(size <= getattr(bucket, name) for shape in shapes for name, size in shape.needs().items()):
            return bucket
    most = BUCKETS[-1]
    for shape in shapes:
        for name, size in shape.needs().items():
            if size > getattr(most, name):
                message = f"is too large for arrays: {size:,} {name}, where there is room for {getattr(most, name):,}"
                raise _unfit(shape.home, message, "Env or TextHomes, which take homes of any size")
    raise AssertionError(most)


def words(mask: int, first: int, bucket: Bucket) -> np.ndarray:
    """Return a set as words.

    Args:
        mask: of nodes; those from `first` on are added ones, which have a word of their own.
        first: how many nodes the home has.
        bucket: the sizes.
    """
    low = mask & (1 << first) - 1
    whole = low | (mask >> first) << bucket.first_added
    return np.frombuffer(whole.to_bytes(8 * bucket.width, "little"), np.uint64)


def home_record(shape: HomeShape, bucket: Bucket) -> Any:
    """Return the record of a home."""
    record = np.zeros(1, home_type(bucket))[0]
    _nodes(record, shape, bucket)
    _rooms(record, shape, bucket)
    _floor(record, shape, bucket)
    _doors(record, shape, bucket)
    return record


def _check(home: Home) -> None:
    """Refuse a home whose edges kernels cannot hold.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    if home.properties["BODY_PART"]:
        raise _unfit(home, "has body parts as nodes", "Env or TextHomes")
    for i in indices(home.everything & ~home.characters):
        inside = home.inside[i]
        if (
            home.on[i].bit_count() > 1
            or (inside & ~home.rooms).bit_count() > 1
            or (inside & home.rooms).bit_count() > 1
        ):
            raise _unfit(home, f"has {home.classes[i]} ({home.ids[i]}) on, or in, several things", "Env or TextHomes")
        if not inside & home.rooms and inside:
            raise _unfit(home, f"has {home.classes[i]} ({home.ids[i]}) in something, in no room", "Env or TextHomes")


def _unfit(home: Home, what: str, remedy: str) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"the home `{home.name}` {what}", suggestion=remedy)


def _nodes(record: Any, shape: HomeShape, bucket: Bucket) -> None:
    home, first = shape.home, len(shape.home)
    for name in ("room_number", "door_number", "slot", "on", "inside", "room", "target"):
        record[name] = -1
    record["measured"], record["box"], record["nodes"] = NEVER, math.nan, first
    record["slot"][bucket.first_added :] = bucket.movable + np.arange(ADDED)
    for number, i in enumerate(shape.movable):
        record["slot"][i] = number
    for number, i in enumerate(shape.rooms):
        record["room_number"][i] = number
    for number, i in enumerate(shape.doors):
        record["door_number"][i] = number
    known = {cells: number for number, cells in enumerate(shape.targets)}
    measured = shape.ground.home
    for i in indices(home.everything):
        record["on"][i], record["inside"][i] = lowest(home.on[i]), lowest(home.inside[i] & ~home.rooms)
        record["room"][i] = lowest(home.inside[i] & home.rooms)
        record["limits"][i] = home.limit(i), home.limit(i, lying=True)
        for name, row in (("close", home.close), ("bears", home.bears), ("contents", home.contents),
                          ("facing", home.facing)):  # fmt: skip
            record[name][i] = words(row[i], first, bucket)
        node, box = home.node(i), shape.ground.box(i)
        record["box"][i] = (*((box.center[0], box.center[2]) if box else (math.nan,) * 2),
                            math.nan if node.yaw is None else node.yaw)  # fmt: skip
        if i < len(measured):
            record["target"][i] = known.get(shape.ground.stands(i), -1)
            record["measured"][i] = _measured(measured, i) if box else NEVER


def _measured(home: Home, i: int) -> tuple[int, int, int]:
    """Return what a node is ON, in, and in which room, where the floor was measured."""
    rows = home.on[i], home.inside[i] & ~home.rooms, home.inside[i] & home.rooms
    return tuple(lowest(row) if row.bit_count() < 2 else NEVER for row in rows)  # type: ignore[return-value]


def _rooms(record: Any, shape: HomeShape, bucket: Bucket) -> None:
    home, first = shape.home, len(shape.home)
    empty = World(home, home.states, (), NOTHING)
    record["rooms"], record["room_node"] = len(shape.rooms), -1
    for number, room in enumerate(shape.rooms):
        record["room_node"][number] = room
        around = sum(1 << door for door in shape.doors if home.between[door] >> room & 1)
        found = in_room(empty, room)
        own = sum(1 << door for door in indices(around) if home.inside[door] >> room & 1)
        record["room_nodes"][number] = words(found & ~around | own, first, bucket)
        record["room_doors"][number] = words(around, first, bucket)


def _floor(record: Any, shape: HomeShape, bucket: Bucket) -> None:
    ground, ways, first = shape.ground, shape.ground.ways, len(shape.home)
    cells = record["cells"] = len(ways.cells)
    record["origin"] = (*ways.floor.origin, ways.floor.cell)
    record["grid"], record["cell_room"] = -1, -1
    rows, columns = map(int, ways.number.shape)
    record["grid"][1 : 1 + rows, 1 : 1 + columns] = ways.number
    record["middle"][:cells], record["cell_room"][:cells] = ways.points, ground.rooms
    record["main"][:cells] = ways.main
    for cell in range(cells):
        record["near"][cell] = words(ground.near[cell], first, bucket)
    for number, door in enumerate(shape.doors):
        for cell in ground.shut(1 << door):
            record["shut"][cell] |= 1 << number
    record["first_stand"][1:] = sum(map(len, shape.targets))
    ends = np.cumsum([0, *map(len, shape.targets)])
    record["first_stand"][: len(ends)] = ends
    for number, (start, end) in enumerate(pairwise(ends.tolist())):
        record["stands"][start:end] = shape.targets[number]


def _doors(record: Any, shape: HomeShape, bucket: Bucket) -> None:
    """Fill the tables by closed doors: parts of the floor, rooms, and things that a walk may lead to."""
    home, ground = shape.home, shape.ground
    first, cells = len(home), int(record["cells"])
    stands = [(i, cell) for i in indices(home.everything) if i < len(ground.home) for cell in ground.stands(i)]
    nodes, at = np.array(stands, np.int64).reshape(-1, 2).T
    bits = np.left_shift(np.uint64(1), (nodes & 63).astype(np.uint64))
    number = {room: k for k, room in enumerate(shape.rooms)}
    for k, door in enumerate(shape.doors):
        record["between"][k] = sum(1 << number[room] for room in indices(home.between[door] & home.rooms))
    for closed in range(1 << len(shape.doors)):
        mask = sum(1 << door for k, door in enumerate(shape.doors) if closed >> k & 1)
        region = np.maximum(ground.regions(mask), 0)  # 0 is that of all cells that are not free
        record["region"][closed, :cells] = region
        np.bitwise_or.at(record["reached"][closed], (region[at], nodes >> 6), bits)
        record["reached"][closed, 0] = 0
        _walks(record, shape, bucket, closed, mask, first)


def _walks(record: Any, shape: HomeShape, bucket: Bucket, closed: int, mask: int, first: int) -> None:
    home = shape.home
    states = list(home.states)
    states[CLOSED] = states[CLOSED] & ~home.doors | mask
    node = home.agents[0] if home.agents else first
    for number, room in enumerate(shape.rooms):
        agent = Agent(node, 1 << node, inside=1 << room)
        world = World(home, tuple(states), tuple(home.agent_rows), NOTHING)
        open_rooms, reached = doors.open_rooms(world, agent), doors.reached_rooms(world, agent)
        for name, found in (("open_rooms", open_rooms), ("reached_rooms", reached)):
            record[name][number, closed] = sum(1 << k for k, each in enumerate(shape.rooms) if found >> each & 1)
        things = reach.walkable(world, agent, True) & ~home.characters
        record["walkable"][number, closed] = words(things, first, bucket)
