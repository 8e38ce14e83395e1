"""Lamps and candles."""

from __future__ import annotations

from hearth.rendering.meshes.look import Look, Recipe
from hearth.rendering.meshes.mesh import Mesh, join, shift, stretch, turn
from hearth.rendering.meshes.paint import BRASS, DARK, STEEL, WALNUT, WHITE, Paint
from hearth.rendering.meshes.shapes import ball, block, cushion, cylinder, lathe, rod

SHADE = Paint("#efe2c4", "fabric", 5.0)
WARM = "#ffe2a8"


def _shade(look: Look, paint: Paint = SHADE) -> Paint:
    return paint.tinted(WARM).lit(0.85) if look.on else paint


def table_lamp(look: Look) -> Mesh:
    """A table lamp: foot, stem and conical shade, or a round ceramic foot."""
    w, h, d = look.size
    r = min(w, d) / 2
    metal = look.pick((BRASS, DARK, STEEL, WALNUT), "metal").tinted(look.color)
    if look.variant % 2:
        foot = lathe(
            [
                (0, 0),
                (r * 0.4, 0),
                (r * 0.62, h * 0.12),
                (r * 0.7, h * 0.25),
                (r * 0.5, h * 0.42),
                (r * 0.14, h * 0.5),
                (r * 0.1, h * 0.6),
            ],
            Paint(look.pick(("#5f8f8a", "#c8604a", "#dcd2be", "#5f6f92"), "glaze"), shine=0.6),
            18,
        )
    else:
        foot = cylinder((0, 0, 0), r * 0.6, h * 0.04, metal) + cylinder(
            (0, h * 0.04, 0), r * 0.08, h * 0.6, metal, sides=8
        )
    return foot + _drum(look, r, h * 0.56, h, 0.6)


def _drum(look: Look, r: float, y0: float, y1: float, taper: float) -> Mesh:
    paint = _shade(look)
    outer = lathe([(r, y0), (r * taper, y1)], paint, 20)
    inner = lathe([(r * taper * 0.97, y1), (r * 0.97, y0)], paint, 20)
    bulb = ball((0, (y0 + y1) / 2, 0), r * 0.22, Paint("#fff6de", glow=2.0 if look.on else 0.0), 3)
    return join((outer, inner, bulb))


def floor_lamp(look: Look) -> Mesh:
    """A tall lamp with a wide shade, or an uplighter."""
    w, h, d = look.size
    r = min(w, d) / 2
    metal = look.pick((BRASS, DARK, STEEL), "metal").tinted(look.color)
    foot = cylinder((0, 0, 0), r * 0.75, 0.025, metal) + cylinder((0, 0.025, 0), 0.014, h * 0.84, metal, sides=8)
    if look.variant % 2:
        bowl = lathe(
            [(0.02, h * 0.88), (r * 0.6, h * 0.92), (r, h), (r * 0.96, h), (r * 0.5, h * 0.94), (0, h * 0.93)],
            _shade(look, metal),
            20,
        )
        return foot + bowl
    return foot + _drum(look, r, h * 0.8, h, 0.7)


def ceiling_lamp(look: Look) -> Mesh:
    """A shallow bowl under the ceiling, or a pendant where it hangs low."""
    w, h, d = look.size
    paint = Paint("#fff3d6", glow=1.1) if look.on else Paint("#e8e4d8", shine=0.3)
    if h > w * 0.7:
        cord = cylinder((0, h * 0.5, 0), 0.006, h * 0.5, DARK, sides=6)
        return (
            cord
            + stretch(
                lathe(
                    [(0.5, 0), (0.42, h * 0.28), (0.1, h * 0.5)],
                    _shade(look, Paint(look.pick(("#3a3d42", "#b8433a", "#e8e2d2"), "shade"))),
                    20,
                ),
                x=w,
                z=d,
            )
            + ball((0, h * 0.14, 0), w * 0.12, paint, 3)
        )
    return stretch(
        lathe(
            [(0, 0), (0.3, h * 0.12), (0.46, h * 0.45), (0.5, h * 0.82), (0.5, h * 0.82), (0.38, h), (0, h)], paint, 24
        ),
        x=w,
        z=d,
    )


def wall_lamp(look: Look) -> Mesh:
    """A bracket with a small shade."""
    w, h, d = look.size
    plate = block(-w * 0.2, w * 0.2, h * 0.2, h * 0.7, -d / 2, -d / 2 + 0.015, BRASS)
    arm = rod((0, h * 0.4, -d / 2), (0, h * 0.4, d * 0.05), 0.008, BRASS, sides=6)
    cup = shift(_drum(look, w * 0.44, h * 0.4, h, 0.6), z=d * 0.05)
    return join((plate, arm, stretch(cup, z=min(1.0, d / w))))


def candle(look: Look) -> Mesh:
    """A candle on a saucer; burns when on."""
    w, h, d = look.size
    r = min(w, d) / 2
    saucer = lathe([(0, 0), (r, 0.01), (r, 0.016), (r * 0.5, 0.01), (0, 0.01)], BRASS, 16)
    wax = cylinder((0, 0.01, 0), r * 0.5, h * 0.72, look.tint(WHITE, ("#f0e6cf", "#b8433a", "#5f7f6a")))
    wick = cylinder((0, h * 0.74, 0), 0.003, h * 0.07, DARK, sides=5)
    flame = (
        [cushion((0, h * 0.9, 0), (r * 0.3, h * 0.2, r * 0.3), Paint("#ffb53a", glow=2.5), 1.0, 4)] if look.on else []
    )
    return join([saucer, wax, wick, *flame])


def light_bulb(look: Look) -> Mesh:
    """A bulb on its screw."""
    w, h, d = look.size
    r = min(w, d) / 2
    glass = lathe(
        [(r * 0.45, h * 0.32), (r * 0.7, h * 0.48), (r, h * 0.72), (r * 0.75, h * 0.93), (0, h)],
        Paint("#fff3d6", glow=1.5 if look.on else 0.0, shine=0.8),
        16,
    )
    return glass + lathe([(0, 0), (r * 0.2, 0), (r * 0.42, h * 0.05), (r * 0.45, h * 0.32)], STEEL, 12)


def ceiling_fan(look: Look) -> Mesh:
    """Four blades under a ceiling, with a lamp."""
    w, h, _ = look.size
    hub = cylinder((0, h * 0.3, 0), 0.09, h * 0.3, WALNUT) + cylinder((0, h * 0.6, 0), 0.02, h * 0.4, DARK)
    blade = block(-0.065, 0.065, h * 0.42, h * 0.45, 0.08, w / 2, WALNUT)
    blades = [turn(blade, "y", 90 * k + (20 if look.on else 0)) for k in range(4)]
    lamp = ball((0, h * 0.22, 0), (0.1, h * 0.2, 0.1), Paint("#fff3d6", glow=1.1 if look.on else 0.0), 4)
    return join([hub, *blades, lamp])


RECIPES = {
    "table_lamp": Recipe(table_lamp, (0.24, 0.42, 0.24), 2, lamp=0.75, states=("ON",)),
    "floor_lamp": Recipe(floor_lamp, (0.36, 1.6, 0.36), 2, lamp=0.9, states=("ON",)),
    "ceiling_lamp": Recipe(ceiling_lamp, (0.45, 0.14, 0.45), lamp=-0.4, states=("ON",)),
    "wall_lamp": Recipe(wall_lamp, (0.16, 0.28, 0.14), lamp=0.7, states=("ON",)),
    "candle": Recipe(candle, (0.08, 0.14, 0.08), lamp=1.1, states=("ON",)),
    "light_bulb": Recipe(light_bulb, (0.06, 0.1, 0.06), lamp=0.7, states=("ON",)),
    "ceiling_fan": Recipe(ceiling_fan, (1.0, 0.3, 1.0), lamp=-0.1, states=("ON",)),
}
