"""Masks as a film: a colour for each class, the same in every film."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Image
from hearth.rendering.film.video_file import Writer
from hearth.schemas.rng import derive

LARGER = 4
"""Pixels of the film for a pixel of the masks, each way."""


def colours() -> NDArray[np.uint8]:
    """(65536, 3) the colour of each class number; the background is black."""
    numbers = np.random.Generator(np.random.PCG64(derive(0, "mask colours")))
    found = numbers.integers(48, 232, (1 << 16, 3), dtype=np.uint8)
    found[0] = 0
    return found


def write_masks(masks: NDArray[Any], path: Path, fps: float) -> None:
    """Write (T, H, W) class numbers as a video.

    Raises:
        HearthError: it can't be written.
    """
    palette, (_, height, width) = colours(), masks.shape
    writer = Writer(path, LARGER * width, LARGER * height, fps)
    for mask in masks:
        picture: Image = palette[mask].repeat(LARGER, 0).repeat(LARGER, 1)
        writer.add(picture)
    writer.close()
