"""Floor plans of homes, drawn from the boxes of their nodes."""

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

from hearth.datasets.dataset import Dataset
from hearth.schemas.graph import Box, Node

_SHELL = frozenset({"Walls", "Ceiling", "Floor", "Floors", "Characters", "Rooms"})
_SMALLEST = 0.25
"""Least area of a drawn thing, square metres."""


Rectangle = tuple[float, float, float, float]
"""Left, top, width and height, metres."""


@dataclass(frozen=True, slots=True)
class Plan:
    """A home's floor plan as SVG, or "" if its nodes have no boxes."""

    home: str
    rooms: str
    nodes: int
    svg: str


def plans(dataset: Dataset) -> list[Plan]:
    """Return every home, by name."""
    _, rows = dataset.rows("SELECT home, rooms, nodes FROM homes ORDER BY home")
    return [
        Plan(home, ", ".join(rooms).replace("_", " "), nodes, draw(dataset.home(home).nodes))
        for home, rooms, nodes in rows
    ]


def draw(nodes: tuple[Node, ...]) -> str:
    """Return a floor plan in metres: rooms with their names, furniture as boxes; z points up the page."""
    rooms = [(node, node.box) for node in nodes if node.category == "Rooms" and node.box]
    if not rooms:
        return ""
    corners = [_rectangle(box) for _, box in rooms]
    left, top = min(x for x, _, _, _ in corners), min(y for _, y, _, _ in corners)
    right, bottom = max(x + w for x, _, w, _ in corners), max(y + h for _, y, _, h in corners)
    view = f"{left - 0.2:.2f} {top - 0.2:.2f} {right - left + 0.4:.2f} {bottom - top + 0.4:.2f}"
    shapes = "".join((*_rooms(rooms), *_things(nodes), *_furniture_names(nodes), *_names(rooms)))
    return f'<svg class="plan" viewBox="{view}" role="img">{shapes}</svg>'


def _rectangle(box: Box) -> Rectangle:
    (x, _, z), (width, _, depth) = box.center, box.size
    return x - width / 2, -z - depth / 2, width, depth


def _rooms(rooms: list[tuple[Node, Box]]) -> Iterator[str]:
    for _, box in rooms:
        x, y, width, height = _rectangle(box)
        yield f'<rect class="room" x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}"/>'


def _names(rooms: list[tuple[Node, Box]]) -> Iterator[str]:
    for node, box in rooms:
        x, y, _, size = _room_name(node, box)
        name = escape(node.class_name.replace("_", " "))
        yield f'<text x="{x:.2f}" y="{y + size:.2f}" font-size="{size:.2f}">{name}</text>'


def _room_name(node: Node, box: Box) -> Rectangle:
    """Return the area of a room's name; its height is the letters'."""
    x, y, width, _ = _rectangle(box)
    length = max(len(node.class_name), 1)
    size = min(0.35, 1.6 * (width - 0.3) / length)
    return x + 0.15, y + 0.45 - size, _LETTER * size * length, size


_MAT = 0.1
"""Height in metres below which furniture stands on a thing, as on a carpet."""

_LONGEST, _LETTER, _LEGIBLE = 0.24, 0.56, 0.085
"""Metres of the largest letters on furniture, width of a letter as a share of its height, and the smallest letters."""


def _furniture_names(nodes: tuple[Node, ...]) -> Iterator[str]:
    """Yield the names of furniture in which they fit, along its longer side, above the things on it as in
    `homes/floor_plan_drawing.py`.

    Names of mats are given where nothing is on them.
    """
    drawn = list(_furniture(nodes))
    taken = [_room_name(node, node.box) for node in nodes if node.category == "Rooms" and node.box]
    for node, (x, y, width, height) in drawn:
        name = node.class_name.replace("_", " ")
        along, across = max(width, height), min(width, height)
        size = min(_LONGEST, 0.9 * along / (_LETTER * len(name)), 0.7 * across)
        long = _LETTER * size * len(name)
        w, h = (long, size) if width >= height else (size, long)
        line = x + (width - w) / 2, y + (height - h) / 2, w, h
        on_mat = [other for one, other in drawn if one is not node and other[2] * other[3] < width * height]
        others = on_mat if node.box is not None and node.box.size[1] < _MAT else []
        if size < _LEGIBLE or any(_overlap(line, other) for other in (*others, *taken)):
            continue
        taken.append(line)
        middle = f"{x + width / 2:.2f} {y + height / 2:.2f}"
        turn = f' transform="rotate(-90 {middle})"' if height > width else ""
        at = f'x="{x + width / 2:.2f}" y="{y + height / 2:.2f}"'
        yield f'<text class="named" {at} font-size="{size:.3f}"{turn}>{escape(name)}</text>'


def _overlap(one: Rectangle, other: Rectangle) -> bool:
    return all(one[k] < other[k] + other[k + 2] and other[k] < one[k] + one[k + 2] for k in (0, 1))


def _furniture(nodes: tuple[Node, ...]) -> Iterator[tuple[Node, Rectangle]]:
    """Yield the things that are large enough to be drawn, and where, the largest first."""
    drawn = [(node, _rectangle(node.box)) for node in nodes if node.box and node.category not in _SHELL]
    for node, at in sorted(drawn, key=lambda each: -each[1][2] * each[1][3]):
        if at[2] * at[3] >= _SMALLEST and node.category != "Doors":
            yield node, at


def _things(nodes: tuple[Node, ...]) -> Iterator[str]:
    drawn = [(node, _rectangle(node.box)) for node in nodes if node.box and node.category not in _SHELL]
    for node, (x, y, width, height) in sorted(drawn, key=lambda each: -each[1][2] * each[1][3]):
        if width * height >= _SMALLEST or node.category == "Doors":
            kind = "door" if node.category == "Doors" else "thing"
            place = f'x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}"'
            yield f'<rect class="{kind}" {place}><title>{escape(node.class_name)} ({node.id})</title></rect>'
