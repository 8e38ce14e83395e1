"""Pictures in the modes of Unity's cameras, as PNG files."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.film.png import encode
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

SCRAMBLE = 0x9E3779
"""An odd factor: numbers below 2**24 times it, modulo 2**24, are all different colours."""

FASTEST = 20.0
"""Pixels of motion that have the deepest colour in pictures of flow."""


def colour_of(number: int) -> tuple[int, int, int]:
    """Return the colour of a node or class; each number has one of its own, and 0, the background, is black."""
    code = number * SCRAMBLE % (1 << 24)
    return code >> 16, code >> 8 & 255, code & 255


def _painted(numbers: NDArray[Any]) -> NDArray[np.uint8]:
    code = numbers.astype(np.int64) * SCRAMBLE % (1 << 24)
    found: NDArray[np.uint8] = np.stack((code >> 16, code >> 8 & 255, code & 255), axis=-1).astype(np.uint8)
    return found


def _depth(millimetres: NDArray[Any]) -> NDArray[Any]:
    """Return depth as three equal channels of 16 bits, as clients of Unity expect it."""
    return np.repeat(millimetres[..., None], 3, axis=2)


def _normals(vectors: NDArray[Any]) -> NDArray[np.uint8]:
    found: NDArray[np.uint8] = np.rint((np.clip(vectors, -1, 1) + 1) / 2 * 255).astype(np.uint8)
    return found


def _flow(pixels: NDArray[Any]) -> NDArray[np.uint8]:
    """Return motion as colours: the hue is its direction, white stands still, and black is unknown."""
    known = np.isfinite(pixels).all(axis=2)
    x, y = np.where(known, pixels[..., 0], 0.0), np.where(known, pixels[..., 1], 0.0)
    hue = np.arctan2(y, x)
    deep = np.clip(np.hypot(x, y) / FASTEST, 0, 1)
    shades = [(1 + np.cos(hue - turn)) / 2 for turn in (0.0, 2 * np.pi / 3, 4 * np.pi / 3)]
    picture = np.stack([1 - deep * (1 - shade) for shade in shades], axis=-1) * known[..., None]
    found: NDArray[np.uint8] = np.rint(picture * 255).astype(np.uint8)
    return found


MODES: Mapping[str, tuple[str, Callable[[NDArray[Any]], NDArray[Any]]]] = MappingProxyType(
    {
        "normal": ("rgb", lambda picture: picture),
        "seg_inst": ("instance_ids", _painted),
        "seg_class": ("class_ids", _painted),
        "depth": ("depth", _depth),
        "flow": ("flow", _flow),
        "surf_normals": ("normals", _normals),
    }
)
"""Mode -> modality of ours, and how its array becomes a picture of 8 or 16 bits and three channels."""

NOT_DRAWN = ("albedo", "illumination")
"""Modes of Unity that Hearth does not draw."""


def check_modes(modes: Iterable[str]) -> None:
    """Check that modes can be drawn.

    Raises:
        HearthError: NOT_RENDERED, naming the mode.
    """
    for mode in modes:
        if mode not in MODES:
            said = (
                f"Hearth does not draw the mode `{mode}`" if mode in NOT_DRAWN else f"no mode is called `{mode[:40]}`"
            )
            raise HearthError.of(Code.NOT_RENDERED, said, suggestion=f"one of {', '.join(MODES)}")


def png_of(mode: str, pictures: Mapping[str, Any]) -> bytes:
    """Return the PNG of a mode, from pictures by modality."""
    modality, drawn = MODES[mode]
    return encode(drawn(pictures[modality]))


def base64_of(data: bytes) -> str:
    """Return bytes as the protocol writes them."""
    return b64encode(data).decode("ascii")
