"""Cutlery, boards, trays and racks of a kitchen."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe, Region, over
from hearth.rendering.meshes.mesh import Mesh, join, shift, turn
from hearth.rendering.meshes.paint import (
    BLACK,
    CERAMIC,
    DARK,
    GREY,
    OAK,
    STEEL,
    WALNUT,
    Paint,
)
from hearth.rendering.meshes.shapes import block, box, cushion, cylinder, panel, prism, rod


def knife(look: Look) -> Mesh:
    """A knife lying along z, its blade towards -z."""
    w, h, d = look.size
    blade = shift(
        turn(
            prism([(-w / 2, 0), (w / 2, 0), (w / 2, d * 0.5), (0, d * 0.62), (-w / 2, d * 0.5)], h * 0.3, STEEL),
            "x",
            -90,
        ),
        y=h / 2,
        z=d * 0.12,
    )
    return blade + cushion((0, h / 2, d * 0.31), (w * 0.8, h, d * 0.38), DARK, 0.6, 3)


def fork(look: Look) -> Mesh:
    """A fork lying along z."""
    w, h, d = look.size
    stem = box((0, h * 0.4, d * 0.14), (w * 0.34, h * 0.4, d * 0.7), STEEL)
    root = box((0, h * 0.5, -d * 0.24), (w, h * 0.4, d * 0.1), STEEL)
    tines = [box((x * w * 0.36, h * 0.55, -d * 0.39), (w * 0.16, h * 0.4, d * 0.22), STEEL) for x in (-1, 0, 1)]
    return join([stem, root, *tines])


def spoon(look: Look) -> Mesh:
    """A spoon lying along z, of steel or wood."""
    w, h, d = look.size
    paint = OAK if look.kind == "wood" else STEEL
    stem = rod((0, h * 0.4, d / 2), (0, h * 0.4, -d * 0.2), w * 0.16, paint, w * 0.12, 6)
    return stem + cushion((0, h * 0.5, -d * 0.33), (w, h * 0.8, d * 0.32), paint, 1.0, 4)


def cutting_board(look: Look) -> Mesh:
    """A board with a handle hole."""
    w, h, d = look.size
    return cushion((0, h / 2, 0), (w, h, d), look.paint((OAK, WALNUT)), 0.5, 3) + panel(
        (w * 0.42, h + 0.001, 0), w * 0.05, d * 0.3, DARK, "+y"
    )


def tray(look: Look) -> Mesh:
    """A tray with a raised edge and two grips."""
    w, h, d = look.size
    paint = look.tint(Paint("#ffffff", "wood", 1.3, shine=0.2), ("#8a5a33", "#b9bcc0", "#3b5f6b"))
    edge = [
        block(-w / 2, w / 2, 0, h, s * (d / 2) - (0.01 if s > 0 else 0), s * (d / 2) + (0.01 if s < 0 else 0), paint)
        for s in (-1, 1)
    ]
    edge += [
        block(s * w / 2 - (0.012 if s > 0 else 0), s * w / 2 + (0.012 if s < 0 else 0), 0, h, -d / 2, d / 2, paint)
        for s in (-1, 1)
    ]
    return join([block(-w / 2, w / 2, 0, h * 0.3, -d / 2, d / 2, paint), *edge])


def dish_rack(look: Look) -> Mesh:
    """A wire rack with plates standing in it."""
    w, h, d = look.size
    base = block(-w / 2, w / 2, 0, 0.02, -d / 2, d / 2, GREY)
    wires = [
        rod(
            (-w / 2 + 0.03 + k * (w - 0.06) / 9, 0.02, z),
            (-w / 2 + 0.03 + k * (w - 0.06) / 9, h, z),
            0.003,
            STEEL,
            sides=5,
        )
        for k in range(10)
        for z in (-d * 0.3, d * 0.3)
    ]
    rails = [rod((-w / 2, h, z), (w / 2, h, z), 0.004, STEEL, sides=5) for z in (-d * 0.3, d * 0.3)]
    r = min(h * 1.2, d * 0.4)
    dishes = (
        [
            shift(
                turn(cylinder((0, 0, 0), r * 0.8, 0.012, CERAMIC), "z", 80), -w * 0.3 + k * w * 0.1, 0.02 + r * 0.55, 0
            )
            for k in range(3)
        ]
        if h > 0.1
        else []
    )
    return join([base, *wires, *rails, *dishes])


def knife_block(look: Look) -> Mesh:
    """A slanted block with knife handles."""
    w, h, d = look.size
    block_ = turn(
        prism([(-d / 2, 0), (d / 2, 0), (d * 0.1, h * 0.7), (-d / 2, h * 0.55)], w, look.paint((OAK, WALNUT))), "y", 90
    )
    grips = [
        rod((x * w, h * 0.6, d * (0.12 + 0.14 * k)), (x * w, h * 0.97, d * (0.28 + 0.1 * k)), 0.009, BLACK, sides=6)
        for x in (-0.25, 0.05, 0.3)
        for k in (-1, 0)
    ]
    return join([block_, *grips])


def rack_places(look: Look) -> tuple[Region, ...]:
    """Between the wires."""
    return (over(look, 0.022, 0.04),)


RECIPES = {
    "knife": Recipe(knife, (0.03, 0.015, 0.24)),
    "fork": Recipe(fork, (0.028, 0.015, 0.2)),
    "spoon": Recipe(spoon, (0.04, 0.015, 0.2), kinds=("", "wood")),
    "cutting_board": Recipe(cutting_board, (0.36, 0.02, 0.26)),
    "tray": Recipe(tray, (0.42, 0.035, 0.3)),
    "dish_rack": Recipe(dish_rack, (0.45, 0.2, 0.34), 1, rack_places, rack_places),
    "knife_block": Recipe(knife_block, (0.12, 0.24, 0.18)),
}
