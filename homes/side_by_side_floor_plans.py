"""Several drawings of one floor plan side by side, each with ways of its own, a title, and a legend of the characters.

Furniture has no names but what is asked for, and names are moved apart.
"""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from xml.sax.saxutils import escape

from hearth.homes.floor_plan_drawing import PERSON, SCALE, Shape, Trail, bounds, paint, shapes, svg_shape, svg_trail
from hearth.homes.geometry import Rect
from hearth.homes.plans.layout import Layout
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library
from hearth.storage import chosen_files

HEAD = 0.9
"""Metres above each drawing, for its title and the legend."""

LETTER = 0.55
"""Approximate width of a letter as a share of its height."""


@dataclass(frozen=True, slots=True)
class Panel:
    """One of the drawings.

    Attributes:
        title: over it.
        trails: on it.
        names: of the walking characters, in the trails' order, for the legend.
    """

    title: str
    trails: tuple[Trail, ...]
    names: tuple[str, ...]


def labelled(layout: Layout, named: Collection[str]) -> list[Shape]:
    """Return the shapes of a plan; of furniture only what is named has a name, and no two names overlap."""
    rooms = {room.name for room in layout.plan.rooms}
    kept, texts = [], []
    for shape in shapes(layout):
        if shape.fill == PERSON:
            continue  # of the home's own character, who is in no episode
        if shape.kind != "text":
            kept.append(shape)
        elif shape.text in rooms and shape.size > 0.2:
            texts.append(shape)
        elif shape.text in named:
            texts.insert(0, replace(shape, size=0.2))
    return [*kept, *_apart(texts)]


def _apart(texts: Sequence[Shape]) -> Iterator[Shape]:
    """Yield the texts, each moved down, then up, until it stands on none of those before it."""
    placed: list[Rect] = []
    for text in texts:
        x, z = text.rect.center
        wide, high = len(text.text) * text.size * LETTER / 2, text.size * 0.6
        for step in (0, -1, 1, -2, 2, -3, 3, -4, 4):
            there = Rect(x - wide, z + step * high - high, x + wide, z + step * high + high)
            if not any(_overlap(there, other) for other in placed):
                break
        placed.append(there)
        yield replace(text, rect=there)


def _overlap(one: Rect, other: Rect) -> bool:
    return one.x0 < other.x1 and other.x0 < one.x1 and one.z0 < other.z1 and other.z0 < one.z1


def write(layout: Layout, path: Path, panels: Sequence[Panel], named: Collection[str] = ()) -> None:
    """Write the drawings as SVG or PNG, by the file's ending.

    Raises:
        HearthError: UNSUPPORTED_FILE for another ending.
    """
    if path.suffix == ".svg":
        chosen_files.write(path, svg(layout, panels, named).encode())
    elif path.suffix == ".png":
        _write_png(layout, path, panels, named)
    else:
        raise HearthError.of(Code.UNSUPPORTED_FILE, "a floor plan is written as .svg or .png", file=str(path))


def svg(layout: Layout, panels: Sequence[Panel], named: Collection[str] = ()) -> str:
    """Return the drawings as one SVG document."""
    area, parts = bounds(layout), labelled(layout, named)
    wide, high, head = area.width * SCALE, area.depth * SCALE, HEAD * SCALE
    size = f'width="{wide * len(panels):.0f}" height="{high + head:.0f}"'
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif">']
    lines.append('<rect width="100%" height="100%" fill="#ffffff"/>')
    for number, panel in enumerate(panels):
        left = wide * number
        lines.append(f'<text x="{left + 30:.0f}" y="30" font-size="22">{escape(panel.title)}</text>')
        for place, (trail, name) in enumerate(zip(panel.trails, panel.names, strict=True)):
            x = left + 30 + 260 * place
            lines.append(f'<path d="M{x:.0f} 58h36" stroke="{trail.colour}" stroke-width="6"/>')
            lines.append(f'<text x="{x + 44:.0f}" y="64" font-size="18">{escape(name)}</text>')
        lines.append(f'<g transform="translate({left:.1f} {head:.1f})">')
        lines += [svg_shape(shape, area) for shape in parts]
        lines += [part for trail in panel.trails for part in svg_trail(trail, area)]
        lines.append("</g>")
    return "\n".join([*lines, "</svg>", ""])


def _write_png(layout: Layout, path: Path, panels: Sequence[Panel], named: Collection[str]) -> None:
    canvas = library("matplotlib.backends.backend_agg").FigureCanvasAgg
    area, parts = bounds(layout), labelled(layout, named)
    high = area.depth + HEAD
    figure = library("matplotlib.figure").Figure(figsize=(area.width * len(panels), high), dpi=SCALE)
    for number, panel in enumerate(panels):
        left, wide = number / len(panels), 1 / len(panels)
        paint(figure.add_axes((left, 0, wide, area.depth / high)), area, parts, panel.trails)
        figure.text(left + 0.02 * wide, 1 - 0.35 / high, panel.title, size=16)
        for place, (trail, name) in enumerate(zip(panel.trails, panel.names, strict=True)):
            x = left + (0.02 + 2.9 * place / area.width) * wide
            line = library("matplotlib.lines").Line2D([x, x + 0.03 * wide], [1 - 0.68 / high] * 2, linewidth=5)
            line.set_color(trail.colour)
            figure.add_artist(line)
            figure.text(x + 0.04 * wide, 1 - 0.75 / high, name, size=13)
    with chosen_files.writing(path) as temporary:
        canvas(figure).print_png(str(temporary), metadata={"Software": None})
