"""What one cleans with."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import BRIGHT_COLORS, DARK, OAK, SOFT_COLORS, STEEL, Paint
from hearth.rendering.meshes.shapes import arc, block, box, cushion, cylinder, lathe, prism, rod, tube
from hearth.rendering.meshes.storage import bottom

STRAW = Paint("#d8b45a", "wood", 8.0)


def broom(look: Look) -> Mesh:
    """A broom standing on its bristles; a mop with strings by kind."""
    w, h, d = look.size
    stick = rod((0, 0.22, 0), (0, h, 0), 0.013, OAK if look.kind == "" else STEEL, sides=8)
    if look.kind == "mop":
        strings = [
            rod((0, 0.24, 0), (w * 0.46 * x, 0.01, d * 0.46 * z), 0.012, Paint("#e6e0d0", "fabric", 8.0), 0.016, 6)
            for x, z in (
                (-1, -0.6),
                (-0.6, 0.9),
                (-0.25, -0.9),
                (0, 0.6),
                (0.3, -0.7),
                (0.6, 0.9),
                (1, -0.4),
                (0.8, 0.3),
                (-0.85, 0.3),
            )
        ]
        return join([stick, cylinder((0, 0.21, 0), 0.03, 0.06, look.tint(DARK, BRIGHT_COLORS)), *strings])
    head = box((0, 0.2, 0), (w * 0.8, 0.06, d * 0.8), look.tint(Paint(), BRIGHT_COLORS))
    bristle = stretch(turn(lathe([(0.71, 0.0), (0.55, 0.17)], STRAW, 4), "y", 45), w, 1, d)
    return join((stick, head, bristle))


def bucket(look: Look) -> Mesh:
    """A bucket with its handle up, some with water."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.4), ("#3f77b5", "#c8463c", "#4f9a5c"))
    top_ = h * 0.72
    body = stretch(
        lathe(
            [(0, 0), (0.38, 0), (0.38, 0), (0.48, top_), (0.5, top_), (0.46, top_), (0.36, 0.02), (0, 0.02)], paint, 20
        ),
        x=w,
        z=d,
    )
    water = shift(
        stretch(lathe([(0.45, 0), (0, 0.001)], Paint("#8fc0d6", "water", 3.0, shine=0.9), 18), x=w, z=d), y=top_ * 0.75
    )
    bow = [(x, top_ + (y - 0) * (h - top_ - 0.008) / (w * 0.47), 0.0) for x, y, _ in arc((0, 0, 0), w * 0.47, 0, 180)]
    return join((body, water, tube(bow, 0.006, STEEL, 6)))


def duster(look: Look) -> Mesh:
    """A feather duster lying along z."""
    w, h, d = look.size
    stick = rod((0, h * 0.5, d / 2), (0, h * 0.5, -d * 0.05), 0.009, DARK, sides=6)
    paint = look.tint(Paint("#ffffff", "carpet", 6.0), ("#e0a83a", "#d2678f", "#3f77b5", "#8b5fa8"))
    tufts = [
        cushion((0, h * 0.5, -d * (0.1 + 0.13 * k)), (w * (1 - 0.12 * k), h * (1 - 0.1 * k), d * 0.2), paint, 1.0, 4)
        for k in range(3)
    ]
    return join([stick, *tufts])


def dustpan(look: Look) -> Mesh:
    """A dustpan with its mouth towards +z, and its brush lying in it."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.3), BRIGHT_COLORS)
    back, front, thin = -d * 0.12, d / 2, 0.006
    outline = [(back, 0), (front, 0), (front, thin * 2), (back + d * 0.2, h * 0.55), (back, h * 0.6)]
    wall = turn(prism(outline, thin, paint), "y", -90)
    sides = [shift(wall, x=s * (w / 2 - thin / 2)) for s in (-1, 1)]
    pan = block(-w / 2, w / 2, 0, thin, back, front, paint) + block(-w / 2, w / 2, 0, h * 0.6, back, back + thin, paint)
    grip = rod((0, h * 0.4, back), (0, h * 0.6, -d / 2 + 0.012), 0.012, paint, sides=8)
    wood = block(-w * 0.36, w * 0.36, h * 0.45, h * 0.7, d * 0.12, d * 0.2, OAK)
    hair = block(-w * 0.34, w * 0.34, thin, h * 0.45, d * 0.11, d * 0.23, Paint("#2f2f33", "carpet", 20.0))
    return join([pan, *sides, grip, wood, hair])


def sponge(look: Look) -> Mesh:
    """A sponge with a scouring side."""
    w, h, d = look.size
    return cushion(
        (0, h * 0.36, 0),
        (w, h * 0.72, d),
        look.tint(Paint("#ffffff", "carpet", 6.0), ("#efd04a", "#f0b84a", "#e79ab0")),
        0.3,
        3,
    ) + block(-w * 0.48, w * 0.48, h * 0.72, h, -d * 0.48, d * 0.48, Paint("#3f7a4a", "carpet", 6.0))


def cloth(look: Look) -> Mesh:
    """A cloth lying in loose folds: rag, napkin, table cloth."""
    w, h, d = look.size
    paint = look.tint(
        Paint("#ffffff", look.pick(("checks", "stripes", "fabric"), "weave"), 12.0),
        (*SOFT_COLORS, "#d8837a", "#7fa3b8"),
    )
    base = cushion((0, h * 0.25, 0), (w, h * 0.5, d), paint, 0.6, 4)
    folds = [
        turn(cushion((x * w, h * 0.55, z * d), (w * 0.5, h * 0.85, d * 0.16), paint, 0.9, 4), "y", a, (x * w, 0, z * d))
        for x, z, a in ((-0.1, -0.12, 25), (0.1, 0.2, -15))
    ]
    return join([base, *folds]) if h > 0.008 else block(-w / 2, w / 2, 0, h, -d / 2, d / 2, paint)


def drying_rack(look: Look) -> Mesh:
    """A folding rack with bars and a few hung clothes."""
    w, h, d = look.size
    legs_ = [
        rod((x, 0, -d / 2), (x, h, d / 2), 0.01, STEEL, sides=6)
        + rod((x, 0, d / 2), (x, h, -d / 2), 0.01, STEEL, sides=6)
        for x in (-w / 2 + 0.01, w / 2 - 0.01)
    ]
    bars = [
        rod((-w / 2, y, z), (w / 2, y, z), 0.006, STEEL, sides=6)
        for y, z in ((h - 0.01, -d / 2), (h - 0.01, 0), (h - 0.01, d / 2), (h * 0.75, -d / 4), (h * 0.75, d / 4))
    ]
    hung = [
        block(
            x * w,
            x * w + 0.26,
            h * 0.55,
            h,
            z - 0.006,
            z + 0.006,
            Paint(look.pick(BRIGHT_COLORS + SOFT_COLORS, f"hung{k}"), "fabric", 4.0),
        )
        for k, (x, z) in enumerate(((-0.4, -d / 2), (0.05, d / 2), (-0.1, 0)))
    ]
    return join([*legs_, *bars, *hung])


def dirt(look: Look) -> Mesh:
    """A patch of dirt."""
    w, h, d = look.size
    return stretch(lathe([(0.5, 0.0), (0.4, 1.0), (0, 1.0)], Paint("#6b5336", "carpet", 6.0), 9), w, min(h, 0.02), d)


RECIPES = {
    "broom": Recipe(broom, (0.32, 1.3, 0.1), kinds=("", "mop")),
    "bucket": Recipe(bucket, (0.32, 0.4, 0.3), inside=bottom),
    "duster": Recipe(duster, (0.1, 0.09, 0.42)),
    "dustpan": Recipe(dustpan, (0.24, 0.1, 0.34)),
    "sponge": Recipe(sponge, (0.12, 0.05, 0.08)),
    "cloth": Recipe(cloth, (0.24, 0.04, 0.24)),
    "drying_rack": Recipe(drying_rack, (1.1, 1.0, 0.5)),
    "dirt": Recipe(dirt, (0.3, 0.02, 0.3)),
}
