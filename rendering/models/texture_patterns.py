"""Components of textures: repeating noise, grids and blends over a square of SIDE texels."""

import numpy as np

from hearth.rendering.arrays import Floats

SIDE = 256


def noise(seed: int, scale: tuple[float, float]) -> Floats:
    """(SIDE, SIDE) repeating noise, mean 0, deviation 1, with about `scale` (across, down) bumps per tile."""
    white = np.random.default_rng(seed).standard_normal((SIDE, SIDE))
    across, down = np.fft.fftfreq(SIDE, 1 / SIDE)[None, :], np.fft.fftfreq(SIDE, 1 / SIDE)[:, None]
    weight = np.exp(-((across / scale[0]) ** 2 + (down / scale[1]) ** 2) / 2)
    weight[0, 0] = 0
    smooth = np.fft.ifft2(np.fft.fft2(white) * weight).real
    found: Floats = (smooth / smooth.std()).astype(np.float32)
    return found


def squares(seed: int, count: int) -> Floats:
    """One random value, -1 to 1, for each of `count` by `count` squares."""
    values = np.random.default_rng(seed).uniform(-1, 1, (count, count))
    return values.repeat(SIDE // count, 0).repeat(SIDE // count, 1).astype(np.float32)


def grid_lines(count: int, width: int) -> Floats:
    """1 on the lines between `count` by `count` squares, else 0."""
    line = (np.arange(SIDE) % (SIDE // count)) < width
    return (line[:, None] | line[None, :]).astype(np.float32)


def blend(image: Floats, color: tuple[float, float, float], share: Floats | float) -> Floats:
    """`image` (…, 3) blended towards `color` by `share`."""
    weight = np.asarray(share, np.float32)[..., None] if np.ndim(share) else np.float32(share)
    return (image + (np.array(color, np.float32) - image) * weight).astype(np.float32)
