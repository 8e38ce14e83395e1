"""Compiled loops over surface points: incoming light, reflections, and the resulting colours."""

from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats, Ints
from hearth.rendering.models.textures import LEVELS, OFFSETS, SLOTS
from hearth.rendering.models.weave import SIDE
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
from hearth.rendering.rays.light_rays import D_AMBIENT, D_HORIZON, D_PLAIN, D_SKY, D_ZENITH, FAINT

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
def ambient(normals: Floats, seen: Any, day: Floats, light: Floats) -> None:
    """Fill in (M, 3) ambient light: more from above, less in corners."""
    level, last = day[D_AMBIENT], seen.shape[1] - 1
    for k in range(len(normals)):
        found = level * (ONE + np.float32(0.22) * normals[k, 1] + np.float32(0.06) * normals[k, 0])
        found *= np.float32(0.15) + np.float32(0.85) * np.float32(seen[k, last]) * SHARE
        light[k, 0], light[k, 1], light[k, 2] = found, found * np.float32(0.985), found * np.float32(0.96)


@kernel
def add(power: Floats, seen: Any, column: int, color: Floats, light: Floats) -> None:
    """Add a light to the incoming light."""
    r, g, b = color[0], color[1], color[2]
    for k in range(len(power)):
        found = power[k] * np.float32(seen[k, column]) * SHARE
        light[k, 0] += found * r
        light[k, 1] += found * g
        light[k, 2] += found * b


@kernel
def shiny(rows: Floats, index: Ints) -> int:
    """Fill in the indices of points with a reflecting surface; returns their number."""
    count = 0
    for k in range(len(rows)):
        if rows[k, SHINE] > ZERO:
            index[count] = k
            count += 1
    return count


@kernel
def add_glints(
    index: Ints, rows: Floats, points: Floats, normals: Floats, views: Floats, power: Floats, seen: Any, column: int,
    place: Floats, color: Floats, gloss: Floats,
) -> None:  # fmt: skip
    """Add a light's specular reflection on polished surfaces; faint ones are skipped."""
    least = FAINT / max(color[0], TINY)
    for j in range(len(index)):
        k = index[j]
        shine = rows[k, SHINE]
        if power[k] <= least or seen[k, column] == 0 or shine <= np.float32(0.05):
            continue
        wx, wy, wz = place[0] - points[k, 0], place[1] - points[k, 1], place[2] - points[k, 2]
        norm = ONE / root(dot3(wx, wy, wz, wx, wy, wz))
        hx, hy, hz = wx * norm - views[k, 0], wy * norm - views[k, 1], wz * norm - views[k, 2]
        norm = ONE / max(root(dot3(hx, hy, hz, hx, hy, hz)), np.float32(1e-6))
        cosine = dot3(hx, hy, hz, normals[k, 0], normals[k, 1], normals[k, 2]) * norm
        top, square = shine * shine * np.float32(1.2), cosine * cosine
        if cosine <= ZERO or top * square * square * square * square < np.float32(1e-3):
            continue
        bright = np.float32(np.exp((np.float32(8) + np.float32(70) * shine) * np.float32(np.log(cosine))))
        bright *= top * power[k] * np.float32(seen[k, column]) * SHARE
        for c in range(3):
            gloss[k, c] += bright * color[c]


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
    """The share of surrounding light that a polished surface reflects: of a bright ceiling or a darker floor."""
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
