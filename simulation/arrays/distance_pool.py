"""Distance fields of a batch, computed when a kernel first needs them.

While doors are closed, the way to a target is the open one wherever that passes none of them. So all sets of closed
doors that turn no way share a field.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hearth.simulation.arrays.home_records import HomeShape
from hearth.simulation.arrays.record_types import Bucket

FIRST_FIELDS = 256
"""Fields for which there is room at first."""


ROUNDS = 12
"""Rounds of following a way, each twice as far: 4,096 cells."""


class DistancePool:
    """The fields of some homes.

    Attributes:
        rows: by home, key and closed doors the number of the field; 0 where it is not computed.
        distance, following: by field and cell, as of `navigation.Field`; field 0 is of the own cell.
        computed: how many fields there are.
    """

    def __init__(self, shapes: Sequence[HomeShape], bucket: Bucket) -> None:
        self._shapes, self._bucket = shapes, bucket
        self.rows = np.zeros((len(shapes), bucket.targets + bucket.cells, 1 << bucket.doors), np.int32)
        self.distance = np.zeros((FIRST_FIELDS, bucket.cells))
        self.following = np.zeros((FIRST_FIELDS, bucket.cells), np.int16)
        self.following[0] = -1
        self.computed = 1
        self._passes: dict[int, np.ndarray] = {}
        self._parts: dict[tuple[int, int], np.ndarray] = {}
        self._doors: dict[int, np.ndarray] = {}

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the arrays that kernels read."""
        return self.rows, self.distance, self.following

    def fill(self, missing: np.ndarray) -> None:
        """Compute the fields that kernels asked for: rows of (home, key, closed doors)."""
        for home, key, closed in {tuple(each) for each in missing.tolist()}:
            self._fill(home, key, closed)

    def _fill(self, home: int, key: int, closed: int) -> int:
        """Return the number of a field, computed where no other serves as well."""
        row = int(self.rows[home, key, closed])
        if not row:
            at_end = self._at_end(home, key) & closed
            row = 0 if at_end == closed else self._fill(home, key, at_end)
            if not row or self._turned(home, key, row, closed):
                row = self._add(home, key, self._shut(home, closed))
            self.rows[home, key, closed] = row
        return row

    def _at_end(self, home: int, key: int) -> int:
        """Return the doors, as bits, in whose ways a target has cells: closed, they change where its ways end."""
        doors = self._in_ways(home)
        found = 0
        for end in self._ends(home, key):
            found |= int(doors[end])
        return found

    def _in_ways(self, home: int) -> np.ndarray:
        """Return by cell the doors, as bits, in whose way it is."""
        if home not in self._doors:
            shape = self._shapes[home]
            found = np.zeros(len(shape.ground.ways.cells), np.int32)
            for k, door in enumerate(shape.doors):
                found[list(shape.ground.shut(1 << door))] |= 1 << k
            self._doors[home] = found
        return self._doors[home]

    def _ends(self, home: int, key: int) -> tuple[int, ...]:
        targets = self._shapes[home].targets
        return targets[key] if key < self._bucket.targets else (key - self._bucket.targets,)

    def _shut(self, home: int, closed: int) -> tuple[int, ...]:
        shape = self._shapes[home]
        return shape.ground.shut(sum(1 << door for k, door in enumerate(shape.doors) if closed >> k & 1))

    def _add(self, home: int, key: int, without: tuple[int, ...]) -> int:
        ways = self._shapes[home].ground.ways
        ends = self._ends(home, key)
        if self.computed == len(self.distance):
            self.distance = np.concatenate([self.distance, np.zeros_like(self.distance)])
            self.following = np.concatenate([self.following, np.zeros_like(self.following)])
        field = ways.field(ends, without) if key < self._bucket.targets else ways.detour(ends, without)
        cells = len(ways.cells)
        self.distance[self.computed, :cells] = field.distance
        self.following[self.computed, :cells] = np.maximum(field.following, -1)
        self.computed += 1
        return self.computed - 1

    def _turned(self, home: int, key: int, row: int, closed: int) -> bool:
        """Return whether closed doors turn the way of a field from some cell that they do not cut off."""
        region = self._regions(home, closed)
        ends = region[list(self._ends(home, key))]
        comes = np.isin(region, ends[ends > 0])
        return bool((self._passing(home, row)[comes] & closed).any())

    def _regions(self, home: int, closed: int) -> np.ndarray:
        if (home, closed) not in self._parts:
            shape = self._shapes[home]
            doors = sum(1 << door for k, door in enumerate(shape.doors) if closed >> k & 1)
            self._parts[home, closed] = np.array(shape.ground.regions(doors), np.int16)
        return self._parts[home, closed]

    def _passing(self, home: int, row: int) -> np.ndarray:
        """Return by cell the doors, as bits, in whose ways a field leads from it."""
        if row not in self._passes:
            found = self._in_ways(home).copy()
            distance, following = self.distance[row, : len(found)], self.following[row, : len(found)].astype(np.int64)
            ahead = np.where((following >= 0) & np.isfinite(distance), following, np.arange(len(found)))
            for _ in range(ROUNDS):
                found |= found[ahead]
                ahead = ahead[ahead]
            self._passes[row] = found.astype(np.uint8)
        return self._passes[row]
