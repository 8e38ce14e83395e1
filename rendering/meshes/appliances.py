"""Machines of kitchen and laundry."""

from __future__ import annotations

from hearth.rendering.meshes.joinery import carcass, feet, knob
from hearth.rendering.meshes.look import Look, Recipe, Region, over, top
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import BLACK, CHROME, DARK, ENAMEL, GLASS, GREY, IRON, STEEL, WHITE, Paint
from hearth.rendering.meshes.shapes import block, box, cushion, cylinder, lathe, panel, prism, rod, tube
from hearth.rendering.meshes.storage import bottom

HOT = Paint("#ff5a2a", glow=1.6)
LED = Paint("#7dff8a", glow=1.2)
WINDOW = Paint("#20262b", shine=0.8)


def stove(look: Look) -> Mesh:
    """An oven with four burners on its top; burners and window glow when it is on."""
    w, h, d = look.size
    body = look.tint(ENAMEL, ("#eeeeec", "#bfc3c6", "#3b3d41"))
    depth = d - 0.04
    shell = carcass(w, h - 0.03, depth, body, board=0.03, shelves=2)
    plate = block(-w / 2, w / 2, h - 0.03, h - 0.012, -d / 2, d / 2, BLACK)
    burners = []
    for i, (x, z) in enumerate(((-0.25, -0.23), (0.25, -0.23), (-0.25, 0.2), (0.25, 0.2))):
        r = (0.09, 0.075, 0.075, 0.09)[i] * w / 0.6
        hot = HOT if look.on and i in (2, 3) else IRON
        burners.append(
            shift(lathe([(0, 0), (r, 0), (r, 0.006), (r * 0.85, 0.011), (0, 0.011)], hot, 20), x * w, h - 0.012, z * d)
        )
    front = join([
        block(-w / 2, w / 2, h - 0.15, h - 0.03, depth / 2 - 0.02, depth / 2, body),
        *(knob(k * w * 0.16, h - 0.09, depth / 2, 0.022, DARK) for k in (-2, -1, 1, 2)),
        panel((0, h - 0.09, depth / 2 + 0.002), w * 0.16, 0.05, LED if look.on else BLACK),
    ])  # fmt: skip
    return shift(
        join([shell, front, _oven_door(w, 0.08, h - 0.16, depth / 2, body, look), feet(w, depth, 0.08, DARK)]), z=-0.01
    ) + join([plate, *burners])


def _oven_door(w: float, y0: float, y1: float, z: float, body: Paint, look: Look) -> Mesh:
    glass = WINDOW.tinted("#ffb35c").lit(0.9) if look.on else WINDOW
    parts = [
        block(-w / 2 + 0.01, w / 2 - 0.01, y0, y1, z - 0.02, z + 0.012, body),
        panel((0, (y0 + y1) / 2 - 0.03, z + 0.014), w * 0.66, (y1 - y0) * 0.52, glass),
        rod((-w * 0.38, y1 - 0.06, z + 0.024), (w * 0.38, y1 - 0.06, z + 0.024), 0.009, CHROME, sides=8),
    ]
    leaf = join(parts)
    return turn(leaf, "x", 85 * look.open, (0, y0, z)) if look.open else leaf


def microwave(look: Look) -> Mesh:
    """A microwave oven: window left, keypad right."""
    w, h, d = look.size
    body = look.tint(ENAMEL, ("#e6e7e6", "#34373c", "#b7bbbe"))
    depth = d - 0.03
    shell = carcass(w, h, depth, body, board=0.02)
    cut = -w * 0.24
    side = block(-w / 2, cut, 0, h, -depth / 2, depth / 2, body)
    light = Paint("#fff0c8").lit(0.8 if look.on else 0.0)
    lining = block(
        cut, w / 2 - 0.02, 0.02, h - 0.02, -depth / 2 + 0.008, -depth / 2 + 0.012, light if look.on else WHITE
    )
    keys = [
        box(
            (cut - w * 0.05 - (k % 3) * w * 0.055, h * 0.62 - (k // 3) * h * 0.13, depth / 2 + 0.003),
            (w * 0.035, h * 0.07, 0.006),
            GREY,
        )
        for k in range(12)
    ]
    show = panel(
        (cut - w * 0.105, h * 0.82, depth / 2 + 0.004), w * 0.16, h * 0.14, Paint("#ffffff", "digits", glow=0.8)
    )
    glass = WINDOW.tinted("#d9b268").lit(0.7) if look.on else WINDOW
    leaf = join((
        block(cut + 0.004, w / 2, 0.004, h - 0.004, depth / 2, depth / 2 + 0.02, body),
        panel(((cut + w / 2) / 2 + 0.015, h / 2, depth / 2 + 0.022), w * 0.56, h * 0.66, glass),
        rod((cut + 0.03, h * 0.2, depth / 2 + 0.028), (cut + 0.03, h * 0.8, depth / 2 + 0.028), 0.008, CHROME, sides=8),
    ))  # fmt: skip
    if look.open:
        leaf = turn(leaf, "y", 100 * look.open, (w / 2, 0, depth / 2))
    return shift(join([shell, side, lining, *keys, show, leaf]), z=-0.014)


def washing_machine(look: Look) -> Mesh:
    """A front loader with a round window; water turns in it when it is on."""
    w, h, d = look.size
    depth = d - 0.03
    body = ENAMEL.tinted(look.color)
    ring = [(0.0, 0.0), (w * 0.34, 0.0), (w * 0.34, 0.02), (w * 0.27, 0.032), (w * 0.25, 0.02)]
    hole = w * 0.27
    shell = join((
        block(-w / 2, w / 2, 0, h, -depth / 2, depth / 2 - 0.12, body),
        block(-w / 2, -hole, 0, h, depth / 2 - 0.12, depth / 2, body),
        block(hole, w / 2, 0, h, depth / 2 - 0.12, depth / 2, body),
        block(-hole, hole, 0, h * 0.46 - hole, depth / 2 - 0.12, depth / 2, body),
        block(-hole, hole, h * 0.46 + hole, h, depth / 2 - 0.12, depth / 2, body),
        panel((0, h * 0.46, depth / 2 - 0.11), hole * 2, hole * 2, DARK),
    ))  # fmt: skip
    glass = Paint("#6fa6c4", "water", 3.0, 0.25, 0.8) if look.on else Paint("#3a4a54", shine=0.9)
    hatch = shift(
        turn(
            lathe(ring[1:], CHROME, 24)
            + shift(lathe([(w * 0.25, 0.0), (w * 0.2, 0.018), (0, 0.024)], glass, 24), y=0.008),
            "x",
            90,
        ),
        0,
        h * 0.46,
        depth / 2,
    )
    if look.open:
        hatch = turn(hatch, "y", -100 * look.open, (-w * 0.34, 0, depth / 2))
    board = join((
        box((0, h - 0.065, depth / 2 + 0.003), (w * 0.96, 0.1, 0.006), WHITE),
        block(w * 0.16, w * 0.45, h - 0.1, h - 0.03, depth / 2 + 0.006, depth / 2 + 0.009, GREY),
        knob(-w * 0.02, h - 0.065, depth / 2 + 0.006, 0.032, CHROME),
        panel((-w * 0.3, h - 0.065, depth / 2 + 0.008), 0.1, 0.04, LED if look.on else BLACK),
    ))  # fmt: skip
    return shift(join((shell, hatch, board)), z=-0.014)


def dishwasher(look: Look) -> Mesh:
    """A dishwasher: a front with a control strip; racks when open."""
    w, h, d = look.size
    depth = d - 0.03
    body = look.tint(STEEL, ("#c3c7ca", "#eeeeec"))
    shell = carcass(w, h, depth, ENAMEL, board=0.02)
    racks = [
        block(-w / 2 + 0.04, w / 2 - 0.04, y, y + 0.012, -depth / 2 + 0.03, depth / 2 - 0.03, GREY)
        for y in (h * 0.2, h * 0.52)
    ]
    leaf = join((
        block(-w / 2 + 0.004, w / 2 - 0.004, 0.1, h - 0.03, depth / 2, depth / 2 + 0.018, body),
        block(-w / 2 + 0.01, w / 2 - 0.01, h - 0.13, h - 0.035, depth / 2 + 0.018, depth / 2 + 0.022, DARK),
        rod((-w * 0.3, h - 0.17, depth / 2 + 0.028), (w * 0.3, h - 0.17, depth / 2 + 0.028), 0.008, CHROME, sides=8),
        panel((0.1, h - 0.08, depth / 2 + 0.024), 0.08, 0.03, LED if look.on else GREY),
    ))  # fmt: skip
    if look.open:
        leaf = turn(leaf, "x", 88 * look.open, (0, 0.1, depth / 2))
    lid = block(-w / 2, w / 2, h - 0.025, h, -depth / 2, depth / 2, WHITE)
    return shift(join([shell, *racks, leaf, lid, feet(w, depth, 0.1, DARK)]), z=-0.014)


def toaster(look: Look) -> Mesh:
    """A toaster with two slots and a lever; slices and glow when on."""
    w, h, d = look.size
    body = look.tint(CHROME, ("#c8ccd0", "#b8433a", "#e8e2d2", "#3b5f6b"))
    shell = cushion((0, h * 0.48, 0), (w * 0.92, h * 0.86, d), body, 0.45)
    slots = [
        block(-w * 0.32, w * 0.32, h * 0.905, h * 0.915, z - d * 0.07, z + d * 0.07, HOT if look.on else BLACK)
        for z in (-d * 0.17, d * 0.17)
    ]
    bread = (
        [cushion((0, h * 0.9, z), (w * 0.5, h * 0.2, d * 0.1), Paint("#c58f4f"), 0.6, 3) for z in (-d * 0.17, d * 0.17)]
        if look.on
        else []
    )
    lever = box((w * 0.48, h * (0.35 if look.on else 0.66), 0), (0.03, 0.025, 0.05), DARK)
    base = block(-w * 0.45, w * 0.45, 0, h * 0.07, -d * 0.45, d * 0.45, DARK)
    return join([shell, *slots, *bread, lever, base])


def coffee_maker(look: Look) -> Mesh:
    """A drip machine: tank behind, glass pot on a plate under the filter."""
    w, h, d = look.size
    body = look.tint(BLACK, ("#26282c", "#8a2f2c", "#d5d7d8"))
    r = min(w, d) * 0.3
    pot = lathe(
        [(0, 0), (r * 0.85, 0), (r, h * 0.1), (r * 0.95, h * 0.22), (r * 0.6, h * 0.32), (r * 0.66, h * 0.34)],
        Paint("#4a2c1a" if look.on else "#bcd2d8", shine=0.9),
        18,
    )
    lid = cylinder((0, h * 0.33, 0), r * 0.66, h * 0.03, DARK)
    grip = tube(
        [(0, h * 0.28, r * 0.7), (0, h * 0.26, r + 0.04), (0, h * 0.1, r + 0.035), (0, h * 0.07, r * 0.9)],
        0.009,
        DARK,
        6,
    )
    carafe = shift(join((pot, lid, grip)), 0, h * 0.11, d * 0.08)
    parts = [
        block(-w / 2, w / 2, 0, h * 0.08, -d / 2, d * 0.4, body),
        cylinder((0, h * 0.08, d * 0.08), r * 0.95, h * 0.02, HOT.lit(0.5) if look.on else STEEL),
        block(-w / 2, w / 2, h * 0.08, h, -d / 2, -d * 0.22, body),
        block(-w / 2, w / 2, h * 0.68, h, -d * 0.22, d * 0.4, body),
        shift(lathe([(r * 0.5, 0), (r * 0.8, h * 0.12), (0, h * 0.12)], DARK, 16), 0, h * 0.57, d * 0.08),
        panel((0, h * 0.84, d * 0.4 + 0.002), w * 0.3, h * 0.07, LED if look.on else GREY),
    ]
    return join([*parts, carafe])


def kettle(look: Look) -> Mesh:
    """An electric kettle: jug, spout, handle, lid."""
    w, h, d = look.size
    paint = look.tint(STEEL, ("#b9bcc0", "#e7e3da", "#a8423a", "#3d4f59"))
    r = min(w * 0.34, d / 2)
    x = w / 2 - r - 0.01
    body = lathe(
        [
            (0, 0.0),
            (r, 0),
            (r, 0.015),
            (r, 0.02),
            (r * 0.98, h * 0.2),
            (r * 0.72, h * 0.82),
            (r * 0.6, h * 0.88),
            (0, h * 0.9),
        ],
        paint,
        20,
    )
    dot = cushion((0, h * 0.94, 0), (0.03, h * 0.1, 0.03), DARK, 1.0, 3)
    spout = rod((r * 0.7, h * 0.62, 0), (r * 1.35, h * 0.84, 0), r * 0.26, paint, r * 0.14, 10)
    grip = tube(
        [(-r * 0.6, h * 0.84, 0), (-r * 1.35, h * 0.8, 0), (-r * 1.45, h * 0.4, 0), (-r * 0.95, h * 0.22, 0)],
        0.012,
        DARK,
        8,
    )
    light = box((-r * 0.2, 0.012, r * 0.98), (0.03, 0.012, 0.02), LED if look.on else DARK)
    return shift(join((body, dot, spout, grip, light)), -x * 0.1)


def blender(look: Look) -> Mesh:
    """A blender: motor base and tapered jug."""
    w, h, d = look.size
    r = min(w, d) / 2
    base = lathe(
        [(0, 0), (r, 0), (r * 0.95, h * 0.05), (r * 0.62, h * 0.28), (0, h * 0.28)],
        look.tint(DARK, ("#2e3035", "#b8433a", "#d8d8d4")),
        16,
    )
    fill = Paint("#c85a7a" if look.on else "#c9dfe6", shine=0.8)
    jug = shift(lathe([(0, 0), (r * 0.5, 0), (r * 0.85, h * 0.6), (0, h * 0.6)], fill, 16), y=h * 0.29)
    lid = cylinder((0, h * 0.89, 0), r * 0.86, h * 0.06, DARK) + cylinder((0, h * 0.95, 0), r * 0.3, h * 0.05, DARK)
    grip = tube(
        [(r * 0.75, h * 0.82, 0), (r * 1.0, h * 0.78, 0), (r * 0.95, h * 0.45, 0), (r * 0.6, h * 0.4, 0)],
        0.009,
        DARK,
        6,
    )
    return join((base, jug, lid, grip, knob(0, h * 0.12, r * 0.78, r * 0.18, CHROME)))


def hood(look: Look) -> Mesh:
    """A cooker hood: a funnel and a duct."""
    w, h, d = look.size
    low = h * 0.35
    cone = stretch(
        turn(lathe([(0.7, 0), (0.7, 0.12), (0.7, 0.12), (0.25, 1.0), (0, 1.0)], STEEL, 4), "y", 45), w, low, d
    )
    duct = block(-w * 0.17, w * 0.17, low, h, -d / 2, -d * 0.1, STEEL)
    lamp = panel((0, 0.02, d * 0.5 - 0.001), w * 0.3, 0.02, Paint("#fff2c8", glow=1.5) if look.on else DARK)
    return stretch(join((cone, duct, lamp)), x=1.0, z=1.0)


def vacuum(look: Look) -> Mesh:
    """An upright vacuum cleaner: head, body, hose and handle."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.4), ("#b8433a", "#3f77b5", "#6b4f8a", "#3d8a6b"))
    head = cushion((0, 0.05, d * 0.16), (w, 0.1, d * 0.66), DARK, 0.6) + panel(
        (0, 0.06, d * 0.5), w * 0.5, 0.03, Paint("#fff6c8", glow=1.2) if look.on else GREY
    )
    body = cushion((0, h * 0.36, -d * 0.12), (w * 0.62, h * 0.46, d * 0.55), paint, 0.7)
    tank = cylinder((0, h * 0.24, d * 0.08), w * 0.2, h * 0.22, GLASS)
    stick = rod((0, h * 0.5, -d * 0.18), (0, h * 0.9, -d * 0.36), 0.018, CHROME, sides=8)
    grip = tube(
        [(0, h * 0.88, -d * 0.34), (0, h * 0.985, -d * 0.42), (0, h * 0.95, -d * 0.2), (0, h * 0.86, -d * 0.3)],
        0.014,
        DARK,
        8,
    )
    wheels = [turn(cylinder((0, 0, 0), 0.06, 0.03, DARK), "z", 90, (0, 0, 0)) for _ in (0, 1)]
    return join(
        [
            head,
            body,
            tank,
            stick,
            grip,
            shift(wheels[0], w * 0.36, 0.06, -d * 0.3),
            shift(wheels[1], -w * 0.3, 0.06, -d * 0.3),
        ]
    )


def iron(look: Look) -> Mesh:
    """A clothes iron lying on its sole, pointing to +z."""
    w, h, d = look.size
    outline = [
        (-w / 2, -d / 2),
        (w / 2, -d / 2),
        (w / 2, d * 0.1),
        (w * 0.25, d * 0.38),
        (0, d / 2),
        (-w * 0.25, d * 0.38),
        (-w / 2, d * 0.1),
    ]
    sole = shift(turn(prism(outline, 0.014, CHROME), "x", 90), y=0.007)
    shell = stretch(
        shift(
            turn(prism(outline, h * 0.34, look.tint(Paint(shine=0.4), ("#3f77b5", "#8b5fa8", "#3d8a6b"))), "x", 90),
            y=0.014 + h * 0.17,
        ),
        0.9,
        1,
        0.9,
    )
    grip = tube(
        [(0, h * 0.4, d * 0.22), (0, h * 0.86, d * 0.16), (0, h * 0.9, -d * 0.2), (0, h * 0.4, -d * 0.36)],
        h * 0.09,
        DARK,
        8,
    )
    lamp = cushion((0, h * 0.44, d * 0.26), (0.02, 0.02, 0.02), Paint("#ff4030", glow=1.5) if look.on else GREY, 1.0, 3)
    return join((sole, shell, grip, lamp))


def oven_inside(look: Look) -> tuple[Region, ...]:
    """The rack of an oven."""
    return (over(look, look.size[1] * 0.34, 0.08)._replace(clear=0.3), over(look, 0.1, 0.08))


def drum(look: Look) -> tuple[Region, ...]:
    """The drum of a washing machine."""
    w, h, d = look.size
    return (Region(h * 0.3, -w * 0.2, w * 0.2, d * 0.2, d * 0.44, 0.3),)


def racks(look: Look) -> tuple[Region, ...]:
    """The two racks of a dishwasher."""
    h = look.size[1]
    return (over(look, h * 0.54, 0.07)._replace(clear=0.3), over(look, h * 0.22, 0.07)._replace(clear=0.25))


def floor_of(look: Look) -> tuple[Region, ...]:
    """The bottom of a microwave oven."""
    w, h, d = look.size
    return (Region(0.025, -w * 0.2, w * 0.42, -d * 0.4, d * 0.35, h * 0.8),)


def hob(look: Look) -> tuple[Region, ...]:
    """The front burners, then the others."""
    w, h, d = look.size
    return tuple(
        Region(h, x * w - 0.13, x * w + 0.13, z * d - 0.13, z * d + 0.13)
        for x, z in ((0.25, 0.2), (-0.25, 0.2), (0.25, -0.23), (-0.25, -0.23))
    )


RECIPES = {
    "stove": Recipe(stove, (0.6, 0.88, 0.6), 1, hob, oven_inside, states=("OPEN", "ON")),
    "microwave": Recipe(microwave, (0.5, 0.3, 0.36), 1, top, floor_of, states=("OPEN", "ON")),
    "washing_machine": Recipe(washing_machine, (0.6, 0.86, 0.6), 1, top, drum, states=("OPEN", "ON")),
    "dishwasher": Recipe(dishwasher, (0.6, 0.86, 0.58), 1, top, racks, states=("OPEN", "ON")),
    "toaster": Recipe(toaster, (0.28, 0.2, 0.18), inside=bottom, states=("ON",)),
    "coffee_maker": Recipe(coffee_maker, (0.24, 0.34, 0.26), inside=bottom, states=("ON",)),
    "kettle": Recipe(kettle, (0.24, 0.24, 0.16), inside=bottom, states=("ON",)),
    "blender": Recipe(blender, (0.18, 0.38, 0.18), inside=bottom, states=("ON",)),
    "hood": Recipe(hood, (0.6, 0.5, 0.45)),
    "vacuum": Recipe(vacuum, (0.32, 0.9, 0.3)),
    "iron": Recipe(iron, (0.12, 0.15, 0.27), states=("ON",)),
}
