"""A home's floor plan as a drawing: SVG written directly, PNG from the same shapes. North is up."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from hearth.homes.geometry import Rect, bottom, footprint
from hearth.homes.plans.home_shell import Thing, before
from hearth.homes.plans.layout import Layout
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Spot
from hearth.schemas.optional_libraries import library
from hearth.storage import chosen_files

SCALE = 90
"""Pixels a metre."""
BORDER = 0.4
"""Metres around the home."""

ROOM_COLOURS = {
    "bathroom": "#dcecf2", "bedroom": "#ece4f3", "kids_bedroom": "#f8e8ee", "kitchen": "#fbf0da",
    "dining_room": "#f7ead8", "living_room": "#e6f0e0", "home_office": "#e4ebf5", "entrance_hall": "#efece6",
}  # fmt: skip
COLOURS = {"wall": "#3b3b3b", "door": "#8a5a2b", "window": "#6db3e8", "curtain": "#b58fc4", "mat": "#e3d2b8"}
FURNITURE, HUNG, SMALL, INK, PERSON = "#d3b28c", "#9fb3a0", "#c65b4a", "#222222", "#3f6fd1"
HALO = "#ffffffd0"


@dataclass(frozen=True, slots=True)
class Shape:
    """A part of the drawing, in metres.

    Attributes:
        kind: `rect`, `line` or `text`.
        rect: what it covers; a line runs from its south-west to its north-east corner; a text stands in its middle.
        fill: colour.
        edge: colour of its outline, or "".
        text: what it says.
        size: of the letters, metres.
    """

    kind: str
    rect: Rect
    fill: str
    edge: str = ""
    text: str = ""
    size: float = 0.12


@dataclass(frozen=True, slots=True)
class Trail:
    """A way over the floor, with moments on it.

    Attributes:
        points: where it leads, metres.
        colour: of the line and the moments.
        moments: points that are marked by a circle with a black border.
    """

    points: tuple[Spot, ...]
    colour: str
    moments: tuple[Spot, ...] = ()


def shapes(layout: Layout) -> Iterator[Shape]:
    """Everything to draw, what lies below first."""
    for room in layout.plan.rooms:
        yield Shape("rect", room.rect, ROOM_COLOURS.get(room.class_name, "#eeeeee"))
    things = layout.things
    yield from (Shape("rect", footprint(t.box), COLOURS["mat"]) for t in things if t.mount == "flat")
    yield from _shell(things)
    furniture = [thing for thing in things if thing.mount in ("floor", "wall") and thing.class_name != "wall"]
    for thing in furniture:
        yield from _furniture(thing)
    for thing in things:
        if thing.mount in ("item", "sunk"):
            yield Shape("rect", footprint(thing.box), SMALL if thing.on else "#7f7f7f", "#ffffff")
    yield from _furniture(layout.character, PERSON)
    covered = [footprint(thing.box) for thing in (*furniture, layout.character)]
    for room in layout.plan.rooms:
        yield _room_label(room.name, room.rect, covered)
    yield from map(_label, (*(thing for thing in furniture if thing.mount == "floor"), layout.character))


def _shell(things: tuple[Thing, ...]) -> Iterator[Shape]:
    for thing in things:
        if thing.class_name == "wall" and bottom(thing.box) == 0 and thing.box.size[1] > 1.5:
            yield Shape("rect", footprint(thing.box), COLOURS["wall"])
        elif thing.class_name == "wall" and bottom(thing.box) == 0:
            yield Shape("rect", footprint(thing.box), "#8d8d8d")
        elif thing.mount == "window":
            yield Shape("rect", footprint(thing.box), COLOURS.get(thing.class_name, COLOURS["curtain"]))
        elif thing.class_name in ("door", "maindoor"):
            yield Shape("rect", footprint(thing.box), COLOURS["door"])


def _furniture(thing: Thing, colour: str = "") -> Iterator[Shape]:
    rect = footprint(thing.box)
    yield Shape("rect", rect, colour or (FURNITURE if thing.mount == "floor" else HUNG), "#6b5535")
    if thing.yaw is not None:
        edge = before(rect, thing.yaw, -min(0.05, rect.width / 3, rect.depth / 3))
        yield Shape("rect", edge, "#6b5535")


_LETTER = 0.24
"""Height of the letters of a room's name, metres, in rooms that have as much space."""

_STEPS = 6
"""Places tried from the middle of a room to each side."""


def _room_label(name: str, room: Rect, furniture: Sequence[Rect]) -> Shape:
    """Return the name of a room, where it covers least furniture, as near to the middle as that allows."""
    depth = min(_LETTER, 0.95 * room.width / (0.6 * max(len(name), 1)))
    width = 0.6 * depth * len(name)
    spare = room.width - width, room.depth - depth
    places = [(across, up) for across in range(-_STEPS, _STEPS + 1) for up in range(-_STEPS, _STEPS + 1)]
    found = []
    for across, up in sorted(places, key=lambda place: place[0] ** 2 + place[1] ** 2):
        x, z = room.x0 + spare[0] * (0.5 + 0.45 * across / _STEPS), room.z0 + spare[1] * (0.5 + 0.45 * up / _STEPS)
        found.append(Rect(x, z, x + width, z + depth))
    best = min(found, key=lambda rect: sum(rect.overlap(thing) for thing in furniture))
    return Shape("text", best, "#00000077", text=name, size=depth)


def _label(thing: Thing) -> Shape:
    """Return the name of a piece of furniture, over what stands on it."""
    rect = footprint(thing.box)
    size = min(0.12, 1.5 * max(rect.width, rect.depth) / max(len(thing.class_name), 1))
    return Shape("text", rect, INK, HALO, text=thing.class_name, size=size)


def bounds(layout: Layout) -> Rect:
    """Extent of the drawing, metres."""
    return Rect.over(room.rect for room in layout.plan.rooms).inset(-BORDER)


def svg(layout: Layout, trails: Sequence[Trail] = ()) -> str:
    """Return the floor plan as an SVG document, with ways over it."""
    area = bounds(layout)
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{area.width * SCALE:.0f}" height="{area.depth * SCALE:.0f}" '
        f'viewBox="0 0 {area.width * SCALE:.1f} {area.depth * SCALE:.1f}" font-family="sans-serif">'
    )
    parts = [head, f"<title>{escape(layout.plan.name)}</title>", '<rect width="100%" height="100%" fill="#ffffff"/>']
    parts.extend(svg_shape(shape, area) for shape in shapes(layout))
    parts.extend(part for trail in trails for part in svg_trail(trail, area))
    return "\n".join([*parts, "</svg>", ""])


def svg_shape(shape: Shape, area: Rect) -> str:
    """Return a shape as SVG."""
    rect = shape.rect
    x, y = (rect.x0 - area.x0) * SCALE, (area.z1 - rect.z1) * SCALE
    if shape.kind == "text":
        middle, centre = x + rect.width * SCALE / 2, y + rect.depth * SCALE / 2
        size = shape.size * SCALE
        halo = f' paint-order="stroke" stroke="{shape.edge}" stroke-width="{size / 4:.1f}"' if shape.edge else ""
        return (
            f'<text x="{middle:.1f}" y="{centre + size / 3:.1f}" font-size="{size:.1f}" text-anchor="middle" '
            f'fill="{shape.fill}"{halo}>{escape(shape.text)}</text>'
        )
    edge = f' stroke="{shape.edge}" stroke-width="0.7"' if shape.edge else ""
    width, height = rect.width * SCALE, rect.depth * SCALE
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" fill="{shape.fill}"{edge}/>'


def svg_trail(trail: Trail, area: Rect) -> Iterator[str]:
    """Yield a way and its moments as SVG."""

    def at(point: Spot) -> str:
        return f"{(point[0] - area.x0) * SCALE:.1f},{(area.z1 - point[1]) * SCALE:.1f}"

    points = " ".join(map(at, trail.points))
    style = f'fill="none" stroke="{trail.colour}" stroke-width="4" stroke-opacity="0.75" stroke-linejoin="round"'
    yield f'<polyline points="{points}" {style}/>'
    for point in trail.moments:
        x, y = at(point).split(",")
        yield f'<circle cx="{x}" cy="{y}" r="8" fill="{trail.colour}" stroke="#000000" stroke-width="2"/>'


def write(layout: Layout, path: Path | str, trails: Sequence[Trail] = ()) -> None:
    """Write the floor plan as SVG or PNG, by the file's ending, with ways over it.

    Raises:
        HearthError: UNSUPPORTED_FILE for another ending.
    """
    target = Path(path)
    if target.suffix == ".svg":
        chosen_files.write(target, svg(layout, trails).encode())
    elif target.suffix == ".png":
        _write_png(layout, target, trails)
    else:
        raise HearthError.of(Code.UNSUPPORTED_FILE, "a floor plan is written as .svg or .png", file=str(path))


def _write_png(layout: Layout, path: Path, trails: Sequence[Trail]) -> None:
    canvas = library("matplotlib.backends.backend_agg").FigureCanvasAgg
    area = bounds(layout)
    figure = library("matplotlib.figure").Figure(figsize=(area.width, area.depth), dpi=SCALE)
    paint(figure.add_axes((0, 0, 1, 1)), area, shapes(layout), trails)
    with chosen_files.writing(path) as temporary:
        canvas(figure).print_png(str(temporary), metadata={"Software": None})


def paint(axes: Any, area: Rect, parts: Iterable[Shape], trails: Sequence[Trail]) -> None:
    """Shapes and ways on axes of matplotlib, which then show an area."""
    rectangle = library("matplotlib.patches").Rectangle
    axes.set_xlim(area.x0, area.x1)
    axes.set_ylim(area.z0, area.z1)
    axes.set_axis_off()
    for number, shape in enumerate(parts):
        rect = shape.rect
        if shape.kind == "text":
            size = shape.size * 72 * 0.95
            halo = [library("matplotlib.patheffects").withStroke(linewidth=size / 4, foreground=shape.edge)]
            axes.text(*rect.center, shape.text, size=size, ha="center", va="center", color=shape.fill, zorder=number,
                      path_effects=halo if shape.edge else None)  # fmt: skip
        else:
            axes.add_patch(rectangle((rect.x0, rect.z0), rect.width, rect.depth, facecolor=shape.fill,
                                     edgecolor=shape.edge or "none", linewidth=0.5, zorder=number))  # fmt: skip
    for trail in trails:
        xs, zs = zip(*trail.points, strict=True)
        axes.plot(xs, zs, color=trail.colour, linewidth=3, alpha=0.75, zorder=10_000)
        for x, z in trail.moments:
            axes.plot(x, z, "o", color=trail.colour, markersize=9, markeredgecolor="black", zorder=10_001)
