"""The leaf of a house plant."""

import numpy as np

from hearth.rendering.models.mesh import Mesh
from hearth.rendering.models.paint import PAINTS
from hearth.rendering.models.shapes import quads


def leaf(reach: float, rise: float) -> Mesh:
    """Return a leaf that arches from the origin to `reach` metres along +z, and rises by `rise` metres."""
    t = np.linspace(0, 1, 6)
    z, y = reach * t, rise * (1.9 * t - 0.9 * t * t * t)
    half = 0.2 * reach * np.sin(np.pi * np.clip(t * 0.93 + 0.07, 0, 1)) ** 0.8
    strips = []
    for k in range(5):
        a, b = (half[k], y[k], z[k]), (half[k + 1], y[k + 1], z[k + 1])
        strips.append([(-a[0], a[1], a[2]), (-b[0], b[1], b[2]), b, a])
    color = ("#4f8a3c", "#3f7a44", "#6a9a48")[round(reach * 1000) % 3]
    return quads(np.array(strips, np.float32), PAINTS["LEAF"].tinted(color))
