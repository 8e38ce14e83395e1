"""Compiled loops of a rasteriser: triangles are projected, filled row by row, and the winner's hit is computed exactly.

A record is a projected triangle: its corners from the top down, and the plane of its inverse depth over the picture. A
pixel belongs to a triangle if its middle lies between the triangle's edges, which neighbours compute alike, so that
there are no gaps between them.
"""

from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays.kernels import kernel

RECORD = 9
"""Columns of a record: x and y of three corners, then inverse depth at (0, 0), and its slopes across and down."""

PLACE = 5
"""Columns of its place: triangle, first and last row, first and last column; the last ones are excluded."""

TILE = 16
"""Width and height in pixels of the tiles by which hidden things are skipped."""


@kernel
def between(low: Any, high: Any, limit: int) -> Any:
    """Return the pixels of a row or column whose middles lie between two numbers.

    The first, and the one after the last.
    """
    first = 0 if low <= 0.0 else int(np.ceil(min(low, limit + 1.0) - 0.5))
    last = limit if high >= limit else int(np.ceil(max(high, 0.0) - 0.5))
    return first, last


@kernel
def record(
    x0: Any, y0: Any, q0: Any, x1: Any, y1: Any, q1: Any, x2: Any, y2: Any, q2: Any,
    triangle: int, width: int, height: int, records: Any, places: Any, n: int,
) -> int:  # fmt: skip
    """Append a triangle of pixel positions and inverse depths if it covers a pixel's middle; returns the new number."""
    top, bottom = between(min(y0, y1, y2), max(y0, y1, y2), height)
    left, right = between(min(x0, x1, x2), max(x0, x1, x2), width)
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    if top >= bottom or left >= right or area == 0.0:
        return n
    across = ((q1 - q0) * (y2 - y0) - (q2 - q0) * (y1 - y0)) / area
    down = ((q2 - q0) * (x1 - x0) - (q1 - q0) * (x2 - x0)) / area
    row, place = records[n], places[n]
    row[6], row[7], row[8] = q0 - across * x0 - down * y0, across, down
    if y1 < y0:
        x0, y0, x1, y1 = x1, y1, x0, y0
    if y2 < y0:
        x0, y0, x2, y2 = x2, y2, x0, y0
    if y2 < y1:
        x1, y1, x2, y2 = x2, y2, x1, y1
    row[0], row[1], row[2], row[3], row[4], row[5] = x0, y0, x1, y1, x2, y2
    place[0], place[1], place[2], place[3], place[4] = triangle, top, bottom, left, right
    return n + 1


@kernel
def project(
    corners: Floats, starts: Any, ends: Any, things: Any, frame: Any, width: int, height: int, near: Any,
    records: Any, places: Any,
) -> int:  # fmt: skip
    """Append records of the triangles of some things; returns their number.

    Args:
        corners: (T, 3, 3) of a part's triangles.
        starts, ends: of each thing's triangles.
        things: indices of the things.
        frame: of the camera: eye, right, up, forward, and focal length in pixels.
        width, height: of the picture.
        near: depth in metres at which triangles are cut off.
        records, places: (N, RECORD) and (N, PLACE), filled; a triangle cut off may become two.
    """
    focal, n = frame[12], 0
    p = np.empty((3, 3))
    q = np.empty((4, 3))
    for thing in things:
        for t in range(starts[thing], ends[thing]):
            behind = 0
            for j in range(3):
                x, y, z = corners[t, j, 0] - frame[0], corners[t, j, 1] - frame[1], corners[t, j, 2] - frame[2]
                for k in range(3):
                    p[j, k] = x * frame[3 + 3 * k] + y * frame[4 + 3 * k] + z * frame[5 + 3 * k]
                behind += p[j, 2] < near
            if behind == 3:
                continue
            count = 3
            if behind:
                count = cut_off(p, near, q)
            else:
                q[:3] = p
            for j in range(count):
                q[j, 2] = 1.0 / q[j, 2]
                q[j, 0] = width * 0.5 + q[j, 0] * focal * q[j, 2]
                q[j, 1] = height * 0.5 - q[j, 1] * focal * q[j, 2]
            for j in range(1, count - 1):
                n = record(
                    q[0, 0], q[0, 1], q[0, 2], q[j, 0], q[j, 1], q[j, 2], q[j + 1, 0], q[j + 1, 1], q[j + 1, 2],
                    t, width, height, records, places, n,
                )  # fmt: skip
    return n


@kernel
def cut_off(p: Any, near: Any, q: Any) -> int:
    """Fill in the part of a triangle beyond a depth, a polygon of up to four corners; returns their number."""
    count = 0
    for j in range(3):
        i = (j + 1) % 3
        if p[j, 2] >= near:
            q[count] = p[j]
            count += 1
        if (p[j, 2] >= near) != (p[i, 2] >= near):
            share = (near - p[j, 2]) / (p[i, 2] - p[j, 2])
            q[count, 0], q[count, 1] = p[j, 0] + share * (p[i, 0] - p[j, 0]), p[j, 1] + share * (p[i, 1] - p[j, 1])
            q[count, 2] = near
            count += 1
    return count


@kernel
def fill(records: Any, places: Any, n: int, top: int, bottom: int, depth: Floats, triangle: Ints) -> None:
    """Write triangles into the rows from `top` to `bottom` of (H, W) inverse depths and triangles, where nearer."""
    for t in range(n):
        first, last = max(places[t, 1], top), min(places[t, 2], bottom)
        if first >= last:
            continue
        number, left, right = places[t, 0], places[t, 3], places[t, 4]
        x0, y0, x1, y1, x2, y2 = (
            records[t, 0],
            records[t, 1],
            records[t, 2],
            records[t, 3],
            records[t, 4],
            records[t, 5],
        )
        origin, across, down = records[t, 6], records[t, 7], records[t, 8]
        long = (x2 - x0) / (y2 - y0)
        upper = (x1 - x0) / (y1 - y0) if y1 > y0 else 0.0
        lower = (x2 - x1) / (y2 - y1) if y2 > y1 else 0.0
        for row in range(first, last):
            y = row + 0.5
            one = x0 + (y - y0) * long
            other = x0 + (y - y0) * upper if y < y1 else x1 + (y - y1) * lower
            start, stop = between(min(one, other), max(one, other), right)
            base = origin + down * y + across * 0.5
            depths, triangles = depth[row], triangle[row]
            for i in range(max(start, left), stop):
                found = np.float32(base + across * np.float64(i))
                old = depths[i]
                nearer = found > old
                depths[i] = found if nearer else old
                triangles[i] = number if nearer else triangles[i]


@kernel
def farthest(depth: Floats, top: int, bottom: int, tiles: Floats) -> None:
    """Fill in the least inverse depth of the tiles of some rows."""
    for i in range(top // TILE, (bottom + TILE - 1) // TILE):
        for j in range(tiles.shape[1]):
            least = np.float32(np.inf)
            for row in range(i * TILE, min(i * TILE + TILE, depth.shape[0])):
                for column in range(j * TILE, min(j * TILE + TILE, depth.shape[1])):
                    least = min(least, depth[row, column])
            tiles[i, j] = least


@kernel
def in_view(
    boxes: Any, things: Any, frame: Any, width: int, height: int, near: Any, tiles: Floats, out: Any
) -> int:  # fmt: skip
    """Fill in those of some things that may cover pixels; returns their number.

    Args:
        boxes: (things, 6) low and high corners.
        things: indices of those to look at.
        frame, width, height, near: as in `project`.
        tiles: (rows, columns) the least inverse depth of each tile, behind which nothing shows; (0, 0) to skip nothing.
        out: filled.
    """
    count, focal = 0, frame[12]
    for thing in things:
        behind = left = right = above = below = 0
        x0, y0, x1, y1, nearest = np.inf, np.inf, -np.inf, -np.inf, 0.0
        for j in range(8):
            x = boxes[thing, 3 if j & 1 else 0] - frame[0]
            y = boxes[thing, 4 if j & 2 else 1] - frame[1]
            z = boxes[thing, 5 if j & 4 else 2] - frame[2]
            a = (x * frame[3] + y * frame[4] + z * frame[5]) * focal
            b = (x * frame[6] + y * frame[7] + z * frame[8]) * focal
            far = x * frame[9] + y * frame[10] + z * frame[11]
            left += a < -far * width * 0.5
            right += a > far * width * 0.5
            above += b > far * height * 0.5
            below += b < -far * height * 0.5
            if far < near:
                behind += 1
            else:
                x0, x1 = min(x0, width * 0.5 + a / far), max(x1, width * 0.5 + a / far)
                y0, y1 = min(y0, height * 0.5 - b / far), max(y1, height * 0.5 - b / far)
                nearest = max(nearest, 1.0 / far)
        if behind == 8 or left == 8 or right == 8 or above == 8 or below == 8:
            continue
        if not behind and len(tiles) and hidden(x0, y0, x1, y1, nearest, width, height, tiles):
            continue
        out[count] = thing
        count += 1
    return count


@kernel
def hidden(x0: Any, y0: Any, x1: Any, y1: Any, nearest: Any, width: int, height: int, tiles: Floats) -> bool:
    """Return whether all tiles of a rectangle of pixels show something nearer."""
    for i in range(max(0, int(y0)) // TILE, min(height - 1, int(y1) + 1) // TILE + 1):
        for j in range(max(0, int(x0)) // TILE, min(width - 1, int(x1) + 1) // TILE + 1):
            if nearest * 1.0001 + 1e-6 >= tiles[i, j]:
                return False
    return True


@kernel
def resolve(
    triangle: Ints, start: int, stop: int, corners: Floats, rays: Floats,
    distance: Floats, number: Ints, u: Floats, v: Floats,
) -> None:  # fmt: skip
    """Write the hits of the pixels from `start` to `stop`, of the rays with the triangles that cover them."""
    for i in range(start, stop):
        number[i] = triangle[i]
        distance[i], u[i], v[i] = np.float32(np.inf), np.float32(0), np.float32(0)
        if triangle[i] >= 0:
            distance[i], u[i], v[i] = hit(corners[triangle[i]], rays[i])


@kernel
def hit(corners: Floats, ray: Floats) -> Any:
    """Distance and barycentric weights at which a ray meets the plane of a triangle (Möller and Trumbore)."""
    ax, ay, az = np.float64(corners[0, 0]), np.float64(corners[0, 1]), np.float64(corners[0, 2])
    bx, by, bz = corners[1, 0] - ax, corners[1, 1] - ay, corners[1, 2] - az
    cx, cy, cz = corners[2, 0] - ax, corners[2, 1] - ay, corners[2, 2] - az
    dx, dy, dz = ray[3], ray[4], ray[5]
    px, py, pz = dy * cz - dz * cy, dz * cx - dx * cz, dx * cy - dy * cx
    scale = 1.0 / (bx * px + by * py + bz * pz)
    tx, ty, tz = ray[0] - ax, ray[1] - ay, ray[2] - az
    qx, qy, qz = ty * bz - tz * by, tz * bx - tx * bz, tx * by - ty * bx
    u, v = (tx * px + ty * py + tz * pz) * scale, (dx * qx + dy * qy + dz * qz) * scale
    return np.float32((cx * qx + cy * qy + cz * qz) * scale), np.float32(u), np.float32(v)


@kernel
def nearer_hits(
    triangle: Ints, top: int, bottom: int, left: int, right: int, width: int, corners: Floats, first: int, rays: Floats,
    distance: Floats, number: Ints, u: Floats, v: Floats, won: Ints,
) -> int:  # fmt: skip
    """Replace hits in a rectangle of pixels by nearer ones of other triangles.

    Args:
        triangle: (H * W,) the other triangles that cover the pixels, -1 for none.
        top, bottom, left, right, width: the rectangle, and the picture's width.
        corners, first: of the other triangles, and the index of the first of them.
        rays: of all pixels.
        distance, number, u, v: the hits; changed.
        won: filled with the changed pixels, in order.

    Returns:
        The number of changed pixels.
    """
    count = 0
    for row in range(top, bottom):
        for i in range(row * width + left, row * width + right):
            if triangle[i] < 0:
                continue
            far, a, b = hit(corners[triangle[i]], rays[i])
            if far < distance[i]:
                distance[i], number[i], u[i], v[i] = far, triangle[i] + np.int32(first), a, b
                won[count] = i
                count += 1
    return count
