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
        self._passes: dict[tuple[int, int], np.ndarray] = {}

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What kernels read."""
        return self.rows, self.distance, self.following

    def fill(self, missing: np.ndarray) -> None:
        """Compute the fields that kernels asked for: rows of (home, key, closed doors)."""
        for home, key, closed in {tuple(each) for each in missing.tolist()}:
            if self.rows[home, key, closed]:
                continue
            if not self.rows[home, key, 0]:
                self.rows[home, key, 0] = self._add(home, key, ())
            if not closed:
                continue
            shut = self._shut(home, closed)
            if self._turned(home, key, closed, shut):
                self.rows[home, key, closed] = self._add(home, key, shut)
            else:
                self.rows[home, key, closed] = self.rows[home, key, 0]

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

    def _turned(self, home: int, key: int, closed: int, shut: tuple[int, ...]) -> bool:
        """Return whether closed doors turn the way from some cell from which the target can still be reached."""
        shape = self._shapes[home]
        doors = sum(1 << door for k, door in enumerate(shape.doors) if closed >> k & 1)
        region = np.array(shape.ground.regions(doors))
        ends = [end for end in self._ends(home, key) if end not in shut]
        if len(ends) < len(self._ends(home, key)):
            return True
        comes = np.isin(region, region[ends])
        return bool((self._passing(home, key)[comes] & closed).any())

    def _passing(self, home: int, key: int) -> np.ndarray:
        """Return by cell the doors, as bits, in whose ways the open way from it lies."""
        if (home, key) not in self._passes:
            shape, row = self._shapes[home], self.rows[home, key, 0]
            cells = len(shape.ground.ways.cells)
            found = np.zeros(cells, np.int32)
            for k, door in enumerate(shape.doors):
                found[list(shape.ground.shut(1 << door))] |= 1 << k
            distance, following = self.distance[row, :cells], self.following[row, :cells].astype(np.int64)
            ahead = np.where((following >= 0) & np.isfinite(distance), following, np.arange(cells))
            for _ in range(16):  # each round doubles the part of the way that is looked at
                found |= found[ahead]
                ahead = ahead[ahead]
            self._passes[home, key] = found
        return self._passes[home, key]
