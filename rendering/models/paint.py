"""Paint: colour, texture and reflectance of a surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from hearth.rendering.arrays import Floats


@dataclass(frozen=True, slots=True)
class Paint:
    """The material of a surface.

    Attributes:
        color: sRGB as `#rrggbb`; multiplies the texture.
        texture: a name of `textures.SLOTS`.
        scale: tiles of the texture per metre.
        glow: emitted light, in units of white paper in full light.
        shine: 0 matt to 1 polished.
    """

    color: str = "#ffffff"
    texture: str = "plain"
    scale: float = 1.0
    glow: float = 0.0
    shine: float = 0.0

    def tinted(self, color: str) -> Paint:
        """The paint in another colour; unchanged if `color` is empty."""
        return replace(self, color=color) if color else self

    def lit(self, glow: float) -> Paint:
        """The paint with emitted light."""
        return replace(self, glow=glow)


@cache
def linear(color: str) -> Floats:
    """(3,) linear light from 0 to 1 of `#rrggbb`."""
    code = color.removeprefix("#")
    srgb = np.array([int(code[i : i + 2], 16) / 255 for i in (0, 2, 4)])
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4).astype(np.float32)


OAK = Paint("#b98a58", "wood", 1.3, shine=0.15)
WALNUT = Paint("#6f4528", "wood", 1.3, shine=0.18)
PINE = Paint("#d9b888", "wood", 1.3, shine=0.12)
CHERRY = Paint("#8c4a2f", "wood", 1.3, shine=0.18)
WHITE_WOOD = Paint("#e9e5dc", "wood_fine", 1.3, shine=0.15)
WOODS = (OAK, WALNUT, PINE, CHERRY)

WHITE = Paint("#eeece6", shine=0.15)
ENAMEL = Paint("#f3f3f0", shine=0.6)
CERAMIC = Paint("#f4f3ee", shine=0.7)
STEEL = Paint("#b9bcc0", "brushed", 2.0, shine=0.7)
CHROME = Paint("#d4d8dc", shine=0.95)
BRASS = Paint("#c6a052", shine=0.8)
IRON = Paint("#3a3b3e", shine=0.4)
BLACK = Paint("#1d1e21", shine=0.35)
DARK = Paint("#2e3035", shine=0.25)
GREY = Paint("#8d9095", shine=0.2)
RUBBER = Paint("#26262a")
GLASS = Paint("#c9dfe6", shine=0.95)
PAPER = Paint("#f5f2e8")
LINEN = Paint("#efece4", "fabric", 5.0)
CLOTH = Paint("#8797a8", "fabric", 4.0)
LEATHER = Paint("#5b3a29", "leather", 2.0, shine=0.3)
WICKER = Paint("#b08a55", "wicker", 4.0)
LEAF = Paint("#4f8a3c", "leaf", 2.0)
SOIL = Paint("#4a3526", "carpet", 3.0)
TERRACOTTA = Paint("#b9653f")
MARBLE = Paint("#e4e2dd", "marble", 0.8, shine=0.4)
GRANITE = Paint("#4b4c50", "granite", 2.0, shine=0.4)

FABRIC_COLORS = ("#5f7896", "#8a5a5a", "#6d8266", "#a68a64", "#7c7f88", "#b7653f", "#4d6b70", "#9a7aa0")
BRIGHT_COLORS = ("#c8463c", "#3f77b5", "#e0a83a", "#4f9a5c", "#8b5fa8", "#d97a3a", "#3fa3a0", "#d2678f")
SOFT_COLORS = ("#c9d3dc", "#dcc9c0", "#cfd8c4", "#e3d7b8", "#d5cbe0", "#bfd5d2")
