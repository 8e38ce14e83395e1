"""Navigation: distance fields, shortest free paths, and other characters as obstacles (thesis 2.3.1, 2.4.1)."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from hashlib import blake2b
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hearth.homes.plans.walkable_floor import Floor
from hearth.schemas.graph import Spot

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


BODY_RADIUS = 0.25
"""Metres around a character that others keep out of."""

MOST_FIELDS = 1_000
"""Distance fields that a floor keeps: 60 KB each for a home of 5,000 cells."""

MOST_PARTS = 64
"""Graphs without the cells of closed doors that a floor keeps."""


def digest_of(floor: Floor) -> str:
    """32 hexadecimal digits, the same for floors that are equal."""
    text = repr((floor.origin, floor.cell, floor.walkable.shape)).encode()
    return blake2b(text + np.packbits(floor.walkable).tobytes(), digest_size=16).hexdigest()


class Field(NamedTuple):
    """The shortest ways from every walkable cell to the nearest of some cells.

    Attributes:
        distance: metres by cell number; inf where no way leads there.
        following: the next cell on the way; negative at its end.
    """

    distance: array[float] | memoryview[float]
    following: array[int] | memoryview[int]


class Ways:
    """The walkable cells of a floor as a graph of eight neighbours, with its distance fields; made once a floor.

    Attributes:
        floor: the floor.
        cells: int (n, 2): the walkable cells; a cell's number is its position here.
        number: int, as the grid: the number of each cell, -1 where it is not walkable.
        points: metres (n, 2): the middles of the cells.
        stored: gives the field to some ends where it was made before (`stored_ways`).
    """

    def __init__(self, floor: Floor) -> None:
        self.floor = floor
        self.cells = np.argwhere(floor.walkable)
        self.number = np.full(floor.walkable.shape, -1, np.int64)
        self.number[floor.walkable] = np.arange(len(self.cells))
        self.points = np.asarray(floor.origin) + (self.cells + 0.5) * floor.cell
        self.main = floor.main[floor.walkable]
        self.stored: Callable[[tuple[int, ...]], Field | None] = lambda ends: None
        self._fields: dict[tuple[tuple[int, ...], tuple[int, ...]], Field] = {}
        self._parts: dict[tuple[int, ...], csr_matrix] = {}

    @cached_property
    def digest(self) -> str:
        """Of the floor: 32 hexadecimal digits, the same for floors that are equal."""
        return digest_of(self.floor)

    @cached_property
    def edges(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pairs of neighbouring cells, once each: one, the other, metres between; a diagonal needs both its sides
        free.
        """
        sources, targets, lengths = [], [], []
        padded = np.pad(self.number, 1, constant_values=-1)
        inner = padded[1:-1, 1:-1]
        for dx, dz in ((1, 0), (0, 1), (1, 1), (1, -1)):
            other = padded[1 + dx : padded.shape[0] - 1 + dx, 1 + dz : padded.shape[1] - 1 + dz]
            both = (inner >= 0) & (other >= 0)
            if dx and dz:
                both &= padded[1 + dx : padded.shape[0] - 1 + dx, 1:-1] >= 0
                both &= padded[1:-1, 1 + dz : padded.shape[1] - 1 + dz] >= 0
            sources.append(inner[both])
            targets.append(other[both])
            lengths.append(np.full(both.sum(), math.hypot(dx, dz) * self.floor.cell))
        return np.concatenate(sources), np.concatenate(targets), np.concatenate(lengths)

    @cached_property
    def graph(self) -> csr_matrix:
        """The same as a matrix."""
        from scipy.sparse import csr_matrix

        sources, targets, lengths = self.edges
        return csr_matrix((lengths, (sources, targets)), shape=(len(self.cells),) * 2)

    def field(self, ends: tuple[int, ...], without: tuple[int, ...] = ()) -> Field:
        """Return the ways to the nearest of some cells; read from where they are stored or computed (some milliseconds)
        at the first call, then kept.

        Args:
            ends: numbers of cells.
            without: cells that are not free; of closed doors, and of other characters.
        """
        try:
            return self._fields[ends, without]
        except KeyError:
            pass
        if len(self._fields) >= MOST_FIELDS:
            self._fields.pop(next(iter(self._fields)))
        stored = None if without else self.stored(ends)
        if without not in self._parts:
            if len(self._parts) >= MOST_PARTS:
                self._parts.clear()
            self._parts[without] = _both_ways(self._without(without) if without else self.graph)
        found = self._fields[ends, without] = stored or self._field(ends, without, self._parts[without], directed=True)
        return found

    def detour(self, ends: tuple[int, ...], without: tuple[int, ...]) -> Field:
        """Return the same, not kept: other characters seldom stand where they did."""
        return self._field(ends, without, self._without(without) if without else self.graph, directed=False)

    def _field(self, ends: tuple[int, ...], without: tuple[int, ...], graph: csr_matrix, directed: bool) -> Field:
        from scipy.sparse.csgraph import dijkstra

        free = [end for end in ends if end not in without]
        if not free:
            return Field(array("d", [math.inf]) * len(self.cells), array("i", [-1]) * len(self.cells))
        distance, before, _ = dijkstra(graph, directed=directed, indices=free, return_predecessors=True, min_only=True)
        return Field(array("d", distance.tobytes()), array("i", before.astype(np.int32).tobytes()))

    def _without(self, taken: Sequence[int]) -> csr_matrix:
        from scipy.sparse import diags

        kept = np.ones(len(self.cells))
        kept[list(taken)] = 0.0
        free = diags(kept)
        found = (free @ self.graph @ free).tocsr()
        found.eliminate_zeros()
        return found

    @cached_property
    def _rows(self) -> list[list[int]]:
        """`number` as lists with a border, which Python reads faster than arrays."""
        rows: list[list[int]] = np.pad(self.number, 1, constant_values=-1).tolist()
        return rows

    @cached_property
    def _middles(self) -> list[Spot]:
        return [(x, z) for x, z in self.points.tolist()]

    def at(self, x: float, z: float) -> int:
        """Return the number of the walkable cell that a point lies in, or -1."""
        (x0, z0), cell, rows = self.floor.origin, self.floor.cell, self._rows
        i, j = math.floor((x - x0) / cell) + 1, math.floor((z - z0) / cell) + 1
        return rows[i][j] if 0 <= i < len(rows) and 0 <= j < len(rows[0]) else -1

    def ahead(self, point: Spot, step: Spot, without: tuple[int, ...] = ()) -> float:
        """Return the share of a straight step from a point that leads over free cells of the main region, looked at
        every half cell.
        """
        (x0, z0), cell, rows, main = self.floor.origin, self.floor.cell, self._rows, self._main
        count = max(1, math.ceil(math.hypot(*step) / (cell / 2)))
        x, z = (point[0] - x0) / cell + 1, (point[1] - z0) / cell + 1
        dx, dz = step[0] / cell / count, step[1] / cell / count
        for part in range(1, count + 1):
            i, j = math.floor(x + dx * part), math.floor(z + dz * part)
            number = rows[i][j] if 0 <= i < len(rows) and 0 <= j < len(rows[0]) else -1
            if number < 0 or not main[number] or number in without:
                return (part - 1) / count
        return 1.0

    @cached_property
    def _main(self) -> list[bool]:
        found: list[bool] = self.main.tolist()
        return found

    def around(self, x: float, z: float) -> list[int]:
        """Return the cells to whose middles one can go straight from a point: its own, and of the three that it lies
        between those that share a free side with it. Of a point on the line between two middles, only these two.
        """
        (x0, z0), cell, rows = self.floor.origin, self.floor.cell, self._rows
        u, v = (x - x0) / cell + 0.5, (z - z0) / cell + 0.5
        i, j = math.floor(u + 1e-6), math.floor(v + 1e-6)
        if not (0 <= i < len(rows) - 1 and 0 <= j < len(rows[0]) - 1):
            return []
        right, up = u - i > 1e-6, v - j > 1e-6
        found = [rows[i][j]]
        if right:
            found.append(rows[i + 1][j])
        if up:
            found.append(rows[i][j + 1])
            if right and rows[i + 1][j + 1] >= 0 and min(found) >= 0:
                found.append(rows[i + 1][j + 1])
            elif right:
                return self._between(x, z, found, rows[i + 1][j + 1])
        return [number for number in found if number >= 0]

    def _between(self, x: float, z: float, three: list[int], far: int) -> list[int]:
        """Of four cells some of which are not free, those that share a side with the one that a point lies in."""
        own = self.at(x, z)
        here, right, up = three
        sides = {here: (right, up), right: (here, far), up: (here, far), far: (right, up)}
        return [own, *(number for number in sides.get(own, ()) if number >= 0)] if own >= 0 else []

    def left(self, field: Field, x: float, z: float) -> tuple[float, int]:
        """Metres from a point to the end of a field's way, and the cell to which it goes first (-1: no way)."""
        best, first = math.inf, -1
        middles, distance = self._middles, field.distance
        for number in self.around(x, z):
            there = middles[number]
            total = math.hypot(x - there[0], z - there[1]) + distance[number]
            if total < best:
                best, first = total, number
        return best, first

    def stepped(self, field: Field, x: float, z: float, stride: float) -> tuple[float, float, int]:
        """Return the point `stride` metres along a field's way from a point, and the cell before or at it on the way.

        Equal strides come to the end in as many steps as the way's length over the stride, rounded up.

        Returns:
            (x, z, the next cell of the way); that cell is -1 when the end is reached, and -2 where no way leads there.
        """
        total, cell = self.left(field, x, z)
        if cell < 0:
            return x, z, -2
        rest = total - stride
        distance, following, middles = field.distance, field.following, self._middles
        here = (x, z)
        while distance[cell] > rest:
            here = middles[cell]
            cell = following[cell]
            if cell < 0:
                return (*here, -1)
        there = middles[cell]
        length = math.hypot(here[0] - there[0], here[1] - there[1])
        share = (rest - distance[cell]) / length if length else 0.0
        if share < 1e-9 and following[cell] < 0:
            return (*there, -1)
        return there[0] + (here[0] - there[0]) * share, there[1] + (here[1] - there[1]) * share, cell

    def nearest(self, point: Spot, blocked: np.ndarray | None = None) -> int:
        """Return the number of the walkable cell nearest to a point, or -1 when there is none."""
        distance = np.hypot(*(self.points - point).T)
        if blocked is not None:
            distance[blocked] = np.inf
        best = int(distance.argmin()) if len(distance) else -1
        return best if best >= 0 and np.isfinite(distance[best]) else -1

    def blocked(self, others: Iterable[Spot]) -> np.ndarray:
        """Bool by cell: where other characters stand in the way."""
        taken = np.zeros(len(self.cells), bool)
        for other in others:
            taken |= np.hypot(*(self.points - other).T) < 2 * BODY_RADIUS
        return taken

    def path(self, start: Spot, goal: Spot, others: Sequence[Spot] = ()) -> tuple[Spot, ...] | None:
        """Return the shortest free path, as points a cell apart, from the cell of `start` to the one nearest to `goal`.

        Args:
            start, goal: metres; each is taken to the nearest walkable cell.
            others: where other characters stand; their cells are not free.

        Returns:
            The points, or None when no path leads there.
        """
        taken = self.blocked(others)
        first, last = self.nearest(start), self.nearest(goal, taken)
        if first < 0 or last < 0:
            return None
        taken[first] = False
        field = self.detour((first,), tuple(np.flatnonzero(taken).tolist()))
        if not math.isfinite(field.distance[last]):
            return None
        numbers = [last]
        while (number := field.following[numbers[-1]]) >= 0:
            numbers.append(number)
        return tuple(self._middles[number] for number in reversed(numbers))


def _both_ways(graph: csr_matrix) -> csr_matrix:
    """Return a graph whose rows have the edges from a cell and then those to it.

    SciPy's search in an undirected graph reads the rows of a graph and then those of its transpose, which it makes at
    each call. Read in the same order from one row, the same ways are the first of those that are equally short.
    """
    from scipy.sparse import csr_matrix

    other = graph.T.tocsr()
    cells = np.arange(graph.shape[0])
    rows = np.concatenate([np.repeat(cells, np.diff(each.indptr)) for each in (graph, other)])
    order = np.argsort(rows, kind="stable")
    columns = np.concatenate([graph.indices, other.indices])[order]
    lengths = np.concatenate([graph.data, other.data])[order]
    return csr_matrix((lengths, columns, graph.indptr + other.indptr), shape=graph.shape)
