"""What stands in bathrooms, and what one washes with."""

from __future__ import annotations

import numpy as np

from hearth.rendering.meshes.joinery import top_board
from hearth.rendering.meshes.look import Look, Recipe, Region, over
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import (
    CERAMIC,
    CHROME,
    DARK,
    ENAMEL,
    STEEL,
    WHITE,
    Paint,
)
from hearth.rendering.meshes.shapes import arc, block, box, cushion, cylinder, lathe, panel, quads, rod, tube
from hearth.rendering.meshes.storage import bottom

WATER = Paint("#7fb6cf", "water", 2.0, shine=0.9)


def toilet(look: Look) -> Mesh:
    """A toilet: bowl, seat with lid up when open, tank."""
    w, h, d = look.size
    seat = look.seat(0.42, 0.6)
    tank = cushion((0, (seat + h) / 2 - 0.02, -d / 2 + 0.1), (w, h - seat, 0.2), CERAMIC, 0.25, 3)
    lid = block(-w / 2, w / 2, h - 0.025, h, -d / 2, -d / 2 + 0.21, CERAMIC)
    button = cylinder((0, h - 0.004, -d / 2 + 0.1), 0.025, 0.006, CHROME, sides=12)
    reach = d - 0.2
    bowl = lathe(
        [
            (0.0, 0),
            (0.3, 0),
            (0.26, 0.1),
            (0.36, seat * 0.55),
            (0.5, seat - 0.04),
            (0.5, seat - 0.02),
            (0.4, seat - 0.02),
            (0.25, seat - 0.16),
            (0, seat - 0.18),
        ],
        CERAMIC,
        24,
    )
    bowl = shift(stretch(bowl, x=w * 0.96, z=reach), z=0.1)
    ring = shift(
        stretch(lathe([(0.5, 0), (0.5, 0.02), (0.34, 0.02), (0.34, 0.0)], WHITE, 24), x=w * 0.98, z=reach),
        0,
        seat - 0.02,
        0.1,
    )
    pool = shift(stretch(lathe([(0.3, 0), (0, 0.001)], WATER, 16), x=w, z=reach), 0, seat - 0.14, 0.1)
    cover = shift(
        stretch(lathe([(0, 0), (0.5, 0), (0.5, 0.015), (0, 0.02)], WHITE, 24), x=w * 0.96, z=reach), 0, seat, 0.1
    )
    cover = turn(cover, "x", -95 * look.open, (0, seat, -d / 2 + 0.23)) if look.open else cover
    foot = block(-w * 0.2, w * 0.2, 0, seat * 0.7, -d / 2 + 0.05, 0.0, CERAMIC)
    return join((tank, lid, button, bowl, ring, pool, cover, foot))


def bathtub(look: Look) -> Mesh:
    """A bathtub: apron, rim, basin, tap."""
    w, h, d = look.size
    rim, t = 0.07, 0.5
    long_ = w >= d
    a, b = (w, d) if long_ else (d, w)
    apron = join((
        block(-a / 2, a / 2, 0, h - 0.03, -b / 2, -b / 2 + 0.03, ENAMEL),
        block(-a / 2, a / 2, 0, h - 0.03, b / 2 - 0.03, b / 2, ENAMEL),
        block(-a / 2, -a / 2 + 0.03, 0, h - 0.03, -b / 2 + 0.03, b / 2 - 0.03, ENAMEL),
        block(a / 2 - 0.03, a / 2, 0, h - 0.03, -b / 2 + 0.03, b / 2 - 0.03, ENAMEL),
    ))  # fmt: skip
    x, z = a / 2 - rim, b / 2 - rim
    top_ = top_board(a, b, h - 0.03, h, ENAMEL, (-x, x, -z, z))
    walls = _basin(x, z, h - 0.03, h * 0.22, ENAMEL, t)
    tap = shift(_spout(0.16, 0.14), -a / 2 + rim / 2 + 0.02, h, 0)
    whole = join([apron, top_, walls, tap])
    return whole if long_ else turn(whole, "y", 90)


def _basin(x: float, z: float, y1: float, y0: float, paint: Paint, taper: float) -> Mesh:
    """Sloping inner walls and a floor, seen from above."""
    slope = (y1 - y0) * taper * 0.3
    a, b = x - slope, z - slope
    up = [(-x, y1, -z), (x, y1, -z), (x, y1, z), (-x, y1, z)]
    low = [(-a, y0, -b), (a, y0, -b), (a, y0, b), (-a, y0, b)]
    faces = [(up[k], low[k], low[(k + 1) % 4], up[(k + 1) % 4]) for k in range(4)] + [(low[3], low[2], low[1], low[0])]
    return quads(np.array(faces, np.float32)[:, ::-1], paint)


def _spout(reach: float, height: float) -> Mesh:
    """A tap: column, arching spout towards +x, lever."""
    neck = tube(
        [
            (0, 0, 0),
            (0, height * 0.7, 0),
            *[(reach / 2 - x, y, 0) for x, y, _ in arc((0, height * 0.7, 0), reach / 2, 0, 180, steps=6)],
            (reach, height * 0.55, 0),
        ],
        0.013,
        CHROME,
        8,
    )
    lever = rod((0, height * 0.72, 0), (-0.02, height * 0.9, 0.05), 0.008, CHROME, sides=6)
    return join((neck, lever, cylinder((0, 0, 0), 0.024, 0.02, CHROME, sides=12)))


def sink(look: Look) -> Mesh:
    """A basin with a rim at the top of its box, and a drain; on a pedestal where it is tall."""
    w, h, d = look.size
    tall = h > 0.5
    depth = 0.16 if tall else h * 0.85
    paint = CERAMIC if look.kind != "steel" else STEEL
    rim = 0.035
    x, z = w / 2 - rim, d / 2 - rim
    board = top_board(w, d, h - 0.02, h, paint, (-x, x, -z + 0.03, z))
    bowl = shift(_basin(x, z - 0.015, h - 0.005, h - depth, paint, 0.8), z=0.015)
    outer = shift(_basin_outside(w, d, h, depth, paint), z=0)
    drain = shift(cylinder((0, 0, 0), 0.025, 0.004, DARK, sides=12), 0, h - depth + 0.001, 0.02)
    water = [block(-x * 0.9, x * 0.9, h - depth * 0.45, h - depth * 0.44, -z * 0.85, z * 0.9, WATER)] if look.on else []
    post = [cylinder((0, 0, -d * 0.05), w * 0.14, h - depth, paint, w * 0.17)] if tall else []
    return join([board, bowl, outer, drain, *water, *post])


def _basin_outside(w: float, d: float, h: float, depth: float, paint: Paint) -> Mesh:
    return join((
        block(-w / 2, -w / 2 + 0.012, h - depth, h - 0.02, -d / 2, d / 2, paint),
        block(w / 2 - 0.012, w / 2, h - depth, h - 0.02, -d / 2, d / 2, paint),
        block(-w / 2, w / 2, h - depth, h - 0.02, d / 2 - 0.012, d / 2, paint),
        block(-w / 2, w / 2, h - depth, h - 0.02, -d / 2, -d / 2 + 0.012, paint),
        block(-w / 2, w / 2, h - depth - 0.012, h - depth, -d / 2, d / 2, paint),
    ))  # fmt: skip


def faucet(look: Look) -> Mesh:
    """A tap whose spout reaches towards +z; a jet of water when on."""
    _, h, d = look.size
    tap = shift(turn(_spout(d * 0.7, h), "y", -90), z=-d / 2 + 0.025)
    tap = stretch(tap, y=0.98)
    jet = [cylinder((0, -0.08, d * 0.2 + 0.025), 0.006, h * 0.55 + 0.08, WATER, sides=6)] if look.on else []
    return join([tap, *jet])


def shower(look: Look) -> Mesh:
    """A shower: tray, glass walls with a steel frame, head on its pipe; rain when on."""
    w, h, d = look.size
    tray = top_board(w, d, 0, 0.1, ENAMEL, (-w / 2 + 0.06, w / 2 - 0.06, -d / 2 + 0.06, d / 2 - 0.06)) + block(
        -w / 2 + 0.06, w / 2 - 0.06, 0, 0.04, -d / 2 + 0.06, d / 2 - 0.06, ENAMEL.tinted("#dfe3e4")
    )
    t = 0.02
    posts = [
        block(x - t, x + t, 0.1, h, z - t, z + t, STEEL)
        for x in (-w / 2 + t, w / 2 - t)
        for z in (-d / 2 + t, d / 2 - t)
    ]
    bars = [block(-w / 2, w / 2, h - 0.03, h, z - t, z + t, STEEL) for z in (-d / 2 + t, d / 2 - t)]
    bars += [block(x - t, x + t, h - 0.03, h, -d / 2, d / 2, STEEL) for x in (-w / 2 + t, w / 2 - t)]
    tiles = Paint("#cfdfe2", "tiles_small", 2.5, shine=0.4)
    walls = block(-w / 2, w / 2, 0.1, h, -d / 2, -d / 2 + 0.01, tiles)
    half = [
        block(x, x + 0.01, 0.1, h * 0.5, -d / 2, d / 2 - t, Paint("#c5dfe4", shine=0.9))
        for x in (-w / 2 + t, w / 2 - t - 0.01)
    ]
    pipe = tube(
        [
            (0, 0.9, -d / 2 + 0.03),
            (0, h * 0.93, -d / 2 + 0.03),
            (0, h * 0.96, -d / 2 + 0.16),
            (0, h * 0.92, -d / 2 + 0.26),
        ],
        0.012,
        CHROME,
        8,
    )
    head = shift(
        turn(lathe([(0.02, 0.05), (0.09, 0.02), (0.09, 0.0), (0, 0)][::-1], CHROME, 16), "x", 15),
        0,
        h * 0.89,
        -d / 2 + 0.27,
    )
    mixer = box((0, 1.0, -d / 2 + 0.04), (0.16, 0.05, 0.05), CHROME)
    rain = (
        [
            rod(
                (0.03 * i, 0.05, -d / 2 + 0.28 + 0.03 * k),
                (0.025 * i, h * 0.88, -d / 2 + 0.27 + 0.025 * k),
                0.003,
                WATER,
                sides=4,
            )
            for i in (-2, -1, 0, 1, 2)
            for k in (-1, 0, 1)
        ]
        if look.on
        else []
    )
    return join([tray, *posts, *bars, walls, *half, pipe, head, mixer, *rain])


def mirror(look: Look) -> Mesh:
    """A framed mirror on the wall, or a standing one where it is tall and deep."""
    w, h, d = look.size
    frame = Paint(look.pick(("#8a6a4a", "#d8d5cc", "#3a3b3e"), "frame"), "wood_fine", shine=0.2)
    glass = Paint("#b3cdd6", shine=1.0)
    t = min(d, 0.03)
    plate = block(-w / 2, w / 2, 0 if d < 0.1 else 0.08, h, -t / 2, t / 2, frame)
    low = 0.03 if d < 0.1 else 0.11
    face = panel((0, (low + h - 0.03) / 2, t / 2 + 0.001), w - 0.06, h - low - 0.03, glass)
    streaks = [
        turn(
            panel((k * w * 0.12, h * 0.6, t / 2 + 0.002), 0.02 * (2 - k), h * 0.4, Paint("#dcebf0", shine=1.0)),
            "z",
            -30,
            (0, h * 0.6, 0),
        )
        for k in (0, 1)
    ]
    if d < 0.1:
        return join([plate, face, *streaks])
    whole = turn(join([plate, face, *streaks]), "x", -4)
    stand = [rod((s * w * 0.4, 0.01, d * 0.46), (s * w * 0.4, h * 0.1, 0), 0.016, frame, sides=6) for s in (-1, 1)] + [
        rod((s * w * 0.4, 0.01, -d * 0.46), (s * w * 0.4, h * 0.6, -0.03), 0.014, frame, sides=6) for s in (-1, 1)
    ]
    return join([whole, *stand])


def shower_region(look: Look) -> tuple[Region, ...]:
    """The tray."""
    return (over(look, 0.04, 0.15),)


def tub_region(look: Look) -> tuple[Region, ...]:
    """The floor of the tub."""
    return (over(look, look.size[1] * 0.23, 0.2),)


def basin_region(look: Look) -> tuple[Region, ...]:
    """The bottom of a basin."""
    h = look.size[1]
    return (over(look, h - (0.15 if h > 0.5 else h * 0.84), 0.09),)


def toilet_region(look: Look) -> tuple[Region, ...]:
    """The lid."""
    w, _, d = look.size
    return (Region(look.seat(0.42, 0.6) + 0.02, -w * 0.3, w * 0.3, -d * 0.1, d * 0.35),)


RECIPES = {
    "toilet": Recipe(toilet, (0.4, 0.78, 0.66), 1, toilet_region, bottom, states=("OPEN",)),
    "bathtub": Recipe(bathtub, (1.7, 0.58, 0.75), 1, tub_region, tub_region),
    "sink": Recipe(sink, (0.5, 0.85, 0.42), 1, basin_region, basin_region, ("", "steel")),
    "faucet": Recipe(faucet, (0.06, 0.24, 0.16), states=("ON",)),
    "shower": Recipe(shower, (0.95, 2.1, 0.95), 1, shower_region, shower_region, states=("ON",)),
    "mirror": Recipe(mirror, (0.6, 0.8, 0.03)),
}
