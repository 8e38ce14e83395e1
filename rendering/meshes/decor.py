"""What makes a room a home: plants, pictures, clocks, curtains, rugs, toys, instruments."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import (
    BLACK,
    BRASS,
    BRIGHT_COLORS,
    CERAMIC,
    CHROME,
    DARK,
    LEAF,
    SOIL,
    TERRACOTTA,
    WALNUT,
    WHITE,
    Paint,
)
from hearth.rendering.meshes.shapes import (
    ball,
    block,
    box,
    cushion,
    cylinder,
    lathe,
    medallion,
    panel,
    prism,
    quads,
    rod,
)
from hearth.rendering.meshes.storage import bottom
from hearth.rendering.pictures import PAINTINGS


def plant(look: Look) -> Mesh:
    """A plant in a pot: leaves in rosettes; blossoms on stems for an orchid."""
    w, h, d = look.size
    r = min(w, d) / 2
    tall = h * 0.3
    clay = look.pick((TERRACOTTA, CERAMIC, Paint("#5f7f8a", shine=0.4)), "pot")
    pot = lathe(
        [
            (0, 0),
            (r * 0.5, 0),
            (r * 0.66, tall * 0.85),
            (r * 0.72, tall * 0.85),
            (r * 0.72, tall),
            (r * 0.6, tall),
            (r * 0.58, tall * 0.85),
            (0, tall * 0.85),
        ],
        clay,
        18,
    )
    soil = shift(lathe([(r * 0.58, 0), (0, 0.002)], SOIL, 14), y=tall * 0.9)
    leaf = _leaf(r * 0.95, h * 0.5 if look.kind != "orchid" else h * 0.2)
    count = 7
    leaves = [
        shift(turn(turn(leaf, "x", 8 * (k % 3)), "y", 360 / count * k + 20 * (k % 2)), y=tall * 0.92)
        for k in range(count)
    ]
    if look.kind != "orchid":
        crown = [shift(turn(stretch(leaf, 0.7, 1.25, 0.6), "y", 120 * k + 30), y=tall * 0.92) for k in range(3)]
        return join([pot, soil, *leaves, *crown])
    bloom = Paint(look.color or look.pick(("#d46aa8", "#f2ecf4", "#b58ad0"), "bloom"))
    stems, blossoms = [], []
    for s in (-1, 1):
        points = [(s * r * 0.1, tall, 0.0), (s * r * 0.3, h * 0.75, 0.02), (s * r * 0.7, h * 0.93, 0.04)]
        stems += [rod(a, b, 0.004, LEAF, sides=5) for a, b in pairwise(points)]
        for t in (0.25, 0.6, 0.95):
            x, y = s * r * (0.3 + 0.4 * t), h * (0.75 + 0.17 * t)
            blossoms += [
                ball((x + 0.016 * math.cos(a), y + 0.016 * math.sin(a), 0.045), (0.017, 0.017, 0.006), bloom, 3)
                for a in (0.5, 1.76, 3.0, 4.3, 5.5)
            ]
            blossoms.append(ball((x, y, 0.052), 0.006, Paint("#f0c23a"), 2))
    return join([pot, soil, *leaves, *stems, *blossoms])


def _leaf(reach: float, rise: float) -> Mesh:
    """A leaf that arches from the origin towards +z."""
    t = np.linspace(0, 1, 6)
    z, y = reach * t, rise * (1.9 * t - 0.9 * t * t * t)
    half = 0.2 * reach * np.sin(np.pi * np.clip(t * 0.93 + 0.07, 0, 1)) ** 0.8
    strips = []
    for k in range(5):
        a, b = (half[k], y[k], z[k]), (half[k + 1], y[k + 1], z[k + 1])
        strips.append([(-a[0], a[1], a[2]), (-b[0], b[1], b[2]), b, a])
    return quads(np.array(strips, np.float32), LEAF.tinted(("#4f8a3c", "#3f7a44", "#6a9a48")[round(reach * 1000) % 3]))


def vase(look: Look) -> Mesh:
    """A vase, with flowers in it unless it is a bare one."""
    w, h, d = look.size
    r = min(w, d) / 2
    tall = h * (0.55 if look.kind != "bare" else 1.0)
    paint = look.tint(Paint(shine=0.6), ("#3f6f95", "#c8604a", "#dcd2be", "#4f8a7a"))
    body = lathe(
        [
            (0, 0),
            (r * 0.5, 0),
            (r * 0.8, tall * 0.35),
            (r * 0.7, tall * 0.6),
            (r * 0.32, tall * 0.86),
            (r * 0.42, tall),
            (r * 0.36, tall),
            (0, tall * 0.8),
        ],
        paint,
        18,
    )
    flowers = []
    if look.kind != "bare":
        for k in range(5):
            a = 2 * math.pi * k / 5
            tip = (r * 0.7 * math.cos(a), h * (0.86 + 0.05 * (k % 2)), r * 0.7 * math.sin(a))
            flowers += [
                rod((0, tall * 0.9, 0), tip, 0.003, LEAF, sides=4),
                ball(tip, (r * 0.24, r * 0.18, r * 0.24), Paint(BRIGHT_COLORS[(k + look.seed) % 8]), 4),
                ball((tip[0], tip[1] + r * 0.14, tip[2]), r * 0.09, Paint("#f4e29a"), 3),
            ]
    return join([body, *flowers])


def picture(look: Look) -> Mesh:
    """A framed picture for a wall; a standing photo where it is deep."""
    w, h, d = look.size
    frame = Paint(look.pick(("#6f4528", "#26282c", "#c6a052", "#e9e5dc"), "frame"), "wood_fine", shine=0.3)
    t = min(d, 0.03)
    rim = min(0.035, w * 0.1)
    name = (
        "child_drawing"
        if look.kind == "drawing"
        else look.pick(PAINTINGS, "subject")
        if look.kind != "photo"
        else "portrait"
    )
    plate = block(-w / 2, w / 2, 0, h, -t / 2, t / 2, frame)
    mat = panel((0, h / 2, t / 2 + 0.001), w - rim * 2, h - rim * 2, Paint("#f4f1e6"))
    image = panel((0, h / 2, t / 2 + 0.002), w - rim * 3.4, h - rim * 3.4, Paint("#ffffff", name))
    whole = join((plate, mat, image))
    if d < 0.045:
        return whole
    prop = rod((0, h * 0.5, -t), (0, 0.004, -d / 2 + 0.004), 0.006, frame, sides=5)
    return shift(turn(whole, "x", -8), z=d * 0.1) + prop


def wall_clock(look: Look) -> Mesh:
    """A round clock for a wall."""
    w, h, d = look.size
    r = min(w, h) / 2
    ring = lathe(
        [(r * 0.97, 0), (r, d * 0.4), (r * 0.95, d), (r * 0.88, d * 0.8)],
        look.tint(Paint(shine=0.4), ("#26282c", "#8a5a33", "#b8433a", "#c6a052")),
        26,
    )
    whole = ring + lathe([(0, 0), (r * 0.97, 0)], DARK, 20)
    face = medallion((0, h / 2, d * 0.25), r * 0.9, Paint("#ffffff", "clock"))
    return shift(turn(whole, "x", 90), 0, h / 2, -d / 2) + face


def alarm_clock(look: Look) -> Mesh:
    """An alarm clock: a box with lit digits, or two bells."""
    w, h, d = look.size
    body = cushion(
        (0, h / 2, 0), (w, h, d), look.tint(Paint(shine=0.4), ("#26282c", "#e4e0d6", "#3f77b5", "#b8433a")), 0.35, 3
    )
    return body + panel((0, h * 0.5, d / 2 + 0.001), w * 0.84, h * 0.7, Paint("#ffffff", "digits", glow=0.9))


def curtain(look: Look) -> Mesh:
    """A curtain in folds; drawn thin when open."""
    w, h, d = look.size
    paint = look.tint(Paint("#ffffff", "fabric", 3.0), ("#c9b79a", "#8fa3b0", "#b58a7a", "#a3b08f", "#d8cfc0"))
    folds = max(3, round(w / 0.07))
    step = w / folds
    return join(
        cushion(
            (-w / 2 + step * (k + 0.5), h / 2, (d * 0.12) * (1 if k % 2 else -1)),
            (step * 1.25, h, d * 0.72),
            paint,
            0.9,
            4,
        )
        for k in range(folds)
    )


def rug(look: Look) -> Mesh:
    """A rug with a pattern and fringes; a plain mat where it is small."""
    w, h, d = look.size
    small = w * d < 0.6
    paint = look.tint(Paint("#ffffff", "carpet", 3.0), ("#7f95a8", "#a88a7a", "#8fa38a", "#b8a890"))
    base = block(-w / 2, w / 2, 0, h * 0.9, -d / 2, d / 2, paint)
    if small or look.variant % 2:
        inner = block(
            -w / 2 + 0.06,
            w / 2 - 0.06,
            h * 0.9,
            h,
            -d / 2 + 0.06,
            d / 2 - 0.06,
            Paint(paint.color, "stripes" if small else "checks", 2.0),
        )
        return base + inner
    return base + panel((0, h, 0), w, d, Paint("#ffffff", "rug"), "+y")


def toy(look: Look) -> Mesh:
    """A teddy bear, sitting; or a ball or blocks by kind."""
    w, h, d = look.size
    if look.kind == "ball":
        return ball(
            (0, h / 2, 0),
            (w / 2, h / 2, d / 2),
            look.tint(Paint("#ffffff", "stripes", 3.0, shine=0.3), BRIGHT_COLORS),
            7,
        )
    fur = look.tint(Paint("#ffffff", "carpet", 6.0), ("#b07a45", "#8a5a33", "#d8b58a", "#9a9aa3"))
    pale = Paint("#e8cfa8", "carpet", 6.0)
    s = min(w / 0.9, h, d / 0.8)
    parts = [
        ball((0, s * 0.3, 0), (s * 0.22, s * 0.27, s * 0.2), fur),
        ball((0, s * 0.3, s * 0.06), (s * 0.15, s * 0.19, s * 0.16), pale),
        ball((0, s * 0.7, s * 0.02), (s * 0.2, s * 0.19, s * 0.18), fur),
        ball((0, s * 0.65, s * 0.17), (s * 0.09, s * 0.075, s * 0.07), pale),
        ball((0, s * 0.68, s * 0.235), s * 0.028, BLACK, 3),
    ]
    for k in (-1, 1):
        parts += [
            ball((k * s * 0.16, s * 0.87, 0), (s * 0.075, s * 0.075, s * 0.04), fur, 4),
            ball((k * s * 0.075, s * 0.74, s * 0.175), s * 0.022, BLACK, 3),
            rod((k * s * 0.2, s * 0.45, 0), (k * s * 0.34, s * 0.28, s * 0.1), s * 0.075, fur, s * 0.06, 8),
            ball((k * s * 0.35, s * 0.27, s * 0.1), s * 0.07, fur, 4),
            rod((k * s * 0.14, s * 0.1, s * 0.05), (k * s * 0.24, s * 0.09, s * 0.3), s * 0.09, fur, s * 0.08, 8),
            ball((k * s * 0.24, s * 0.09, s * 0.31), (s * 0.08, s * 0.09, s * 0.06), pale, 4),
        ]
    return join(parts)


def board_game(look: Look) -> Mesh:
    """A board with pieces: chess by kind."""
    w, h, d = look.size
    chess = look.kind == "chess"
    t = min(h * 0.4, 0.02)
    base = block(-w / 2, w / 2, 0, t, -d / 2, d / 2, WALNUT) + panel(
        (0, t + 0.001, 0), w * 0.94, d * 0.94, Paint("#ffffff", "chess" if chess else "board"), "+y"
    )
    pieces = []
    for k in range(8):
        x = (k - 3.5) * w * 0.94 / 8
        for row, paint in (
            ((-3.5, DARK), (3.5, Paint("#ecdcb8"))) if chess else ((3.5, Paint(BRIGHT_COLORS[k % 4])),) if k % 2 else ()
        ):
            z = row * d * 0.94 / 8
            pieces.append(
                cylinder((x, t, z), w * 0.03, (h - t) * 0.7 * (0.7 + 0.3 * (k in (3, 4))), paint, w * 0.012, 10)
            )
            pieces.append(ball((x, t + (h - t) * 0.72 * (0.7 + 0.3 * (k in (3, 4))), z), w * 0.02, paint, 3))
    return join([base, *pieces])


def guitar(look: Look) -> Mesh:
    """A guitar or violin standing upright, its face towards +z."""
    w, h, d = look.size
    wood = Paint(look.color or look.pick(("#b5793a", "#8c4a2f", "#c79a66"), "wood"), "wood", 2.0, shine=0.5)
    t = d * 0.6
    outline = []
    for k in range(36):
        a = 2 * math.pi * k / 36
        y = -math.cos(a)
        half = (
            0.5 * (1 - 0.12 * (y + 1) / 2) * abs(math.sin(a)) ** 0.6 * (1 - 0.26 * math.exp(-((y - 0.15) ** 2) / 0.05))
        )
        outline.append((w * half * (1 if math.sin(a) > 0 else -1), h * 0.235 + h * 0.235 * y))
    body = prism(outline, t, wood)
    hole = shift(turn(cylinder((0, 0, 0), w * 0.13, 0.002, BLACK, sides=18), "x", 90), 0, h * 0.29, t / 2)
    neck = block(-w * 0.055, w * 0.055, h * 0.4, h * 0.88, t / 2 - 0.004, t / 2 + 0.014, WALNUT)
    head = block(-w * 0.09, w * 0.09, h * 0.87, h, t / 2 - 0.01, t / 2 + 0.008, WALNUT)
    bridge = block(-w * 0.15, w * 0.15, h * 0.12, h * 0.14, t / 2, t / 2 + 0.01, DARK)
    strings = [
        rod((x * w * 0.014, h * 0.13, t / 2 + 0.016), (x * w * 0.012, h * 0.9, t / 2 + 0.018), 0.0012, CHROME, sides=4)
        for x in (-3, -1, 1, 3)
    ]
    pegs = [rod((-w * 0.13, h * y, t / 2), (w * 0.13, h * y, t / 2), 0.006, CHROME, sides=5) for y in (0.91, 0.95)]
    return join([body, hole, neck, head, bridge, *strings, *pegs])


def piano(look: Look) -> Mesh:
    """An upright piano with its keys towards +z."""
    w, h, d = look.size
    wood = Paint(look.color or look.pick(("#26211f", "#5d3a22"), "wood"), "wood_fine", 1.0, shine=0.6)
    deep, bed = d * 0.55, h * 0.6
    body = block(-w / 2, w / 2, 0, h, -d / 2, -d / 2 + deep, wood)
    shelf = block(-w / 2, w / 2, bed - 0.1, bed, -d / 2 + deep, d / 2, wood)
    keys = panel(
        (0, bed + 0.002, (d / 2 - 0.02 + (-d / 2 + deep)) / 2 + 0.01),
        w * 0.9,
        d - deep - 0.04,
        Paint("#ffffff", "piano_keys"),
        "+y",
    )
    ends = [
        block(
            s * w / 2 - (0.05 if s > 0 else 0),
            s * w / 2 + (0.05 if s < 0 else 0),
            bed,
            bed + 0.06,
            -d / 2 + deep,
            d / 2,
            wood,
        )
        for s in (-1, 1)
    ]
    feet = [
        block(s * (w / 2 - 0.04) - 0.035, s * (w / 2 - 0.04) + 0.035, 0, bed - 0.1, d / 2 - 0.08, d / 2 - 0.01, wood)
        for s in (-1, 1)
    ]
    notes = panel((0, bed + 0.26, -d / 2 + deep + 0.01), 0.4, 0.3, Paint("#ffffff", "book_open"))
    pedals = [box((x, 0.06, -d / 2 + deep + 0.03), (0.03, 0.015, 0.08), BRASS) for x in (-0.06, 0.06)]
    return join([body, shelf, keys, *ends, *feet, notes, *pedals])


def music_stand(look: Look) -> Mesh:
    """A tripod with a desk for sheets."""
    w, h, d = look.size
    column = cylinder((0, 0.1, 0), 0.012, h * 0.72, DARK, sides=8)
    feet = [turn(rod((0, 0.16, 0), (0, 0.01, d * 0.48), 0.01, DARK, sides=6), "y", 120 * k) for k in range(3)]
    plate = turn(
        block(-w / 2, w / 2, h * 0.72, h * 0.98, -0.006, 0.006, DARK)
        + panel((0, h * 0.85, 0.008), w * 0.86, h * 0.24, Paint("#ffffff", "book_open")),
        "x",
        -18,
        (0, h * 0.74, 0),
    )
    return join([column, *feet, plate])


def longboard(look: Look) -> Mesh:
    """A skateboard on its wheels, along z."""
    w, h, d = look.size
    deck = cushion((0, h * 0.85, 0), (w, h * 0.28, d), look.tint(Paint("#ffffff", "wood", 2.0), BRIGHT_COLORS), 0.9)
    wheels = [turn(cylinder((0, -w * 0.1, 0), h * 0.3, w * 0.2, WHITE, sides=12), "z", 90) for _ in range(4)]
    spots = [(x * w * 0.34, h * 0.3, z * d * 0.32) for x in (-1, 1) for z in (-1, 1)]
    return join([deck, *(shift(wheel, *spot) for wheel, spot in zip(wheels, spots, strict=True))])


RECIPES = {
    "plant": Recipe(plant, (0.4, 0.7, 0.4), kinds=("", "orchid")),
    "vase": Recipe(vase, (0.16, 0.34, 0.16), inside=bottom, kinds=("", "bare")),
    "picture": Recipe(picture, (0.6, 0.45, 0.03), 3, kinds=("", "drawing", "photo")),
    "wall_clock": Recipe(wall_clock, (0.3, 0.3, 0.05)),
    "alarm_clock": Recipe(alarm_clock, (0.13, 0.08, 0.06)),
    "curtain": Recipe(curtain, (0.5, 1.5, 0.1)),
    "rug": Recipe(rug, (1.4, 0.015, 0.9), 2),
    "toy": Recipe(toy, (0.22, 0.24, 0.18), kinds=("", "ball")),
    "board_game": Recipe(board_game, (0.34, 0.07, 0.34), kinds=("", "chess")),
    "guitar": Recipe(guitar, (0.38, 1.0, 0.14)),
    "piano": Recipe(piano, (1.45, 1.15, 0.6)),
    "music_stand": Recipe(music_stand, (0.5, 1.2, 0.4)),
    "longboard": Recipe(longboard, (0.22, 0.12, 0.8)),
}
