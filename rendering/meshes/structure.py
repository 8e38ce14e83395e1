"""Walls, floors, ceilings, windows and doors."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe, nowhere, top
from hearth.rendering.meshes.mesh import Mesh, join, turn
from hearth.rendering.meshes.paint import BRASS, SOFT_COLORS, WHITE_WOOD, Paint
from hearth.rendering.meshes.shapes import ball, block, panel, rod

FLOORS = {
    "bathroom": Paint("#c9d2d6", "tiles_small", 1.2, shine=0.35),
    "kitchen": Paint("#d6d0c4", "tiles", 1.1, shine=0.35),
    "bedroom": Paint("#c4b59e", "carpet", 2.0),
    "kids_bedroom": Paint("#b7c4cf", "carpet", 2.0),
    "entrance_hall": Paint("#b9a88e", "tiles", 1.1, shine=0.3),
}
PLANKS = Paint("#b88a58", "planks", 0.55, shine=0.2)
WALLS = ("#ece7dd", "#e3e7e6", "#ece2d6", "#dfe6df", "#e6e1ea", "#e9e4d4")
CEILING = Paint("#f1efea")


def floor(look: Look) -> Mesh:
    """Flooring by the room (`kind`)."""
    w, h, d = look.size
    paint = FLOORS.get(look.kind, PLANKS.tinted(look.pick(("#b88a58", "#a5764a", "#c79f6e", "#8f6340"), "planks")))
    return block(-w / 2, w / 2, 0, h, -d / 2, d / 2, paint)


def wall(look: Look) -> Mesh:
    """Plaster in the room's colour with a skirting board; tiled low in a bathroom. Its inner face is +z."""
    w, h, d = look.size
    paint = Paint(look.color or look.pick(WALLS, "wall"), "plaster", 0.5)
    if look.kind == "bathroom":
        paint = Paint(look.pick(("#dbe6e8", "#e6e2d8", "#d6e2da"), "tiles"), "tiles_small", 0.8, shine=0.35)
    return block(-w / 2, w / 2, 0, h, -d / 2, d / 2, paint)


def ceiling(look: Look) -> Mesh:
    """A white slab."""
    w, h, d = look.size
    return block(-w / 2, w / 2, 0, h, -d / 2, d / 2, CEILING)


def window(look: Look) -> Mesh:
    """A frame with a cross of bars and a sill; the glass itself lets light through and is not drawn."""
    w, h, d = look.size
    f = min(0.06, w * 0.1)
    paint = WHITE_WOOD
    t = d * 0.5
    frame = [
        block(-w / 2, w / 2, 0, f, -t / 2, t / 2, paint),
        block(-w / 2, w / 2, h - f, h, -t / 2, t / 2, paint),
        block(-w / 2, -w / 2 + f, f, h - f, -t / 2, t / 2, paint),
        block(w / 2 - f, w / 2, f, h - f, -t / 2, t / 2, paint),
    ]
    sill = block(-w / 2, w / 2, 0, 0.025, -d / 2, d / 2 + 0.06, paint)
    bars = [block(-0.018, 0.018, f, h - f, -t / 3, t / 3, paint)] if w > 0.7 else []
    return join([*frame, sill, *bars])


def door(look: Look) -> Mesh:
    """A door leaf with two panels and handles on both sides."""
    w, h, d = look.size
    wide = w >= d
    a, t = (w, d) if wide else (d, w)
    paint = look.pick(
        (WHITE_WOOD, WHITE_WOOD.tinted("#d9cdb8"), Paint("#b98a58", "wood", 1.0, shine=0.15)), "leaf"
    ).tinted(look.color)
    leaf = block(-a / 2, a / 2, 0, h, -t / 2, t / 2, paint)
    deep = paint.tinted("#cfc6b6") if paint.color == WHITE_WOOD.color else paint
    fields = [
        panel((0, y * h, s * (t / 2 + 0.001)), a * 0.62, k * h, deep, "+z" if s > 0 else "-z")
        for y, k in ((0.28, 0.34), (0.72, 0.38))
        for s in (-1, 1)
    ]
    handles = [
        join(
            (
                ball((a * 0.42, h * 0.5, s * (t / 2 + 0.03)), 0.022, BRASS, 3),
                rod(
                    (a * 0.42, h * 0.5, s * (t / 2 + 0.035)),
                    (a * 0.32, h * 0.5, s * (t / 2 + 0.035)),
                    0.011,
                    BRASS,
                    sides=6,
                ),
            )
        )
        for s in (-1, 1)
    ]
    whole = join([leaf, *fields, *handles])
    if wide:
        return whole
    return turn(whole, "y", 90)


def jamb(look: Look) -> Mesh:
    """A door frame: two posts and a lintel, a little wider than the wall."""
    w, h, d = look.size
    post, extra = 0.05, 0.015
    z = d / 2 + extra
    return join((
        block(-w / 2, -w / 2 + post, 0, h, -z, z, WHITE_WOOD),
        block(w / 2 - post, w / 2, 0, h, -z, z, WHITE_WOOD),
        block(-w / 2 + post, w / 2 - post, h - post, h, -z, z, WHITE_WOOD),
        block(-w / 2 + post, w / 2 - post, -0.004, 0.004, -d / 2, d / 2, Paint("#8f6340", "wood", 1.0)),
    ))  # fmt: skip


def tablecloth(look: Look) -> Mesh:
    """A cloth hanging a little over the sides of what it lies on."""
    w, h, d = look.size
    return block(-w / 2, w / 2, 0, h, -d / 2, d / 2, look.tint(Paint("#ffffff", "checks", 4.0), SOFT_COLORS))


RECIPES = {
    "floor": Recipe(floor, (2.5, 0.1, 2.5), 1, top),
    "wall": Recipe(wall, (2.5, 2.5, 0.06), 1, nowhere),
    "ceiling": Recipe(ceiling, (2.5, 0.1, 2.5), 1, nowhere),
    "window": Recipe(window, (1.2, 1.2, 0.12), 1, nowhere),
    "door": Recipe(door, (0.9, 2.0, 0.045), 1, nowhere),
    "doorjamb": Recipe(jamb, (0.9, 2.05, 0.12), 1, nowhere),
    "tablecloth": Recipe(tablecloth, (0.5, 0.004, 0.4), 1, top),
}
