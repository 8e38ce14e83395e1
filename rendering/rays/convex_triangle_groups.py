"""Groups of triangles that never shade one another: convex bodies, seen from outside, and planes.

A surface point that lies a little in front of its triangle cannot be shaded by the rest of a convex body: the body lies
behind the triangle's plane, and the way to the light leads away from it.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays.kernels import kernel

SLACK = 5e-4
"""Metres by which a vertex may lie before a plane of its body; less than points are lifted off their surface."""

MOST = 600
"""Triangles of a body up to which it is looked at whether it is convex."""

WELD = 1e4
"""Vertices that agree in this many parts of a metre are one."""

NONE = np.int32(-1)


def unshaded_groups(corners: Floats, owner: NDArray[np.int32]) -> Ints:
    """(T,) the group of each of T triangles.

    Even numbers are convex bodies, whose triangles are seen from in front; odd ones are planes, seen from either side;
    -1 is a triangle without area.

    Args:
        corners: (T, 3, 3).
        owner: (T,) the thing that each triangle belongs to; a body belongs to one thing.
    """
    if not len(corners):
        return np.zeros(0, np.int32)
    exact = np.asarray(corners, np.float64)
    normals = np.cross(exact[:, 1] - exact[:, 0], exact[:, 2] - exact[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    flat = lengths > 1e-12
    normals[flat] /= lengths[flat, None]
    body = _bodies(exact, owner)
    order = np.argsort(body, kind="stable").astype(np.int64)
    ends = np.cumsum(np.bincount(body)).astype(np.int64)
    convex = np.zeros(len(ends), np.bool_)
    find_convex(exact, normals, flat, order, ends, convex)
    groups = np.where(convex[body], 2 * body, 2 * _planes(exact, normals) + 1).astype(np.int32)
    groups[~flat] = NONE
    return groups


def _bodies(corners: NDArray[np.float64], owner: NDArray[np.int32]) -> NDArray[np.int64]:
    """(T,) the connected piece of each triangle: triangles of a thing that share a vertex."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    key = np.rint(corners * WELD).astype(np.int64)
    code = (key[..., 0] * 73_856_093) ^ (key[..., 1] * 19_349_663) ^ (key[..., 2] * 83_492_791)
    _, vertex = np.unique(code ^ (owner.astype(np.int64)[:, None] << 40), return_inverse=True)
    vertex = vertex.reshape(-1, 3)
    ones = np.ones(2 * len(vertex), np.bool_)
    rows, columns = np.concatenate((vertex[:, 0], vertex[:, 0])), np.concatenate((vertex[:, 1], vertex[:, 2]))
    size = int(vertex.max()) + 1
    _, piece = connected_components(coo_array((ones, (rows, columns)), shape=(size, size)), directed=False)
    _, found = np.unique(piece[vertex[:, 0]], return_inverse=True)
    return np.asarray(found, np.int64)


def _planes(corners: NDArray[np.float64], normals: NDArray[np.float64]) -> NDArray[np.int64]:
    """(T,) the plane of each triangle; the two sides of a plane are one."""
    first = np.where(np.abs(normals) > 1e-6, np.sign(normals), 0)
    lead = first[np.arange(len(first)), np.argmax(first != 0, axis=1)]
    normals = normals * lead[:, None]
    offsets = (normals * corners[:, 0]).sum(axis=1)
    rounded = np.rint(np.column_stack((normals, offsets)) * 1e4).astype(np.int64)
    _, found = np.unique(rounded, axis=0, return_inverse=True)
    return np.asarray(found.reshape(-1), np.int64)


@kernel
def find_convex(corners: Any, normals: Any, flat: Any, order: Any, ends: Any, convex: Any) -> None:
    """Fill in whether bodies are convex.

    Args:
        corners, normals, flat: (T, 3, 3), (T, 3) and (T,) of all triangles, and whether they have an area.
        order: (T,) triangles, body after body.
        ends: (B,) the end of each body in `order`.
        convex: (B,) filled.
    """
    start = 0
    for b in range(len(ends)):
        stop = ends[b]
        good = stop - start <= MOST
        for i in range(start, stop):
            t = order[i]
            if not good:
                break
            if not flat[t]:
                continue
            nx, ny, nz = normals[t, 0], normals[t, 1], normals[t, 2]
            limit = nx * corners[t, 0, 0] + ny * corners[t, 0, 1] + nz * corners[t, 0, 2] + SLACK
            for j in range(start, stop):
                s = order[j]
                for k in range(3):
                    if nx * corners[s, k, 0] + ny * corners[s, k, 1] + nz * corners[s, k, 2] > limit:
                        good = False
                if not good:
                    break
        convex[b] = good
        start = stop
