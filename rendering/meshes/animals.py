"""Pets, and what is alive but small."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, stretch, turn
from hearth.rendering.meshes.paint import BLACK, Paint
from hearth.rendering.meshes.shapes import ball, cushion, rod, tube

FURS = {"cat": ("#8a8a8a", "#c98a4a", "#3a3a40", "#e4d8c4"), "dog": ("#8a5a33", "#c9a06a", "#4a3a30", "#e0d2b8")}


def beast(look: Look) -> Mesh:
    """A cat or dog standing, looking along +z."""
    w, h, d = look.size
    fur = look.tint(Paint("#ffffff", "carpet", 5.0), FURS.get(look.kind, FURS["cat"]))
    dog = look.kind == "dog"
    back, girth = h * 0.62, min(w * 0.42, h * 0.2)
    body = cushion((0, back, -d * 0.06), (girth * 2, girth * 2, d * 0.56), fur, 0.95)
    head_y, head_z, r = h * 0.82, d * 0.3, min(w * 0.36, h * 0.17)
    head = ball((0, head_y, head_z), (r, r * 0.95, r), fur)
    muzzle = ball(
        (0, head_y - r * 0.3, head_z + r * (1.1 if dog else 0.8)),
        (r * 0.5, r * 0.4, r * (0.8 if dog else 0.45)),
        Paint("#e8dcc8"),
    )
    nose = ball((0, head_y - r * 0.15, head_z + r * (1.8 if dog else 1.2)), r * 0.16, BLACK, 3)
    neck = rod((0, back + girth * 0.4, d * 0.14), (0, head_y - r * 0.3, head_z), girth * 0.8, fur, r * 0.7, 8)
    eyes = [ball((s * r * 0.42, head_y + r * 0.2, head_z + r * 0.85), r * 0.15, BLACK, 3) for s in (-1, 1)]
    ears = [
        cushion((s * r * 0.95, head_y + r * 0.1, head_z), (r * 0.4, r * 1.2, r * 0.7), fur, 0.9, 4)
        if dog
        else rod(
            (s * r * 0.6, head_y + r * 0.5, head_z), (s * r * 0.75, head_y + r * 1.4, head_z), r * 0.4, fur, 0.003, 6
        )
        for s in (-1, 1)
    ]
    legs = [
        rod((s * girth * 0.6, 0, z), (s * girth * 0.6, back, z), girth * 0.28, fur, girth * 0.4, 8)
        for s in (-1, 1)
        for z in (d * 0.12, -d * 0.26)
    ]
    tail = tube(
        [(0, back + girth * 0.5, -d * 0.32), (0, back + girth, -d * 0.4), (0, h * 0.95, -d * 0.44)], girth * 0.2, fur, 6
    )
    return join([body, head, muzzle, nose, neck, *eyes, *ears, *legs, tail])


def bird(look: Look) -> Mesh:
    """A small bird, or an insect where it is tiny."""
    w, h, d = look.size
    coat = look.tint(Paint(), ("#e0b83a", "#4fa3d8", "#6fb85c"))
    parts = [
        cushion((0, 0.52, -0.05), (0.55, 0.55, 0.7), coat, 1.0),
        ball((0, 0.8, 0.2), 0.2, coat, 4),
        rod((0, 0.8, 0.36), (0, 0.78, 0.5), 0.06, Paint("#e08a2a"), 0.01, 6),
        turn(cushion((0, 0.5, -0.4), (0.25, 0.06, 0.4), coat, 0.8, 4), "x", 20, (0, 0.5, -0.3)),
        *(cushion((s * 0.28, 0.55, -0.08), (0.1, 0.34, 0.5), coat.tinted("#3a4a5a"), 1.0, 4) for s in (-1, 1)),
        *(rod((s * 0.1, 0, 0), (s * 0.1, 0.3, 0), 0.02, Paint("#e08a2a"), sides=5) for s in (-1, 1)),
        *(ball((s * 0.13, 0.85, 0.33), 0.03, BLACK, 2) for s in (-1, 1)),
    ]
    return stretch(join(parts), w, h, d)


RECIPES = {
    "beast": Recipe(beast, (0.24, 0.36, 0.5), kinds=("cat", "dog")),
    "bird": Recipe(bird, (0.1, 0.14, 0.16)),
}
