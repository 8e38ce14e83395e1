"""What one cooks in, eats from and drinks from."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe, Region, nowhere, top
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import (
    BLACK,
    BRIGHT_COLORS,
    CERAMIC,
    DARK,
    GLASS,
    IRON,
    SOFT_COLORS,
    STEEL,
    WHITE,
    Paint,
)
from hearth.rendering.meshes.shapes import block, box, cushion, cylinder, lathe, panel, prism, rod, tube
from hearth.rendering.meshes.storage import bottom

GLAZES = (*SOFT_COLORS, "#b8433a", "#3f6f95", "#e0b04a", "#6a8f6a")


def liquid(look: Look) -> Mesh:
    """The surface of what is poured into a vessel."""
    w, h, d = look.size
    surface = Paint(look.color or look.kind or "#a9d2e6", shine=0.85)
    return stretch(lathe([(0.5, 0), (0.5, h), (0, h)], surface, 18), x=w, z=d)


def mug(look: Look) -> Mesh:
    """A mug with its handle towards +x; a coffee cup stands on a saucer."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.6), GLAZES)
    r = min(d / 2, w * 0.38)
    saucer = look.kind == "cup"
    low = h * 0.12 if saucer else 0.0
    wide = 0.62 if saucer else 0.94
    profile = [
        (0, low),
        (r * wide, low),
        (r * wide, low),
        (r * (0.98 if saucer else 0.96), h * 0.5),
        (r, h),
        (r * 0.92, h),
        (r * 0.86, h * 0.5),
        (r * wide * 0.85, low + 0.008),
        (0, low + 0.008),
    ]
    body = lathe(profile, paint, 18)
    grip = tube(
        [
            (r * 0.9, h * 0.86, 0),
            (r * 1.4, h * 0.8, 0),
            (r * 1.5, h * 0.55, 0),
            (r * 1.25, h * 0.34, 0),
            (r * 0.85, h * 0.3, 0),
        ],
        min(0.008, h * 0.08),
        paint,
        8,
    )
    dish = (
        [
            lathe(
                [
                    (0, 0),
                    (r * 0.7, 0),
                    (min(d / 2, r * 1.4), low * 0.9),
                    (min(d / 2, r * 1.35), low),
                    (r * 0.6, low * 0.5),
                    (0, low * 0.5),
                ],
                paint,
                18,
            )
        ]
        if saucer
        else []
    )
    return shift(join([body, grip, *dish]), -r * 0.25 if not saucer else 0)


def glass(look: Look) -> Mesh:
    """A tumbler, or a stemmed wine glass."""
    w, h, d = look.size
    r = min(w, d) / 2
    pale = GLASS.tinted(look.color)
    if look.kind == "wine":
        profile = [
            (0, 0),
            (r * 0.85, 0.004),
            (r * 0.2, 0.012),
            (r * 0.09, h * 0.08),
            (r * 0.09, h * 0.44),
            (r * 0.7, h * 0.56),
            (r, h * 0.74),
            (r * 0.82, h),
            (r * 0.78, h),
            (r * 0.9, h * 0.74),
            (0, h * 0.55),
        ]
        return join([lathe(profile, pale, 18)])
    profile = [(0, 0), (r * 0.74, 0), (r * 0.74, 0), (r, h), (r * 0.94, h), (r * 0.7, 0.012), (0, 0.012)]
    return join([lathe(profile, pale, 18)])


def bowl(look: Look) -> Mesh:
    """A bowl; a sieve when it is a colander."""
    w, h, d = look.size
    sieve = look.kind == "colander"
    paint = STEEL if sieve else look.tint(Paint(shine=0.6), GLAZES)
    if sieve:
        paint = Paint("#b9bcc0", "dots", 20.0, shine=0.6)
    r = min(w, d) / 2
    body = lathe(
        [
            (0, 0),
            (r * 0.45, 0),
            (r * 0.42, h * 0.08),
            (r * 0.78, h * 0.45),
            (r, h),
            (r * 0.94, h),
            (r * 0.72, h * 0.5),
            (r * 0.35, h * 0.16),
            (0, h * 0.14),
        ],
        paint,
        22,
    )
    grips = [box((s * r * 0.98, h * 0.9, 0), (r * 0.16, h * 0.1, r * 0.4), STEEL) for s in (-1, 1)] if sieve else []
    return join([body, *grips])


def plate(look: Look) -> Mesh:
    """A plate with a rim and a ring of colour."""
    w, h, d = look.size
    r = min(w, d) / 2
    ring = Paint(look.pick(("#3f6f95", "#b8433a", "#6a8f6a", "#d8c9a3"), "ring"), shine=0.5)
    base = CERAMIC.tinted(look.color)
    return join((
        lathe([(0, 0), (r * 0.6, 0), (r * 0.95, h * 0.75)], base, 24),
        lathe([(r * 0.95, h * 0.75), (r, h), (r * 0.94, h * 0.98)], ring, 24),
        lathe([(r * 0.94, h * 0.98), (r * 0.62, h * 0.42), (0, h * 0.4)], base, 24),
    ))  # fmt: skip


def pot(look: Look) -> Mesh:
    """A cooking pot with two handles, and a lid unless it is open."""
    w, h, d = look.size
    steel = look.tint(STEEL, ("#b9bcc0", "#a8342e", "#3a4a55"))
    r = min(w * 0.4, d / 2)
    body = lathe(
        [
            (0, 0),
            (r * 0.96, 0),
            (r, h * 0.05),
            (r, h * 0.8),
            (r * 1.02, h * 0.82),
            (r * 0.96, h * 0.82),
            (r * 0.94, 0.012),
            (0, 0.012),
        ],
        steel,
        22,
    )
    lid = [
        lathe([(r * 1.0, h * 0.82), (r * 0.9, h * 0.87), (0, h * 0.92)], steel, 22),
        cylinder((0, h * 0.9, 0), r * 0.12, h * 0.1, DARK, sides=10),
    ]
    z = r * 0.25
    grips = [
        tube(
            [
                (s * r * 0.98, h * 0.68, -z),
                (s * (w / 2 - 0.008), h * 0.7, -z * 0.8),
                (s * (w / 2 - 0.008), h * 0.7, z * 0.8),
                (s * r * 0.98, h * 0.68, z),
            ],
            0.008,
            DARK,
            6,
        )
        for s in (-1, 1)
    ]
    return join([body, *([] if look.open else lid), *grips])


def pan(look: Look) -> Mesh:
    """A frying pan with its handle towards +z."""
    w, h, d = look.size
    r = w / 2
    rim = h * 0.75
    body = lathe(
        [(0, 0), (r * 0.78, 0), (r, rim), (r * 0.95, rim), (r * 0.75, h * 0.2), (0, h * 0.2)],
        IRON.tinted(look.color),
        24,
    )
    grip = rod((0, rim * 0.9, r * 0.95), (0, h * 0.9, d - r - 0.005), h * 0.16, BLACK, h * 0.2, 8)
    return shift(body + grip, z=-d / 2 + r)


def coffee_pot(look: Look) -> Mesh:
    """A pot with spout and handle: coffee, tea, watering."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.6), ("#d8d5cc", "#3f6f95", "#b9bcc0", "#a8423a"))
    r = min(w * 0.3, d / 2)
    body = lathe(
        [
            (0, 0),
            (r * 0.8, 0),
            (r, h * 0.25),
            (r * 0.85, h * 0.62),
            (r * 0.45, h * 0.82),
            (r * 0.5, h * 0.86),
            (0, h * 0.92),
        ],
        paint,
        20,
    )
    spout = tube([(-r * 0.8, h * 0.3, 0), (-r * 1.25, h * 0.5, 0), (-w / 2 + 0.01, h * 0.82, 0)], r * 0.13, paint, 8)
    grip = tube(
        [(r * 0.7, h * 0.74, 0), (w / 2 - 0.012, h * 0.72, 0), (w / 2 - 0.012, h * 0.34, 0), (r * 0.9, h * 0.26, 0)],
        r * 0.11,
        paint,
        8,
    )
    return join((body, spout, grip, cushion((0, h * 0.95, 0), (r * 0.3, h * 0.1, r * 0.3), paint, 1.0, 3)))


def bottle(look: Look) -> Mesh:
    """Bottles by kind: wine, beer, water, oil, sauce; or pump and spray bottles, and cleaners with a handle."""
    return {"spray": _spray, "pump": _pump, "jug": _jug}.get(look.kind, _bottle)(look)


def _bottle(look: Look) -> Mesh:
    w, h, d = look.size
    r = min(w, d) / 2
    colors = {
        "wine": ("#2f4a33", "#3a2026"),
        "beer": ("#6b4220", "#4a5a2a"),
        "oil": ("#c9b23a",),
        "water": ("#a9d2e6",),
        "sauce": ("#a8342e", "#c98a2a"),
        "shampoo": BRIGHT_COLORS,
    }
    paint = look.tint(Paint(shine=0.85), colors.get(look.kind, ("#3f77b5", "#4f9a5c", "#c8604a", "#e0a83a")))
    neck = 0.3 if look.kind in ("wine", "beer", "oil") else 0.18
    shoulder = 1 - neck - 0.14
    body = lathe(
        [
            (0, 0),
            (r * 0.95, 0),
            (r, h * 0.03),
            (r, h * shoulder),
            (r * 0.8, h * (shoulder + 0.07)),
            (r * 0.36, h * (shoulder + 0.14)),
            (r * 0.32, h * 0.93),
            (r * 0.32, h * 0.93),
        ],
        paint,
        18,
    )
    cap = cylinder(
        (0, h * 0.92, 0),
        r * 0.38,
        h * 0.08,
        Paint(look.pick(("#c6a052", "#d8d5cc", "#26282c"), "cap"), shine=0.4),
        sides=12,
    )
    label = lathe(
        [(r * 1.01, h * 0.16), (r * 1.01, h * shoulder * 0.8)], Paint("#f0e8d2", "label", 1 / (2 * 3.14159 * r)), 18
    )
    return stretch(join((body, cap, label)), x=w / (2 * r) * 0.98, z=d / (2 * r) * 0.98)


def _spray(look: Look) -> Mesh:
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.6), ("#4fa3d8", "#6fb85c", "#e0a83a"))
    body = cushion((0, h * 0.33, 0), (w, h * 0.66, d), paint, 0.5)
    neck = cylinder((0, h * 0.62, 0), d * 0.22, h * 0.16, WHITE, sides=10)
    head = block(-w * 0.2, w * 0.2, h * 0.78, h, -d * 0.3, d * 0.45, Paint("#d8433a"))
    lever = rod((0, h * 0.8, d * 0.3), (0, h * 0.62, d * 0.42), 0.006, WHITE, sides=6)
    label = panel((0, h * 0.34, d / 2 + 0.001), w * 0.7, h * 0.34, Paint("#ffffff", "label"))
    return join((body, neck, head, lever, label))


def _pump(look: Look) -> Mesh:
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.6), ("#e9c9d3", "#bfe0d2", "#efe3c0", "#b9d2e8"))
    body = cushion((0, h * 0.36, 0), (w, h * 0.72, d), paint, 0.5)
    neck = cylinder((0, h * 0.7, 0), d * 0.16, h * 0.2, WHITE, sides=10)
    spout = box((0, h * 0.95, d * 0.18), (w * 0.22, h * 0.08, d * 0.6), WHITE)
    label = panel((0, h * 0.36, d / 2 + 0.001), w * 0.6, h * 0.3, Paint("#ffffff", "label"))
    return join((body, neck, spout, label))


def _jug(look: Look) -> Mesh:
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.5), ("#3f77b5", "#d97a3a", "#5a9a5c"))
    body = cushion((0, h * 0.4, 0), (w, h * 0.8, d), paint, 0.3)
    grip = tube([(w * 0.1, h * 0.8, 0), (w * 0.42, h * 0.84, 0), (w * 0.42, h * 0.6, 0)], 0.014, paint, 8)
    cap = cylinder((-w * 0.22, h * 0.8, 0), d * 0.26, h * 0.2, WHITE, sides=12)
    label = panel((0, h * 0.4, d / 2 + 0.001), w * 0.8, h * 0.4, Paint("#ffffff", "label"))
    return join((body, grip, cap, label))


def jar(look: Look) -> Mesh:
    """A jar with a lid and a label."""
    w, h, d = look.size
    r = min(w, d) / 2
    content = look.tint(Paint(shine=0.8), ("#a8342e", "#c98a2a", "#6b3a5a", "#8a5a2a"))
    body = lathe([(0, 0), (r * 0.95, 0), (r, h * 0.05), (r, h * 0.72), (r * 0.8, h * 0.8), (0, h * 0.8)], content, 18)
    lid = cylinder(
        (0, h * 0.8, 0), r * 0.88, h * 0.2, Paint(look.pick(("#c6a052", "#b8433a", "#d8d5cc"), "lid"), shine=0.5)
    )
    label = lathe([(r * 1.01, h * 0.2), (r * 1.01, h * 0.62)], Paint("#f5f0e0", "label", 1 / (2 * 3.14159 * r)), 18)
    return join((body, lid, label))


def packet(look: Look) -> Mesh:
    """A cardboard packet, a gabled drink carton, or a paper sack."""
    w, h, d = look.size
    paint = look.tint(Paint(shine=0.2), BRIGHT_COLORS)
    if look.kind == "carton":
        body = h * 0.78
        gable = turn(prism([(-d / 2, body), (d / 2, body), (0, h * 0.94)], w, paint.tinted("#f4f3ee")), "y", 90)
        fin = block(-w / 2, w / 2, h * 0.93, h, -0.004, 0.004, paint)
        cartoon = [
            block(-w / 2, w / 2, 0, body * 0.55, -d / 2, d / 2, paint),
            block(-w / 2, w / 2, body * 0.55, body, -d / 2, d / 2, WHITE),
        ]
        cap = shift(
            turn(cylinder((0, 0, 0), w * 0.16, 0.02, Paint("#c8463c"), sides=12), "x", 60), 0, h * 0.86, d * 0.25
        )
        return join([*cartoon, gable, fin, cap])
    if look.kind == "sack":
        return (
            cushion((0, h * 0.44, 0), (w, h * 0.88, d), paint, 0.5)
            + block(-w * 0.46, w * 0.46, h * 0.84, h, -0.006, 0.006, paint)
            + panel((0, h * 0.45, d / 2 + 0.001), w * 0.6, h * 0.4, Paint("#ffffff", "label"))
        )
    box = block(-w / 2, w / 2, 0, h, -d / 2, d / 2, paint)
    front = [
        panel((0, h * 0.5, s * (d / 2 + 0.001)), w * 0.86, h * 0.7, Paint("#ffffff", "label"), "+z" if s > 0 else "-z")
        for s in (-1, 1)
    ]
    return join([box, *front])


def can(look: Look) -> Mesh:
    """A tin or a canister."""
    w, h, d = look.size
    r = min(w, d) / 2
    body = lathe([(0, 0), (r, 0), (r, 0), (r, h * 0.96), (r, h * 0.96), (r * 0.94, h), (0, h * 0.98)], STEEL, 18)
    return body + lathe(
        [(r * 1.01, h * 0.06), (r * 1.01, h * 0.92)],
        look.tint(Paint("#ffffff", "label", 1 / (2 * 3.14159 * r)), BRIGHT_COLORS),
        18,
    )


def shaker(look: Look) -> Mesh:
    """A salt cellar."""
    w, h, d = look.size
    r = min(w, d) / 2
    return lathe([(0, 0), (r, 0), (r * 0.75, h * 0.7), (r * 0.7, h * 0.72)], GLASS.tinted("#eef2f3"), 14) + lathe(
        [(r * 0.78, h * 0.7), (r * 0.78, h * 0.84), (r * 0.5, h * 0.98), (0, h)], STEEL, 14
    )


def dish_place(look: Look) -> tuple[Region, ...]:
    """The hollow of a plate or bowl."""
    w, h, d = look.size
    return (Region(h * 0.45, -w * 0.35, w * 0.35, -d * 0.35, d * 0.35),)


RECIPES = {
    "liquid": Recipe(liquid, (0.06, 0.004, 0.06), 1, nowhere),
    "mug": Recipe(mug, (0.12, 0.1, 0.085), inside=bottom, kinds=("", "cup")),
    "glass": Recipe(glass, (0.075, 0.13, 0.075), inside=bottom, kinds=("", "wine")),
    "bowl": Recipe(bowl, (0.18, 0.08, 0.18), 1, dish_place, dish_place, ("", "colander")),
    "plate": Recipe(plate, (0.24, 0.025, 0.24), 1, dish_place, dish_place),
    "pot": Recipe(pot, (0.3, 0.18, 0.24), 1, top, bottom),
    "pan": Recipe(pan, (0.28, 0.06, 0.46), 1, dish_place, dish_place),
    "coffee_pot": Recipe(coffee_pot, (0.24, 0.2, 0.15), inside=bottom),
    "bottle": Recipe(bottle, (0.08, 0.28, 0.08), inside=bottom, kinds=("", "wine", "water", "spray", "pump", "jug")),
    "jar": Recipe(jar, (0.08, 0.11, 0.08), inside=bottom),
    "packet": Recipe(packet, (0.16, 0.24, 0.07), kinds=("", "carton", "sack")),
    "can": Recipe(can, (0.08, 0.12, 0.08)),
    "shaker": Recipe(shaker, (0.05, 0.1, 0.05)),
}
