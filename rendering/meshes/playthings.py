"""Toys, tools and vehicles."""

from __future__ import annotations

import math

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, turn
from hearth.rendering.meshes.paint import (
    BLACK,
    BRASS,
    BRIGHT_COLORS,
    CHROME,
    DARK,
    GREY,
    IRON,
    OAK,
    RUBBER,
    STEEL,
    Paint,
)
from hearth.rendering.meshes.shapes import arc, ball, box, cushion, cylinder, lathe, rod, tube


def rolling_pin(look: Look) -> Mesh:
    """A rolling pin along its longer side."""
    w, h, d = look.size
    r, long_ = h / 2, max(w, d)
    pin = rod((-long_ * 0.32, r, 0), (long_ * 0.32, r, 0), r, OAK) + join(
        rod((s * long_ * 0.3, r, 0), (s * long_ * 0.5, r, 0), r * 0.4, OAK, r * 0.5, 8) for s in (-1, 1)
    )
    return pin if w >= d else turn(pin, "y", 90)


def hammer(look: Look) -> Mesh:
    """A hammer lying along z."""
    w, h, d = look.size
    shaft = rod((0, h * 0.4, d / 2), (0, h * 0.4, -d * 0.36), min(h * 0.3, 0.016), OAK, sides=8)
    return shaft + box((0, h * 0.5, -d * 0.4), (w, h, d * 0.14), IRON)


def ladder(look: Look) -> Mesh:
    """A step ladder."""
    w, h, d = look.size
    sides = [rod((s * w * 0.48, 0, d * 0.48), (s * w * 0.36, h, -d * 0.05), 0.02, STEEL, sides=6) for s in (-1, 1)]
    props = [
        rod((s * w * 0.48, 0, -d * 0.48), (s * w * 0.36, h * 0.98, -d * 0.1), 0.014, STEEL, sides=6) for s in (-1, 1)
    ]
    count = max(3, round(h / 0.28))
    steps = [
        box(
            (0, h * (k + 1) / count - 0.02, d * (0.48 - 0.53 * (k + 1) / count)),
            (w * (0.96 - 0.24 * (k + 1) / count), 0.025, 0.09),
            GREY,
        )
        for k in range(count)
    ]
    return join([*sides, *props, *steps])


def umbrella(look: Look) -> Mesh:
    """A closed umbrella, standing where it is high, else lying along its longer side."""
    w, h, d = look.size
    long_ = max(w, h, d)
    paint = look.tint(Paint("#ffffff", "fabric", 4.0), BRIGHT_COLORS)
    r = max(sorted((w, h, d))[1] / 2, 0.025)
    one = lathe(
        [(0, long_ * 0.06), (r * 0.35, long_ * 0.1), (r, long_ * 0.6), (r * 0.4, long_ * 0.74), (0, long_ * 0.75)],
        paint,
        8,
    )
    crook = tube(
        [(0, long_ * 0.74, 0), (0, long_ * 0.94, 0), (r * 0.5, long_ * 0.985, 0), (r, long_ * 0.92, 0)], 0.01, OAK, 6
    )
    whole = join((one, crook, rod((0, 0, 0), (0, long_ * 0.08, 0), 0.006, CHROME, sides=6)))
    if h == long_:
        return whole
    lying = shift(turn(whole, "x", 90), 0, h / 2, -long_ / 2)
    return lying if d >= w else turn(lying, "y", 90)


def globe(look: Look) -> Mesh:
    """A globe on a stand."""
    w, h, d = look.size
    r = min(w, d, h * 0.8) / 2
    y = h - r
    world = ball((0, y, 0), r * 0.95, Paint("#4f8ac8", "marble", 4.0, shine=0.5), 6)
    lands = [
        ball(
            (r * 0.55 * math.cos(a), y + r * 0.4 * math.sin(2 * a), r * 0.55 * math.sin(a)),
            r * 0.5,
            Paint("#6fa04a"),
            4,
        )
        for a in (0.6, 2.4, 4.2)
    ]
    return join(
        [
            world,
            *lands,
            cylinder((0, 0, 0), r * 0.6, h * 0.05, OAK),
            cylinder((0, h * 0.05, 0), 0.012, y - r - h * 0.05 + 0.02, BRASS, sides=8),
        ]
    )


def blocks(look: Look) -> Mesh:
    """Building blocks in a small heap."""
    w, h, d = look.size
    s = min(w, d) * 0.3
    spots = ((-0.3, 0, -0.2, 10), (0.05, 0, -0.25, -12), (0.3, 0, 0.15, 30), (-0.15, 0, 0.25, 50), (-0.12, 1, -0.2, 20))
    return join(
        turn(
            box((x * w, (y + 0.5) * min(s, h / 2), z * d), (s, min(s, h / 2), s), Paint(BRIGHT_COLORS[k])),
            "y",
            a,
            (x * w, 0, z * d),
        )
        for k, (x, y, z, a) in enumerate(spots)
    )


def toy_car(look: Look) -> Mesh:
    """A toy car along its longer side."""
    w, h, d = look.size
    a, b = max(w, d), min(w, d)
    paint = look.tint(Paint(shine=0.5), BRIGHT_COLORS)
    low = cushion((0, h * 0.4, 0), (a, h * 0.44, b * 0.9), paint, 0.4, 3)
    cabin = cushion((-a * 0.05, h * 0.76, 0), (a * 0.5, h * 0.46, b * 0.8), Paint("#bcd8e4", shine=0.8), 0.5, 3)
    wheels = [
        shift(
            turn(cylinder((0, 0, 0), h * 0.22, b * 0.14, RUBBER, sides=12), "x", 90), x * a, h * 0.22, z * b - b * 0.07
        )
        for x in (-0.3, 0.3)
        for z in (-0.38, 0.44)
    ]
    car = join([low, cabin, *wheels])
    return car if w >= d else turn(car, "y", 90)


def dumbbell(look: Look) -> Mesh:
    """A dumbbell along its longer side."""
    w, h, d = look.size
    long_, r = max(w, d), h / 2
    bar = rod((-long_ / 2, r, 0), (long_ / 2, r, 0), r * 0.3, CHROME)
    discs = [rod((s * long_ * 0.24, r, 0), (s * long_ * 0.48, r, 0), r, DARK, sides=14) for s in (-1, 1)]
    whole = join([bar, *discs])
    return whole if w >= d else turn(whole, "y", 90)


def bicycle(look: Look) -> Mesh:
    """A bicycle along its longer side."""
    w, h, d = look.size
    a, paint = max(w, d), look.tint(Paint(shine=0.5), BRIGHT_COLORS)
    r = min(h * 0.34, a * 0.21)
    hubs = (-a / 2 + r, a / 2 - r)
    parts = []
    for x in hubs:
        parts.append(
            tube([(x + px, r + py, 0.0) for px, py, _ in arc((0, 0, 0), r * 0.95, 0, 360, steps=18)], 0.018, RUBBER, 6)
        )
        parts += [
            rod((x, r, 0), (x + r * 0.9 * math.cos(t), r + r * 0.9 * math.sin(t), 0), 0.003, CHROME, sides=4)
            for t in (k * math.pi / 5 for k in range(10))
        ]
    crank, saddle, head = (-a * 0.04, r * 0.9, 0.0), (-a * 0.12, h * 0.78, 0.0), (a * 0.22, h * 0.8, 0.0)
    for start, end in (
        (crank, saddle),
        (saddle, head),
        (crank, head),
        (crank, (hubs[0], r, 0.0)),
        (saddle, (hubs[0], r, 0.0)),
        (head, (hubs[1], r, 0.0)),
    ):
        parts.append(rod(start, end, 0.016, paint, sides=6))
    parts += [
        cushion((saddle[0], h * 0.84, 0), (0.24, 0.05, 0.13), BLACK, 0.8, 4),
        rod((head[0], h * 0.8, 0), (head[0] - 0.02, h * 0.97, 0), 0.014, CHROME, sides=6),
        rod((head[0] - 0.02, h * 0.97, -0.26), (head[0] - 0.02, h * 0.97, 0.26), 0.014, DARK, sides=6),
    ]
    whole = join(parts)
    return whole if w >= d else turn(whole, "y", 90)


RECIPES = {
    "rolling_pin": Recipe(rolling_pin, (0.4, 0.06, 0.06)),
    "hammer": Recipe(hammer, (0.12, 0.035, 0.3)),
    "ladder": Recipe(ladder, (0.5, 1.4, 0.7)),
    "umbrella": Recipe(umbrella, (0.1, 0.9, 0.1)),
    "globe": Recipe(globe, (0.26, 0.36, 0.26)),
    "blocks": Recipe(blocks, (0.25, 0.14, 0.25)),
    "toy_car": Recipe(toy_car, (0.16, 0.07, 0.08)),
    "dumbbell": Recipe(dumbbell, (0.28, 0.1, 0.1)),
    "bicycle": Recipe(bicycle, (1.7, 1.05, 0.5)),
}
