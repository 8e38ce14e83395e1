"""Clothes, lying as they are put down, and what is carried."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import CHROME, DARK, GLASS, OAK, Paint
from hearth.rendering.meshes.shapes import Point, ball, block, cushion, cylinder, lathe, prism, rod, tube

CLOTHES_COLORS = ("#4a6f9a", "#b5564a", "#5f8a5a", "#d8b04a", "#7a5f92", "#e4e0d6", "#3d4656")

SHIRT = (
    (-0.2, -0.5),
    (0.2, -0.5),
    (0.22, 0.12),
    (0.42, -0.08),
    (0.5, 0.12),
    (0.26, 0.46),
    (0.1, 0.5),
    (0.0, 0.42),
    (-0.1, 0.5),
    (-0.26, 0.46),
    (-0.5, 0.12),
    (-0.42, -0.08),
    (-0.22, 0.12),
)
PANTS = ((-0.34, -0.5), (-0.06, -0.5), (0.0, 0.16), (0.06, -0.5), (0.34, -0.5), (0.3, 0.5), (-0.3, 0.5))
DRESS = (
    (-0.5, -0.5),
    (0.5, -0.5),
    (0.18, 0.1),
    (0.26, 0.34),
    (0.14, 0.5),
    (0.06, 0.5),
    (0.0, 0.36),
    (-0.06, 0.5),
    (-0.14, 0.5),
    (-0.26, 0.34),
    (-0.18, 0.1),
)
SKIRT = ((-0.5, -0.5), (0.5, -0.5), (0.26, 0.5), (-0.26, 0.5))
UNDERWEAR = ((-0.12, -0.5), (0.12, -0.5), (0.5, 0.2), (0.48, 0.5), (-0.48, 0.5), (-0.5, 0.2))
SOCK = ((-0.5, -0.5), (0.1, -0.5), (0.2, -0.28), (-0.1, -0.1), (-0.12, 0.5), (-0.5, 0.5))
GLOVE = (
    (-0.3, -0.5),
    (0.14, -0.5),
    (0.16, -0.1),
    (0.44, 0.0),
    (0.5, 0.14),
    (0.18, 0.14),
    (0.2, 0.5),
    (-0.4, 0.5),
    (-0.34, 0.0),
)
MITT = (
    (-0.3, -0.5),
    (0.3, -0.5),
    (0.3, -0.05),
    (0.5, 0.1),
    (0.42, 0.24),
    (0.28, 0.16),
    (0.22, 0.42),
    (0.0, 0.5),
    (-0.24, 0.42),
    (-0.34, 0.1),
)

CUTS = {
    "shirt": SHIRT,
    "pants": PANTS,
    "dress": DRESS,
    "skirt": SKIRT,
    "underwear": UNDERWEAR,
    "jacket": SHIRT,
    "mitts": MITT,
}
Points = tuple[tuple[float, float], ...]


def garment(look: Look) -> Mesh:
    """A garment spread out flat, collar away from the viewer: shirt, jacket, pants, dress, skirt, underwear."""
    w, h, d = look.size
    cut = CUTS.get(look.kind, SHIRT)
    thick = min(h, 0.035)
    paint = look.tint(
        Paint(
            "#ffffff",
            look.pick(("fabric", "stripes", "checks"), "weave") if look.kind in ("shirt", "dress", "") else "fabric",
            5.0,
        ),
        CLOTHES_COLORS,
    )
    body = _flat(cut, w, d, thick, paint)
    if look.kind == "jacket":
        zip_ = block(-0.006, 0.006, thick, thick + 0.003, -d * 0.42, d * 0.5, CHROME)
        lapels = [
            _flat(
                ((s * 0.02, 0.0), (s * 0.16, 0.3), (s * 0.1, 0.5), (0.0, 0.34))[::s],
                w,
                d,
                thick + 0.008,
                paint.tinted("#2c3038"),
            )
            for s in (1, -1)
        ]
        return join([body, zip_, *lapels])
    if look.kind in ("shirt", ""):
        buttons = [
            cylinder((0, thick, z * d), 0.008, 0.003, Paint("#f4f1e8"), sides=8) for z in (-0.25, -0.05, 0.15, 0.35)
        ]
        return join([body, *buttons])
    if look.kind == "pants":
        return body + block(-w * 0.3, w * 0.3, thick, thick + 0.004, -d * 0.5, -d * 0.43, Paint("#4a3526"))
    return body


def _flat(cut: Points, w: float, d: float, thick: float, paint: Paint) -> Mesh:
    """An outline of unit size laid on the ground, its top towards -z."""
    return shift(turn(prism([(x * w, y * d) for x, y in cut], thick, paint), "x", -90), y=thick / 2)


def pair(look: Look) -> Mesh:
    """A pair of socks or gloves, side by side."""
    w, h, d = look.size
    paint = look.tint(Paint("#ffffff", "stripes" if look.kind == "socks" else "fabric", 8.0), CLOTHES_COLORS)
    cut = SOCK if look.kind == "socks" else GLOVE
    one = _flat(cut, w * 0.46, d, min(h, 0.02), paint)
    other = one if look.kind == "socks" else stretch(one, x=-1.0)
    return shift(one, w * 0.25) + shift(other, -w * 0.25)


def shoes(look: Look) -> Mesh:
    """A pair of shoes or slippers, toes towards +z."""
    w, h, d = look.size
    soft = look.kind == "slippers"
    paint = look.tint(
        Paint("#ffffff", "carpet" if soft else "leather", 5.0, shine=0.0 if soft else 0.3),
        ("#8a9fb8", "#c58f8f", "#9a8fb8") if soft else ("#3a2a22", "#26282c", "#7a4a2a", "#e4e0d6"),
    )
    width = w * 0.42
    sole = cushion((0, h * 0.1, 0), (width, h * 0.2, d), Paint("#e6e0d2" if not soft else "#b8a890"), 0.6, 4)
    toe = cushion((0, h * 0.4, d * 0.2), (width * 0.96, h * 0.62, d * 0.58), paint, 0.9)
    heel = [] if soft else [cushion((0, h * 0.55, -d * 0.24), (width * 0.86, h * 0.86, d * 0.46), paint, 0.6)]
    hole = [lathe([(width * 0.3, h * 0.97), (0, h * 0.975)], DARK, 10)] if not soft else []
    one = join([sole, toe, *heel, *(shift(m, z=-d * 0.22) for m in hole)])
    laces = (
        []
        if soft
        else [
            block(-width * 0.3, width * 0.3, h * 0.66, h * 0.7, z * d, z * d + 0.008, Paint("#f0ece2"))
            for z in (-0.02, 0.06, 0.14)
        ]
    )
    one = join([one, *laces])
    return shift(one, w * 0.27) + shift(one, -w * 0.27)


def hat(look: Look) -> Mesh:
    """A brimmed hat with a ribbon."""
    w, h, d = look.size
    paint = look.tint(Paint("#ffffff", "wicker", 6.0), ("#d8b878", "#6b5a4a", "#4a5a6a"))
    body = lathe([(0.3, 0.02), (0.5, 0.0), (0.5, 0.06), (0.3, 0.12), (0.28, 0.8), (0.2, 1.0), (0, 0.95)], paint, 22)
    ribbon = lathe([(0.31, 0.12), (0.3, 0.34)], Paint("#8a2f2c"), 22)
    return stretch(body + ribbon, w, h, d)


def scarf(look: Look) -> Mesh:
    """A scarf folded once, with fringes."""
    w, h, d = look.size
    paint = look.tint(Paint("#ffffff", "stripes", 7.0), CLOTHES_COLORS)
    parts = [
        cushion((0, h * 0.3, 0), (w, h * 0.55, d * 0.5), paint, 0.7, 4),
        turn(cushion((w * 0.1, h * 0.65, 0), (w * 0.8, h * 0.5, d * 0.42), paint, 0.7, 4), "y", 18),
    ]
    fringe = [
        rod(
            (w * 0.48, h * 0.1, -d * 0.24 + k * d * 0.08),
            (w * 0.5, 0.004, -d * 0.26 + k * d * 0.085),
            0.004,
            paint,
            sides=4,
        )
        for k in range(7)
    ]
    return join([*parts, *fringe])


def folded(look: Look) -> Mesh:
    """A folded stack of cloth: sheets, blanket, pyjamas."""
    w, h, d = look.size
    paint = look.tint(
        Paint("#ffffff", look.pick(("fabric", "checks", "stripes"), "weave"), 4.0),
        ("#6f92bd", "#b56a5c", "#7f9c78", "#d9c9a3", "#8d7fa8", "#e4e0d6"),
    )
    count = max(2, min(4, round(h / 0.03)))
    step = h / count
    return join(
        cushion((0.004 * (k % 2), step * (k + 0.5), 0.003 * (k % 3)), (w * 0.98, step * 1.05, d * 0.97), paint, 0.9, 4)
        for k in range(count)
    )


def hanger(look: Look) -> Mesh:
    """A clothes hanger in the plane of x."""
    w, h, d = look.size
    r = min(0.012, d / 2)
    hook: list[Point] = [
        (0, h * 0.55, 0),
        (0, h * 0.72, 0),
        (0.022, h * 0.84, 0),
        (0.0, h * 0.97, 0),
        (-0.024, h * 0.88, 0),
    ]
    wood = tube([(-w / 2 + r, r * 2, 0), (0, h * 0.55, 0), (w / 2 - r, r * 2, 0)], r, OAK, 6)
    return join(
        (wood, rod((-w / 2 + r, r * 2, 0), (w / 2 - r, r * 2, 0), r * 0.6, OAK, sides=6), tube(hook, 0.004, CHROME, 5))
    )


def spectacles(look: Look) -> Mesh:
    """Spectacles, folded open, lenses towards +z."""
    w, h, d = look.size
    rims = []
    for s in (-1, 1):
        ring = shift(
            turn(
                lathe(
                    [(h * 0.36, -0.002), (h * 0.48, -0.002), (h * 0.48, 0.003), (h * 0.36, 0.003), (h * 0.36, -0.002)],
                    DARK,
                    14,
                ),
                "x",
                90,
            ),
            s * w * 0.26,
            h / 2,
            d * 0.4,
        )
        lens = shift(turn(cylinder((0, 0, 0), h * 0.38, 0.001, GLASS, sides=14), "x", 90), s * w * 0.26, h / 2, d * 0.4)
        rims.append(
            join(
                (
                    stretch(ring, x=1.0),
                    lens,
                    rod((s * w * 0.48, h * 0.6, d * 0.4), (s * w * 0.46, h * 0.5, -d * 0.48), 0.003, DARK, sides=5),
                )
            )
        )
    bridge = rod((-w * 0.1, h * 0.6, d * 0.4), (w * 0.1, h * 0.6, d * 0.4), 0.003, DARK, sides=5)
    return join([*rims, bridge])


def pillow(look: Look) -> Mesh:
    """A pillow."""
    w, h, d = look.size
    paint = look.tint(Paint("#ffffff", "fabric", 5.0), ("#efece4", "#c9d3dc", "#d8b04a", "#b5766a", "#8fa38a"))
    return cushion((0, h / 2, 0), (w, h, d), paint, 0.97, 6)


def wool(look: Look) -> Mesh:
    """A reel of thread with a needle."""
    w, h, d = look.size
    r = min(w, d) / 2
    reel = cylinder((0, 0, 0), r, h * 0.12, OAK) + cylinder((0, h * 0.88, 0), r, h * 0.12, OAK)
    return (
        reel
        + cylinder((0, h * 0.1, 0), r * 0.8, h * 0.8, look.tint(Paint("#ffffff", "brushed", 20.0), CLOTHES_COLORS))
        + ball((0, h * 1.0, 0), 0.002, CHROME, 2)
    )


RECIPES = {
    "garment": Recipe(
        garment, (0.5, 0.04, 0.5), kinds=("shirt", "pants", "dress", "skirt", "jacket", "underwear", "mitts")
    ),
    "pair": Recipe(pair, (0.22, 0.03, 0.22), kinds=("socks", "gloves")),
    "shoes": Recipe(shoes, (0.22, 0.12, 0.28), kinds=("", "slippers")),
    "hat": Recipe(hat, (0.3, 0.15, 0.3)),
    "scarf": Recipe(scarf, (0.3, 0.06, 0.18)),
    "folded": Recipe(folded, (0.4, 0.1, 0.32)),
    "hanger": Recipe(hanger, (0.42, 0.22, 0.03)),
    "spectacles": Recipe(spectacles, (0.14, 0.045, 0.14)),
    "pillow": Recipe(pillow, (0.5, 0.15, 0.36)),
    "thread": Recipe(wool, (0.05, 0.06, 0.05)),
}
