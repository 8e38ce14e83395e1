"""Things to sit and lie on."""

from __future__ import annotations

from hearth.rendering.meshes.joinery import legs, round_legs
from hearth.rendering.meshes.look import Look, Recipe, Region, over
from hearth.rendering.meshes.mesh import Mesh, join, shift, turn
from hearth.rendering.meshes.paint import (
    CHROME,
    DARK,
    FABRIC_COLORS,
    LEATHER,
    LINEN,
    WOODS,
    Paint,
)
from hearth.rendering.meshes.shapes import block, box, cushion, cylinder, rod

FABRIC = Paint("#8797a8", "fabric", 4.0)


def chair(look: Look) -> Mesh:
    """A dining chair with slats, an upholstered one, or an office chair."""
    return (_slat_chair, _padded_chair, _office_chair)[look.variant % 3](look)


def _slat_chair(look: Look) -> Mesh:
    w, h, d = look.size
    seat, wood = look.seat(0.46, 0.7), look.paint(WOODS)
    t = 0.04
    back = -d / 2 + t / 2
    posts = [box((s * (w / 2 - t / 2), h / 2, back), (t, h, t), wood) for s in (-1, 1)]
    front = [box((s * (w / 2 - t / 2), (seat - 0.03) / 2, d / 2 - t / 2), (t, seat - 0.03, t), wood) for s in (-1, 1)]
    rungs = [block(-w / 2 + t, w / 2 - t, y, y + 0.05, back - 0.01, back + 0.01, wood) for y in (h - 0.07, seat + 0.12)]
    slats = [
        box((x * w, (seat + 0.12 + h - 0.05) / 2, back), (0.03, h - seat - 0.2, 0.014), wood)
        for x in (-0.25, -0.08, 0.08, 0.25)
    ]
    rails = [
        block(s * (w / 2 - t * 0.7) - 0.01, s * (w / 2 - t * 0.7) + 0.01, 0.18, 0.21, -d / 2, d / 2, wood)
        for s in (-1, 1)
    ]
    board = block(-w / 2, w / 2, seat - 0.03, seat - 0.01, -d / 2 + t, d / 2, wood)
    pad = cushion((0, seat - 0.012, t / 2), (w * 0.86, 0.03, d * 0.82), look.tint(FABRIC, FABRIC_COLORS), 0.9)
    return join([*posts, *front, *rungs, *slats, *rails, board, pad])


def _padded_chair(look: Look) -> Mesh:
    w, h, d = look.size
    seat, cloth, wood = look.seat(0.46, 0.7), look.tint(FABRIC, FABRIC_COLORS), look.pick(WOODS, "wood")
    pad = cushion((0, seat - 0.05, 0), (w, 0.1, d), cloth, 0.6)
    back = cushion((0, (seat + h) / 2, -d / 2 + 0.05), (w * 0.96, h - seat, 0.09), cloth, 0.7)
    return join((round_legs(w, d, seat - 0.08, 0.025, wood), pad, back))


def _office_chair(look: Look) -> Mesh:
    w, h, d = look.size
    seat, cloth = look.seat(0.46, 0.7), look.tint(FABRIC, ("#33363d", "#3f77b5", "#8a5a5a", "#4d6b70"))
    r = min(w, d) / 2 - 0.03
    star = []
    for k in range(5):
        arm = rod((0, 0.1, 0), (0, 0.055, r), 0.018, CHROME, sides=6) + cushion(
            (0, 0.028, r), (0.05, 0.056, 0.05), DARK, 1.0, 3
        )
        star.append(turn(arm, "y", 72 * k))
    column = cylinder((0, 0.08, 0), 0.025, seat - 0.14, CHROME)
    pad = cushion((0, seat - 0.045, 0.02), (w * 0.92, 0.09, d * 0.84), cloth, 0.8)
    post = block(-0.03, 0.03, seat - 0.06, seat + 0.2, -d / 2 + 0.01, -d / 2 + 0.03, DARK)
    back = cushion((0, (seat + 0.12 + h) / 2, -d / 2 + 0.06), (w * 0.84, h - seat - 0.12, 0.08), cloth, 0.8)
    arms = [cushion((s * (w / 2 - 0.03), seat + 0.18, 0.02), (0.05, 0.03, d * 0.5), DARK, 0.8, 3) for s in (-1, 1)]
    stays = [
        block(s * (w / 2 - 0.03) - 0.012, s * (w / 2 - 0.03) + 0.012, seat - 0.05, seat + 0.17, 0, 0.04, DARK)
        for s in (-1, 1)
    ]
    return join([*star, column, pad, post, back, *arms, *stays])


def sofa(look: Look) -> Mesh:
    """A couch for as many as its width holds: fabric with scatter cushions, or leather on legs."""
    w, h, d = look.size
    seat = look.seat(0.44, 0.6)
    leather = look.variant % 2 == 1
    cloth = (
        LEATHER.tinted(look.color or look.pick(("#5b3a29", "#3a3330", "#8a6a4a"), "hide"))
        if leather
        else look.tint(FABRIC, FABRIC_COLORS)
    )
    arm, back, foot = min(0.18, w * 0.12), min(0.24, d * 0.28), 0.1 if leather else 0.05
    places = max(1, round((w - 2 * arm) / 0.65))
    step = (w - 2 * arm) / places
    base = cushion((0, (foot + seat - 0.12) / 2, back / 2), (w - 2 * arm, seat - 0.12 - foot, d - back), cloth, 0.1, 3)
    rear = cushion((0, (foot + h) / 2, -d / 2 + back / 2), (w - arm, h - foot, back), cloth, 0.5)
    arms = [
        cushion((s * (w - arm) / 2, (foot + seat + 0.18) / 2, 0), (arm, seat + 0.18 - foot, d), cloth, 0.55)
        for s in (-1, 1)
    ]
    pads = [
        cushion((-w / 2 + arm + step * (k + 0.5), seat - 0.07, back / 2), (step - 0.01, 0.14, d - back), cloth, 0.5)
        for k in range(places)
    ]
    rests = [
        turn(
            cushion(
                (-w / 2 + arm + step * (k + 0.5), (seat + h) / 2, -d / 2 + back + 0.06),
                (step - 0.02, h - seat - 0.02, 0.15),
                cloth,
                0.8,
            ),
            "x",
            -6,
            (0, seat, -d / 2 + back),
        )
        for k in range(places)
    ]
    feet = legs(w, d, foot, 0.05, look.pick(WOODS, "wood"), 0.04)
    extra = [] if leather else [_scatter(look, w, seat, arm, back, d)]
    return join([base, rear, *arms, *pads, *rests, feet, *extra])


def _scatter(look: Look, w: float, seat: float, arm: float, back: float, d: float) -> Mesh:
    paint = Paint(look.pick(("#d8a24a", "#c8604a", "#dcd2be", "#5f8f8a"), "scatter"), "fabric", 4.0)
    pillow = turn(cushion((0, 0, 0), (0.34, 0.34, 0.12), paint, 0.95), "x", -20)
    return join(
        turn(shift(pillow, s * (w / 2 - arm - 0.17), seat + 0.17, -d / 2 + back + 0.18), "y", 0)
        for s in ((-1, 1) if w > 1.2 else (1,))
    )


def bench(look: Look) -> Mesh:
    """A wooden bench, or a padded one as before a piano."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    under = legs(w, d, h - 0.05, 0.05, wood, 0.02)
    rail = block(-w / 2 + 0.03, w / 2 - 0.03, h - 0.12, h - 0.05, -d / 2 + 0.03, d / 2 - 0.03, wood)
    if look.kind == "piano":
        return join((under, rail, cushion((0, h - 0.03, 0), (w, 0.06, d), LEATHER.tinted("#26262a"), 0.6)))
    boards = [
        block(-w / 2, w / 2, h - 0.05, h, -d / 2 + k * d / 3 + 0.004, -d / 2 + (k + 1) * d / 3 - 0.004, wood)
        for k in range(3)
    ]
    return join([under, rail, *boards])


def bed(look: Look) -> Mesh:
    """A bed with headboard at -z, mattress, blanket and pillows; a narrow one has one pillow."""
    w, h, d = look.size
    level, wood = look.seat(0.5, 0.95), look.paint(WOODS)
    cover = Paint(
        look.pick(("#6f92bd", "#b56a5c", "#7f9c78", "#d9c9a3", "#8d7fa8", "#5f6f82"), "cover"),
        ("fabric", "stripes")[look.variant % 2],
        2.0,
    )
    head = block(-w / 2, w / 2, 0.0, h, -d / 2, -d / 2 + 0.05, wood)
    frame = block(-w / 2, w / 2, 0.1, level * 0.55, -d / 2 + 0.05, d / 2, wood)
    feet = legs(w, d, 0.1, 0.07, wood)
    soft = cushion((0, level * 0.77, 0.03), (w - 0.04, level * 0.44, d - 0.08), LINEN, 0.35)
    reach = d * 0.66
    blanket = cushion((0, level * 0.8, d / 2 - reach / 2 - 0.002), (w + 0.0, level * 0.42, reach), cover, 0.3)
    fold = cushion((0, level * 0.985, d / 2 - reach + 0.03), (w - 0.01, 0.035, 0.24), LINEN.tinted("#f7f4ec"), 0.9)
    count = 2 if w > 1.25 else 1
    step = w / count
    pillows = [
        cushion(
            (-w / 2 + step * (k + 0.5), level + 0.035, -d / 2 + 0.29), (min(step * 0.82, 0.68), 0.13, 0.4), LINEN, 0.95
        )
        for k in range(count)
    ]
    return join([head, frame, feet, soft, blanket, fold, *pillows])


def bed_places(look: Look) -> tuple[Region, ...]:
    """The mattress below the pillows."""
    return (over(look, look.seat(0.5, 0.95) + 0.01, 0.1)._replace(z0=-look.size[2] / 2 + 0.6),)


def chair_places(look: Look) -> tuple[Region, ...]:
    """The seat."""
    return (over(look, look.seat(0.46, 0.7), 0.06),)


def sofa_places(look: Look) -> tuple[Region, ...]:
    """The seat between the arms."""
    w, _, d = look.size
    x = w / 2 - min(0.18, w * 0.12) - 0.03
    return (Region(look.seat(0.44, 0.6), -x, x, -d / 2 + 0.42, d / 2 - 0.04),)


RECIPES = {
    "chair": Recipe(chair, (0.45, 0.9, 0.48), 3, chair_places),
    "sofa": Recipe(sofa, (2.0, 0.82, 0.9), 2, sofa_places),
    "bench": Recipe(bench, (1.1, 0.45, 0.4), kinds=("", "piano")),
    "bed": Recipe(bed, (1.6, 0.95, 2.05), 2, bed_places),
}
