"""Compiled loops of shadow maps: triangles are drawn into them with bounds, and points are looked up.

A map is a picture of the things, taken from a light. Each texel has bounds of their nearness to the light. Nearness is
the inverse depth for a lamp, and the height towards the sun. Bounds hold for the whole texel, and for everything that
touches it at a corner, so that a bound and a ray agree about a point.
"""

from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays.kernels import kernel

TOUCH = 1e-2
"""Parts of a texel by which triangles are widened, or made smaller."""

FLAT_AREA = 1e-7
"""Area in texels below which a triangle is seen from the side."""

CLIP = 0.02
"""Metres before a lamp at which triangles are cut off."""

LEAST_DEPTH = 0.7
"""Metres from a lamp from which on points are looked up: what is cut off is beyond the end of their rays."""

TOO_NEAR = 4.0
"""Nearness to a lamp up to which a triangle is said to cast a shadow: nearer ones may lie beyond the rays' end."""

DARK, LIT, UNSURE = 0, 1, 2

ROUND = 1e-5
"""Relative rounding of nearness."""


@kernel
def draw(
    x: Any, y: Any, q: Any, group: int, most: Any, first: Any, other: Any, covered: Any, groups: Any
) -> None:  # fmt: skip
    """Draw a triangle into a map.

    Args:
        x, y: of its corners, three numbers each, in texels.
        q: their nearness.
        group: that it belongs to.
        most: greatest nearness at which it is said to cast a shadow.
        first, other, groups: (N, N) changed: the greatest nearness and its group, and the greatest of all other groups.
        covered: (N, N) changed: the greatest nearness that a triangle has everywhere in a texel.
    """
    size = first.shape[0]
    low, high = min(q[0], q[1], q[2]), max(q[0], q[1], q[2])
    left, right = max(int(np.floor(min(x[0], x[1], x[2]) - TOUCH)), 0), int(np.floor(max(x[0], x[1], x[2]) + TOUCH))
    top, bottom = max(int(np.floor(min(y[0], y[1], y[2]) - TOUCH)), 0), int(np.floor(max(y[0], y[1], y[2]) + TOUCH))
    right, bottom = min(right, size - 1), min(bottom, size - 1)
    area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
    sign = 1.0 if area >= 0.0 else -1.0
    steep = abs(area) < FLAT_AREA
    across = down = 0.0
    if not steep:
        across = ((q[1] - q[0]) * (y[2] - y[0]) - (q[2] - q[0]) * (y[1] - y[0])) / area
        down = ((q[2] - q[0]) * (x[1] - x[0]) - (q[1] - q[0]) * (x[2] - x[0])) / area
    a0, b0 = sign * (y[0] - y[1]), sign * (x[1] - x[0])
    a1, b1 = sign * (y[1] - y[2]), sign * (x[2] - x[1])
    a2, b2 = sign * (y[2] - y[0]), sign * (x[0] - x[2])
    # The greatest and least value of an edge over a texel, and by how much a corner may miss it.
    m0, m1, m2 = TOUCH * (abs(a0) + abs(b0)), TOUCH * (abs(a1) + abs(b1)), TOUCH * (abs(a2) + abs(b2))
    g0, g1, g2 = max(a0, 0.0) + max(b0, 0.0), max(a1, 0.0) + max(b1, 0.0), max(a2, 0.0) + max(b2, 0.0)
    l0, l1, l2 = min(a0, 0.0) + min(b0, 0.0), min(a1, 0.0) + min(b1, 0.0), min(a2, 0.0) + min(b2, 0.0)
    for r in range(top, bottom + 1):
        for c in range(left, right + 1):
            e0 = a0 * (c - x[0]) + b0 * (r - y[0])
            if e0 + g0 < -m0:
                continue
            e1 = a1 * (c - x[1]) + b1 * (r - y[1])
            if e1 + g1 < -m1:
                continue
            e2 = a2 * (c - x[2]) + b2 * (r - y[2])
            if e2 + g2 < -m2:
                continue
            near, far = high, low
            if not steep:
                corner = q[0] + across * (c - x[0]) + down * (r - y[0])
                slack = TOUCH * (abs(across) + abs(down))
                near = min(high, corner + max(across, 0.0) + max(down, 0.0) + slack)
                far = max(low, corner + min(across, 0.0) + min(down, 0.0) - slack)
            near32 = np.float32(near + ROUND * abs(near))
            if groups[r, c] == group and group >= 0:
                first[r, c] = max(first[r, c], near32)
            elif near32 > first[r, c]:
                other[r, c] = max(other[r, c], first[r, c])
                first[r, c], groups[r, c] = near32, group
            else:
                other[r, c] = max(other[r, c], near32)
            if not steep and near <= most and e0 + l0 > m0 and e1 + l1 > m1 and e2 + l2 > m2:
                covered[r, c] = max(covered[r, c], np.float32(far - ROUND * abs(far)))


@kernel
def face_of(face: int, x: Any, y: Any, z: Any) -> Any:
    """Return a vector from a lamp as a face of its cube sees it: right, up, and depth."""
    if face == 0:
        return -z, y, x
    if face == 1:
        return z, y, -x
    if face == 2:
        return x, -z, y
    if face == 3:
        return x, z, -y
    if face == 4:
        return x, y, z
    return -x, y, -z


@kernel
def draw_cube(
    corners: Floats, triangles: Any, group: Ints, place: Any, face: int,
    first: Any, other: Any, covered: Any, groups: Any,
) -> None:  # fmt: skip
    """Draw triangles into one face of a lamp's cube; see `draw`.

    Args:
        corners: (T, 3, 3) of all triangles.
        triangles: those that are drawn.
        group: (T,) their groups.
        place: of the lamp.
        face: from 0 to 5.
        first, other, covered, groups: of the face.
    """
    half = first.shape[0] / 2
    a, b, c = np.empty(3), np.empty(3), np.empty(3)
    px, py, pz = np.empty(4), np.empty(4), np.empty(4)
    x, y, q = np.empty(3), np.empty(3), np.empty(3)
    for i in range(len(triangles)):
        t = triangles[i]
        if group[t] < 0:
            continue
        for k in range(3):
            dx, dy, dz = corners[t, k, 0] - place[0], corners[t, k, 1] - place[1], corners[t, k, 2] - place[2]
            a[k], b[k], c[k] = face_of(face, dx, dy, dz)
        if c[0] < CLIP and c[1] < CLIP and c[2] < CLIP:
            continue
        count = 0
        for k in range(3):
            j = (k + 1) % 3
            if c[k] >= CLIP:
                px[count], py[count], pz[count] = a[k], b[k], c[k]
                count += 1
            if (c[k] >= CLIP) != (c[j] >= CLIP):
                w = (CLIP - c[k]) / (c[j] - c[k])
                px[count], py[count], pz[count] = a[k] + w * (a[j] - a[k]), b[k] + w * (b[j] - b[k]), CLIP
                count += 1
        for k in range(1, count - 1):
            for j in range(3):
                n = 0 if j == 0 else k + j - 1
                q[j] = 1.0 / pz[n]
                x[j], y[j] = half + half * px[n] * q[j], half - half * py[n] * q[j]
            draw(x, y, q, group[t], TOO_NEAR, first, other, covered, groups)


@kernel
def draw_plane(
    corners: Floats, group: Ints, frame: Any, scale: Any, first: Any, other: Any, covered: Any, groups: Any
) -> None:
    """Draw all triangles into the sun's map; see `draw`.

    Args:
        corners, group: of all triangles.
        frame: the least position across and down; right, up, and the direction to the sun.
        scale: texels a metre.
        first, other, covered, groups: of the map.
    """
    x, y, q = np.empty(3), np.empty(3), np.empty(3)
    for t in range(len(corners)):
        if group[t] < 0:
            continue
        for k in range(3):
            p, f = corners[t, k], frame
            x[k] = (p[0] * f[2] + p[1] * f[3] + p[2] * f[4] - f[0]) * scale
            y[k] = (p[0] * f[5] + p[1] * f[6] + p[2] * f[7] - f[1]) * scale
            q[k] = p[0] * f[8] + p[1] * f[9] + p[2] * f[10]
        draw(x, y, q, group[t], 1e9, first, other, covered, groups)


@kernel
def judged(q: Any, own: int, first: Any, other: Any, covered: Any, group: int, slack: Any) -> int:
    """Return whether a point of nearness `q` and of a group is DARK, LIT or UNSURE, by a texel's bounds."""
    if q > (other if own >= 0 and own == group else first) + slack:
        return LIT
    return DARK if covered > q + np.float32(10) * slack else UNSURE


@kernel
def put_off(rays: Floats, j: int, rest: Floats, places: Ints, count: int) -> int:
    """Keep a ray for casting, as the next after `count` others; returns their number with it."""
    for k in range(6):
        rest[count, k] = rays[j, k]
    places[count] = j
    return count + 1


@kernel
def look_up_cube(
    rays: Floats, index: Ints, own: Ints, first: Any, other: Any, covered: Any, groups: Any,
    blocked: Any, rest: Floats, places: Ints,
) -> int:  # fmt: skip
    """Fill in which rays to a lamp are blocked; returns the number of those that must be cast.

    Args:
        rays: (N, 6) from points to the lamp.
        index: (N,) their points.
        own: (M,) the points' groups.
        first, other, covered, groups: (6, S, S) of the map.
        blocked: (N,) filled where it is certain.
        rest, places: filled with the rays that must be cast, and their places in `rays`.
    """
    size, count = first.shape[1], 0
    half = np.float32(size) * np.float32(0.5)
    for j in range(len(rays)):
        x, y, z = -rays[j, 3], -rays[j, 4], -rays[j, 5]
        ax, ay, az = abs(x), abs(y), abs(z)
        if ax >= ay and ax >= az:
            face = 0 if x > 0 else 1
        elif ay >= az:
            face = 2 if y > 0 else 3
        else:
            face = 4 if z > 0 else 5
        a, b, c = face_of(face, x, y, z)
        state = UNSURE
        if c > np.float32(LEAST_DEPTH):
            q = np.float32(1) / c
            column = min(max(int(half + half * a * q), 0), size - 1)
            row = min(max(int(half - half * b * q), 0), size - 1)
            f, o, v = first[face, row, column], other[face, row, column], covered[face, row, column]
            state = judged(q, own[index[j]], f, o, v, groups[face, row, column], q * np.float32(ROUND))
        if state == UNSURE:
            count = put_off(rays, j, rest, places, count)
        else:
            blocked[j] = state == DARK
    return count


@kernel
def look_up_plane(
    rays: Floats, index: Ints, own: Ints, frame: Any, scale: Any, first: Any, other: Any, covered: Any, groups: Any,
    blocked: Any, rest: Floats, places: Ints,
) -> int:  # fmt: skip
    """Fill in which rays to the sun are blocked; returns the number of those that must be cast; see `look_up_cube`."""
    size, count = first.shape[0], 0
    for j in range(len(rays)):
        x, y, z = rays[j, 0], rays[j, 1], rays[j, 2]
        column = int(np.floor((x * frame[2] + y * frame[3] + z * frame[4] - frame[0]) * scale))
        row = int(np.floor((x * frame[5] + y * frame[6] + z * frame[7] - frame[1]) * scale))
        q = x * frame[8] + y * frame[9] + z * frame[10]
        state = UNSURE
        if 0 <= column < size and 0 <= row < size:
            f, o, v = first[row, column], other[row, column], covered[row, column]
            state = judged(q, own[index[j]], f, o, v, groups[row, column], np.float32(2e-5))
        if state == UNSURE:
            count = put_off(rays, j, rest, places, count)
        else:
            blocked[j] = state == DARK
    return count


@kernel
def own_groups(triangles: Ints, groups: Ints, rows: Floats, flats: Floats, normal: int, out: Ints) -> None:
    """Fill in (M,) the groups that cannot shade some points; -1 for none.

    Args:
        triangles: (M,) that the points lie on.
        groups: (T,) of the static triangles.
        rows, flats: (M, COLUMNS) of the triangles, and (M, 3) flat normals towards the viewer.
        normal: column of a row's flat normal.
        out: filled.
    """
    for k in range(len(triangles)):
        t = triangles[k]
        out[k] = -1
        if 0 <= t < len(groups):
            group = groups[t]
            side = rows[k, normal] * flats[k, 0] + rows[k, normal + 1] * flats[k, 1] + rows[k, normal + 2] * flats[k, 2]
            if group % 2 == 1 or side > 0:
                out[k] = group
