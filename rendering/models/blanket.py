"""A blanket on a bed: over somebody's legs, or folded back at the foot."""

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.models.mesh import Mesh, join
from hearth.rendering.models.paint import Paint
from hearth.rendering.models.shapes import triangles

EMPTY, OVER_FEET = 0.1, 0.3
"""Heights in metres of a blanket under which nobody lies, and of one with feet underneath."""

SHEET, TURNED = 0.03, 0.09
"""Thickness in metres of a spread blanket, and depth of its edge that is turned back."""

LEGS, SIDES = 0.21, 0.39
"""Metres to the side up to which a blanket lies on legs, and from which on it lies on the mattress."""

ALONG = ((0.0, 0.0), (0.05, 0.75), (0.12, 1.0), (0.2, 0.98), (0.34, 0.72), (0.6, 0.85), (2.0, 0.85))
"""Metres from a blanket's end at the foot, and the height of the feet and legs there, as a share of the highest."""

SINKING, OPEN = 0.3, 0.8
"""Shares by which a blanket sinks at its upper edge, and to which that edge stays open."""

CELL = 0.05
"""Metres between the points of its surface, about."""


def drape(w: float, h: float, d: float, paint: Paint, edge: Paint) -> Mesh:
    """Return a blanket whose end at +z lies over somebody's feet, as far as it is higher than an empty one."""
    turned = min(TURNED, d / 3)
    return join((_part(w, h, d, -d / 2, d / 2, 0.0, paint), _part(w, h, d, -d / 2, turned - d / 2, 0.012, edge)))


def _part(w: float, h: float, d: float, start: float, end: float, more: float, paint: Paint) -> Mesh:
    """Return a part of a blanket between two lines `more` metres higher, its sides down to the mattress."""
    x, z = _ticks(-w / 2 - more / 2, w / 2 + more / 2), _ticks(start - more / 2, end)
    across, along = np.meshgrid(x, z)
    filled = min(max((h - EMPTY) / (OVER_FEET - EMPTY), 0.0), 1.0)
    y = _heights(across, d / 2 - along, h, filled) + more
    # Rims are round; towards the head the blanket lies on the body, of which it leaves the end open.
    upper = 1 - np.clip((along - z[0]) / 0.1, 0.0, 1.0)
    y = y * (1 - SINKING * filled * upper * upper)
    inside = np.minimum(np.minimum(across - x[0], x[-1] - across), z[-1] - along)
    y = y * _rounded(inside) * np.maximum(_rounded(along - z[0]), filled * OPEN)
    points = np.stack((across, y, along), axis=-1)
    corners = _split(points)
    return triangles(corners, paint, _split(_normals(points)), corners[..., [2, 0]] * paint.scale)


def _rounded(inside: Floats) -> Floats:
    """Shares of a height at distances from a rim."""
    found: Floats = np.sqrt(np.clip(inside / 0.03, 0.0, 1.0))
    return found


def _heights(x: Floats, from_foot: Floats, h: float, filled: float) -> Floats:
    """Heights of the surface at points; `filled` is 0 without legs to 1 with them."""
    thick = SHEET + (min(h, EMPTY) - SHEET) * (1 - filled)
    side = np.clip((SIDES - np.abs(x)) / (SIDES - LEGS), 0.0, 1.0)
    # Between the legs it sinks a little.
    hump = side * side * (3 - 2 * side) * (1 - 0.16 * np.exp(-((x / 0.05) ** 2)))
    found: Floats = thick + (h - thick) * filled * hump * np.interp(from_foot, *np.transpose(ALONG))
    return found


def _ticks(low: float, high: float) -> Floats:
    """Coordinates from one rim to the other, closer at the rims."""
    found: Floats = np.linspace(low, high, max(4, round((high - low) / CELL)))
    return np.concatenate(([low, low + 0.008, low + 0.02], found[1:-1], [high - 0.02, high - 0.008, high]))


def _normals(points: Floats) -> Floats:
    """Return unit normals of a surface's points, which look up."""
    found = np.cross(np.gradient(points, axis=0), np.gradient(points, axis=1))
    unit: Floats = found / np.maximum(np.linalg.norm(found, axis=-1, keepdims=True), 1e-12)
    return unit


def _split(grid: Floats) -> Floats:
    """(T, 3, 3) corners of the triangles of a grid."""
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    return np.stack((np.stack((a, b, c), axis=-2), np.stack((a, c, d), axis=-2)), axis=-3).reshape(-1, 3, 3)
