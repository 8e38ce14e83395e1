"""Compiled loops over surface points: incoming light, reflections, and the resulting colours."""

from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.models.texture_patterns import SIDE
from hearth.rendering.models.textures import LEVELS, OFFSETS, SLOTS
from hearth.rendering.rays.kernels import (
    COLOR,
    DENSITY,
    FLAT,
    GLOW,
    HALF,
    ONE,
    SHINE,
    SOLID,
    TEXTURE,
    TINY,
    TWO,
    UV,
    UV_U,
    UV_V,
    ZERO,
    dot3,
    kernel,
    root,
)
from hearth.rendering.rays.light_rays import (
    D_AMBIENT,
    D_COLOR,
    D_HORIZON,
    D_PLAIN,
    D_SKY,
    D_SUN,
    D_UP,
    D_ZENITH,
    FAINT,
    L_AREA,
    L_COLOR,
    L_FACING,
    L_PLACE,
    L_WINDOW,
    reaching,
)

GROUND = np.float32(0.55)
"""Brightness of the plain background around a home in views from above."""

GRASS = np.int64(SLOTS["grass"])
LENGTH = np.int64(OFFSETS[-1])
STARTS = tuple(int(offset) for offset in OFFSETS[:-1])
SPREAD = np.float32(SIDE * 2**0.3)
LAST = LEVELS - 1
SHARE = ONE / np.float32(255)
TONE_STEPS = 8192
TONE_SCALE = np.float32(TONE_STEPS / 4.0)


@kernel
def glint(
    shine: Any, wx: Any, wy: Any, wz: Any, nx: Any, ny: Any, nz: Any, vx: Any, vy: Any, vz: Any
) -> Any:  # fmt: skip
    """Return the share of a light that a polished surface with a normal n reflects.

    W leads to the light, v from the viewer.

    Faint ones are 0.
    """
    norm = ONE / root(dot3(wx, wy, wz, wx, wy, wz))
    hx, hy, hz = wx * norm - vx, wy * norm - vy, wz * norm - vz
    norm = ONE / max(root(dot3(hx, hy, hz, hx, hy, hz)), np.float32(1e-6))
    cosine = dot3(hx, hy, hz, nx, ny, nz) * norm
    top, square = shine * shine * np.float32(1.2), cosine * cosine
    if cosine <= ZERO or top * square * square * square * square < np.float32(1e-3):
        return ZERO
    return top * np.float32(np.exp((np.float32(8) + np.float32(70) * shine) * np.float32(np.log(cosine))))


@kernel
def lighten(
    points: Floats, normals: Floats, flats: Floats, views: Floats, rows: Floats, seen: Any, day: Floats, lights: Floats,
    near: Ints, light: Floats, gloss: Floats,
) -> None:  # fmt: skip
    """Fill in (M, 3) incoming light and reflections.

    Args:
        points, normals, flats, views, rows: of the M points, as `locate` gives them.
        seen: (M, lights + 2) visibility: of the sun, of each light, and of ambient light.
        day, lights: rows of the day and of the lights.
        near: the lights that may reach the points.
        light, gloss: filled. Ambient light is more from above, less in corners.
    """
    level, last, up = day[D_AMBIENT], seen.shape[1] - 1, day[D_UP] > ZERO
    sx, sy, sz = day[D_SUN], day[D_SUN + 1], day[D_SUN + 2]
    for k in range(len(points)):
        nx, ny, nz, shine = normals[k, 0], normals[k, 1], normals[k, 2], rows[k, SHINE]
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        r = level * (ONE + np.float32(0.22) * ny + np.float32(0.06) * nx)
        r *= np.float32(0.15) + np.float32(0.85) * np.float32(seen[k, last]) * SHARE
        g, b = r * np.float32(0.985), r * np.float32(0.96)
        shine_r, shine_g, shine_b = ZERO, ZERO, ZERO
        if up and seen[k, 0] > 0 and dot3(flats[k, 0], flats[k, 1], flats[k, 2], sx, sy, sz) > ZERO:
            found = max(dot3(nx, ny, nz, sx, sy, sz), ZERO) * np.float32(seen[k, 0]) * SHARE
            r += found * day[D_COLOR]
            g += found * day[D_COLOR + 1]
            b += found * day[D_COLOR + 2]
        for j in range(len(near)):
            n = near[j]
            if seen[k, n + 1] == 0:
                continue
            if not (
                lights[n, L_AREA] < x < lights[n, L_AREA + 1] and lights[n, L_AREA + 2] < z < lights[n, L_AREA + 3]
            ):
                continue
            wx, wy, wz = lights[n, L_PLACE] - x, lights[n, L_PLACE + 1] - y, lights[n, L_PLACE + 2] - z
            fx, fy, fz = lights[n, L_FACING], lights[n, L_FACING + 1], lights[n, L_FACING + 2]
            power = reaching(wx, wy, wz, nx, ny, nz, lights[n, L_WINDOW] > ZERO, fx, fy, fz)
            found = power * np.float32(seen[k, n + 1]) * SHARE
            red, green, blue = lights[n, L_COLOR], lights[n, L_COLOR + 1], lights[n, L_COLOR + 2]
            r += found * red
            g += found * green
            b += found * blue
            if shine > np.float32(0.05) and power > FAINT / max(red, TINY):
                found *= glint(shine, wx, wy, wz, nx, ny, nz, views[k, 0], views[k, 1], views[k, 2])
                shine_r += found * red
                shine_g += found * green
                shine_b += found * blue
        light[k, 0], light[k, 1], light[k, 2] = r, g, b
        gloss[k, 0], gloss[k, 1], gloss[k, 2] = shine_r, shine_g, shine_b


@kernel
def texel(slot: Any, u: Any, v: Any, footprint: Any) -> Any:
    """Index of the nearest texel in the atlas; the number of tiles that a pixel spans selects the mipmap."""
    spread, level, side = footprint * SPREAD, 0, SIDE
    while spread >= TWO and level < LAST:
        spread *= HALF
        level += 1
        side >>= 1
    column = min(int((u - np.floor(u)) * np.float32(side)), side - 1)
    row = min(int((v - np.floor(v)) * np.float32(side)), side - 1)
    return slot * LENGTH + STARTS[level] + row * side + column


@kernel
def mirrored(shine: Any, ny: Any, vy: Any, cosine: Any) -> Any:
    """Return the share of surrounding light that a polished surface reflects: of a bright ceiling or a darker floor."""
    up = vy + TWO * cosine * ny
    away = ONE - min(max(cosine, ZERO), ONE)
    square = away * away
    fresnel = np.float32(0.05) + np.float32(0.95) * square * square * away
    more = np.float32(0.25) if shine > np.float32(0.85) else ZERO
    room = np.float32(0.35)
    if up > np.float32(0.15):
        room += np.float32(0.65) * min(max(up + np.float32(0.3), ZERO), ONE)
    return shine * shine * min(max(fresnel + more, ZERO), np.float32(0.6)) * room


@kernel
def tone(value: Any) -> Any:
    """Index into the table of tones."""
    return min(int(root(max(value, ZERO)) * TONE_SCALE), TONE_STEPS)


@kernel
def colour(
    pixels: Ints, rays: Floats, distance: Floats, u: Floats, v: Floats, rows: Floats, normals: Floats, flats: Floats,
    views: Floats, light: Floats, gloss: Floats, angle: Any, texels: Any, decode: Floats, tones: Any, out: Any,
) -> None:  # fmt: skip
    """Write the colours of pixels that show a surface.

    Args:
        pixels: (M,) their indices.
        rays, distance, u, v: of all pixels.
        rows, normals, flats, views: of the M pixels, as `locate` gives them.
        light, gloss: (M, 3) incoming light, and reflections.
        angle: radians per pixel.
        texels, decode: the atlas, and the linear value of its bytes.
        tones: sRGB bytes, indexed by TONE_SCALE times the root of linear light.
        out: (N, 3) colours of all pixels, filled.
    """
    for k in range(len(pixels)):
        i = pixels[k]
        fx, fy, fz = flats[k, 0], flats[k, 1], flats[k, 2]
        if fx == ZERO and fy == ZERO and fz == ZERO:
            continue
        if rows[k, SOLID] > ZERO and dot3(rows[k, FLAT], rows[k, FLAT + 1], rows[k, FLAT + 2], fx, fy, fz) < ZERO:
            # A wall's section in a view from above.
            out[i, 0], out[i, 1], out[i, 2] = tones[CUT[0]], tones[CUT[1]], tones[CUT[2]]
            continue
        shine, extra = rows[k, SHINE], ZERO
        if shine > ZERO:
            facing = -dot3(views[k, 0], views[k, 1], views[k, 2], normals[k, 0], normals[k, 1], normals[k, 2])
            extra = mirrored(shine, normals[k, 1], views[k, 1], facing)
            extra *= (light[k, 0] + light[k, 1] + light[k, 2]) * np.float32(1 / 3)
        across = rows[k, UV] + rows[k, UV_U] * u[i] + rows[k, UV_V] * v[i]
        down = rows[k, UV + 1] + rows[k, UV_U + 1] * u[i] + rows[k, UV_V + 1] * v[i]
        length = root(dot3(rays[i, 3], rays[i, 4], rays[i, 5], rays[i, 3], rays[i, 4], rays[i, 5]))
        at = texel(np.int64(rows[k, TEXTURE]), across, down, distance[i] * length * angle * rows[k, DENSITY])
        for c in range(3):
            value = decode[texels[at, c]] * rows[k, COLOR + c] * (light[k, c] + rows[k, GLOW])
            out[i, c] = tones[tone(value + gloss[k, c] + extra)]


CUT = tuple(int(np.sqrt(level) * TONE_SCALE) for level in (0.05, 0.055, 0.065))


@kernel
def outside(
    pixels: Ints, rays: Floats, flats: Floats, views: Floats, day: Floats, texels: Any, decode: Floats, tones: Any,
    out: Any,
) -> None:  # fmt: skip
    """Write the colours of background pixels: sky and lawn, or a plain colour in views from above."""
    plain = day[D_PLAIN] > ZERO
    bright = np.float32(0.25) + np.float32(0.75) * min(ONE, day[D_SKY])
    for k in range(len(pixels)):
        i = pixels[k]
        if flats[k, 0] != ZERO or flats[k, 1] != ZERO or flats[k, 2] != ZERO:
            continue
        dx, dy, dz = views[k, 0], views[k, 1], views[k, 2]
        up = np.float32(np.exp(np.float32(0.6) * np.float32(np.log(max(dy, np.float32(1e-6))))))
        clear, haze, at = ZERO, ONE, np.int64(0)
        if dy < np.float32(-1e-3):
            far = (rays[i, 1] + np.float32(0.3)) / -dy
            x, z = (rays[i, 0] + dx * far) * np.float32(0.4), (rays[i, 2] + dz * far) * np.float32(0.4)
            at = texel(GRASS, x, z, far * np.float32(0.004))
            haze = min(max(far / np.float32(90), ZERO), np.float32(0.75))
            clear, haze = (ONE - haze) * bright, haze * np.float32(0.85)
        for c in range(3):
            low = day[D_HORIZON + c]
            value = (low + (day[D_ZENITH + c] - low) * up) * haze
            value += decode[texels[at, c]] * LAWN[c] * clear
            out[i, c] = tones[tone(GROUND if plain else value)]


LAWN = (np.float32(0.17), np.float32(0.30), np.float32(0.08))
"""The colour of grass."""
