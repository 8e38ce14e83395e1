"""Things that hold other things."""

from __future__ import annotations

from hearth.rendering.meshes.joinery import carcass, doors, drawers, feet, legs
from hearth.rendering.meshes.look import Look, Recipe, Region, over, shelves, top
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import (
    BRASS,
    CHROME,
    DARK,
    GLASS,
    IRON,
    STEEL,
    WHITE,
    WHITE_WOOD,
    WICKER,
    WOODS,
    Paint,
)
from hearth.rendering.meshes.shapes import arc, ball, block, box, lathe, panel, prism, rod, tube

CARDBOARD = Paint("#b58a5c", "wood_fine", 1.0)


def cabinet(look: Look) -> Mesh:
    """A cupboard with doors: on a plinth when it stands, without when it is shallow and hangs."""
    w, h, d = look.size
    body = look.pick((*WOODS, WHITE_WOOD), "body").tinted(look.color)
    hung = h < 0.85 and d < 0.42
    base = 0.0 if hung else 0.07
    shell = shift(carcass(w, h - base, d, body, shelves=2 if h < 0.9 else 3), y=base)
    fronts = doors(w, base, h, d / 2 + 0.004, max(1, round(w / 0.5)), body, look.open, BRASS)
    rows = join((shell, fronts))
    if not hung:
        rows += feet(w, d, 0.07, DARK) + block(-w / 2, w / 2, h - 0.02, h, -d / 2, d / 2, body)
    return shift(stretch(rows, z=0.97), z=-0.006)


def mirror_cabinet(look: Look) -> Mesh:
    """A bathroom cabinet with a mirror for a door."""
    w, h, d = look.size
    shell = carcass(w, h, d - 0.01, WHITE, shelves=3)
    glass = panel((0, h / 2, d / 2 - 0.005 + 0.001), w - 0.05, h - 0.05, GLASS.tinted("#a9c4cf"))
    leaf = doors(w, 0, h, d / 2 - 0.005, 1, WHITE, 0.0) + glass
    if look.open:
        leaf = turn(leaf, "y", -105 * look.open, (-w / 2, 0, d / 2 - 0.02))
    return shell + leaf


def dresser(look: Look) -> Mesh:
    """A chest of drawers, in two columns where it is wide."""
    w, h, d = look.size
    wood = look.pick((*WOODS, WHITE_WOOD), "body").tinted(look.color)
    shell = shift(carcass(w, h - 0.08, d - 0.01, wood, shelves=2), y=0.08)
    rows, columns = max(2, round(h / 0.27)), 2 if w > 0.85 else 1
    step = (w - 0.02) / columns
    fronts = [
        shift(drawers(step, 0.1, h - 0.03, d - 0.01, rows, wood, look.open, BRASS), (k - (columns - 1) / 2) * step)
        for k in range(columns)
    ]
    board = block(-w / 2, w / 2, h - 0.025, h, -d / 2, d / 2, wood)
    return join([shell, *fronts, board, legs(w, d, 0.08, 0.05, wood, 0.01)])


def filing_cabinet(look: Look) -> Mesh:
    """A steel cabinet of drawers with label holders."""
    w, h, d = look.size
    steel = look.tint(STEEL, ("#8f989e", "#6c7880", "#a9a59c"))
    count = max(2, round(h / 0.28))
    shell = carcass(w, h, d - 0.02, steel)
    fronts = drawers(w - 0.02, 0.03, h - 0.02, d - 0.02, count, steel, look.open, DARK)
    step = (h - 0.05) / count
    shown = range(count - 1) if look.open else range(count)
    labels = [panel((0, 0.03 + step * (k + 0.78), d / 2 - 0.01), 0.1, 0.035, WHITE) for k in shown]
    return join([shell, fronts, *labels])


def wardrobe(look: Look) -> Mesh:
    """A closet with a rail and hangers behind tall doors."""
    w, h, d = look.size
    wood = look.pick((*WOODS, WHITE_WOOD), "body").tinted(look.color)
    shell = carcass(w, h, d - 0.02, wood)
    shelf = block(-w / 2 + 0.02, w / 2 - 0.02, h * 0.84, h * 0.84 + 0.02, -d / 2, d / 2 - 0.04, wood)
    rail = rod((-w / 2 + 0.02, h * 0.8, 0), (w / 2 - 0.02, h * 0.8, 0), 0.014, CHROME, sides=8)
    clothes = []
    if look.open:
        for k in range(max(2, int(w / 0.16))):
            x = -w / 2 + 0.12 + k * 0.15
            color = look.pick(("#5f7896", "#b56a5c", "#d8cdb4", "#4c5866", "#7f9c78", "#8a6a94"), f"hung{k}")
            long_ = look.pick((0.45, 0.6, 0.75), f"length{k}")
            if x < w / 2 - 0.08:
                clothes.append(
                    block(
                        x - 0.025,
                        x + 0.025,
                        h * 0.77 - long_ * h * 0.5,
                        h * 0.77,
                        -d * 0.3,
                        d * 0.28,
                        Paint(color, "fabric", 4.0),
                    )
                )
    fronts = doors(w, 0.02, h - 0.01, d / 2 - 0.006, max(2, round(w / 0.55)), wood, look.open, BRASS)
    return join([shell, shelf, rail, *clothes, fronts])


def bookshelf(look: Look) -> Mesh:
    """Open shelves, some with rows of books."""
    w, h, d = look.size
    wood = look.pick((*WOODS, WHITE_WOOD), "body").tinted(look.color)
    count = max(2, round((h - 0.1) / 0.36))
    step = (h - 0.1) / count
    shell = shift(carcass(w, h - 0.06, d, wood, shelves=count, board=0.025), y=0.06) + block(
        -w / 2, w / 2, 0, 0.06, -d / 2 + 0.01, d / 2 - 0.02, wood
    )
    spine = Paint("#ffffff", "spines")
    rows = []
    for k in range(count):
        if look.kind != "bare" and k % 2 == 1 - look.variant % 2:
            x0, x1 = (-w / 2 + 0.03, w * 0.08) if k % 4 < 2 else (-w * 0.05, w / 2 - 0.03)
            y = 0.085 + k * step
            tall = step * 0.72
            rows.append(block(x0, x1, y, y + tall * 0.97, -d / 2 + 0.03, d * 0.2, Paint("#cfc6b4")))
            rows.append(panel(((x0 + x1) / 2, y + tall / 2, d * 0.2 + 0.002), x1 - x0, tall, spine))
    return join([shell, *rows])


def wall_shelf(look: Look) -> Mesh:
    """A board on two brackets."""
    w, h, d = look.size
    board = block(-w / 2, w / 2, max(h - 0.03, 0), h, -d / 2, d / 2, look.paint(WOODS))
    brackets = [
        block(s * w * 0.35 - 0.01, s * w * 0.35 + 0.01, 0, max(h - 0.03, 0.01), -d / 2, d * 0.2, IRON) for s in (-1, 1)
    ]
    return join([board, *brackets])


def shoe_rack(look: Look) -> Mesh:
    """Slatted shelves between two side frames."""
    w, h, d = look.size
    wood = look.paint(WOODS)
    sides = [
        block(s * w / 2 - (0.03 if s > 0 else 0), s * w / 2 + (0.03 if s < 0 else 0), 0, h, z - 0.015, z + 0.015, wood)
        for s in (-1, 1)
        for z in (-d / 2 + 0.015, d / 2 - 0.015)
    ]
    slats = [
        block(-w / 2, w / 2, y - 0.015, y, -d / 2 + k * d / 5 + 0.008, -d / 2 + (k + 1) * d / 5 - 0.008, wood)
        for y in (0.08, 0.08 + (h - 0.08) * 0.45, h)
        for k in range(5)
    ]
    return join([*sides, *slats])


def carton(look: Look) -> Mesh:
    """A cardboard box, its flaps up when open."""
    w, h, d = look.size
    paint = CARDBOARD.tinted(look.color)
    t, lid = 0.008, h if not look.open else h * 0.999
    walls = join((
        block(-w / 2, w / 2, 0, t, -d / 2, d / 2, paint),
        block(-w / 2, -w / 2 + t, t, lid - t, -d / 2, d / 2, paint),
        block(w / 2 - t, w / 2, t, lid - t, -d / 2, d / 2, paint),
        block(-w / 2 + t, w / 2 - t, t, lid - t, -d / 2, -d / 2 + t, paint),
        block(-w / 2 + t, w / 2 - t, t, lid - t, d / 2 - t, d / 2, paint),
    ))  # fmt: skip
    tape = Paint("#d9c39a", shine=0.3)
    if not look.open:
        cover = block(-w / 2, w / 2, h - t, h, -d / 2, d / 2, paint)
        return join((walls, cover, block(-w / 2, w / 2, h - 0.001, h + 0.001, -0.03, 0.03, tape)))
    flap = block(0, d * 0.45, h - t, h - t / 2, -w / 2, w / 2, paint)
    flaps = [turn(turn(flap, "z", 60, (0, h, 0)), "y", angle) for angle in (-90, 90)]
    shifted = [shift(flaps[0], z=d / 2), shift(flaps[1], z=-d / 2)]
    return join([walls, *shifted])


def crate(look: Look) -> Mesh:
    """What is drawn where no recipe knows the class: a box with a lid line."""
    w, h, d = look.size
    paint = look.tint(Paint("#a8a29a", "wood_fine", 1.5), ("#a8a29a", "#9aa3a8", "#a89a9f"))
    return block(-w / 2, w / 2, 0, h * 0.8, -d / 2, d / 2, paint) + box(
        (0, h * 0.9, 0), (w * 0.96, h * 0.2, d * 0.96), paint
    )


def basket(look: Look) -> Mesh:
    """A wicker basket, wider at its top; with a lid when closed."""
    w, h, d = look.size
    paint = WICKER.tinted(look.color)
    r, t = 0.5, 0.03
    profile = [
        (0, 0),
        (r * 0.8, 0),
        (r * 0.8, 0),
        (r * 0.97, h * 0.9),
        (r, h * 0.9),
        (r, h * 0.96),
        (r - t, h * 0.96),
        (r * 0.76, 0.03),
        (0, 0.03),
    ]
    body = lathe(profile, paint, 20)
    if "CLOSED" in look.states or look.kind == "lid":
        body += lathe([(r, h * 0.96), (r * 0.97, h), (0, h)], paint, 20)
    return stretch(body, x=w, z=d)


def bin_(look: Look) -> Mesh:
    """A waste bin: open tapered bucket, or one with pedal and lid."""
    w, h, d = look.size
    paint = look.tint(STEEL, ("#b9bcc0", "#5f6a70", "#3a3d42", "#d8d4ca"))
    r = 0.5
    if look.variant % 2:
        profile = [
            (0, 0),
            (r * 0.78, 0),
            (r * 0.78, 0),
            (r, h),
            (r * 0.95, h),
            (r * 0.95, h),
            (r * 0.74, 0.02),
            (0, 0.02),
        ]
        liner = lathe([(r * 0.98, h * 0.9), (r * 1.0, h), (r * 0.93, h * 0.97)], WHITE, 20)
        return stretch(lathe(profile, paint, 20) + liner, x=w, z=d)
    body = lathe(
        [(0, 0), (r * 0.96, 0), (r * 0.96, 0), (r * 0.96, h * 0.86), (r * 0.92, h * 0.86), (r * 0.9, 0.03), (0, 0.03)],
        paint,
        20,
    )
    lid = lathe([(r, h * 0.86), (r, h * 0.92), (r * 0.8, h * 0.98), (0, h)], DARK, 20)
    if look.open:
        lid = turn(lid, "x", -70 * look.open, (0, h * 0.88, -r * 0.9))
    pedal = block(-0.15, 0.15, 0.0, 0.03, 0.4, 0.5, DARK)
    return stretch(join((body, lid, pedal)), x=w, z=d)


def bag(look: Look) -> Mesh:
    """A bag with two handles: paper with groceries, cloth, or leather with a flap."""
    w, h, d = look.size
    kinds = {"groceries": CARDBOARD.tinted("#c49a68"), "purse": Paint("#7a3d3a", "leather", 2.0, shine=0.3)}
    paint = kinds.get(look.kind, Paint("#4d6b70", "fabric", 3.0)).tinted(look.color)
    body = h * 0.66
    outline = [(-w / 2, 0), (w / 2, 0), (w * 0.44, body), (-w * 0.44, body)]
    sack = prism(outline, d, paint)
    strap = [(x, body + y * 0.5 * (h - body) / (h * 0.17) * 0.68, 0.0) for x, y, _ in arc((0, 0, 0), 0.17 * h, 0, 180)]
    handles = [
        shift(tube([(x * w / h * 1.3, min(y, h - 0.012), 0) for x, y, _ in strap], 0.008, paint, 6), z=s * d * 0.35)
        for s in (-1, 1)
    ]
    if look.kind == "groceries":
        leaves = [
            ball((x * w, body + 0.02, 0), (w * 0.12, h * 0.16, d * 0.25), Paint(c))
            for x, c in ((-0.25, "#5d9a44"), (0.05, "#d8a24a"), (0.28, "#c8463c"))
        ]
        return join([sack, *leaves])
    if look.kind == "purse":
        flap = prism(
            [(-w * 0.45, body * 0.55), (w * 0.45, body * 0.55), (w * 0.45, body), (-w * 0.45, body)], d + 0.008, paint
        )
        clasp = box((0, body * 0.55, d / 2 + 0.004), (0.03, 0.02, 0.012), BRASS)
        return join([sack, *handles, flap, clasp])
    return join([sack, *handles])


def fridge(look: Look) -> Mesh:
    """A fridge: two doors above each other; shelves, a drawer and light inside."""
    w, h, d = look.size
    body = look.tint(Paint("#eceeee", shine=0.5), ("#eef0f0", "#c3c7ca", "#eef0f0", "#9db3b8"))
    split = h * (0.34 if look.kind != "freezer" else 0.5)
    depth = d - 0.06
    inner = Paint("#f4f7f8", shine=0.3).lit(0.35 * look.open)
    shell = carcass(w, h, depth, body, board=0.035) + block(
        -w / 2 + 0.035, w / 2 - 0.035, split - 0.03, split + 0.01, -depth / 2, depth / 2, inner
    )
    lining = block(-w / 2 + 0.035, w / 2 - 0.035, 0.035, h - 0.035, -depth / 2 + 0.009, -depth / 2 + 0.02, inner)
    count = 4
    step = (h - split - 0.06) / count
    glass = Paint("#cfe2e8", shine=0.8)
    racks = [
        block(
            -w / 2 + 0.036,
            w / 2 - 0.036,
            split + 0.02 + k * step,
            split + 0.03 + k * step,
            -depth / 2,
            depth / 2 - 0.03,
            glass,
        )
        for k in range(1, count)
    ]
    racks += [
        block(
            -w / 2 + 0.04,
            w / 2 - 0.04,
            0.05 + k * split * 0.3,
            0.05 + k * split * 0.3 + 0.012,
            -depth / 2,
            depth / 2 - 0.03,
            glass,
        )
        for k in range(1, 3)
    ]
    shell = shift(join([shell, lining, *racks]), z=-0.03)
    front = depth / 2 - 0.03
    seam = block(-w / 2, w / 2, split - 0.008, split + 0.008, front, d / 2 - 0.035, IRON)
    leaves = [
        seam,
        _fridge_door(w, split + 0.008, h, front, d / 2, body, look.open),
        _fridge_door(w, 0.03, split - 0.008, front, d / 2, body, False),
    ]
    return join([shell, *leaves])


def _fridge_door(w: float, y0: float, y1: float, z0: float, z1: float, paint: Paint, open_: float) -> Mesh:
    leaf = block(-w / 2, w / 2, y0, y1, z0 + 0.003, z1 - 0.012, paint)
    x = w / 2 - 0.07
    middle = y0 + 0.3 if y1 - y0 > 0.7 else (y0 + y1) / 2
    reach = min(0.24, (y1 - y0) * 0.32)
    grip = box((x, middle, z1 - 0.006), (0.03, reach * 2, 0.022), IRON)
    racks = []
    if open_:
        for y in (y0 + 0.1, y0 + 0.4, y0 + 0.7):
            if y < y1 - 0.15:
                racks.append(block(-w / 2 + 0.06, w / 2 - 0.06, y, y + 0.07, z0 - 0.09, z0, GLASS))
    whole = join([leaf, grip, *racks])
    return turn(whole, "y", -100 * open_, (-w / 2, 0, z0)) if open_ else whole


def fridge_inside(look: Look) -> tuple[Region, ...]:
    """Glass shelves over the freezing compartment."""
    _, h, d = look.size
    split = h * (0.34 if look.kind != "freezer" else 0.5)
    step = (h - split - 0.06) / 4
    region = over(look, 0.0, 0.07)._replace(z0=-d / 2 + 0.06, z1=d / 2 - 0.14, clear=step - 0.04)
    return tuple(region._replace(y=split + 0.03 + k * step) for k in (2, 1, 3, 0))


def three_shelves(look: Look) -> tuple[Region, ...]:
    """Three shelves behind doors."""
    return shelves(look, 3 if look.size[1] >= 0.9 else 2, 0.1 if look.size[1] >= 0.85 else 0.025)


def book_places(look: Look) -> tuple[Region, ...]:
    """Shelves of a bookshelf, the ones at hand first."""
    h = look.size[1]
    count = max(2, round((h - 0.1) / 0.36))
    step = (h - 0.1) / count
    levels = sorted(range(count), key=lambda k: (abs(0.085 + k * step - 1.0), k))
    return tuple(over(look, 0.085 + k * step, 0.05)._replace(clear=step - 0.05) for k in levels)


def bottom(look: Look) -> tuple[Region, ...]:
    """The bottom of a vessel."""
    w, h, d = look.size
    return (Region(min(0.03, h * 0.2), -w * 0.25, w * 0.25, -d * 0.25, d * 0.25, h),)


def shoe_places(look: Look) -> tuple[Region, ...]:
    """The upper shelf first."""
    h = look.size[1]
    return tuple(over(look, y) for y in (h, 0.08 + (h - 0.08) * 0.45, 0.08))


RECIPES = {
    "cabinet": Recipe(cabinet, (0.8, 1.1, 0.4), 1, top, three_shelves, states=("OPEN",)),
    "mirror_cabinet": Recipe(mirror_cabinet, (0.6, 0.65, 0.16), 1, top, three_shelves, states=("OPEN",)),
    "dresser": Recipe(dresser, (1.0, 1.0, 0.48), 1, top, three_shelves, states=("OPEN",)),
    "filing_cabinet": Recipe(filing_cabinet, (0.45, 0.7, 0.55), 1, top, three_shelves, states=("OPEN",)),
    "wardrobe": Recipe(wardrobe, (1.2, 2.0, 0.58), 1, top, three_shelves, states=("OPEN",)),
    "bookshelf": Recipe(bookshelf, (0.9, 1.9, 0.32), 2, book_places, book_places),
    "wall_shelf": Recipe(wall_shelf, (0.8, 0.2, 0.24)),
    "shoe_rack": Recipe(shoe_rack, (0.75, 0.5, 0.32), 1, shoe_places, shoe_places),
    "carton": Recipe(carton, (0.4, 0.28, 0.3), 1, top, bottom, states=("OPEN",)),
    "crate": Recipe(crate, (0.3, 0.2, 0.2), 1, top, bottom),
    "basket": Recipe(basket, (0.42, 0.5, 0.36), 1, top, bottom),
    "bin": Recipe(bin_, (0.3, 0.4, 0.3), 2, top, bottom, states=("OPEN",)),
    "bag": Recipe(bag, (0.34, 0.34, 0.16), 1, top, bottom, ("", "groceries", "purse")),
    "fridge": Recipe(fridge, (0.65, 1.8, 0.65), 1, top, fridge_inside, ("", "freezer"), states=("OPEN",)),
}
