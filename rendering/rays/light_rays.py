"""Compiled loops over surface points: their positions and normals, and rays from them to lights."""

from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.rays.kernels import (
    FLAT,
    HALF,
    NORMAL,
    NORMAL_U,
    NORMAL_V,
    ONE,
    TINY,
    TWO,
    ZERO,
    dot3,
    kernel,
    root,
    slab,
)

LIFT = np.float32(2e-3)
"""Metres by which ray origins are lifted off their surface."""

FAR = np.float32(60.0)
"""Length of shadow rays to the sun, metres."""

REACH = np.float32(7.0)
"""Metres beyond which lamps give no light."""

FAINT = np.float32(0.012)
"""Light below which shadows and reflections are not computed."""

NEAR = np.float32(0.7)
"""Metres within which surfaces occlude ambient light."""

# A light's row: position, colour, whether it is a window, its direction, (x0, x1, z0, z1) that it reaches, its span.
L_PLACE, L_COLOR, L_WINDOW, L_FACING, L_AREA, L_SPAN, L_COLUMNS = 0, 3, 6, 7, 10, 14, 17
# The day's row: direction to the sun, its colour, whether it is up, ambient light; zenith, horizon, brightness of the
# sky, whether the background is plain; and radians per pixel.
D_SUN, D_COLOR, D_UP, D_AMBIENT = 0, 3, 6, 7
D_ZENITH, D_HORIZON, D_SKY, D_PLAIN, D_ANGLE = 8, 11, 14, 15, 16

OPEN = np.uint8(255)
"""Visibility of an unoccluded light."""

FADE = ONE / (REACH * REACH)


@kernel
def side_of(x: Any, y: Any, z: Any, wx: Any, wy: Any, wz: Any) -> Any:
    """-1 if a vector points along a direction, else 1."""
    return -ONE if dot3(x, y, z, wx, wy, wz) > ZERO else ONE


@kernel
def locate(
    pixels: Ints, rays: Floats, distance: Floats, u: Floats, v: Floats, rows: Floats,
    points: Floats, normals: Floats, flats: Floats, views: Floats, bounds: Floats,
) -> None:  # fmt: skip
    """Surface points of some pixels.

    Args:
        pixels: (M,) their indices.
        rays, distance, u, v: of all pixels.
        rows: (M, COLUMNS) of their triangles.
        points, normals, flats: (M, 3) filled: points lifted off their surface; normals towards the viewer, smooth and
            flat; flat ones are 0 for the background.
        views: (M, 3) unit vectors along the rays, filled.
        bounds: filled with the least and greatest x and z of the points.
    """
    west, south = np.float32(1e9), np.float32(1e9)
    east, north = np.float32(-1e9), np.float32(-1e9)
    for k in range(len(pixels)):
        i = pixels[k]
        dx, dy, dz, far = rays[i, 3], rays[i, 4], rays[i, 5], distance[i]
        norm = ONE / root(dot3(dx, dy, dz, dx, dy, dz))
        views[k, 0], views[k, 1], views[k, 2] = dx * norm, dy * norm, dz * norm
        fx, fy, fz = rows[k, FLAT], rows[k, FLAT + 1], rows[k, FLAT + 2]
        if fx == ZERO and fy == ZERO and fz == ZERO:
            flats[k, 0] = flats[k, 1] = flats[k, 2] = ZERO
            normals[k, 0] = normals[k, 1] = normals[k, 2] = ZERO
            points[k, 0] = points[k, 1] = points[k, 2] = ZERO
            continue
        sign = side_of(fx, fy, fz, dx, dy, dz)
        fx, fy, fz = fx * sign, fy * sign, fz * sign
        nx = rows[k, NORMAL] + rows[k, NORMAL_U] * u[i] + rows[k, NORMAL_V] * v[i]
        ny = rows[k, NORMAL + 1] + rows[k, NORMAL_U + 1] * u[i] + rows[k, NORMAL_V + 1] * v[i]
        nz = rows[k, NORMAL + 2] + rows[k, NORMAL_U + 2] * u[i] + rows[k, NORMAL_V + 2] * v[i]
        sign = -side_of(nx, ny, nz, fx, fy, fz)
        flats[k, 0], flats[k, 1], flats[k, 2] = fx, fy, fz
        normals[k, 0], normals[k, 1], normals[k, 2] = nx * sign, ny * sign, nz * sign
        x, z = rays[i, 0] + dx * far + fx * LIFT, rays[i, 2] + dz * far + fz * LIFT
        points[k, 0], points[k, 1], points[k, 2] = x, rays[i, 1] + dy * far + fy * LIFT, z
        west, east, south, north = min(west, x), max(east, x), min(south, z), max(north, z)
    bounds[0], bounds[1], bounds[2], bounds[3] = west, east, south, north


@kernel
def aim_at_sun(
    points: Floats, normals: Floats, flats: Floats, day: Floats, noise: Floats, out: Floats, index: Ints
) -> int:
    """Fill in rays to the sun and the indices of their points, for points that it may light; returns their number.

    `noise`, (M, 2) from 0 to 1, softens the edges of shadows; (0, 2) leaves them hard.
    """
    count, soft = 0, len(noise) > 0
    x, y, z = day[D_SUN], day[D_SUN + 1], day[D_SUN + 2]
    for k in range(len(points)):
        if dot3(flats[k, 0], flats[k, 1], flats[k, 2], x, y, z) <= ZERO:
            continue
        if dot3(normals[k, 0], normals[k, 1], normals[k, 2], x, y, z) <= ZERO:
            continue
        one, other = (noise[k, 0] - HALF, noise[k, 1] - HALF) if soft else (ZERO, ZERO)
        out[count, 0], out[count, 1], out[count, 2] = points[k, 0], points[k, 1], points[k, 2]
        out[count, 3] = (x + one * np.float32(0.05)) * FAR
        out[count, 4] = (y + other * np.float32(0.02)) * FAR
        out[count, 5] = (z - one * np.float32(0.05)) * FAR
        index[count] = k
        count += 1
    return count


@kernel
def strength(window: bool, cosine: Any, leaving: Any, square: Any) -> Any:
    """Return a light's strength at a point, before shadows.

    Args:
        window: whether the light is a window; else a lamp.
        cosine: between the surface's normal and the direction to the light.
        leaving: cosine between a window's direction and the direction from it.
        square: of the distance.
    """
    if not window:
        fade = square * FADE
        return max(cosine, ZERO) * max(ONE - fade * fade, ZERO) / (square + np.float32(0.35))
    # The sky is wide: surfaces turned slightly away from the window still receive light.
    wide = max((cosine + np.float32(0.25)) * np.float32(0.8), ZERO)
    return wide * (np.float32(0.25) + np.float32(0.75) * max(leaving, ZERO)) / (square + np.float32(0.8))


@kernel
def reaching(wx: Any, wy: Any, wz: Any, nx: Any, ny: Any, nz: Any, window: bool, fx: Any, fy: Any, fz: Any) -> Any:
    """Return a light's strength, before shadows, at a point with a normal n, from which w leads to it.

    A window faces f.
    """
    square = dot3(wx, wy, wz, wx, wy, wz)
    norm = ONE / root(square)
    return strength(window, dot3(nx, ny, nz, wx, wy, wz) * norm, -dot3(fx, fy, fz, wx, wy, wz) * norm, square)


@kernel
def aim_at_light(
    points: Floats, normals: Floats, flats: Floats, light: Floats, noise: Floats, out: Floats, index: Ints
) -> int:
    """Fill in rays to a light and the indices of their points, for points that it may light; returns their number.

    `noise`, (M, 2), spreads the targets over the light; (0, 2) aims at its middle.
    """
    count, soft, least = 0, len(noise) > 0, FAINT / max(light[L_COLOR], TINY)
    lx, ly, lz = light[L_PLACE], light[L_PLACE + 1], light[L_PLACE + 2]
    sx, sy, sz = light[L_SPAN], light[L_SPAN + 1], light[L_SPAN + 2]
    fx, fy, fz, window = light[L_FACING], light[L_FACING + 1], light[L_FACING + 2], light[L_WINDOW] > ZERO
    west, east, south, north = light[L_AREA], light[L_AREA + 1], light[L_AREA + 2], light[L_AREA + 3]
    for k in range(len(points)):
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        if not (west < x < east and south < z < north):
            continue
        wx, wy, wz = lx - x, ly - y, lz - z
        if soft:
            third = (noise[k, 0] + noise[k, 1]) % ONE
            wx += ((third if sx < sz else noise[k, 0]) * TWO - ONE) * sx
            wy += (noise[k, 1] * TWO - ONE) * sy
            wz += ((noise[k, 0] if sx < sz else third) * TWO - ONE) * sz
        if dot3(flats[k, 0], flats[k, 1], flats[k, 2], wx, wy, wz) <= ZERO:
            continue
        nx, ny, nz = normals[k, 0], normals[k, 1], normals[k, 2]
        if reaching(lx - x, ly - y, lz - z, nx, ny, nz, window, fx, fy, fz) <= least:
            continue
        out[count, 0], out[count, 1], out[count, 2] = x, y, z
        out[count, 3], out[count, 4], out[count, 5] = wx, wy, wz
        index[count] = k
        count += 1
    return count


@kernel
def aim_around(points: Floats, flats: Floats, noise: Floats, number: int, share: Any, out: Floats, index: Ints) -> int:
    """Fill in one ray per point over its hemisphere, NEAR metres long; returns their number."""
    count = 0
    for k in range(len(points)):
        fx, fy, fz = flats[k, 0], flats[k, 1], flats[k, 2]
        if fx == ZERO and fy == ZERO and fz == ZERO:
            continue
        height = ONE - TWO * ((noise[k, 0] + share) % ONE)
        phi = np.float32(2 * np.pi) * ((noise[k, 1] + np.float32(number) * np.float32(0.618)) % ONE)
        ring = root(max(ONE - height * height, ZERO))
        # A point of the unit sphere around the normal's tip gives a cosine-weighted direction.
        x = fx * np.float32(1.02) + ring * np.float32(np.cos(phi))
        y = fy * np.float32(1.02) + height
        z = fz * np.float32(1.02) + ring * np.float32(np.sin(phi))
        norm = NEAR / max(root(dot3(x, y, z, x, y, z)), np.float32(1e-3))
        out[count, 0], out[count, 1], out[count, 2] = points[k, 0], points[k, 1], points[k, 2]
        out[count, 3], out[count, 4], out[count, 5] = x * norm, y * norm, z * norm
        index[count] = k
        count += 1
    return count


@kernel
def _meets(boxes: Floats, x: Any, y: Any, z: Any, dx: Any, dy: Any, dz: Any) -> bool:
    """Return whether a ray, up to its end, intersects one of (B, 6) boxes."""
    for b in range(len(boxes)):
        near, far = slab(boxes[b, 0], boxes[b, 3], x, dx, ZERO, ONE)
        near, far = slab(boxes[b, 1], boxes[b, 4], y, dy, near, far)
        near, far = slab(boxes[b, 2], boxes[b, 5], z, dz, near, far)
        if near <= far:
            return True
    return False


@kernel
def aim_again(
    lit: Ints, skipped: Any, points: Floats, target: Floats, is_sun: bool, boxes: Floats, out: Floats, index: Ints
) -> int:
    """Of points that a light reaches, fill in the rays to it that intersect the boxes; returns their number.

    Args:
        lit: (K,) indices of the points.
        skipped: (M,) whether a point is excluded.
        points: (M, 3).
        target: the light's position, or the direction to the sun.
        is_sun: whether it is the sun.
        boxes: (B, 6) low and high corners.
        out, index: (K, 6) rays and (K,) their points.
    """
    count = 0
    tx, ty, tz = target[0], target[1], target[2]
    for j in range(len(lit)):
        k = lit[j]
        if skipped[k]:
            continue
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        dx, dy, dz = (tx * FAR, ty * FAR, tz * FAR) if is_sun else (tx - x, ty - y, tz - z)
        if _meets(boxes, x, y, z, dx, dy, dz):
            out[count, 0], out[count, 1], out[count, 2] = x, y, z
            out[count, 3], out[count, 4], out[count, 5] = dx, dy, dz
            index[count] = k
            count += 1
    return count


@kernel
def meeting(rays: Floats, done: Any, boxes: Floats, index: Ints) -> int:
    """Fill in the indices of (N, 6) rays, without `done`, that intersect one of (B, 6) boxes; returns their number."""
    count = 0
    for k in range(len(rays)):
        ray = rays[k]
        if not done[k] and _meets(boxes, ray[0], ray[1], ray[2], ray[3], ray[4], ray[5]):
            index[count] = k
            count += 1
    return count


@kernel
def mark(index: Ints, blocked: Any, seen: Any, column: int, value: Any, lit: Ints) -> int:
    """Write `value` into a column of `seen` for blocked rays; fill `lit` with the others and return their number."""
    count = 0
    for j in range(len(index)):
        if blocked[j]:
            seen[index[j], column] = value
        else:
            lit[count] = index[j]
            count += 1
    return count


@kernel
def darken(index: Ints, blocked: Any, seen: Any, column: int, amount: Any) -> None:
    """Subtract `amount` from a column of `seen` for blocked rays."""
    for j in range(len(index)):
        if blocked[j]:
            seen[index[j], column] -= amount
