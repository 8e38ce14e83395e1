"""Paint: colour, texture and reflectance of a surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.schemas.yaml_limits import packaged


@dataclass(frozen=True, slots=True)
class Paint:
    """The material of a surface.

    Attributes:
        color: sRGB as `#rrggbb`; multiplies the texture.
        texture: a name of `textures.SLOTS`.
        scale: tiles of the texture per metre.
        glow: emitted light, in units of white paper in full light.
        shine: 0 matt to 1 polished; above `triangles.MIRROR` a mirror.
    """

    color: str = "#ffffff"
    texture: str = "plain"
    scale: float = 1.0
    glow: float = 0.0
    shine: float = 0.0

    def tinted(self, color: str) -> Paint:
        """Return the paint in another colour; unchanged if `color` is empty."""
        return replace(self, color=color) if color else self

    def lit(self, glow: float) -> Paint:
        """Return the paint with emitted light."""
        return replace(self, glow=glow)


@cache
def linear(color: str) -> Floats:
    """(3,) linear light from 0 to 1 of `#rrggbb`."""
    code = color.removeprefix("#")
    srgb = np.array([int(code[i : i + 2], 16) / 255 for i in (0, 2, 4)])
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4).astype(np.float32)


def _named() -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in packaged("hearth.rendering.models", "paints.yaml").items():
        listed = isinstance(value, list)
        found[name] = tuple(found.get(each, each) for each in value) if listed else Paint(**value)
    return found


PAINTS = _named()
"""Paints, and lists of paints or of colours, by the names that model files use. To add one: a row of `paints.yaml`."""
