"""Pictures that objects show, drawn by the strokes of `pictures.yaml`: pages, screens, paintings, keyboards."""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Bytes, Floats
from hearth.rendering.models.model_expressions import MATH, Scope, Values, entries_of, shared_of
from hearth.rendering.models.texture_patterns import SIDE, blend, noise

Color = tuple[int, int, int]

PACKAGE, FILE = "hearth.rendering.models", "pictures.yaml"


def _ground(image: Bytes, *color: int) -> None:
    image[:] = color


def _fill(image: Bytes, x0: float, y0: float, x1: float, y1: float, color: Color) -> None:
    image[round(y0 * SIDE) : round(y1 * SIDE), round(x0 * SIDE) : round(x1 * SIDE)] = color


def _disc(image: Bytes, x: float, y: float, radius: float, color: Color) -> None:
    t = (np.arange(SIDE) + 0.5) / SIDE
    image[(t[None, :] - x) ** 2 + (t[:, None] - y) ** 2 < radius * radius] = color


def _below(image: Bytes, heights: Sequence[float] | NDArray[np.float64], color: Color) -> None:
    """Fill under a skyline given as heights over the width, 0 at the top."""
    line = np.interp(np.linspace(0, 1, SIDE), np.linspace(0, 1, len(heights)), heights)
    image[(np.arange(SIDE)[:, None] + 0.5) / SIDE > line[None, :]] = color


def _lines(image: Bytes, x0: float, x1: float, y0: float, y1: float, count: int, color: Color = (45, 48, 55)) -> None:
    """Lines of writing, each a row of words."""
    words = np.random.default_rng(count).uniform(0.04, 0.13, 400)
    step, k = (y1 - y0) / count, 0
    for row in range(count):
        x, y = x0, y0 + row * step
        while x < x1 - 0.05 and not (row % 7 == 6 and x > (x0 + x1) / 2):
            _fill(image, x, y, min(x + words[k % 400], x1), y + step * 0.45, color)
            x, k = x + words[k % 400] + 0.02, k + 1


def _rhombus(image: Bytes, half: float, color: Color) -> None:
    """A square standing on its corner in the middle; `half` is half of its diagonal."""
    t = np.abs((np.arange(SIDE) + 0.5) / SIDE - 0.5)
    image[t[None, :] + t[:, None] < half] = color


def _flap(image: Bytes, low: float, color: Color) -> None:
    """The edges of an envelope's flap with its corner at `low`."""
    t = np.arange(SIDE) / SIDE
    image[np.abs(t[:, None] - (low - np.abs(t[None, :] - 0.5))) < 0.012] = color


def _books(image: Bytes, seed: int, shades: Sequence[Color]) -> None:
    """A row of spines, each with its title."""
    random, x = np.random.default_rng(seed), 0.0
    while x < 1:
        width, top = random.uniform(0.04, 0.085), random.uniform(0, 0.22)
        color = shades[int(random.integers(len(shades)))]
        _fill(image, x, top, min(x + width - 0.006, 1), 1, color)
        _fill(image, x + 0.01, top + 0.12, min(x + width - 0.014, 1), top + 0.2, (236, 220, 170))
        x += width


STROKES: dict[str, Callable[..., None]] = {
    "ground": _ground,
    "fill": _fill,
    "disc": _disc,
    "below": _below,
    "lines": _lines,
    "rhombus": _rhombus,
    "flap": _flap,
    "books": _books,
}


@cache
def _shared() -> Values:
    return shared_of(PACKAGE, FILE, MATH)


def picture(name: str) -> Floats:
    """(SIDE, SIDE, 3) a picture in linear light.

    Raises:
        HearthError: `pictures.yaml` has an unknown stroke or a wrong expression.
    """
    image = np.zeros((SIDE, SIDE, 3), np.uint8)
    *strokes, last = entries_of(PACKAGE, FILE)[name]
    names: Values = {**MATH, **_shared()}
    scope = Scope(f"rendering/{FILE}", name, frozenset(names))
    # Dust covers the whole picture, and is finer than the steps of a byte.
    dust = last.get("dust")
    _paint(strokes if dust else [*strokes, last], image, names, scope)
    linear: Floats = ((image / 255.0) ** 2.2).astype(np.float32)
    if not dust:
        return linear
    color, most = scope.at("dust").expression(dust)(names)
    return blend(linear, color, np.clip(noise(40, (60, 60)) * 0.1, 0, most))


def _paint(strokes: Sequence[dict[str, Any]], image: Bytes, names: Values, scope: Scope) -> None:
    for stroke in strokes:
        rest = dict(stroke)
        bound, values = scope.loop(rest.pop("for", "once in (0,)"))
        inner = scope.knowing(bound)
        holds = inner.expression(rest.pop("when", "True"))
        (key, node), *more = rest.items()
        if more or (key != "all" and key not in STROKES):
            raise scope.fault(f"`{', '.join(rest)}` is not a stroke", f"one of {', '.join(STROKES)}, all")
        found = None if key == "all" else inner.at(key).expression(node)
        for each in values(names):
            here: Values = {**names, **dict(zip(bound, each, strict=True))}
            if holds(here) and found:
                STROKES[key](image, *found(here))
            elif holds(here):
                _paint(node, image, here, inner)


PICTURES = tuple(name for name in entries_of(PACKAGE, FILE) if name != "shared")
"""Names of the pictures; a panel shows its picture once."""

PAINTINGS = ("mountains", "sea", "flowers", "abstract", "portrait")
SHOWS = ("show_news", "show_cartoon", "show_match")
PROGRAMMES = (*SHOWS, "show_weather", "show_kitchen", "show_street")
"""Pictures of a television, in order."""

DESKTOPS = ("desktop", "screen_text", "screen_site", "screen_chart")
"""Pictures of a computer's screen, in order."""
