"""Paper, pens and small things of a desk or a pocket."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import BRASS, BRIGHT_COLORS, CHROME, DARK, PAPER, STEEL, Paint
from hearth.rendering.meshes.shapes import block, box, cylinder, lathe, panel, rod

COVERS = ("#8a2f2c", "#2f5a86", "#3f6f4f", "#b5863a", "#5f3f6f", "#2c3038", "#c8604a")


def book(look: Look) -> Mesh:
    """A book: upright where it is higher than deep, else lying, open pages up when it is open."""
    w, h, d = look.size
    cover = look.tint(Paint(shine=0.2), COVERS)
    if look.open:
        return _open_book(look, cover)
    if h > d:
        return shift(turn(_closed(w, d, h, cover), "x", 90), y=h / 2, z=-d / 2)
    return _closed(w, h, d, cover)


def _closed(w: float, h: float, d: float, cover: Paint) -> Mesh:
    t = min(0.003, h * 0.2)
    spine = w / 2
    return join((
        block(-w / 2, w / 2, 0, t, -d / 2, d / 2, cover),
        block(-w / 2, w / 2, h - t, h, -d / 2, d / 2, cover),
        block(spine - 0.004, spine, t, h - t, -d / 2, d / 2, cover),
        block(-w / 2 + 0.004, spine - 0.004, t, h - t, -d / 2 + 0.004, d / 2 - 0.004, PAPER),
        panel((0, h + 0.0006, 0), w, d, Paint(cover.color, "cover"), "+y"),
    ))  # fmt: skip


def _open_book(look: Look, cover: Paint) -> Mesh:
    w, h, d = look.size
    if h > d:
        h, d = d, h
    leaf = block(-w, w, 0, 0.004, -d / 2, d / 2, cover)
    pages = [
        turn(
            block(
                0.002 if s > 0 else -w * 0.97,
                w * 0.97 if s > 0 else -0.002,
                0.004,
                0.004 + h * 0.5,
                -d / 2 + 0.005,
                d / 2 - 0.005,
                PAPER,
            ),
            "z",
            s * 3,
        )
        for s in (-1, 1)
    ]
    text = panel((0, 0.008 + h * 0.5, 0), w * 1.9, d * 0.97, Paint("#ffffff", "book_open"), "+y")
    return stretch(join([leaf, *pages, text]), x=0.75)


def magazine(look: Look) -> Mesh:
    """A newspaper, folded, or a magazine."""
    w, h, d = look.size
    if look.kind == "news":
        return block(-w / 2, w / 2, 0, h, -d / 2, d / 2, Paint("#dedbd0")) + panel(
            (0, h + 0.0006, 0), w * 0.98, d * 0.98, Paint("#ffffff", "newspaper"), "+y"
        )
    cover = look.tint(Paint(shine=0.4), BRIGHT_COLORS)
    photo = panel(
        (0, h + 0.001, d * 0.1),
        w * 0.8,
        d * 0.62,
        Paint("#ffffff", look.pick(("portrait", "mountains", "sea", "flowers"), "photo"), shine=0.3),
        "+y",
    )
    title = panel((0, h + 0.001, -d * 0.36), w * 0.8, d * 0.16, Paint("#fdfbf4"), "+y")
    return join((block(-w / 2, w / 2, 0, h, -d / 2, d / 2, cover), photo, title))


def sheet(look: Look) -> Mesh:
    """Paper with writing: sheet, note pad, envelope, bill, card, by kind; a small stack."""
    w, h, d = look.size
    pictures = {
        "envelope": "envelope",
        "money": "banknote",
        "card": "label",
        "pad": "page",
        "drawing": "child_drawing",
        "cards": "cards",
        "blank": "plain",
    }
    paint = Paint(look.color or "#ffffff", pictures.get(look.kind, "page"))
    edge = Paint(look.pick(COVERS, "edge")) if look.kind == "pad" else PAPER.tinted(look.color)
    base = block(-w / 2, w / 2, 0, h, -d / 2, d / 2, edge)
    face = panel((0, h + 0.0006, 0), w * 0.98, d * 0.98, paint, "+y")
    if look.kind == "pad":
        rings = [
            cylinder((-w * 0.42 + k * w * 0.12, h * 0.5, -d / 2 + 0.008), 0.003, h * 0.9, STEEL, sides=6)
            for k in range(8)
        ]
        return join([base, face, *rings])
    if look.kind in ("", "page") and h > 0.004:
        return join((base, face, shift(turn(block(-w / 2, w / 2, 0, 0.001, -d / 2, d / 2, PAPER), "y", 7), y=h * 0.4)))
    return base + face


def pen(look: Look) -> Mesh:
    """A pen, pencil, marker or crayon lying along z."""
    w, h, d = look.size
    r = min(w, h) / 2
    if look.kind == "crayons":
        count = max(3, round(w / 0.02))
        return join(
            shift(
                _stick(
                    0.008, d, Paint(BRIGHT_COLORS[k % len(BRIGHT_COLORS)]), Paint(BRIGHT_COLORS[k % len(BRIGHT_COLORS)])
                ),
                -w / 2 + w * (k + 0.5) / count,
                0.0,
            )
            for k in range(count)
        )
    if look.kind == "pencil":
        return _stick(r, d, look.tint(Paint(shine=0.3), ("#e0b03a", "#c8463c", "#4f9a5c")), Paint("#e2c79b"))
    body = look.tint(Paint(shine=0.5), ("#2f4a86", "#26282c", "#a8342e"))
    clip = box((0, r * 2, d * 0.36), (0.003, 0.003, d * 0.22), CHROME)
    return _stick(r, d, body, CHROME) + clip


def _stick(r: float, d: float, body: Paint, tip: Paint) -> Mesh:
    return rod((0, r, d / 2), (0, r, -d * 0.36), r, body, sides=8) + rod(
        (0, r, -d * 0.36), (0, r, -d / 2), r, tip, r * 0.12, 8
    )


def scissors(look: Look) -> Mesh:
    """Scissors lying along z, a little open."""
    w, h, d = look.size
    grip = Paint(look.color or look.pick(("#c8463c", "#26282c", "#3f77b5"), "grip"), shine=0.4)
    halves = []
    for s in (-1, 1):
        blade = box((0, h * 0.5, -d * 0.26), (w * 0.16, h * 0.4, d * 0.5), STEEL)
        ring = shift(
            lathe([(w * 0.16, 0), (w * 0.26, 0), (w * 0.26, h * 0.9), (w * 0.16, h * 0.9), (w * 0.16, 0)], grip, 14),
            s * w * 0.22,
            0,
            d * 0.34,
        )
        halves.append(
            turn(
                join((blade, ring, box((s * w * 0.08, h * 0.5, d * 0.1), (w * 0.14, h * 0.5, d * 0.3), grip))),
                "y",
                -s * 9,
            )
        )
    return join([*halves, cylinder((0, h * 0.3, 0), w * 0.07, h * 0.6, CHROME, sides=8)])


def keys(look: Look) -> Mesh:
    """Keys on a ring."""
    w, h, d = look.size
    ring = shift(
        lathe([(w * 0.14, 0), (w * 0.18, 0), (w * 0.18, h * 0.4), (w * 0.14, h * 0.4), (w * 0.14, 0)], CHROME, 14),
        w * 0.3,
    )
    found = []
    for k, paint in enumerate((BRASS, STEEL, BRASS)):
        bow = cylinder((-w * 0.02, h * 0.2, 0), d * 0.2, h * 0.3, paint, sides=12)
        blade = box((-w * 0.26, h * 0.35, 0), (w * 0.44, h * 0.3, d * 0.1), paint)
        teeth = box((-w * 0.4, h * 0.35, d * 0.08), (w * 0.05, h * 0.3, d * 0.12), paint)
        found.append(turn(join((bow, blade, teeth)), "y", (k - 1) * 28, (w * 0.3, 0, 0)))
    return join([ring, *found])


def tape(look: Look) -> Mesh:
    """A roll of tape lying flat."""
    w, h, d = look.size
    r = min(w, d) / 2
    return lathe(
        [(r * 0.6, 0), (r, 0), (r, 0), (r, h), (r, h), (r * 0.62, h)], Paint(look.color or "#d9b36a", shine=0.5), 22
    ) + lathe([(r * 0.62, h), (r * 0.6, 0)], Paint("#e9e4d6"), 18)


def coin(look: Look) -> Mesh:
    """A few coins."""
    w, h, d = look.size
    r = min(w, d) * 0.3
    return join(
        cylinder((x * w, y * h, z * d), r, h * 0.45, paint, sides=16)
        for x, y, z, paint in ((-0.2, 0, -0.15, BRASS), (0.2, 0, 0.1, STEEL), (-0.02, 0.5, 0.05, BRASS))
    )


def folder(look: Look) -> Mesh:
    """A folder with papers sticking out, or a ring binder."""
    w, h, d = look.size
    paint = look.tint(Paint(), ("#d9b36a", "#7fa3c4", "#c98a7a", "#9fb58a"))
    papers = block(-w * 0.46, w * 0.46, h * 0.2, h * 0.8, -d * 0.5, d * 0.4, PAPER)
    tab = block(w * 0.1, w * 0.42, h * 0.7, h * 0.95, -d * 0.5, -d * 0.42, paint)
    return join(
        (
            block(-w / 2, w / 2, 0, h * 0.2, -d * 0.44, d / 2, paint),
            papers,
            block(-w / 2, w / 2, h * 0.8, h, -d * 0.42, d / 2, paint),
            tab,
            panel((0, h + 0.001, d * 0.05), w * 0.5, d * 0.2, Paint("#ffffff", "label"), "+y"),
        )
    )


def disc(look: Look) -> Mesh:
    """A compact disc in its case."""
    w, h, d = look.size
    r = min(w, d) * 0.44
    case_ = block(-w / 2, w / 2, 0, h * 0.6, -d / 2, d / 2, DARK)
    rings = [
        cylinder((0, h * 0.6 + k * h * 0.1, 0), r * s, h * 0.1, paint, sides=22)
        for k, (s, paint) in enumerate(
            ((1.0, Paint("#c9d6e4", shine=1.0)), (0.4, Paint("#e6c9d8", shine=1.0)), (0.14, DARK))
        )
    ]
    return join([case_, *rings])


RECIPES = {
    "book": Recipe(book, (0.17, 0.035, 0.24), states=("OPEN",)),
    "magazine": Recipe(magazine, (0.26, 0.015, 0.34), kinds=("", "news")),
    "sheet": Recipe(sheet, (0.21, 0.01, 0.3), kinds=("", "envelope", "money", "pad", "drawing", "cards", "card")),
    "pen": Recipe(pen, (0.014, 0.012, 0.15), kinds=("", "pencil", "crayons")),
    "scissors": Recipe(scissors, (0.09, 0.012, 0.2)),
    "keys": Recipe(keys, (0.1, 0.02, 0.07)),
    "tape": Recipe(tape, (0.1, 0.03, 0.1)),
    "coin": Recipe(coin, (0.06, 0.008, 0.05)),
    "folder": Recipe(folder, (0.25, 0.03, 0.33)),
    "disc": Recipe(disc, (0.13, 0.012, 0.13)),
}
