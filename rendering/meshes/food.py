"""Things to eat."""

from __future__ import annotations

import math

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import CERAMIC, Paint
from hearth.rendering.meshes.shapes import arc, ball, block, box, cushion, cylinder, lathe, prism, rod, tube

CRUST = Paint("#c58f4f", "carpet", 4.0)
STALK = Paint("#5a4326")
GREEN = Paint("#5d9a44")
MEAT = Paint("#9a4b3a", "marble", 5.0)
ROASTED = Paint("#b9763a", "leather", 4.0, shine=0.3)

FRUIT_COLORS = {
    "apple": "#c23a33",
    "orange": "#e88a2a",
    "lemon": "#f0d038",
    "kiwi": "#7a6a3a",
    "potato": "#b8955a",
    "onion": "#c98a4a",
    "tomato": "#cf3a2c",
}


def fruit(look: Look) -> Mesh:
    """A round fruit by kind: apple, orange, lemon, kiwi, potato, onion."""
    w, h, d = look.size
    paint = Paint(look.color or FRUIT_COLORS.get(look.kind, "#c23a33"), "plaster", 4.0, shine=0.4)
    if look.kind in ("apple", ""):
        body = lathe(
            [
                (0, h * 0.06),
                (0.2, 0),
                (0.42, h * 0.25),
                (0.5, h * 0.55),
                (0.36, h * 0.85),
                (0.12, h * 0.86),
                (0, h * 0.76),
            ],
            paint,
            18,
        )
        return (
            stretch(body, x=w, z=d)
            + rod((0, h * 0.76, 0), (0.006, h, 0), 0.004, STALK, sides=5)
            + shift(turn(cushion((0, 0, 0), (0.03, 0.004, 0.016), GREEN, 1.0, 3), "z", 25), 0.018, h * 0.94, 0)
        )
    body = ball((0, h / 2, 0), (w / 2, h / 2, d / 2), paint, 6)
    if look.kind == "lemon":
        return (
            stretch(body, x=0.84)
            + ball((w * 0.42, h / 2, 0), (w * 0.1, h * 0.14, d * 0.14), paint, 3)
            + ball((-w * 0.42, h / 2, 0), (w * 0.1, h * 0.14, d * 0.14), paint, 3)
        )
    if look.kind == "onion":
        return stretch(body, y=0.86) + cylinder((0, h * 0.8, 0), w * 0.08, h * 0.2, paint, 0.002, 8)
    if look.kind == "orange":
        return body + cylinder((0, h * 0.985, 0), 0.006, 0.003, GREEN, sides=6)
    return body


def fruit_bowl(look: Look) -> Mesh:
    """A dish of mixed fruit, or a heap of vegetables."""
    w, h, d = look.size
    dish = stretch(
        lathe([(0, 0), (0.28, 0), (0.5, h * 0.4), (0.46, h * 0.4), (0.25, 0.01), (0, 0.01)], CERAMIC, 18), x=w, z=d
    )
    colors = (
        ("#6f9a3a", "#cf3a2c", "#d8892a", "#4f8a3c", "#8a3a6a")
        if look.kind == "vegetable"
        else ("#c23a33", "#e88a2a", "#f0d038", "#7aa83a", "#6b3a7a")
    )
    r = min(w, d, h * 2) * 0.19
    spots = ((0, 0, 0.52), (1, 0, 0.42), (-0.5, 0.85, 0.42), (-0.5, -0.85, 0.42), (0.2, 0.1, 0.8))
    return join(
        [
            dish,
            *(
                ball((x * w * 0.22, min(y * h, h - r), z * d * 0.22), r, Paint(c, shine=0.4), 5)
                for (x, z, y), c in zip(spots, colors, strict=True)
            ),
        ]
    )


def banana(look: Look) -> Mesh:
    """Bananas in a bunch."""
    w, h, d = look.size
    paint = Paint("#ecc83a")
    bunch = []
    for k in range(3):
        bow = arc((0, h * 0.5, -d * 0.1), w * 0.46, 25 + k * 4, 155 - k * 4, "xz", 7)
        one = tube([(x, y, z * 0.7 - w * 0.2) for x, y, z in bow], min(h * 0.42, 0.02), paint, 7)
        bunch.append(shift(one, y=(k % 2) * h * 0.08 - h * 0.04, z=(k - 1) * d * 0.2))
    tip = box((w * 0.44, h * 0.5, -d * 0.1), (w * 0.08, h * 0.3, d * 0.4), STALK)
    return join([*bunch, tip])


def carrot(look: Look) -> Mesh:
    """Carrots with their leaves, lying along x."""
    w, h, d = look.size
    one = rod((-w * 0.2, h * 0.4, 0), (w * 0.5, h * 0.3, 0), h * 0.4, Paint("#e07a2a"), 0.003, 10)
    leaves = [
        rod((-w * 0.2, h * 0.4, 0), (-w * 0.48, h * (0.4 + 0.3 * (k == 1)), (k - 1) * d * 0.25), 0.003, GREEN, 0.007, 5)
        for k in range(3)
    ]
    bundle = join([one, *leaves])
    return shift(bundle, z=-d * 0.2) + shift(bundle, 0.01, 0, d * 0.2)


def bread(look: Look) -> Mesh:
    """A loaf with cuts, and a slice before it."""
    w, h, d = look.size
    loaf = cushion((-w * 0.06, h * 0.48, 0), (w * 0.86, h * 0.96, d), CRUST, 0.75, 6)
    cuts = [
        turn(
            box((-w * 0.3 + k * w * 0.2, h * 0.93, 0), (0.012, h * 0.05, d * 0.5), Paint("#e8cf9f")),
            "y",
            25,
            (-w * 0.3 + k * w * 0.2, 0, 0),
        )
        for k in range(3)
    ]
    piece = shift(
        turn(cushion((0, 0, 0), (0.016, h * 0.86, d * 0.9), Paint("#ecd9ae", "carpet", 6.0), 0.4, 4), "z", -20),
        w * 0.44,
        h * 0.45,
        0,
    )
    return join([loaf, *cuts, piece])


def cake(look: Look) -> Mesh:
    """A round cake, one piece missing, with icing and cherries."""
    w, h, d = look.size
    r = min(w, d) / 2
    icing = look.tint(Paint(shine=0.3), ("#f2d7dc", "#5a3420", "#f4eedc"))
    body = cylinder((0, 0.012, 0), r * 0.9, h * 0.66, Paint("#c9965a", "carpet", 5.0), sides=24)
    cream = lathe([(r * 0.92, h * 0.5), (r * 0.94, h * 0.72), (r * 0.88, h * 0.78), (0, h * 0.78)], icing, 24)
    plate = lathe([(0, 0), (r, 0.004), (r, 0.012), (0, 0.012)], CERAMIC, 24)
    berries = [
        ball((r * 0.7 * x, h * 0.86, r * 0.7 * z), h * 0.12, Paint("#b8202c", shine=0.7), 3)
        for x, z in ((1, 0), (0.5, 0.86), (-0.5, 0.86), (-1, 0), (-0.5, -0.86), (0.5, -0.86), (0, 0))
    ]
    return join([body, cream, plate, *berries])


def dessert(look: Look) -> Mesh:
    """Scoops in a cup."""
    w, h, d = look.size
    r = min(w, d) / 2
    cup = lathe(
        [
            (0, 0),
            (r * 0.5, 0),
            (r * 0.25, h * 0.12),
            (r * 0.3, h * 0.2),
            (r, h * 0.52),
            (r * 0.92, h * 0.52),
            (0, h * 0.3),
        ],
        Paint("#cfe2e8", shine=0.9),
        18,
    )
    scoops = [
        ball((x * r * 0.42, h * 0.62, z * r * 0.42), r * 0.46, Paint(c, "carpet", 8.0), 5)
        for x, z, c in ((1, 0, "#f2d7dc"), (-0.5, 0.8, "#f4eedc"), (-0.5, -0.8, "#6b3f26"))
    ]
    cherry = ball((0, h * 0.9, 0), h * 0.1, Paint("#b8202c", shine=0.7), 3)
    return join([cup, *scoops, cherry])


def cheese(look: Look) -> Mesh:
    """A wedge of cheese with holes, or a block of butter on paper."""
    w, h, d = look.size
    paint = Paint("#efc84a")
    if look.kind == "butter":
        return block(-w / 2, w / 2, 0, 0.006, -d / 2, d / 2, CERAMIC) + cushion(
            (0, h * 0.52, 0), (w * 0.82, h * 0.92, d * 0.72), Paint("#f4e29a", shine=0.3), 0.2, 3
        )
    wedge = shift(turn(prism([(-w / 2, -d / 2), (w / 2, 0), (-w / 2, d / 2)], h, paint), "x", 90), y=h / 2)
    holes = [
        ball((x * w, y * h, z * d), 0.11 * h + 0.004, Paint("#c99a2a"), 3)
        for x, y, z in (
            (-0.1, 0.5, 0.29),
            (-0.35, 0.7, 0.4),
            (0.12, 0.75, 0.2),
            (-0.2, 0.98, 0.0),
            (-0.38, 0.98, -0.2),
            (-0.48, 0.4, 0.1),
        )
    ]
    return join([wedge, *holes])


def egg(look: Look) -> Mesh:
    """A box of eggs."""
    w, h, d = look.size
    card = Paint("#a8a090", "carpet", 4.0)
    base = cushion((0, h * 0.3, 0), (w, h * 0.6, d), card, 0.3, 3)
    eggs = [
        ball(
            (-w / 2 + w * (i + 0.5) / 5, h * 0.62, (k - 0.5) * d * 0.44),
            (min(w / 11, h * 0.4), h * 0.38, min(w / 11, h * 0.4)),
            Paint(("#e8cdb0", "#f2e6d6")[(i + k) % 2]),
            4,
        )
        for i in range(5)
        for k in range(2)
    ]
    return join([base, *eggs])


def meat(look: Look) -> Mesh:
    """By kind: a steak, bacon, a fish, or a roast bird; on a plate."""
    w, h, d = look.size
    plate = stretch(
        lathe([(0, 0), (0.35, 0), (0.5, h * 0.16), (0.48, h * 0.2), (0.3, 0.008), (0, 0.008)], CERAMIC, 20), x=w, z=d
    )
    return plate + {"fish": _fish, "bird": _bird, "bacon": _bacon}.get(look.kind, _steak)(w, h, d)


def _steak(w: float, h: float, d: float) -> Mesh:
    fat = shift(
        turn(
            prism(
                [
                    (x * w, z * d)
                    for x, z in ((-0.3, -0.25), (0.1, -0.32), (0.34, -0.12), (0.3, 0.16), (0.02, 0.28), (-0.32, 0.2))
                ],
                h * 0.55,
                Paint("#ecd9c6"),
            ),
            "x",
            90,
        ),
        y=h * 0.55,
    )
    lean = shift(
        turn(
            prism(
                [
                    (x * w, z * d)
                    for x, z in ((-0.26, -0.2), (0.1, -0.27), (0.29, -0.1), (0.25, 0.13), (0.02, 0.23), (-0.27, 0.16))
                ],
                h * 0.6,
                MEAT,
            ),
            "x",
            90,
        ),
        y=h * 0.57,
    )
    return fat + lean + cushion((-0.02 * w, h * 0.84, 0), (w * 0.1, h * 0.1, d * 0.1), Paint("#f0e6d6"), 1.0, 3)


def _bacon(w: float, h: float, d: float) -> Mesh:
    strips = []
    for k in range(3):
        for j in range(6):
            strips.append(
                box(
                    (-w * 0.32 + j * w * 0.13, h * (0.4 + 0.3 * (j % 2)), (k - 1) * d * 0.2),
                    (w * 0.13, h * 0.24, d * 0.15),
                    (MEAT, Paint("#ecd0b8"))[(j + k) % 2],
                )
            )
    return join(strips)


def _fish(w: float, h: float, d: float) -> Mesh:
    scale = Paint("#8fa3ad", "dots", 20.0, shine=0.6)
    body = ball((-w * 0.04, h * 0.55, 0), (w * 0.34, h * 0.42, d * 0.22), scale, 6)
    tail = shift(
        turn(
            prism([(0, 0), (w * 0.16, d * 0.24), (w * 0.13, 0), (w * 0.16, -d * 0.24)][::-1], h * 0.2, scale), "x", 90
        ),
        w * 0.27,
        h * 0.5,
    )
    fin = shift(
        turn(prism([(-w * 0.1, 0), (w * 0.1, 0), (w * 0.06, d * 0.14)], h * 0.12, scale), "x", -90),
        0,
        h * 0.6,
        -d * 0.14,
    )
    return join((body, tail, fin, ball((-w * 0.27, h * 0.72, d * 0.1), h * 0.1, Paint("#1d1e21", shine=0.8), 3)))


def _bird(w: float, h: float, d: float) -> Mesh:
    body = cushion((0, h * 0.5, -d * 0.04), (w * 0.56, h * 0.86, d * 0.66), ROASTED, 0.95, 6)
    drums = [
        rod((s * w * 0.2, h * 0.46, d * 0.1), (s * w * 0.13, h * 0.66, d * 0.4), h * 0.2, ROASTED, h * 0.08, 8)
        + ball((s * w * 0.125, h * 0.68, d * 0.42), h * 0.09, Paint("#f0e6d6"), 3)
        for s in (-1, 1)
    ]
    wings = [
        cushion((s * w * 0.28, h * 0.45, -d * 0.1), (w * 0.1, h * 0.3, d * 0.34), ROASTED, 0.9, 4) for s in (-1, 1)
    ]
    greens = [ball((s * w * 0.34, h * 0.2, d * 0.24), (w * 0.08, h * 0.1, d * 0.08), GREEN, 3) for s in (-1, 1)]
    return join([body, *drums, *wings, *greens])


def pizza(look: Look) -> Mesh:
    """A pizza with salami, olives and basil."""
    w, h, d = look.size
    r = min(w, d) / 2
    base = lathe([(0, 0), (r * 0.95, 0), (r, h * 0.35), (r * 0.93, h * 0.7), (r * 0.86, h * 0.42)], CRUST, 24)
    top = lathe([(r * 0.88, h * 0.44), (0, h * 0.46)], Paint("#e6b04a", "marble", 8.0), 24)
    bits = []
    for k in range(9):
        a, q = k * 2.4, r * (0.25 + 0.5 * ((k * 37) % 10) / 10)
        bits.append(
            cylinder((q * math.cos(a), h * 0.46, q * math.sin(a)), r * 0.13, h * 0.1, Paint("#b03a2c"), sides=12)
        )
        bits.append(
            ball((q * math.cos(a + 1.1), h * 0.5, q * math.sin(a + 1.1)), (r * 0.06, h * 0.12, r * 0.04), GREEN, 2)
        )
    return join([base, top, *bits])


def burger(look: Look) -> Mesh:
    """A hamburger: bun, salad, meat, cheese."""
    w, h, d = look.size
    layers = [
        ([(0, 0), (0.46, 0), (0.48, 0.2), (0, 0.22)], CRUST),
        ([(0, 0.22), (0.5, 0.22), (0.5, 0.36), (0, 0.38)], Paint("#6b3a22", "carpet", 6.0)),
        ([(0, 0.38), (0.48, 0.36), (0.49, 0.42), (0, 0.43)], Paint("#f0c23a")),
        ([(0, 0.43), (0.5, 0.4), (0.49, 0.5), (0, 0.5)], Paint("#6fae46")),
        ([(0, 0.5), (0.48, 0.5), (0.47, 0.68), (0.34, 0.9), (0.15, 0.99), (0, 1.0)], CRUST),
    ]
    return join(stretch(lathe(profile, paint, 18), w, h, d) for profile, paint in layers)


def dish(look: Look) -> Mesh:
    """Food on a dish: rice, noodles, a meal."""
    w, h, d = look.size
    plate = stretch(
        lathe([(0, 0), (0.35, 0), (0.5, h * 0.3), (0.47, h * 0.34), (0.3, 0.01), (0, 0.01)], CERAMIC, 20), x=w, z=d
    )
    if look.kind == "noodles":
        strands = [
            tube(
                [
                    (w * 0.3 * x * 0.9, h * (0.4 + 0.08 * k), d * 0.3 * z * 0.9)
                    for x, _, z in arc((0, 0, 0), 1 - 0.13 * k, 40 * k, 40 * k + 300, "xz", 9)
                ],
                h * 0.07,
                Paint("#ecd592"),
                5,
            )
            for k in range(6)
        ]
        return join(
            [
                plate,
                *strands,
                ball((0, h * 0.85, 0), (w * 0.16, h * 0.14, d * 0.16), Paint("#b03a2c", "carpet", 8.0), 4),
            ]
        )
    heap = ball((-w * 0.08, h * 0.35, 0), (w * 0.26, h * 0.55, d * 0.26), Paint("#f2ead2", "carpet", 8.0), 5)
    sides = ball((w * 0.2, h * 0.35, d * 0.1), (w * 0.14, h * 0.34, d * 0.2), MEAT, 4) + ball(
        (w * 0.12, h * 0.32, -d * 0.24), (w * 0.14, h * 0.3, d * 0.12), GREEN, 4
    )
    return join((plate, heap, sides))


def dough(look: Look) -> Mesh:
    """A lump of dough."""
    w, h, d = look.size
    return cushion((0, h / 2, 0), (w, h, d), Paint("#e6d2a6"), 0.9, 6)


RECIPES = {
    "fruit": Recipe(fruit, (0.08, 0.08, 0.08), kinds=("apple", "orange", "lemon", "onion", "potato")),
    "fruit_bowl": Recipe(fruit_bowl, (0.24, 0.14, 0.24), kinds=("", "vegetable")),
    "banana": Recipe(banana, (0.2, 0.06, 0.14)),
    "carrot": Recipe(carrot, (0.2, 0.04, 0.08)),
    "bread": Recipe(bread, (0.28, 0.12, 0.12)),
    "cake": Recipe(cake, (0.24, 0.14, 0.24)),
    "dessert": Recipe(dessert, (0.12, 0.14, 0.12)),
    "cheese": Recipe(cheese, (0.16, 0.08, 0.12), kinds=("", "butter")),
    "egg": Recipe(egg, (0.26, 0.07, 0.11)),
    "meat": Recipe(meat, (0.28, 0.09, 0.22), kinds=("", "fish", "bird", "bacon")),
    "pizza": Recipe(pizza, (0.3, 0.04, 0.3)),
    "burger": Recipe(burger, (0.12, 0.09, 0.12)),
    "dish": Recipe(dish, (0.22, 0.08, 0.22), kinds=("", "noodles")),
    "dough": Recipe(dough, (0.2, 0.1, 0.16)),
}
