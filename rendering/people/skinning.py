"""Linear blend skinning, compiled by numba."""

from typing import Any

import numpy as np

from hearth.rendering.rays.kernels import TINY, ZERO, kernel


@kernel
def skinned(
    points: Any, normals: Any, bone_of: Any, weights: Any, bones: Any, triangles: Any, corners: Any, turned: Any
) -> None:
    """Corners (T, 3, 3) and their unit normals of triangles whose (P, 3) points follow their bones (B, 3, 4)."""
    moved = np.empty((len(points), 6), np.float32)
    for p in range(len(points)):
        for row in range(3):
            at, way = ZERO, ZERO
            for k in range(4):
                w = weights[p, k]
                if w == ZERO:
                    continue
                m = bones[bone_of[p, k], row]
                at += w * (m[0] * points[p, 0] + m[1] * points[p, 1] + m[2] * points[p, 2] + m[3])
                way += w * (m[0] * normals[p, 0] + m[1] * normals[p, 1] + m[2] * normals[p, 2])
            moved[p, row], moved[p, row + 3] = at, way
        length = np.float32(np.sqrt(moved[p, 3] ** 2 + moved[p, 4] ** 2 + moved[p, 5] ** 2 + TINY))
        for row in range(3, 6):
            moved[p, row] /= length
    for t in range(len(triangles)):
        for k in range(3):
            for axis in range(3):
                corners[t, k, axis] = moved[triangles[t, k], axis]
                turned[t, k, axis] = moved[triangles[t, k], axis + 3]
