"""Basic loops over pixels and triangles, compiled by numba.

They are compiled on first use and cached in the folder of the source (or in the user's cache folder if that is not
writable). They release the interpreter's lock, so that threads run in parallel. All numbers, constants included, are
float32: one double would turn every result into doubles. Kernels called for every pixel take numbers, not arrays:
reference counts of arrays cost more than the computation, and threads contend for them.
"""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.schemas.optional_libraries import library

F = TypeVar("F", bound=Callable[..., Any])

njit = library("numba").njit

FAST = {"contract", "reassoc", "nsz", "arcp", "afn"}
"""LLVM's fast-math flags without those for infinities, which mark rays that hit nothing."""


def kernel(function: F) -> F:
    """Compile a function at its first call."""
    return cast(F, njit(cache=True, nogil=True, fastmath=FAST, error_model="numpy")(function))


ZERO, HALF, ONE, TWO = np.float32(0), np.float32(0.5), np.float32(1), np.float32(2)
TINY = np.float32(1e-12)

# Columns of a part's rows, which shading looks up for each triangle. Differences are to the first corner.
NORMAL, NORMAL_U, NORMAL_V = 0, 3, 6
UV, UV_U, UV_V = 9, 11, 13
FLAT, DENSITY, COLOR, GLOW, SHINE, TEXTURE, SOLID = 15, 18, 19, 22, 23, 24, 25
COLUMNS = 26


@kernel
def root(value: Any) -> Any:
    """Square root of a float32."""
    return np.float32(np.sqrt(np.float32(value)))


@kernel
def dot3(ax: Any, ay: Any, az: Any, bx: Any, by: Any, bz: Any) -> Any:
    """Scalar product."""
    return ax * bx + ay * by + az * bz


@kernel
def ray_grid(frame: Floats, width: int, height: int, offset: Floats, out: Floats) -> None:
    """Fill (height * width, 6) rays of a camera.

    Args:
        frame: eye, right, up, forward (three numbers each) and the focal length in pixels.
        width, height: of the image.
        offset: position of the ray within its pixel, across and down.
        out: origins and directions; directions have camera-space z = 1.
    """
    focal = frame[12]
    for row in range(height):
        y = (np.float32(height) * HALF - np.float32(row) - offset[1]) / focal
        for column in range(width):
            x = (np.float32(column) + offset[0] - np.float32(width) * HALF) / focal
            i = row * width + column
            for k in range(3):
                out[i, k] = frame[k]
                out[i, 3 + k] = frame[9 + k] + x * frame[3 + k] + y * frame[6 + k]


@kernel
def triangle_rows(
    corners: Floats, normals: Floats, uvs: Floats, surface: Floats, textures: Any, solid: Floats, out: Floats
) -> None:
    """Fill the (T, COLUMNS) rows of triangles."""
    for t in range(len(corners)):
        row, c = out[t], corners[t]
        for k in range(3):
            row[NORMAL + k] = normals[t, 0, k]
            row[NORMAL_U + k] = normals[t, 1, k] - normals[t, 0, k]
            row[NORMAL_V + k] = normals[t, 2, k] - normals[t, 0, k]
            row[COLOR + k] = surface[t, k]
        tiles, span = ZERO, ZERO
        for k in range(2):
            row[UV + k] = uvs[t, 0, k]
            row[UV_U + k] = uvs[t, 1, k] - uvs[t, 0, k]
            row[UV_V + k] = uvs[t, 2, k] - uvs[t, 0, k]
        ax, ay, az = c[1, 0] - c[0, 0], c[1, 1] - c[0, 1], c[1, 2] - c[0, 2]
        bx, by, bz = c[2, 0] - c[0, 0], c[2, 1] - c[0, 1], c[2, 2] - c[0, 2]
        nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        length = max(root(nx * nx + ny * ny + nz * nz), TINY)
        row[FLAT], row[FLAT + 1], row[FLAT + 2] = nx / length, ny / length, nz / length
        tiles = max(row[UV_U] ** 2 + row[UV_U + 1] ** 2, row[UV_V] ** 2 + row[UV_V + 1] ** 2)
        span = max(ax * ax + ay * ay + az * az, bx * bx + by * by + bz * bz)
        row[DENSITY] = root(tiles) / max(root(span), np.float32(1e-6))
        row[GLOW], row[SHINE] = surface[t, 3], surface[t, 4]
        row[TEXTURE], row[SOLID] = np.float32(textures[t]), solid[t]


@kernel
def nearer(
    pixels: Ints, found: Floats, numbers: Any, uvs: Floats, first: int,
    distance: Floats, triangle: Ints, u: Floats, v: Floats, won: Ints,
) -> int:  # fmt: skip
    """Replace the hits of some pixels by nearer hits on other triangles.

    Args:
        pixels: (M,) pixels whose rays were cast again.
        found, numbers, uvs: distances, triangles and weights of the new hits.
        first: index of their first triangle.
        distance, triangle, u, v: the hits of all pixels; changed.
        won: (M,) filled with the changed pixels.

    Returns:
        The number of changed pixels.
    """
    count = 0
    for k in range(len(pixels)):
        i = pixels[k]
        if found[k] < distance[i]:
            distance[i], triangle[i] = found[k], np.int32(numbers[k]) + np.int32(first)
            u[i], v[i] = uvs[k, 0], uvs[k, 1]
            won[count] = i
            count += 1
    return count


@kernel
def taken(values: Floats, index: Ints, out: Floats) -> None:
    """Fill (M, K) rows `index` of (N, K) values."""
    for k in range(len(index)):
        for j in range(values.shape[1]):
            out[k, j] = values[index[k], j]


@kernel
def gather_rows(pixels: Ints, triangle: Ints, static: Floats, moving: Floats, out: Floats) -> None:
    """Fill in the (M, COLUMNS) rows of the triangles that some pixels show; zeros without a triangle.

    Indices of moving triangles follow those of static ones.
    """
    first, columns = len(static), out.shape[1]
    for k in range(len(pixels)):
        t = triangle[pixels[k]]
        if t < 0:
            for c in range(columns):
                out[k, c] = ZERO
        elif t < first:
            for c in range(columns):
                out[k, c] = static[t, c]
        else:
            for c in range(columns):
                out[k, c] = moving[t - first, c]


@kernel
def slab(low: Any, high: Any, start: Any, way: Any, near: Any, far: Any) -> Any:
    """Return the part of a ray segment, from `near` to `far`, between two planes across an axis."""
    if abs(way) < TINY:
        return (near, far) if low <= start <= high else (ONE, ZERO)
    one, other = (low - start) / way, (high - start) / way
    return max(near, min(one, other)), min(far, max(one, other))
