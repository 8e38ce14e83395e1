"""Tables, desks and counters."""

from __future__ import annotations

from hearth.rendering.meshes.joinery import carcass, doors, drawers, feet, legs, round_legs, top_board
from hearth.rendering.meshes.look import Look, Recipe, Region, over, shelves, top
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import DARK, GRANITE, MARBLE, OAK, WHITE_WOOD, WOODS, Paint
from hearth.rendering.meshes.shapes import block, lathe, prism, rod


def table(look: Look) -> Mesh:
    """A dining table: square legs and apron, or a round pedestal where it is as wide as deep."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    if look.variant % 2 and abs(w - d) < 0.15 * w:
        return _pedestal(w, h, d, wood)
    board = block(-w / 2, w / 2, h - 0.035, h, -d / 2, d / 2, wood)
    apron = join(
        block(*ends, h - 0.12, h - 0.035, *sides, wood)
        for ends, sides in (
            ((-w / 2 + 0.08, w / 2 - 0.08), (-d / 2 + 0.05, -d / 2 + 0.07)),
            ((-w / 2 + 0.08, w / 2 - 0.08), (d / 2 - 0.07, d / 2 - 0.05)),
            ((-w / 2 + 0.05, -w / 2 + 0.07), (-d / 2 + 0.08, d / 2 - 0.08)),
            ((w / 2 - 0.07, w / 2 - 0.05), (-d / 2 + 0.08, d / 2 - 0.08)),
        )
    )
    under = (
        round_legs(w - 0.06, d - 0.06, h - 0.03, 0.03, wood)
        if look.variant % 2
        else legs(w, d, h - 0.03, 0.07, wood, 0.02)
    )
    return join((board, apron, under))


def _pedestal(w: float, h: float, d: float, wood: Paint) -> Mesh:
    r = w / 2
    profile = [(0, 0), (r * 0.55, 0), (r * 0.55, 0.03), (0.09, 0.08), (0.05, 0.2), (0.05, h - 0.12), (0.16, h - 0.04),
               (r * 0.97, h - 0.04), (r, h - 0.03), (r, h - 0.005), (r * 0.995, h), (0, h)]  # fmt: skip
    return stretch(lathe(profile, wood, 28), z=d / w)


def coffee_table(look: Look) -> Mesh:
    """A low table with a shelf under its top."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    board = block(-w / 2, w / 2, h - 0.04, h, -d / 2, d / 2, wood)
    shelf = block(-w / 2 + 0.05, w / 2 - 0.05, 0.12, 0.14, -d / 2 + 0.05, d / 2 - 0.05, wood)
    return join((board, shelf, legs(w, d, h - 0.04, 0.06, wood)))


def desk(look: Look) -> Mesh:
    """A writing desk with drawers on its right; sitting side at +z."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    board = block(-w / 2, w / 2, h - 0.035, h, -d / 2, d / 2, wood)
    panel = block(-w / 2, -w / 2 + 0.035, 0, h - 0.035, -d / 2, d / 2, wood)
    back = block(-w / 2 + 0.035, w / 2 - 0.4, h - 0.4, h - 0.035, -d / 2 + 0.03, -d / 2 + 0.05, wood)
    width = min(0.42, w * 0.35)
    chest = carcass(width, h - 0.035, d, wood, shelves=3) + drawers(
        width - 0.02, 0.06, h - 0.05, d, 3, wood, look.open, DARK
    )
    return join((board, panel, back, shift(chest, w / 2 - width / 2)))


def nightstand(look: Look) -> Mesh:
    """A bedside table: two drawers, or one over an open shelf."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    shell = shift(carcass(w, h - 0.08, d, wood, shelves=2), y=0.06) + block(
        -w / 2, w / 2, h - 0.025, h, -d / 2, d / 2, wood
    )
    low = h / 2 + 0.03 if look.variant % 2 else 0.07
    fronts = drawers(w - 0.02, low, h - 0.035, d, 1 if look.variant % 2 else 2, wood, look.open, DARK)
    return join((shell, fronts, legs(w, d, 0.06, 0.04, wood)))


def counter(look: Look) -> Mesh:
    """A worktop over cupboards, with a hole where a sink is sunk in."""
    w, h, d = look.size
    stone = look.pick((GRANITE, MARBLE, OAK), "stone")
    body = look.pick(
        (WHITE_WOOD, WHITE_WOOD.tinted("#9fb0b3"), WHITE_WOOD.tinted("#b9c2a8"), WHITE_WOOD.tinted("#d9d3c6")), "front"
    ).tinted(look.color)
    depth = d - 0.03
    inside = shift(carcass(w, h - 0.14, depth, body, shelves=2), y=0.1)
    count = max(1, round(w / 0.5))
    lower = h - 0.2 if look.variant % 2 else h - 0.04
    fronts = doors(w, 0.1, lower, depth / 2 + 0.004, count, body, look.open)
    if look.variant % 2:
        fronts += drawers(w, lower, h - 0.04, depth + 0.008, 1, body, False)
    shell = shift(join((inside, fronts, feet(w, depth, 0.1, DARK))), z=-0.015)
    if look.hole:
        shell = shift(join((_gutted(w, h, depth, body), fronts, feet(w, depth, 0.1, DARK))), z=-0.015)
    return shell + top_board(w, d, h - 0.04, h, stone, look.hole)


def _gutted(w: float, h: float, d: float, body: Paint) -> Mesh:
    """A carcass without its top, where a basin hangs in it."""
    x, z = w / 2, d / 2
    return join((
        block(-x, -x + 0.02, 0.1, h - 0.04, -z, z, body),
        block(x - 0.02, x, 0.1, h - 0.04, -z, z, body),
        block(-x + 0.02, x - 0.02, 0.1, 0.12, -z, z, body),
        block(-x + 0.02, x - 0.02, 0.12, h - 0.04, -z, -z + 0.01, body),
    ))  # fmt: skip


def tv_stand(look: Look) -> Mesh:
    """A low board with open compartments and doors at its ends."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    shell = shift(carcass(w, h - 0.06, d, wood, shelves=2), y=0.06)
    walls = [block(s * w / 5 - 0.01, s * w / 5 + 0.01, 0.06, h, -d / 2, d / 2 - 0.01, wood) for s in (-1, 1)]
    width = w * 0.3
    sides = [
        shift(doors(width, 0.07, h - 0.01, d / 2 + 0.003, 1, WHITE_WOOD, look.open), s * (w / 2 - width / 2))
        for s in (-1, 1)
    ]
    return join([shell, *walls, *sides, legs(w, d, 0.06, 0.05, wood, 0.02)])


def ironing_board(look: Look) -> Mesh:
    """A padded board, pointed at one end, on crossed legs."""
    w, h, d = look.size
    tip = w * 0.3
    outline = [
        (-w / 2, -d / 2),
        (w / 2 - tip, -d / 2),
        (w / 2 - 0.05, -d * 0.16),
        (w / 2, 0),
        (w / 2 - 0.05, d * 0.16),
        (w / 2 - tip, d / 2),
        (-w / 2, d / 2),
    ]
    cover = Paint(look.color or look.pick(("#7fa3c4", "#c58f8f", "#9fb58a"), "cover"), "checks", 6.0)
    board = shift(turn(prism(outline, 0.035, cover), "x", -90), y=h - 0.018)
    z = d * 0.3
    sticks = [rod((-w * 0.32, 0.01, s * z), (w * 0.22, h - 0.04, s * z), 0.012, DARK, sides=6) for s in (-1, 1)]
    sticks += [
        rod((w * 0.32, 0.01, s * z * 0.8), (-w * 0.22, h - 0.04, s * z * 0.8), 0.012, DARK, sides=6) for s in (-1, 1)
    ]
    bars = [rod((x, 0.012, -z), (x, 0.012, z), 0.012, DARK, sides=6) for x in (-w * 0.32, w * 0.32)]
    return join([board, *sticks, *bars])


def counter_inside(look: Look) -> tuple[Region, ...]:
    """Two shelves behind the doors."""
    return shelves(look, 2, 0.13, 0.06)


def drawer_inside(look: Look) -> tuple[Region, ...]:
    """Where the upper drawer stands when it is open."""
    _, h, d = look.size
    return (over(look, h * 0.7, 0.06)._replace(z0=d * 0.1, z1=d * 0.5, clear=0.1), *shelves(look, 2, 0.08, 0.06))


RECIPES = {
    "table": Recipe(table, (1.4, 0.75, 0.85), 2),
    "coffee_table": Recipe(coffee_table, (1.1, 0.42, 0.6), 1),
    "desk": Recipe(desk, (1.3, 0.75, 0.65), 1, top, drawer_inside, states=("OPEN",)),
    "nightstand": Recipe(nightstand, (0.45, 0.5, 0.4), 2, top, drawer_inside, states=("OPEN",)),
    "counter": Recipe(counter, (1.2, 0.88, 0.6), 2, top, counter_inside, states=("OPEN",)),
    "tv_stand": Recipe(tv_stand, (1.5, 0.5, 0.42), 1, top, counter_inside, states=("OPEN",)),
    "ironing_board": Recipe(ironing_board, (1.25, 0.9, 0.36)),
}
