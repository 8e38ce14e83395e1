"""What one washes, combs and shaves with."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join
from hearth.rendering.meshes.paint import (
    BRIGHT_COLORS,
    CERAMIC,
    CHROME,
    DARK,
    PAPER,
    SOFT_COLORS,
    STEEL,
    WHITE,
    Paint,
)
from hearth.rendering.meshes.shapes import ball, block, box, cushion, cylinder, lathe, rod
from hearth.rendering.meshes.storage import bottom


def towel(look: Look) -> Mesh:
    """A folded towel."""
    w, h, d = look.size
    cloth = look.tint(Paint("#ffffff", "carpet", 3.0), (*SOFT_COLORS, "#7fa3b8", "#c98a7a"))
    layers = [
        cushion((0, h * (k + 0.5) / 3, 0), (w * (1 - 0.02 * k), h / 3 * 1.04, d * (1 - 0.03 * k)), cloth, 0.8, 4)
        for k in range(3)
    ]
    stripe = Paint("#ffffff")
    return join(
        [
            *layers,
            *(
                block(x - 0.012, x + 0.012, h * 0.995, h * 1.0, -d * 0.42, d * 0.42, stripe)
                for x in (-w * 0.32, -w * 0.24)
            ),
        ]
    )


def towel_rack(look: Look) -> Mesh:
    """A bar on the wall with a towel over it."""
    w, h, d = look.size
    z, y = d * 0.1, h * 0.85
    bar = rod((-w / 2, y, z), (w / 2, y, z), 0.01, CHROME, sides=8)
    arms = [rod((s * (w / 2 - 0.02), y, -d / 2), (s * (w / 2 - 0.02), y, z), 0.01, CHROME, sides=8) for s in (-1, 1)]
    cloth = look.tint(Paint("#ffffff", "carpet", 3.0), (*SOFT_COLORS, "#7fa3b8"))
    drape = cushion((w * 0.05, y / 2, z), (w * 0.6, y * 1.0, 0.05), cloth, 0.7, 4)
    return join([bar, *arms, drape])


def roll(look: Look) -> Mesh:
    """A roll of paper, upright, with a loose end."""
    w, h, d = look.size
    r = min(w, d) / 2
    body = lathe(
        [(r * 0.35, 0), (r, 0), (r, 0), (r, h), (r, h), (r * 0.35, h), (r * 0.35, h), (r * 0.35, 0)], PAPER, 20
    )
    core = lathe([(r * 0.34, h), (r * 0.34, 0)], Paint("#b58a5c"), 12)
    end = block(r * 0.98 - 0.004, r * 0.99, 0, h, -0.0, r * 0.7, PAPER)
    return join((body, core, end))


def toothbrush(look: Look) -> Mesh:
    """A toothbrush lying along z."""
    w, h, d = look.size
    handle = look.tint(Paint(shine=0.4), BRIGHT_COLORS)
    stick = cushion((0, h * 0.25, d * 0.1), (w * 0.5, h * 0.4, d * 0.8), handle, 0.8, 4)
    head = box((0, h * 0.3, -d * 0.4), (w * 0.6, h * 0.3, d * 0.2), handle)
    return join((stick, head, box((0, h * 0.72, -d * 0.4), (w * 0.55, h * 0.55, d * 0.18), WHITE)))


def brush_cup(look: Look) -> Mesh:
    """A cup with toothbrushes in it."""
    w, h, d = look.size
    r = min(w, d) / 2
    cup = lathe(
        [(0, 0), (r * 0.6, 0), (r * 0.7, h * 0.6), (r * 0.62, h * 0.6), (r * 0.5, 0.01), (0, 0.01)],
        look.tint(Paint(shine=0.6), SOFT_COLORS),
        16,
    )
    sticks = [
        rod((0, 0.02, 0), (x * r, h * 0.86, z * r), 0.004, Paint(c), sides=6)
        + box((x * r * 1.1, h * 0.93, z * r * 1.1), (0.012, h * 0.14, 0.012), WHITE)
        for x, z, c in ((0.7, 0.2, "#c8463c"), (-0.6, -0.4, "#3f77b5"))
    ]
    return join([cup, *sticks])


def paste(look: Look) -> Mesh:
    """A tube lying along z: flat end, round cap."""
    w, h, d = look.size
    body = look.tint(Paint(shine=0.4), ("#e9ecef", "#c9dfe6", "#e3d7d0"))
    outer = rod((0, h * 0.45, d * 0.25), (0, h * 0.45, -d * 0.3), h * 0.42, body, h * 0.42)
    flat = block(-w / 2, w / 2, h * 0.35, h * 0.55, -d / 2, -d * 0.25, body)
    cap = rod(
        (0, h * 0.45, d * 0.25),
        (0, h * 0.45, d * 0.5),
        h * 0.26,
        look.pick((Paint("#c8463c"), Paint("#3f77b5")), "cap"),
    )
    band = rod(
        (0, h * 0.45, d * 0.15),
        (0, h * 0.45, -d * 0.05),
        h * 0.43,
        look.pick((Paint("#c8463c"), Paint("#3f77b5")), "cap"),
    )
    return join((outer, flat, cap, band))


def soap(look: Look) -> Mesh:
    """A bar of soap on a dish."""
    w, h, d = look.size
    dish = cushion((0, h * 0.2, 0), (w, h * 0.4, d), CERAMIC, 0.8, 4)
    return dish + cushion(
        (0, h * 0.62, 0),
        (w * 0.78, h * 0.6, d * 0.74),
        look.tint(Paint(shine=0.4), ("#e9c9d3", "#cfe0c2", "#efe3c0")),
        0.8,
        4,
    )


def comb(look: Look) -> Mesh:
    """A comb lying along z."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.4), ("#3a2a22", "#3f77b5", "#8a5a8f"))
    teeth = [
        box((w * 0.1, h / 2, -d / 2 + d * (k + 0.5) / 16), (w * 0.7, h * 0.6, d * 0.026), paint) for k in range(16)
    ]
    return join([box((-w * 0.35, h / 2, 0), (w * 0.3, h, d), paint), *teeth])


def hairbrush(look: Look) -> Mesh:
    """A hairbrush lying along z, bristles up."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.3), ("#8a5a33", "#b8433a", "#5f5f8f"))
    head = cushion((0, h * 0.25, -d * 0.22), (w, h * 0.4, d * 0.52), paint, 0.9)
    handle = rod((0, h * 0.25, 0), (0, h * 0.25, d * 0.49), h * 0.2, paint, h * 0.26)
    bristles = [
        rod(
            (x * w * 0.14, h * 0.4, -d * 0.22 + z * d * 0.055),
            (x * w * 0.15, h, -d * 0.22 + z * d * 0.057),
            0.002,
            DARK,
            sides=4,
        )
        for x in (-2, -1, 0, 1, 2)
        for z in (-3, -2, -1, 0, 1, 2, 3)
    ]
    return join([head, handle, *bristles])


def razor(look: Look) -> Mesh:
    """A razor: handle and head, or an electric shaver standing upright."""
    w, h, d = look.size
    if h > d:
        body = cushion((0, h * 0.45, 0), (w, h * 0.9, d), DARK, 0.7)
        return body + join(cylinder((s * w * 0.22, h * 0.86, d * 0.1), w * 0.2, h * 0.12, STEEL) for s in (-1, 1))
    paint = look.tint(Paint(shine=0.4), ("#3f77b5", "#d2678f", "#3a3d42"))
    return rod((0, h * 0.4, d / 2), (0, h * 0.5, -d * 0.35), h * 0.25, paint) + box(
        (0, h * 0.55, -d * 0.42), (w, h * 0.5, d * 0.14), STEEL
    )


def hair_dryer(look: Look) -> Mesh:
    """A hair dryer on its side: barrel along x and handle."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.4), ("#b8433a", "#3f4a5a", "#8b5fa8"))
    y = h * 0.5
    barrel = rod((-w * 0.48, y, -d * 0.2), (w * 0.3, y, -d * 0.2), h * 0.32, DARK, h * 0.44) + ball(
        (w * 0.28, y, -d * 0.2), (w * 0.2, h * 0.46, h * 0.46), paint, 5
    )
    return barrel + cushion((w * 0.22, y * 0.9, d * 0.22), (w * 0.16, h * 0.55, d * 0.6), paint, 0.7)


RECIPES = {
    "towel": Recipe(towel, (0.34, 0.1, 0.26)),
    "towel_rack": Recipe(towel_rack, (0.6, 0.4, 0.14)),
    "roll": Recipe(roll, (0.11, 0.1, 0.11)),
    "toothbrush": Recipe(toothbrush, (0.02, 0.02, 0.18)),
    "brush_cup": Recipe(brush_cup, (0.09, 0.18, 0.09), inside=bottom),
    "paste": Recipe(paste, (0.05, 0.04, 0.16)),
    "soap": Recipe(soap, (0.1, 0.04, 0.07)),
    "comb": Recipe(comb, (0.04, 0.01, 0.18)),
    "hairbrush": Recipe(hairbrush, (0.07, 0.04, 0.22)),
    "razor": Recipe(razor, (0.05, 0.03, 0.14)),
    "hair_dryer": Recipe(hair_dryer, (0.22, 0.09, 0.14)),
}
