"""Procedural textures, made once per process: repeating tiles that modulate a colour, and pictures."""

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.models import object_pictures
from hearth.rendering.models.texture_patterns import SIDE, blend, grid_lines, noise, squares


def _grey(values: Floats) -> Floats:
    return np.repeat(values[..., None], 3, axis=-1).astype(np.float32)


def _plain() -> Floats:
    return np.ones((SIDE, SIDE, 3), np.float32)


def _wood() -> Floats:
    grain = noise(1, (1.5, 40.0)) * 0.16 + noise(2, (0.8, 9.0)) * 0.14
    wave = np.sin((np.arange(SIDE)[:, None] / SIDE * 6 + noise(3, (1.0, 2.0)) * 0.35) * 2 * np.pi) * 0.07
    return _grey(1 + grain + wave)


def _planks() -> Floats:
    rows = np.arange(SIDE) * 8 // SIDE
    shade = np.array([0.95, 1.04, 0.9, 1.1, 0.98, 0.87, 1.05, 0.93])[rows][:, None]
    shift = np.array([0, 130, 60, 200, 90, 170, 30, 150])[rows][:, None]
    column = (np.arange(SIDE)[None, :] + shift) % SIDE
    seam = 1 - 0.3 * (column < 2) - 0.3 * ((np.arange(SIDE) % (SIDE // 8)) < 1)[:, None]
    grain = 1 + noise(5, (1.5, 60.0)) * 0.12
    board = 1 + 0.07 * np.sin(shift * 1.7 + (column // (SIDE // 2)) * 2.1)
    return _grey(shade * board * grain * np.clip(seam, 0.55, 1))


def _fabric() -> Floats:
    t = np.arange(SIDE) / SIDE * 2 * np.pi * 32
    weave = np.sin(t)[:, None] * np.sin(t)[None, :]
    return _grey(1 + weave * 0.07 + noise(11, (30.0, 30.0)) * 0.06)


def _wicker() -> Floats:
    t = np.arange(SIDE) / SIDE * 2 * np.pi * 8
    strand = np.where(
        np.sin(t)[:, None] * np.sin(t)[None, :] > 0, np.abs(np.sin(t))[None, :], np.abs(np.sin(t))[:, None]
    )
    return _grey(0.6 + 0.55 * strand)


def _marble() -> Floats:
    vein = np.abs(noise(14, (3.0, 3.0)) + 0.5 * noise(15, (8.0, 8.0)))
    return _grey(1 - 0.22 * np.exp(-vein * 9) + noise(16, (5.0, 5.0)) * 0.03)


def _grass() -> Floats:
    return blend(_grey(1 + noise(19, (50.0, 50.0)) * 0.2 + noise(20, (5.0, 5.0)) * 0.12), (1.05, 1.0, 0.9), 0.3)


def _leaf() -> Floats:
    t = np.arange(SIDE) / SIDE
    rib = np.exp(-((t - 0.5) ** 2) / 0.0008)[None, :]
    return _grey(0.9 + 0.35 * rib + noise(21, (12.0, 12.0)) * 0.1)


def _brick() -> Floats:
    rows = np.arange(SIDE) * 8 // SIDE
    column = (np.arange(SIDE)[None, :] + (rows % 2 * SIDE // 8)[:, None]) % (SIDE // 4)
    mortar = (column < 4) | ((np.arange(SIDE) % (SIDE // 8)) < 4)[:, None]
    return _grey(np.where(mortar, 1.25, 0.95 + noise(22, (20.0, 20.0)) * 0.12))


def _stripes() -> Floats:
    band = (np.arange(SIDE) * 8 // SIDE % 2 == 0)[None, :].repeat(SIDE, 0)
    return _grey(np.where(band, 1.1, 0.62))


def _checks() -> Floats:
    band = (np.arange(SIDE) * 4 // SIDE % 2).astype(np.float32)
    return _grey(1.12 - 0.28 * band[:, None] - 0.28 * band[None, :])


def _dots() -> Floats:
    t = (np.arange(SIDE) * 4 / SIDE) % 1 - 0.5
    return _grey(np.where(t[:, None] ** 2 + t[None, :] ** 2 < 0.06, 1.45, 0.9))


def _grime() -> Floats:
    patch = np.clip(noise(23, (4.0, 4.0)) * 1.6 + noise(24, (16.0, 16.0)) * 0.6, 0, 1)
    return blend(_plain(), (0.33, 0.24, 0.13), patch)


TILES: dict[str, Callable[[], Floats]] = {
    "plain": _plain,
    "wood": _wood,
    "wood_fine": lambda: _grey(1 + noise(4, (1.5, 50.0)) * 0.05),
    "planks": _planks,
    "tiles": lambda: _grey((1 + noise(6, (3.0, 3.0)) * 0.03 + squares(7, 2) * 0.03) * (1 - 0.28 * grid_lines(2, 3))),
    "tiles_small": lambda: _grey((1 + squares(8, 8) * 0.07) * (1 - 0.25 * grid_lines(8, 2))),
    "carpet": lambda: _grey(1 + noise(9, (60.0, 60.0)) * 0.16 + noise(10, (4.0, 4.0)) * 0.04),
    "fabric": _fabric,
    "leather": lambda: _grey(1 - np.abs(noise(12, (14.0, 14.0))) * 0.14),
    "wicker": _wicker,
    "brushed": lambda: _grey(1 + noise(13, (1.0, 90.0)) * 0.05),
    "marble": _marble,
    "granite": lambda: _grey(1 + np.clip(noise(17, (50.0, 50.0)), -1, 2) * 0.35),
    "plaster": lambda: _grey(1 + noise(18, (8.0, 8.0)) * 0.012),
    "grass": _grass,
    "leaf": _leaf,
    "brick": _brick,
    "stripes": _stripes,
    "checks": _checks,
    "dots": _dots,
    "grime": _grime,
    "hair": lambda: _grey(1 + noise(26, (24.0, 0.8)) * 0.1 + noise(27, (90.0, 1.0)) * 0.08),
    "water": lambda: _grey(1 + noise(25, (6.0, 6.0)) * 0.12),
}
"""Repeating textures that modulate the colour; linear values about 1."""

SLOTS: dict[str, int] = {name: slot for slot, name in enumerate([*TILES, *object_pictures.PICTURES])}
"""Index of each texture in the atlas."""

LEVELS = 6
"""Mipmap levels: SIDE, SIDE/2, ..."""

OFFSETS = np.cumsum([0, *((SIDE >> level) ** 2 for level in range(LEVELS))]).astype(np.int64)
"""First texel of each level in a slot's row; the last entry is the row's length."""

RANGE = 2.0
"""Linear value of the brightest texel."""


@cache
def decode() -> Floats:
    """(256,) linear value of each byte of the atlas, which stores square roots: finer steps in the dark."""
    return (RANGE * (np.arange(256) / 255) ** 2).astype(np.float32)


@cache
def atlas() -> NDArray[np.uint8]:
    """(slots, texels, 3) bytes: every texture with its mipmaps, level by level."""
    rows = np.empty((len(SLOTS), OFFSETS[-1], 3), np.uint8)
    for name, slot in SLOTS.items():
        level = TILES[name]() if name in TILES else object_pictures.picture(name)
        for number in range(LEVELS):
            code = np.sqrt(np.clip(level, 0, RANGE) / RANGE) * 255 + 0.5
            rows[slot, OFFSETS[number] : OFFSETS[number + 1]] = code.astype(np.uint8).reshape(-1, 3)
            level = (level[::2, ::2] + level[1::2, ::2] + level[::2, 1::2] + level[1::2, 1::2]) / 4
    return rows


@cache
def texels() -> NDArray[np.uint8]:
    """(slots * texels, 3) the atlas, flattened."""
    return atlas().reshape(-1, 3)
