"""Parts that much furniture shares: legs, carcasses, doors, drawers."""

from __future__ import annotations

from hearth.rendering.meshes.mesh import Mesh, join, shift, turn
from hearth.rendering.meshes.paint import CHROME, Paint
from hearth.rendering.meshes.shapes import block, box, cylinder, rod

SWING = 105.0
"""Degrees a cabinet's door is open."""


def legs(w: float, d: float, h: float, thick: float, paint: Paint, inset: float = 0.0) -> Mesh:
    """Four square legs under a w by d top, `h` high."""
    x, z = w / 2 - inset - thick / 2, d / 2 - inset - thick / 2
    return join(box((i * x, h / 2, k * z), (thick, h, thick), paint) for i in (-1, 1) for k in (-1, 1))


def round_legs(w: float, d: float, h: float, radius: float, paint: Paint, splay: float = 0.04) -> Mesh:
    """Four tapered round legs that lean outwards."""
    x, z = w / 2 - radius, d / 2 - radius
    return join(
        rod((i * x, 0, k * z), (i * (x - splay), h, k * (z - splay)), radius * 0.6, paint, radius, sides=8)
        for i in (-1, 1)
        for k in (-1, 1)
    )


def carcass(w: float, h: float, d: float, paint: Paint, y: float = 0.0, board: float = 0.02, shelves: int = 1) -> Mesh:
    """A cupboard without doors, open towards +z, with boards between its `shelves` compartments."""
    x, z = w / 2, d / 2
    sides = [
        block(s * x - (board if s > 0 else 0), s * x + (board if s < 0 else 0), y, y + h, -z, z, paint) for s in (-1, 1)
    ]
    flat = [block(-x + board, x - board, y + h - board, y + h, -z, z, paint)]
    step = (h - board) / shelves
    flat += [
        block(-x + board, x - board, y + k * step, y + k * step + board, -z, z - 0.01, paint) for k in range(shelves)
    ]
    back = block(-x + board, x - board, y + board, y + h - board, -z, -z + 0.008, paint)
    return join([*sides, *flat, back])


def door(x0: float, x1: float, y0: float, y1: float, z: float, paint: Paint, open_: float, left: bool,
         knob: Paint = CHROME, frame: float = 0.05) -> Mesh:  # fmt: skip
    """A cabinet's door with its front at `z`, hinged on its left (-x) or right side; `open_` from 0 to 1."""
    gap, thick = 0.003, 0.018
    leaf = block(x0 + gap, x1 - gap, y0 + gap, y1 - gap, z - thick, z - 0.004, paint)
    rails = _frame(x0 + gap, x1 - gap, y0 + gap, y1 - gap, z, min(frame, (x1 - x0) / 5), paint)
    grip = x1 - 0.035 if left else x0 + 0.035
    height = (y0 + y1) / 2
    reach = min(0.06, (y1 - y0) / 4)
    handle = rod((grip, height - reach, z + 0.006), (grip, height + reach, z + 0.006), 0.006, knob, sides=6)
    whole = join((leaf, rails, handle))
    hinge = x0 if left else x1
    # The frame is left-handed: a left door opens towards +z when it turns by a negative angle.
    return turn(whole, "y", (-SWING if left else SWING) * open_, (hinge, 0, z - thick)) if open_ else whole


def _frame(x0: float, x1: float, y0: float, y1: float, z: float, width: float, paint: Paint) -> Mesh:
    a, b = z - 0.006, z
    return join((
        block(x0, x0 + width, y0, y1, a, b, paint),
        block(x1 - width, x1, y0, y1, a, b, paint),
        block(x0 + width, x1 - width, y0, y0 + width, a, b, paint),
        block(x0 + width, x1 - width, y1 - width, y1, a, b, paint),
    ))  # fmt: skip


def doors(
    w: float, y0: float, y1: float, z: float, count: int, paint: Paint, open_: float, knob: Paint = CHROME
) -> Mesh:
    """`count` doors side by side over a front of width w; pairs open away from each other."""
    step = w / count
    return join(
        door(-w / 2 + k * step, -w / 2 + (k + 1) * step, y0, y1, z, paint, open_, k % 2 == 0 and count > 1, knob)
        for k in range(count)
    )


def drawers(
    w: float, y0: float, y1: float, d: float, count: int, paint: Paint, open_: float, knob: Paint = CHROME
) -> Mesh:
    """A stack of drawers; the upper one is pulled out by a share `open_` of the way."""
    step, gap = (y1 - y0) / count, 0.004
    parts = []
    for k in range(count):
        low, high = y0 + k * step + gap, y0 + (k + 1) * step - gap
        front = block(-w / 2 + gap, w / 2 - gap, low, high, d / 2 - 0.018, d / 2 - 0.002, paint)
        length = min(0.14, w / 3)
        bar = rod(
            (-length / 2, (low + high) / 2, d / 2 + 0.008),
            (length / 2, (low + high) / 2, d / 2 + 0.008),
            0.007,
            knob,
            sides=6,
        )
        parts.append(front + bar)
        if open_ and k == count - 1:
            parts[-1] = shift(
                join((parts[-1], tray(w - 0.04, min(high - low, 0.1) * 0.8, d * 0.8, low, d, paint))),
                z=d * 0.55 * open_,
            )
    return join(parts)


def tray(w: float, h: float, d: float, y: float, depth: float, paint: Paint) -> Mesh:
    """An open-topped drawer's body behind a front at z = depth / 2."""
    z1, z0, t = depth / 2 - 0.018, depth / 2 - 0.018 - d, 0.01
    return join((
        block(-w / 2, w / 2, y, y + t, z0, z1, paint),
        block(-w / 2, -w / 2 + t, y + t, y + h, z0, z1, paint),
        block(w / 2 - t, w / 2, y + t, y + h, z0, z1, paint),
        block(-w / 2 + t, w / 2 - t, y + t, y + h, z0, z0 + t, paint),
    ))  # fmt: skip


def feet(w: float, d: float, h: float, paint: Paint) -> Mesh:
    """A recessed plinth."""
    return block(-w / 2 + 0.01, w / 2 - 0.01, 0, h, -d / 2 + 0.02, d / 2 - 0.04, paint)


def knob(x: float, y: float, z: float, radius: float, paint: Paint) -> Mesh:
    """A dial on a front at `z`."""
    return shift(turn(cylinder((0, 0, 0), radius, 0.02, paint, sides=12), "x", 90), x, y, z)


def top_board(w: float, d: float, y0: float, y1: float, paint: Paint,
              hole: tuple[float, float, float, float] | None = None) -> Mesh:  # fmt: skip
    """A worktop, with a rectangular hole for a sink if there is one."""
    x, z = w / 2, d / 2
    if hole is None:
        return block(-x, x, y0, y1, -z, z, paint)
    a, b, c, e = max(hole[0], -x), min(hole[1], x), max(hole[2], -z), min(hole[3], z)
    parts = [(-x, a, -z, z), (b, x, -z, z), (a, b, -z, c), (a, b, e, z)]
    return join(block(p, q, y0, y1, r, s, paint) for p, q, r, s in parts if q - p > 1e-4 and s - r > 1e-4)
