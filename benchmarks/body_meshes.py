"""Surfaces: triangles, normals, fewer triangles, smoothing, and cutting along lines."""

from __future__ import annotations

import heapq
from collections import defaultdict
from typing import NamedTuple

import numpy as np
from body_source import Array


class Part(NamedTuple):
    """A surface: points as means of vertices, triangles of them, and how far each lies outside along its normal."""

    rows: list[dict[int, float]]
    triangles: Array
    offsets: Array
    slots: Array


def triangles_of(quads: Array) -> Array:
    return np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])


def normals_of(points: Array, triangles: Array) -> Array:
    found = np.zeros_like(points)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    for k in range(3):
        np.add.at(found, triangles[:, k], np.cross(b - a, c - a))
    return found / np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-12)


def thinned(points: Array, triangles: Array, keep: int, dear: Array) -> Array:
    """Triangles after collapsing edges onto one of their ends, cheapest first by quadric error, until `keep` are left.

    Args:
        points: (V, 3).
        triangles: (T, 3).
        keep: number of triangles to keep.
        dear: (V,) factor of the cost of removing a vertex.
    """
    faces: dict[int, list[int]] = dict(enumerate(triangles.tolist()))
    around: dict[int, set[int]] = defaultdict(set)
    quadric: dict[int, Array] = defaultdict(lambda: np.zeros((4, 4)))
    edges: dict[tuple[int, int], int] = defaultdict(int)
    for number, face in faces.items():
        a, b, c = points[face]
        normal = np.cross(b - a, c - a)
        area = float(np.linalg.norm(normal))
        plane = np.append(normal, -normal @ a) / max(area, 1e-15)
        for k in range(3):
            around[face[k]].add(number)
            quadric[face[k]] += np.outer(plane, plane) * area
            edges[tuple(sorted((face[k], face[k - 1])))] += 1  # type: ignore[index]
    rim = {v for edge, count in edges.items() if count == 1 for v in edge}
    version: dict[int, int] = defaultdict(int)

    def cost(gone: int, stays: int) -> float:
        at = np.append(points[stays], 1.0)
        length = float(np.sum((points[gone] - points[stays]) ** 2))
        return float(at @ quadric[gone] @ at + 1e-7 * length) * float(dear[gone])

    heap = [(cost(a, b), a, b, 0, 0) for edge in edges for a, b in (edge, edge[::-1]) if a not in rim]
    heapq.heapify(heap)
    while len(faces) > keep and heap:
        _, gone, stays, one, other = heapq.heappop(heap)
        if gone not in around or stays not in around or (version[gone], version[stays]) != (one, other):
            continue
        if _folds(points, faces, around, gone, stays):
            continue
        for number in list(around[gone]):
            face = faces[number]
            if stays in face:
                del faces[number]
                for vertex in face:
                    around[vertex].discard(number)
            else:
                faces[number] = [stays if vertex == gone else vertex for vertex in face]
                around[stays].add(number)
        del around[gone]
        quadric[stays] += quadric[gone]
        near = {vertex for number in around[stays] for vertex in faces[number]}
        version[stays] += 1
        for vertex in sorted(near - {stays}):
            for a, b in ((vertex, stays), (stays, vertex)):
                if a not in rim:
                    heapq.heappush(heap, (cost(a, b), a, b, version[a], version[b]))
    return np.array(list(faces.values()))


def _folds(points: Array, faces: dict[int, list[int]], around: dict[int, set[int]], gone: int, stays: int) -> bool:
    """Return whether collapsing an edge would turn a triangle over or join more than the edge's two sides."""
    one = {v for n in around[gone] for v in faces[n]} & {v for n in around[stays] for v in faces[n]}
    if len(one - {gone, stays}) != 2:
        return True
    for number in around[gone]:
        face = faces[number]
        if stays in face:
            continue
        before = points[face]
        after = points[[stays if v == gone else v for v in face]]
        m, n = (
            np.cross(before[1] - before[0], before[2] - before[0]),
            np.cross(after[1] - after[0], after[2] - after[0]),
        )
        if m @ n < 0.3 * np.linalg.norm(m) * np.linalg.norm(n):
            return True
    return False


def smoothed(quads: Array, count: int, times: int) -> list[dict[int, float]]:
    """Each vertex as a mean of vertices: neighbours averaged `times` times."""
    from scipy.sparse import csr_matrix, diags, identity

    ends = np.concatenate([quads[:, [k, (k + 1) % 4]] for k in range(4)])
    ends = np.concatenate([ends, ends[:, ::-1]])
    joined = csr_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), (count, count))
    joined.data[:] = 1.0
    degree = np.maximum(np.asarray(joined.sum(axis=1)).ravel(), 1)
    step = 0.5 * identity(count) + 0.5 * diags(1 / degree) @ joined
    whole = identity(count, format="csr")
    for _ in range(times):
        whole = step @ whole
    whole = whole.tocsr()
    return [
        dict(zip(whole.indices[a:b].tolist(), whole.data[a:b].tolist(), strict=True))
        for a, b in zip(whole.indptr, whole.indptr[1:], strict=False)
    ]


def halved(rows: list[dict[int, float]], triangles: Array) -> tuple[list[dict[int, float]], Array]:
    """Each triangle as four, by the middles of its edges."""
    rows, known = list(rows), {}

    def middle(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in known:
            known[key] = len(rows)
            row: dict[int, float] = defaultdict(float)
            for end in key:
                for vertex, weight in rows[end].items():
                    row[vertex] += weight / 2
            rows.append(dict(row))
        return known[key]

    found: list[tuple[int, int, int]] = []
    for a, b, c in triangles.tolist():
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        found += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    return rows, np.array(found)


def cut(rows: list[dict[int, float]], triangles: Array, offsets: Array, field: Array, slot: int) -> Part:
    """The part of a surface where `field` is at most 0, with edges cut where it is 0."""
    rows, more = list(rows), list(offsets)
    known: dict[tuple[int, int], int] = {}

    def between(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in known:
            share = field[key[0]] / (field[key[0]] - field[key[1]])
            row: dict[int, float] = defaultdict(float)
            for end, part in ((key[0], 1 - share), (key[1], share)):
                for vertex, weight in rows[end].items():
                    row[vertex] += weight * part
            known[key] = len(rows)
            rows.append(dict(row))
            more.append(more[key[0]] * (1 - share) + more[key[1]] * share)
        return known[key]

    found: list[list[int]] = []
    for a, b, c in triangles.tolist():
        line: list[int] = []
        for one, other in ((a, b), (b, c), (c, a)):
            if field[one] <= 0:
                line.append(one)
            if (field[one] <= 0) != (field[other] <= 0):
                line.append(between(one, other))
        found += [[line[0], line[k], line[k + 1]] for k in range(1, len(line) - 1)]
    kept = np.array(found, np.int64).reshape(-1, 3)
    return compact(Part(rows, kept, np.array(more), np.full(len(kept), slot)))


def compact(part: Part) -> Part:
    """The part with only the points that its triangles use."""
    used, inverse = np.unique(part.triangles, return_inverse=True)
    rows = [part.rows[k] for k in used.tolist()]
    return Part(rows, inverse.reshape(part.triangles.shape), part.offsets[used], part.slots)


def applied(rows: list[dict[int, float]], values: Array) -> Array:
    """Values at points that are means of vertices."""
    from scipy.sparse import csr_matrix

    lengths = np.cumsum([0, *(len(row) for row in rows)])
    columns = np.array([c for row in rows for c in row])
    data = np.array([w for row in rows for w in row.values()])
    return np.asarray(csr_matrix((data, columns, lengths), (len(rows), len(values))) @ values)
