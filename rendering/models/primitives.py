"""The vocabulary of the model files: shapes, functions, paints, and quantities of the drawn object."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import TypeVar

from hearth.rendering.models import shapes
from hearth.rendering.models.appearance import Look, Region, nowhere, over, shelves, top
from hearth.rendering.models.blanket import drape
from hearth.rendering.models.mesh import Mesh
from hearth.rendering.models.model_expressions import MATH, Values
from hearth.rendering.models.object_pictures import DESKTOPS, PAINTINGS, PROGRAMMES
from hearth.rendering.models.paint import PAINTS, Paint
from hearth.rendering.models.plant_leaf import leaf

Value = TypeVar("Value")

SHAPES: dict[str, Callable[..., Mesh]] = {
    "ball": shapes.ball,
    "block": shapes.block,
    "box": shapes.box,
    "cushion": shapes.cushion,
    "cylinder": shapes.cylinder,
    "drape": drape,
    "lathe": shapes.lathe,
    "leaf": leaf,
    "medallion": shapes.medallion,
    "panel": shapes.panel,
    "prism": shapes.prism,
    "quads": shapes.quads,
    "rod": shapes.rod,
    "tube": shapes.tube,
}
LINES = frozenset(("lathe", "prism", "quads", "tube"))
"""Shapes whose list is one line or outline; the lists of others are positional arguments."""


def _lookup(table: Mapping[str, Value], key: str, default: Value) -> Value:
    return table.get(key, default)


FUNCTIONS: Values = {
    **MATH,
    "arc": shapes.arc,
    "Paint": Paint,
    "tinted": Paint.tinted,
    "lit": Paint.lit,
    "color_of": lambda paint: paint.color,
    "lookup": _lookup,
    "region": Region,
    **PAINTS,
    "PAINTINGS": PAINTINGS,
    "PROGRAMMES": PROGRAMMES,
    "DESKTOPS": DESKTOPS,
}
"""Names that every expression of a model may use."""


def names_of(look: Look) -> Values:
    """Names for the drawn object in a model's expressions: its size w, h, d and the other fields of its look."""
    w, h, d = look.size
    return {
        **FUNCTIONS,
        "w": w, "h": h, "d": d,
        "kind": look.kind, "color": look.color, "variant": look.variant, "seed": look.seed, "hole": look.hole,
        "open": look.open, "on": look.on, "closed": "CLOSED" in look.states, "moment": look.moment,
        "rest_height": look.seat, "pick": look.pick, "painted": look.paint, "tint": look.tint,
        "top": partial(top, look), "nowhere": partial(nowhere, look), "over": partial(_over, look),
        "shelves": partial(shelves, look), "bottom": partial(_bottom, look),
    }  # fmt: skip


def _over(look: Look, y: float, inset: float = 0.02, **more: float) -> Region:
    """Return the footprint at height `y` without its rim; `more` replaces further sides."""
    return over(look, y, inset)._replace(**more)


def _bottom(look: Look) -> tuple[Region, ...]:
    """Return the bottom of a vessel."""
    w, h, d = look.size
    return (Region(min(0.03, h * 0.2), -w * 0.25, w * 0.25, -d * 0.25, d * 0.25, h),)


KNOWN = frozenset(names_of(Look((1.0, 1.0, 1.0))))
"""Every name that `names_of` defines."""
