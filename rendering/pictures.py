"""Pictures that objects show: pages, screens, paintings, keyboards. Linear light, (SIDE, SIDE, 3)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Bytes, Floats
from hearth.rendering.weave import SIDE, blend, noise

Color = tuple[int, int, int]

INK: Color = (45, 48, 55)
PAGE: Color = (246, 243, 233)


def _canvas(color: Color) -> Bytes:
    return np.full((SIDE, SIDE, 3), color, np.uint8)


def _linear(image: Bytes) -> Floats:
    return ((image / 255.0) ** 2.2).astype(np.float32)


def _fill(image: Bytes, x0: float, y0: float, x1: float, y1: float, color: Color) -> None:
    image[round(y0 * SIDE) : round(y1 * SIDE), round(x0 * SIDE) : round(x1 * SIDE)] = color


def _disc(image: Bytes, x: float, y: float, radius: float, color: Color) -> None:
    t = (np.arange(SIDE) + 0.5) / SIDE
    image[(t[None, :] - x) ** 2 + (t[:, None] - y) ** 2 < radius * radius] = color


def _below(image: Bytes, heights: Sequence[float] | NDArray[np.float64], color: Color) -> None:
    """Fill under a skyline given as heights over the width, 0 at the top."""
    line = np.interp(np.linspace(0, 1, SIDE), np.linspace(0, 1, len(heights)), heights)
    image[(np.arange(SIDE)[:, None] + 0.5) / SIDE > line[None, :]] = color


def _lines(image: Bytes, x0: float, x1: float, y0: float, y1: float, count: int, color: Color = INK) -> None:
    """Lines of writing, each a row of words."""
    words = np.random.default_rng(count).uniform(0.04, 0.13, 400)
    step, k = (y1 - y0) / count, 0
    for row in range(count):
        x, y = x0, y0 + row * step
        while x < x1 - 0.05 and not (row % 7 == 6 and x > (x0 + x1) / 2):
            _fill(image, x, y, min(x + words[k % 400], x1), y + step * 0.45, color)
            x, k = x + words[k % 400] + 0.02, k + 1


def _page() -> Floats:
    image = _canvas(PAGE)
    _lines(image, 0.1, 0.9, 0.08, 0.95, 18)
    return _linear(image)


def _book_open() -> Floats:
    image = _canvas(PAGE)
    _lines(image, 0.05, 0.45, 0.08, 0.95, 16)
    _lines(image, 0.55, 0.95, 0.08, 0.95, 16)
    _fill(image, 0.49, 0, 0.51, 1, (190, 184, 170))
    return _linear(image)


def _newspaper() -> Floats:
    image = _canvas((226, 223, 212))
    _fill(image, 0.08, 0.05, 0.92, 0.14, (30, 30, 34))
    _fill(image, 0.08, 0.2, 0.5, 0.48, (120, 125, 132))
    _disc(image, 0.28, 0.34, 0.07, (196, 196, 190))
    for left in (0.08, 0.37, 0.66):
        _lines(image, left, left + 0.25, 0.54, 0.97, 13)
    _lines(image, 0.55, 0.92, 0.2, 0.5, 9)
    return _linear(image)


def _keyboard() -> Floats:
    image = _canvas((44, 46, 52))
    for row in range(5):
        for column in range(14):
            x = 0.025 + column * 0.068
            _fill(image, x, 0.06 + row * 0.18, x + 0.055, 0.2 + row * 0.18, (214, 216, 220))
    _fill(image, 0.025, 0.78, 0.975, 0.92, (44, 46, 52))
    _fill(image, 0.25, 0.78, 0.7, 0.92, (214, 216, 220))
    return _linear(image)


def _piano_keys() -> Floats:
    image = _canvas((245, 243, 236))
    for key in range(28):
        _fill(image, key / 28, 0, key / 28 + 0.005, 1, (90, 90, 90))
        if key % 7 not in (2, 6):
            _fill(image, (key + 0.7) / 28, 0, (key + 1.3) / 28, 0.6, (20, 20, 22))
    return _linear(image)


def _clock() -> Floats:
    image = _canvas((248, 246, 240))
    for hour in range(12):
        angle = hour * np.pi / 6
        _disc(image, 0.5 + 0.4 * np.sin(angle), 0.5 - 0.4 * np.cos(angle), 0.03 if hour % 3 else 0.045, INK)
    for t in np.linspace(0, 1, 60):
        _disc(image, 0.5 + 0.2 * t, 0.5 - 0.12 * t, 0.022, INK)
        _disc(image, 0.5 - 0.1 * t, 0.5 - 0.32 * t, 0.016, INK)
    _disc(image, 0.5, 0.5, 0.035, (190, 60, 50))
    return _linear(image)


_STROKES: dict[str, tuple[float, float, float, float]] = {
    "a": (0, 0, 0.14, 0.06),
    "b": (0.1, 0, 0.14, 0.25),
    "c": (0.1, 0.25, 0.14, 0.5),
    "d": (0, 0.44, 0.14, 0.5),
    "e": (0, 0.25, 0.04, 0.5),
    "f": (0.1, 0, 0.14, 0.25),
    "g": (0, 0.22, 0.14, 0.28),
}


def _digits() -> Floats:
    image = _canvas((14, 18, 20))
    for x, strokes in ((0.12, "cf"), (0.3, "abged"), (0.56, "abgcd"), (0.76, "abcdef")):
        for stroke in strokes:
            box = _STROKES[stroke]
            _fill(image, x + box[0], 0.25 + box[1], x + box[2], 0.25 + box[3], (255, 70, 50))
    _disc(image, 0.51, 0.42, 0.02, (255, 70, 50))
    _disc(image, 0.51, 0.58, 0.02, (255, 70, 50))
    return _linear(image)


def _desktop() -> Floats:
    image = _canvas((52, 104, 160))
    _below(image, (0.75, 0.55, 0.7, 0.5, 0.68), (38, 82, 132))
    _fill(image, 0.2, 0.14, 0.88, 0.8, (244, 245, 248))
    _fill(image, 0.2, 0.14, 0.88, 0.2, (80, 84, 92))
    _fill(image, 0.2, 0.2, 0.36, 0.8, (222, 228, 236))
    _lines(image, 0.4, 0.84, 0.26, 0.76, 10, (110, 116, 126))
    _fill(image, 0, 0.93, 1, 1, (28, 32, 40))
    for icon in range(5):
        _fill(image, 0.04, 0.08 + icon * 0.16, 0.12, 0.17 + icon * 0.16, ((240, 190, 70), (90, 200, 140))[icon % 2])
    return _linear(image)


def _show_news() -> Floats:
    image = _canvas((36, 62, 120))
    _fill(image, 0.52, 0.12, 0.94, 0.5, (110, 170, 220))
    _below(image, (0.98, 0.7, 0.64, 0.66, 0.98, 1.2, 1.2, 1.2), (58, 60, 70))
    _disc(image, 0.28, 0.42, 0.13, (224, 178, 148))
    _disc(image, 0.28, 0.33, 0.13, (70, 46, 34))
    _disc(image, 0.28, 0.45, 0.11, (224, 178, 148))
    _fill(image, 0, 0.82, 1, 0.94, (190, 42, 44))
    _fill(image, 0.06, 0.86, 0.7, 0.9, (250, 246, 240))
    return _linear(image)


def _show_cartoon() -> Floats:
    image = _canvas((130, 206, 240))
    _below(image, (0.72, 0.6, 0.7, 0.8, 0.7), (110, 190, 90))
    _disc(image, 0.82, 0.2, 0.1, (255, 224, 90))
    _disc(image, 0.42, 0.5, 0.2, (240, 120, 70))
    for x in (0.36, 0.5):
        _disc(image, x, 0.45, 0.055, (255, 255, 255))
        _disc(image, x + 0.01, 0.46, 0.025, (20, 20, 24))
    _fill(image, 0.36, 0.57, 0.5, 0.61, (120, 30, 30))
    return _linear(image)


def _show_match() -> Floats:
    image = _canvas((70, 150, 70))
    for stripe in range(0, 8, 2):
        _fill(image, stripe / 8, 0.25, (stripe + 1) / 8, 1, (82, 166, 80))
    _fill(image, 0, 0, 1, 0.25, (92, 96, 112))
    _fill(image, 0.49, 0.25, 0.51, 1, (236, 240, 236))
    for x, y, red in ((0.2, 0.5, 1), (0.38, 0.75, 0), (0.63, 0.45, 1), (0.78, 0.7, 0), (0.3, 0.38, 0), (0.7, 0.86, 1)):
        _fill(image, x, y, x + 0.035, y + 0.1, (214, 50, 50) if red else (245, 245, 250))
        _disc(image, x + 0.018, y - 0.015, 0.022, (222, 176, 146))
    _disc(image, 0.47, 0.62, 0.018, (255, 255, 255))
    return _linear(image)


def _mountains() -> Floats:
    image = _canvas((168, 206, 232))
    _disc(image, 0.75, 0.22, 0.08, (252, 232, 160))
    _below(image, (0.62, 0.35, 0.5, 0.28, 0.55, 0.45, 0.6), (110, 128, 150))
    _below(image, (0.7, 0.62, 0.72, 0.6, 0.68), (74, 116, 84))
    _below(image, (0.86, 0.8, 0.84, 0.88, 0.82), (142, 172, 84))
    return _linear(image)


def _sea() -> Floats:
    image = _canvas((246, 196, 150))
    _disc(image, 0.4, 0.46, 0.13, (250, 120, 80))
    _below(image, (0.52, 0.52), (44, 96, 140))
    _below(image, (0.78, 0.82, 0.77, 0.83), (70, 140, 170))
    _below(image, (0.92, 0.88, 0.94), (232, 210, 160))
    return _linear(image)


def _flowers() -> Floats:
    image = _canvas((238, 230, 214))
    _below(image, (1.2, 1.2, 0.72, 0.7, 0.72, 1.2, 1.2), (70, 110, 160))
    petals = (
        (0.3, 0.36, (206, 70, 80)),
        (0.5, 0.25, (236, 170, 60)),
        (0.7, 0.38, (150, 90, 170)),
        (0.5, 0.47, (230, 120, 140)),
    )
    for x, _, _ in petals:
        _fill(image, x - 0.01, 0.4, x + 0.01, 0.72, (80, 130, 70))
    for x, y, color in petals:
        for angle in np.arange(6) * np.pi / 3:
            _disc(image, x + 0.08 * np.cos(angle), y + 0.08 * np.sin(angle), 0.055, color)
        _disc(image, x, y, 0.04, (250, 226, 120))
    return _linear(image)


def _abstract() -> Floats:
    image = _canvas((240, 236, 224))
    _fill(image, 0.08, 0.1, 0.5, 0.6, (214, 86, 60))
    _fill(image, 0.4, 0.4, 0.9, 0.92, (40, 84, 130))
    _disc(image, 0.62, 0.32, 0.2, (240, 190, 70))
    _fill(image, 0.1, 0.72, 0.34, 0.9, (30, 34, 40))
    return _linear(image)


def _portrait() -> Floats:
    image = _canvas((120, 140, 124))
    _below(image, (1.1, 0.86, 0.74, 0.7, 0.74, 0.86, 1.1), (126, 54, 60))
    _disc(image, 0.5, 0.38, 0.21, (84, 54, 38))
    _disc(image, 0.5, 0.44, 0.17, (226, 182, 152))
    for x in (0.43, 0.57):
        _disc(image, x, 0.42, 0.02, INK)
    _fill(image, 0.45, 0.52, 0.55, 0.54, (170, 80, 80))
    return _linear(image)


def _spines() -> Floats:
    image = _canvas((60, 50, 44))
    random = np.random.default_rng(31)
    x = 0.0
    shades: list[Color] = [
        (150, 52, 46),
        (44, 84, 120),
        (196, 160, 84),
        (70, 104, 78),
        (112, 76, 120),
        (214, 206, 190),
        (52, 56, 66),
    ]
    while x < 1:
        width, top = random.uniform(0.04, 0.085), random.uniform(0, 0.22)
        color = shades[int(random.integers(len(shades)))]
        _fill(image, x, top, min(x + width - 0.006, 1), 1, color)
        _fill(image, x + 0.01, top + 0.12, min(x + width - 0.014, 1), top + 0.2, (236, 220, 170))
        x += width
    return _linear(image)


def _cover() -> Floats:
    image = _canvas((255, 255, 255))
    _fill(image, 0.12, 0.12, 0.88, 0.34, (120, 120, 120))
    _fill(image, 0.2, 0.18, 0.8, 0.22, (250, 250, 250))
    _fill(image, 0.28, 0.26, 0.72, 0.29, (250, 250, 250))
    _disc(image, 0.5, 0.64, 0.17, (160, 160, 160))
    _fill(image, 0, 0, 0.05, 1, (150, 150, 150))
    return _linear(image)


def _label() -> Floats:
    image = _canvas((255, 255, 255))
    for x in (0.0, 0.5):
        _fill(image, x + 0.08, 0.2, x + 0.42, 0.34, (90, 90, 96))
        _disc(image, x + 0.25, 0.6, 0.14, (150, 150, 156))
    _fill(image, 0, 0.88, 1, 0.94, (120, 120, 126))
    return _linear(image)


def _chess() -> Floats:
    step = np.arange(SIDE) * 8 // SIDE
    dark = (step[:, None] + step[None, :]) % 2 == 1
    return _linear(np.where(dark[..., None], np.array((98, 62, 40)), np.array((232, 208, 168))).astype(np.uint8))


def _board() -> Floats:
    image = _canvas((214, 232, 206))
    for k in range(9):
        color = ((214, 60, 60), (60, 110, 190), (240, 190, 60), (70, 150, 90))[k % 4]
        for x, y in ((k / 9, 0), (k / 9, 8 / 9), (0, k / 9), (8 / 9, k / 9)):
            _fill(image, x + 0.008, y + 0.008, x + 0.103, y + 0.103, color)
    _disc(image, 0.5, 0.5, 0.16, (214, 60, 60))
    return _linear(image)


def _cards() -> Floats:
    image = _canvas((250, 250, 248))
    _fill(image, 0.02, 0.02, 0.98, 0.04, (170, 170, 170))
    for x, y in ((0.28, 0.25), (0.72, 0.25), (0.5, 0.5), (0.28, 0.75), (0.72, 0.75)):
        _disc(image, x - 0.045, y - 0.03, 0.055, (204, 40, 46))
        _disc(image, x + 0.045, y - 0.03, 0.055, (204, 40, 46))
        _disc(image, x, y + 0.035, 0.055, (204, 40, 46))
    return _linear(image)


def _rug() -> Floats:
    image = _canvas((150, 52, 48))
    _fill(image, 0.06, 0.06, 0.94, 0.94, (226, 204, 160))
    _fill(image, 0.1, 0.1, 0.9, 0.9, (52, 66, 96))
    for k in range(6):
        for x, y in (
            (0.17 + k * 0.132, 0.17),
            (0.17 + k * 0.132, 0.83),
            (0.17, 0.17 + k * 0.132),
            (0.83, 0.17 + k * 0.132),
        ):
            _disc(image, x, y, 0.04, (226, 204, 160))
    _fill(image, 0.26, 0.26, 0.74, 0.74, (150, 52, 48))
    t = np.abs((np.arange(SIDE) + 0.5) / SIDE - 0.5)
    image[t[None, :] + t[:, None] < 0.22] = (226, 204, 160)
    image[t[None, :] + t[:, None] < 0.15] = (52, 66, 96)
    return blend(_linear(image), (0.1, 0.08, 0.07), np.clip(noise(40, (60, 60)) * 0.1, 0, 0.3))


def _banknote() -> Floats:
    image = _canvas((176, 204, 170))
    _fill(image, 0.04, 0.08, 0.96, 0.92, (206, 224, 198))
    _disc(image, 0.5, 0.5, 0.26, (110, 150, 112))
    _disc(image, 0.14, 0.26, 0.08, (70, 110, 78))
    _disc(image, 0.86, 0.74, 0.08, (70, 110, 78))
    return _linear(image)


def _envelope() -> Floats:
    image = _canvas((240, 234, 218))
    t = np.arange(SIDE) / SIDE
    flap = np.abs(t[:, None] - (0.55 - np.abs(t[None, :] - 0.5))) < 0.012
    image[flap] = (180, 170, 150)
    _fill(image, 0.8, 0.06, 0.95, 0.26, (190, 70, 70))
    _lines(image, 0.34, 0.66, 0.64, 0.9, 3)
    return _linear(image)


def _child_drawing() -> Floats:
    image = _canvas((250, 248, 242))
    _disc(image, 0.3, 0.3, 0.14, (240, 190, 60))
    _below(image, (0.9, 0.8, 0.9, 0.82), (110, 170, 90))
    _fill(image, 0.5, 0.5, 0.8, 0.85, (214, 96, 80))
    for row in range(18):
        half = row * 0.011
        _fill(image, 0.65 - half, 0.3 + row * 0.011, 0.65 + half, 0.312 + row * 0.011, (110, 70, 50))
    _fill(image, 0.61, 0.66, 0.69, 0.85, (250, 240, 200))
    return _linear(image)


PICTURES: dict[str, Callable[[], Floats]] = {
    "page": _page,
    "book_open": _book_open,
    "newspaper": _newspaper,
    "keyboard": _keyboard,
    "piano_keys": _piano_keys,
    "clock": _clock,
    "digits": _digits,
    "desktop": _desktop,
    "show_news": _show_news,
    "show_cartoon": _show_cartoon,
    "show_match": _show_match,
    "mountains": _mountains,
    "sea": _sea,
    "flowers": _flowers,
    "abstract": _abstract,
    "portrait": _portrait,
    "child_drawing": _child_drawing,
    "spines": _spines,
    "cover": _cover,
    "label": _label,
    "chess": _chess,
    "board": _board,
    "cards": _cards,
    "rug": _rug,
    "banknote": _banknote,
    "envelope": _envelope,
}
"""Pictures, shown once over a panel."""

PAINTINGS = ("mountains", "sea", "flowers", "abstract", "portrait")
SHOWS = ("show_news", "show_cartoon", "show_match")
