"""Things for which a home has one place: seats without backs, tools, heaters, vehicles, luggage."""

from __future__ import annotations

import math

from hearth.rendering.meshes.joinery import legs, round_legs
from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import (
    BLACK,
    BRASS,
    BRIGHT_COLORS,
    CHROME,
    DARK,
    FABRIC_COLORS,
    GREY,
    OAK,
    STEEL,
    WHITE,
    WOODS,
    Paint,
)
from hearth.rendering.meshes.shapes import arc, ball, block, box, cushion, cylinder, lathe, panel, prism, rod, tube
from hearth.rendering.meshes.storage import bottom


def stool(look: Look) -> Mesh:
    """A round stool on four legs with rungs."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    seat = stretch(lathe([(0, h - 0.05), (0.48, h - 0.05), (0.5, h - 0.02), (0.47, h), (0, h)], wood, 20), x=w, z=d)
    rungs = [
        rod((-w * 0.36, h * 0.35, s * d * 0.36), (w * 0.36, h * 0.35, s * d * 0.36), 0.012, wood, sides=6)
        for s in (-1, 1)
    ]
    return join([seat, round_legs(w * 0.95, d * 0.95, h - 0.04, 0.022, wood, 0.06), *rungs])


def pouf(look: Look) -> Mesh:
    """An upholstered block to put feet on."""
    w, h, d = look.size
    cloth = look.tint(Paint("#ffffff", "fabric", 4.0), FABRIC_COLORS)
    return cushion((0, h * 0.55, 0), (w, h * 0.9, d), cloth, 0.35) + legs(w, d, h * 0.15, 0.05, OAK, 0.04)


def suitcase(look: Look) -> Mesh:
    """A suitcase or backpack standing: shell, handle, straps and lock."""
    w, h, d = look.size
    paint = look.tint(Paint("#ffffff", "leather", 2.0, shine=0.2), ("#7a4a2a", "#3f5f86", "#4a4f55", "#8a3a3a"))
    body = cushion((0, h * 0.46, 0), (w, h * 0.92, d), paint, 0.3)
    straps = [
        box((x * w, h * 0.46, 0), (w * 0.07, h * 0.925, d * 1.005), paint.tinted("#c9a06a")) for x in (-0.28, 0.28)
    ]
    grip = tube(
        [(-w * 0.14, h * 0.9, 0), (-w * 0.12, h * 0.985, 0), (w * 0.12, h * 0.985, 0), (w * 0.14, h * 0.9, 0)],
        0.011,
        DARK,
        6,
    )
    return join([body, *straps, grip, box((0, h * 0.7, d / 2), (0.05, 0.03, 0.01), BRASS)])


def coat_rack(look: Look) -> Mesh:
    """A stand on four feet with hooks around its top, and a coat on one of them."""
    w, h, d = look.size
    r = min(w, d) / 2
    pole = cylinder((0, 0.05, 0), 0.022, h - 0.07, OAK, sides=8) + ball((0, h - 0.025, 0), 0.025, OAK, steps=3)
    feet = [turn(rod((0, 0.12, 0), (0, 0.015, r * 0.95), 0.016, OAK, sides=6), "y", 45 + 90 * k) for k in range(4)]
    hook = tube([(0, h * 0.9, 0), (0, h * 0.89, r * 0.5), (0, h * 0.95, r * 0.85)], 0.011, OAK, 6)
    hooks = [turn(hook, "y", 60 * k) for k in range(6)]
    paint = look.tint(Paint("#ffffff", "fabric", 4.0), FABRIC_COLORS)
    hang, wide = r * 0.62, min(r * 0.95, 0.2)
    half = [(wide, h * 0.36), (wide * 0.62, h * 0.8), (0.03, h * 0.89)]
    body = [*half, *((-x, y) for x, y in reversed(half))]
    arms = [
        rod((s * wide * 0.6, h * 0.79, hang), (s * wide * 1.02, h * 0.5, hang), 0.035, paint, sides=8) for s in (-1, 1)
    ]
    return join([pole, *feet, *hooks, shift(prism(body, 0.1, paint), z=hang), *arms])


def saucepan(look: Look) -> Mesh:
    """A small pot with one long handle towards +z."""
    w, h, d = look.size
    r = min(w / 2, d * 0.38)
    body = lathe(
        [(0, 0), (r * 0.96, 0), (r, h * 0.06), (r, h * 0.84), (r * 0.95, h * 0.84), (r * 0.93, 0.01), (0, 0.01)],
        look.tint(STEEL, ("#b9bcc0", "#a8342e")),
        22,
    )
    grip = rod((0, h * 0.74, r * 0.95), (0, h * 0.9, d - r - 0.01), 0.012, DARK, sides=8)
    return shift(join([body, grip]), z=-d / 2 + r)


def donut(look: Look) -> Mesh:
    """A ring of dough, glazed, with sprinkles."""
    w, h, d = look.size
    r = min(w, d) / 2
    ring = [
        (r * 0.64 + r * 0.36 * math.cos(a), h / 2 + h / 2 * math.sin(a))
        for a in (k * math.pi / 4 for k in range(-4, 5))
    ]
    glaze = look.tint(Paint(shine=0.5), ("#e79ab0", "#5a3420", "#f2ead8"))
    bits = [
        shift(
            turn(box((0, 0, 0), (0.012, 0.003, 0.003), Paint(BRIGHT_COLORS[k % 8])), "y", 70 * k),
            r * 0.64 * math.cos(2.4 * k),
            h * 0.985,
            r * 0.64 * math.sin(2.4 * k),
        )
        for k in range(12)
    ]
    return join([lathe(ring[:5], Paint("#c58f4f"), 18), lathe(ring[4:], glaze, 18), *bits])


def fan(look: Look) -> Mesh:
    """A fan on a foot with a wire cage."""
    w, h, d = look.size
    r = min(w / 2, h * 0.36)
    y = h - r
    stand = cylinder((0, 0, 0), min(w, d) * 0.4, 0.03, WHITE) + cylinder((0, 0.03, 0), 0.018, y - 0.03, WHITE, sides=8)
    ring = tube([(x, y + z, 0.0) for x, z, _ in arc((0, 0, 0), r * 0.97, 0, 360, steps=16)], 0.006, CHROME, 5)
    spokes = [
        rod((0, y, 0.03), (r * 0.96 * math.cos(a), y + r * 0.96 * math.sin(a), 0.0), 0.003, CHROME, sides=4)
        for a in (k * math.pi / 6 for k in range(12))
    ]
    blades = [
        shift(
            turn(
                cushion((0, r * 0.45, 0), (r * 0.42, r * 0.8, 0.02), Paint("#6f9ab8"), 0.9, 4),
                "z",
                120 * k + (40 if look.on else 0),
            ),
            y=y,
        )
        for k in range(3)
    ]
    return join([stand, ring, *spokes, *blades, ball((0, y, 0.0), 0.05, WHITE, 4)])


def radiator(look: Look) -> Mesh:
    """A ribbed radiator with a valve."""
    w, h, d = look.size
    count = max(4, round(w / 0.07))
    step = w / count
    ribs = [
        cushion((-w / 2 + step * (k + 0.5), h * 0.52, 0), (step * 0.82, h * 0.92, d), WHITE, 0.6, 3)
        for k in range(count)
    ]
    pipes = [rod((-w / 2, y, 0), (w / 2, y, 0), 0.015, WHITE, sides=6) for y in (h * 0.15, h * 0.88)]
    return join([*ribs, *pipes, cylinder((w * 0.47, 0, 0), 0.02, h * 0.16, BRASS, sides=8)])


def air_conditioner(look: Look) -> Mesh:
    """A wall unit with slats."""
    w, h, d = look.size
    slats = [
        block(-w * 0.44, w * 0.44, h * (0.1 + 0.09 * k), h * (0.13 + 0.09 * k), d * 0.49, d * 0.505, GREY)
        for k in range(3)
    ]
    led = panel((w * 0.4, h * 0.6, d * 0.502), 0.03, 0.015, Paint("#7dff8a", glow=1.2) if look.on else GREY)
    return join([cushion((0, h / 2, 0), (w, h, d), WHITE, 0.25, 3), *slats, led])


def sewing_machine(look: Look) -> Mesh:
    """A sewing machine: bed, arm, wheel and needle."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.4), ("#e9e4d6", "#2c3038", "#7fa3b8"))
    parts = [
        block(-w / 2, w / 2, 0, h * 0.16, -d / 2, d / 2, paint),
        block(w * 0.22, w * 0.42, h * 0.16, h, -d * 0.4, d * 0.4, paint),
        block(-w * 0.42, w * 0.42, h * 0.68, h, -d * 0.38, d * 0.38, paint),
        block(-w * 0.44, -w * 0.28, h * 0.42, h, -d * 0.34, d * 0.34, paint),
        rod((-w * 0.36, h * 0.16, 0), (-w * 0.36, h * 0.44, 0), 0.006, CHROME, sides=6),
        turn(cylinder((0, 0, 0), h * 0.2, 0.03, DARK), "z", -90, (0, 0, 0)),
    ]
    parts[-1] = shift(parts[-1], w * 0.43, h * 0.76)
    return join([*parts, cylinder((w * 0.1, h, 0), 0.018, 0.04, Paint("#c8463c"), sides=10)])


def fireplace(look: Look) -> Mesh:
    """A brick fireplace with logs; it burns when on."""
    w, h, d = look.size
    brick = Paint("#a8604a", "brick", 1.2)
    x = w * 0.32
    parts = [
        block(-w / 2, -x, 0, h * 0.9, -d / 2, d / 2, brick),
        block(x, w / 2, 0, h * 0.9, -d / 2, d / 2, brick),
        block(-x, x, h * 0.62, h * 0.9, -d / 2, d / 2, brick),
        block(-x, x, 0, h * 0.62, -d / 2, -d * 0.42, BLACK),
        block(-w / 2, w / 2, h * 0.9, h, -d / 2, d / 2, Paint("#6f4528", "wood", 1.2)),
        *(
            rod(
                (-w * 0.2, 0.06 + 0.07 * k, (k - 0.5) * 0.1),
                (w * 0.2, 0.07 + 0.05 * k, (0.5 - k) * 0.1),
                0.04,
                Paint("#6b4a30", "wood", 3.0),
            )
            for k in range(2)
        ),
    ]
    flames = (
        [
            cushion(
                (x_ * w, 0.22, 0),
                (0.09, 0.3 + 0.1 * k, 0.07),
                Paint(("#ffb53a", "#ff7a2a", "#ffd86a")[k], glow=2.0),
                1.0,
                4,
            )
            for k, x_ in enumerate((-0.1, 0.08, 0.0))
        ]
        if look.on
        else []
    )
    return join([*parts, *flames])


def camera(look: Look) -> Mesh:
    """A camera with its lens towards +z."""
    w, h, d = look.size
    lens = turn(
        lathe([(0.0, d * 0.5), (h * 0.3, d * 0.5), (h * 0.36, d * 0.46), (h * 0.36, 0)][::-1], DARK, 18), "x", 90
    )
    front = shift(
        turn(cylinder((0, 0, 0), h * 0.26, 0.003, Paint("#4a6f9a", shine=1.0)), "x", 90), 0, h * 0.44, d * 0.49
    )
    return join(
        [
            cushion((0, h * 0.44, -d * 0.2), (w, h * 0.88, d * 0.5), BLACK, 0.3, 3),
            shift(lens, 0, h * 0.44, -d * 0.02),
            front,
            box((w * 0.1, h * 0.93, -d * 0.2), (w * 0.3, h * 0.14, d * 0.3), BLACK),
            cylinder((-w * 0.34, h * 0.86, -d * 0.2), 0.01, h * 0.08, CHROME, sides=8),
        ]
    )


def staircase(look: Look) -> Mesh:
    """Steps that rise towards -z."""
    w, h, d = look.size
    count = max(3, round(h / 0.18))
    return join(
        block(-w / 2, w / 2, 0, h * (k + 1) / count, d / 2 - d * (k + 1) / count, d / 2 - d * k / count, OAK)
        for k in range(count)
    )


RECIPES = {
    "stool": Recipe(stool, (0.36, 0.5, 0.36)),
    "pouf": Recipe(pouf, (0.6, 0.42, 0.5)),
    "suitcase": Recipe(suitcase, (0.5, 0.62, 0.22), inside=bottom),
    "coat_rack": Recipe(coat_rack, (0.45, 1.7, 0.45)),
    "saucepan": Recipe(saucepan, (0.2, 0.12, 0.36), inside=bottom),
    "donut": Recipe(donut, (0.1, 0.04, 0.1)),
    "fan": Recipe(fan, (0.42, 1.1, 0.36), states=("ON",)),
    "radiator": Recipe(radiator, (0.9, 0.6, 0.12)),
    "air_conditioner": Recipe(air_conditioner, (0.85, 0.28, 0.22)),
    "sewing_machine": Recipe(sewing_machine, (0.42, 0.3, 0.18)),
    "fireplace": Recipe(fireplace, (1.3, 1.1, 0.45), lamp=0.25, states=("ON",)),
    "camera": Recipe(camera, (0.13, 0.09, 0.1)),
    "staircase": Recipe(staircase, (1.0, 1.6, 2.2)),
}
