"""Compiled loops of light buffers: triangles are projected, put into cells, and met by shadow rays."""

from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays.kernels import ONE, ZERO, kernel
from hearth.rendering.rays.light_rays import FAR

EDGE = 0.5
"""Cells around the outermost triangles."""

SLACK = np.float32(0.01)
"""Cells by which a triangle's rectangle is widened: positions are rounded."""


ROUNDED = 1e-4
"""Metres by which depths may be wrong."""


@kernel
def middle(corners: Floats, chosen: Any) -> Floats:
    """Return the middle of some triangles' first corners."""
    total = np.zeros(3)
    for t in chosen:
        for k in range(3):
            total[k] += corners[t, 0, k]
    return total / len(chosen)


@kernel
def seen_from(frame: Floats, is_sun: bool, x: Any, y: Any, z: Any) -> Any:
    """Return where a point lies from a light: across, up, and how far along the grid's axis."""
    x, y, z = x - frame[0], y - frame[1], z - frame[2]
    right = x * frame[3] + y * frame[4] + z * frame[5]
    up = x * frame[6] + y * frame[7] + z * frame[8]
    depth = x * frame[9] + y * frame[10] + z * frame[11]
    if is_sun:
        return right, up, depth
    scale = 1.0 / depth if depth > 0.0 else 0.0
    return right * scale, up * scale, depth


@kernel
def project(
    corners: Floats, chosen: Any, frame: Floats, is_sun: bool, places: Floats, nearest: Floats, bounds: Floats
) -> None:
    """Fill in (K, 3, 2) where the corners of some triangles lie, and (K,) their least depths, less some slack.

    `bounds` is filled with the least and greatest places across and up, and the least depth of all.
    """
    west, low, least = np.inf, np.inf, np.inf
    east, high = -np.inf, -np.inf
    for n in range(len(chosen)):
        t, near = chosen[n], np.inf
        for k in range(3):
            a, b, depth = seen_from(frame, is_sun, corners[t, k, 0], corners[t, k, 1], corners[t, k, 2])
            places[n, k, 0], places[n, k, 1] = a, b
            west, east, low, high = min(west, a), max(east, a), min(low, b), max(high, b)
            near = min(near, depth)
        nearest[n], least = near - ROUNDED, min(least, near)
    bounds[0], bounds[1], bounds[2], bounds[3], bounds[4] = west, east, low, high, least


@kernel
def cells(places: Floats, n: int, frame: Floats, size: int) -> Any:
    """Return the columns and rows of cells that a triangle may touch; the last ones are included."""
    left, down, scale = np.float32(frame[12]), np.float32(frame[13]), np.float32(frame[14])
    x0, x1, x2 = places[n, 0, 0], places[n, 1, 0], places[n, 2, 0]
    y0, y1, y2 = places[n, 0, 1], places[n, 1, 1], places[n, 2, 1]
    first = int((min(x0, x1, x2) - left) * scale - SLACK)
    last = int((max(x0, x1, x2) - left) * scale + SLACK)
    bottom = int((min(y0, y1, y2) - down) * scale - SLACK)
    top = int((max(y0, y1, y2) - down) * scale + SLACK)
    return max(first, 0), min(last, size - 1), max(bottom, 0), min(top, size - 1)


@kernel
def count(places: Floats, frame: Floats, size: int, starts: Ints) -> int:
    """Fill in where each cell's triangles end in the list, before any is in it; returns the list's length."""
    for n in range(len(places)):
        first, last, bottom, top = cells(places, n, frame, size)
        for row in range(bottom, top + 1):
            for column in range(first, last + 1):
                starts[row * size + column] += 1
    total = 0
    for cell in range(len(starts)):
        total += starts[cell]
        starts[cell] = total
    return total


@kernel
def distribute(
    places: Floats,
    nearest: Floats,
    chosen: Any,
    frame: Floats,
    size: int,
    starts: Ints,
    triangles: Ints,
    depths: Floats,
) -> None:
    """Fill the list with triangles and their least depths; afterwards `starts` is where each cell's triangles begin."""
    for n in range(len(places)):
        first, last, bottom, top = cells(places, n, frame, size)
        for row in range(bottom, top + 1):
            for column in range(first, last + 1):
                place = starts[row * size + column] - 1
                starts[row * size + column], triangles[place], depths[place] = place, chosen[n], nearest[n]


@kernel
def edges_of(corners: Floats, edges: Floats) -> None:
    """Fill in (T, 9) a corner of each triangle, and the ways from there to the two others."""
    for t in range(len(corners)):
        for k in range(3):
            edges[t, k] = corners[t, 0, k]
            edges[t, 3 + k], edges[t, 6 + k] = corners[t, 1, k] - corners[t, 0, k], corners[t, 2, k] - corners[t, 0, k]


@kernel
def crosses(
    ax: Any, ay: Any, az: Any, bx: Any, by: Any, bz: Any, cx: Any, cy: Any, cz: Any,
    x: Any, y: Any, z: Any, dx: Any, dy: Any, dz: Any, far: Any,
) -> Any:  # fmt: skip
    """Return whether a ray meets a triangle before `far` times its direction (Möller and Trumbore, without a division).

    The triangle is a corner, and the ways from there to the two others.
    """
    px, py, pz = dy * cz - dz * cy, dz * cx - dx * cz, dx * cy - dy * cx
    scale = bx * px + by * py + bz * pz
    sign = ONE if scale >= ZERO else -ONE
    scale *= sign
    tx, ty, tz = (x - ax) * sign, (y - ay) * sign, (z - az) * sign
    u = tx * px + ty * py + tz * pz
    qx, qy, qz = ty * bz - tz * by, tz * bx - tx * bz, tx * by - ty * bx
    v = dx * qx + dy * qy + dz * qz
    along = cx * qx + cy * qy + cz * qz
    return (u >= ZERO) & (v >= ZERO) & (u + v <= scale) & (along > ZERO) & (along < far * scale)


@kernel
def shaded(
    lit: Ints, skipped: Any, points: Floats, light: Floats, is_sun: bool, far: Any,
    frame: Floats, size: int, starts: Ints, triangles: Ints, depths: Floats, edges: Floats, dark: Ints,
) -> int:  # fmt: skip
    """Fill in those of some points whose rays to a light meet a triangle; returns their number.

    Args:
        lit: (K,) indices of the points.
        skipped: (M,) whether a point is excluded.
        points: (M, 3).
        light: position, or direction to the sun.
        is_sun: whether it is the sun.
        far: share of the way up to which triangles count.
        frame, size, starts, triangles, depths, edges: see `LightGrid`.
        dark: (K,) filled.
    """
    found = 0
    left, down, scale = np.float32(frame[12]), np.float32(frame[13]), np.float32(frame[14])
    right, top = left + size / scale, down + size / scale
    lx, ly, lz = light[0], light[1], light[2]
    fx, fy, fz = np.float32(frame[0]), np.float32(frame[1]), np.float32(frame[2])
    ax, ay, az = np.float32(frame[3]), np.float32(frame[4]), np.float32(frame[5])
    bx, by, bz = np.float32(frame[6]), np.float32(frame[7]), np.float32(frame[8])
    cx, cy, cz = np.float32(frame[9]), np.float32(frame[10]), np.float32(frame[11])
    for j in range(len(lit)):
        k = lit[j]
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        px, py, pz = x - fx, y - fy, z - fz
        depth = px * cx + py * cy + pz * cz
        by_depth = ONE if is_sun else depth
        a, b = px * ax + py * ay + pz * az, px * bx + py * by + pz * bz
        if a < left * by_depth or a > right * by_depth or b < down * by_depth or b > top * by_depth or skipped[k]:
            continue
        a, b = (a / by_depth - left) * scale, (b / by_depth - down) * scale
        if not (ZERO <= a < size and ZERO <= b < size):
            continue
        cell = int(b) * size + int(a)
        first, last = starts[cell], starts[cell + 1]
        if first == last:
            continue
        dx, dy, dz = (lx * FAR, ly * FAR, lz * FAR) if is_sun else (lx - x, ly - y, lz - z)
        for n in range(first, last):
            if depths[n] > depth:
                continue
            t = triangles[n]
            if crosses(
                edges[t, 0], edges[t, 1], edges[t, 2], edges[t, 3], edges[t, 4], edges[t, 5], edges[t, 6], edges[t, 7],
                edges[t, 8], x, y, z, dx, dy, dz, far,
            ):  # fmt: skip
                dark[found] = k
                found += 1
                break
    return found
