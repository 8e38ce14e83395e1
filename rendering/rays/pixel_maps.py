"""Compiled loops over a picture's pixels: depth, labels, normals, boxes, flow, and smoothing for fine pictures."""

from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays.kernels import FLAT, HALF, NORMAL, NORMAL_U, NORMAL_V, ONE, ZERO, dot3, kernel, root
from hearth.rendering.rays.light_rays import side_of


@kernel
def depths(distance: Floats, triangle: Ints, skipped: Floats, out: Any) -> None:
    """Fill in millimetres along the axis, 0 for the background; `skipped`, (N,) or (0,), lies before the rays."""
    cut = len(skipped) > 0
    for i in range(len(distance)):
        far = ZERO
        if triangle[i] >= 0:
            far = distance[i] + (skipped[i] if cut else ZERO)
        out[i] = np.uint16(min(far * np.float32(1000) + HALF, np.float32(65535)))


@kernel
def labels(triangle: Ints, owners: Ints, values: Any, out: Any) -> None:
    """Fill in the value of the thing that each pixel shows; `values` has one per thing, and one for the background."""
    for i in range(len(triangle)):
        out[i] = values[owners[triangle[i]]]


@kernel
def facings(
    rays: Floats, triangle: Ints, u: Floats, v: Floats, static: Floats, moving: Floats, start: int, stop: int,
    out: Floats,
) -> None:  # fmt: skip
    """Write (N, 3) unit normals towards the viewer of the pixels from `start` to `stop`; 0 for the background.

    `static` and `moving` are rows of triangles; the others are of all pixels. The normals are those of `locate`.
    """
    first = len(static)
    for i in range(start, stop):
        t = triangle[i]
        out[i, 0] = out[i, 1] = out[i, 2] = ZERO
        if t < 0:
            continue
        row = static[t] if t < first else moving[t - first]
        fx, fy, fz = row[FLAT], row[FLAT + 1], row[FLAT + 2]
        sign = side_of(fx, fy, fz, rays[i, 3], rays[i, 4], rays[i, 5])
        x = row[NORMAL] + row[NORMAL_U] * u[i] + row[NORMAL_V] * v[i]
        y = row[NORMAL + 1] + row[NORMAL_U + 1] * u[i] + row[NORMAL_V + 1] * v[i]
        z = row[NORMAL + 2] + row[NORMAL_U + 2] * u[i] + row[NORMAL_V + 2] * v[i]
        sign = -side_of(x, y, z, fx * sign, fy * sign, fz * sign)
        norm = sign / max(root(dot3(x, y, z, x, y, z)), np.float32(1e-9))
        out[i, 0], out[i, 1], out[i, 2] = x * norm, y * norm, z * norm


@kernel
def extents(triangle: Ints, owners: Ints, width: int, out: Ints) -> None:
    """Fill in (things, 5): left, top, right, bottom (excluded) and number of pixels of each thing.

    `out` begins as width, height, 0, 0, 0.
    """
    for i in range(len(triangle)):
        number = owners[triangle[i]]
        if number < 0:
            continue
        row, column = i // width, i % width
        out[number, 0], out[number, 1] = min(out[number, 0], column), min(out[number, 1], row)
        out[number, 2], out[number, 3] = max(out[number, 2], column + 1), max(out[number, 3], row + 1)
        out[number, 4] += 1


HORIZON = np.float32(1e5)
"""Distance of the sky, metres."""

TOLERANCE = np.float32(0.02)
"""Relative difference between expected and seen depth up to which a point counts as visible."""


@kernel
def motion(
    rays: Floats, distance: Floats, triangle: Ints, u: Floats, v: Floats, shifts: Floats, first: int, frame: Floats,
    width: int, height: int, start: int, stop: int, ids: Ints, later: Ints, far: Floats, out: Floats,
) -> None:  # fmt: skip
    """Fill in (N, 2) pixels by which points move right and down; NaN for points that are not visible afterwards.

    Fills in the pixels from `start` to `stop`.

    Args:
        rays, distance, triangle, u, v: of the first picture.
        shifts: (M, 3, 3) displacements of the corners of the moving triangles, which begin at index `first`.
        frame: of the second camera: eye, right, up, forward, focal length.
        width, height: of both pictures.
        ids, later: (N,) node ids in the first and in the second picture; -1 for the background.
        far: (N,) depth of the second picture.
        out: filled.
    """
    focal = frame[12]
    for i in range(start, stop):
        t, away = triangle[i], HORIZON
        if t >= 0:
            away = distance[i]
        x, y, z = rays[i, 0] + rays[i, 3] * away, rays[i, 1] + rays[i, 4] * away, rays[i, 2] + rays[i, 5] * away
        if t >= first:
            m, w = t - first, ONE - u[i] - v[i]
            x += shifts[m, 0, 0] * w + shifts[m, 1, 0] * u[i] + shifts[m, 2, 0] * v[i]
            y += shifts[m, 0, 1] * w + shifts[m, 1, 1] * u[i] + shifts[m, 2, 1] * v[i]
            z += shifts[m, 0, 2] * w + shifts[m, 1, 2] * u[i] + shifts[m, 2, 2] * v[i]
        x, y, z = x - frame[0], y - frame[1], z - frame[2]
        depth = dot3(x, y, z, frame[9], frame[10], frame[11])
        out[i, 0] = out[i, 1] = np.float32(np.nan)
        if depth <= ZERO:
            continue
        column = dot3(x, y, z, frame[3], frame[4], frame[5]) / depth * focal + np.float32(width) * HALF
        row = np.float32(height) * HALF - dot3(x, y, z, frame[6], frame[7], frame[8]) / depth * focal
        if column < ZERO or row < ZERO or column >= np.float32(width) or row >= np.float32(height):
            continue
        there = int(row) * width + int(column)
        near = abs(far[there] - depth) <= TOLERANCE * depth + np.float32(0.02)
        if ids[i] == later[there] and (near or t < 0):
            out[i, 0] = column - np.float32(i % width) - HALF
            out[i, 1] = row - np.float32(i // width) - HALF


@kernel
def edges(colors: Any, triangle: Ints, owners: Ints, width: int, height: int, step: int, out: Any) -> None:
    """Mark pixels that differ from a neighbour by the thing, or by `step` in colour."""
    for row in range(height):
        for column in range(width):
            i = row * width + column
            for right in range(2):
                j = i + 1 if right else i + width
                if (right and column + 1 >= width) or (not right and row + 1 >= height):
                    continue
                other = owners[triangle[i]] != owners[triangle[j]]
                if not other:
                    for c in range(3):
                        other = other or abs(np.int32(colors[i, c]) - np.int32(colors[j, c])) > step
                if other:
                    out[i] = out[j] = True


@kernel
def smoothed(
    seen: Any, columns: Ints, flats: Floats, points: Floats, width: int, height: int, top: int, bottom: int, out: Any
) -> None:
    """Fill in some columns of `seen`, (N, K), averaged over the 4 by 4 pixels around each that show the same plane.

    The pixels of such a square cast rays at 16 different places of a light; together they sample all of it.
    Fills in the rows from `top` to `bottom`.
    """
    total = np.zeros(len(columns), np.int32)
    for row in range(top, bottom):
        for column in range(width):
            i = row * width + column
            fx, fy, fz = flats[i, 0], flats[i, 1], flats[i, 2]
            if fx == ZERO and fy == ZERO and fz == ZERO:
                continue
            total[:] = 0
            count = 0
            for r in range(max(row - 2, 0), min(row + 2, height)):
                for c in range(max(column - 2, 0), min(column + 2, width)):
                    j = r * width + c
                    if dot3(fx, fy, fz, flats[j, 0], flats[j, 1], flats[j, 2]) < np.float32(0.9):
                        continue
                    x, y, z = points[j, 0] - points[i, 0], points[j, 1] - points[i, 1], points[j, 2] - points[i, 2]
                    if abs(dot3(fx, fy, fz, x, y, z)) > np.float32(0.02):
                        continue
                    for k in range(len(columns)):
                        total[k] += seen[j, columns[k]]
                    count += 1
            for k in range(len(columns)):
                out[i, columns[k]] = np.uint8(total[k] // max(count, 1))


@kernel
def borrowed(
    pixels: Ints, flats: Floats, points: Floats, width: int, height: int, around: Floats, places: Floats, seen: Any,
    out: Any, index: Ints,
) -> int:  # fmt: skip
    """Fill in the lights' visibility from some points, copied from the nearest pixel on the same surface.

    Args:
        pixels: (M,) pixels of the points.
        flats, points: (M, 3) their flat normals and positions.
        width, height: of the picture.
        around, places, seen: flat normals, positions and visibility of all pixels.
        out: (M, K) filled.
        index: filled with the points without such a pixel.

    Returns:
        The number of points without such a pixel.
    """
    count = 0
    for k in range(len(pixels)):
        row, column = pixels[k] // width, pixels[k] % width
        fx, fy, fz = flats[k, 0], flats[k, 1], flats[k, 2]
        best, least = -1, np.float32(1e9)
        for r in range(max(row - 1, 0), min(row + 2, height)):
            for c in range(max(column - 1, 0), min(column + 2, width)):
                j = r * width + c
                if dot3(fx, fy, fz, around[j, 0], around[j, 1], around[j, 2]) < np.float32(0.9):
                    continue
                x, y, z = places[j, 0] - points[k, 0], places[j, 1] - points[k, 1], places[j, 2] - points[k, 2]
                far = dot3(x, y, z, x, y, z)
                if abs(dot3(fx, fy, fz, x, y, z)) <= np.float32(0.02) and far < least:
                    best, least = j, far
        if best >= 0:
            for n in range(seen.shape[1]):
                out[k, n] = seen[best, n]
        elif fx != ZERO or fy != ZERO or fz != ZERO:
            index[count] = k
            count += 1
    return count
