"""Boxes of a home that was read: those of the file with rooms around them, or those of a layout."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from hearth.homes.from_graph.layout_from_boxes import measured
from hearth.homes.geometry import Rect, bottom, box_over, footprint
from hearth.homes.lint import CHECKS, View
from hearth.homes.plans.walkable_floor import REACH, gaps
from hearth.interop.scene_graphs import completion
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY

Notes = list[tuple[str, Sequence[str]]]
"""Kinds of changes and additions, with a word for each case."""

MARGIN = 0.6
"""Metres of floor around the things of a room whose own size is not known."""

SHIFT = 0.25
"""Metres by which a thing is moved at most to be within reach."""

MOST_OVER = 0.8
"""Least share of a room's things that stand over its floors."""

HEIGHT = 2.6
"""Metres from floor to ceiling of such a room."""


class Extents(NamedTuple):
    """Boxes of the rooms, and how they were found, in words."""

    boxes: Mapping[int, Box]
    how: str


def with_boxes(
    graph: EnvironmentGraph, floors: Sequence[Box], file: str, knowledge: Knowledge
) -> tuple[EnvironmentGraph, Notes]:
    """Return a graph with boxes, and notes: the file's if a person can walk to everything, else those of a layout.

    Raises:
        HearthError: as `lay_out`.
    """
    own, notes = _with_own_boxes(graph, knowledge)
    if own is None:
        return _laid_out(graph, file, knowledge, notes)
    cut: list[str] = []
    last: tuple[EnvironmentGraph, Notes] | None = None
    for extents in _extents(own, floors):
        found = _with_rooms(own, extents.boxes)
        out_of_reach = completion.unreachable(found, knowledge)
        named = [node.class_name for node in own.nodes if node.id in extents.boxes]
        if not out_of_reach:
            return found, [*notes, (extents.how, named)]
        cut = cut or out_of_reach
        last = found, [*notes, (extents.how, named)]
    moved = [] if last is None else _within_reach(last[0], knowledge)
    if last is not None and moved:
        boxes = {node.id: node.box for node in moved if node.box is not None}
        last[1].append((f"things moved by {SHIFT:g} m at most into reach", [node.class_name for node in moved]))
        return _with_rooms(last[0], boxes), last[1]
    had = [node.class_name for node in graph.nodes if node.box is not None and node.category != ROOM_CATEGORY]
    others = f" and {len(cut) - 1} others" if len(cut) > 1 else ""
    why = f"nobody can walk to {cut[0]}{others}" if cut else "its rooms cannot be distinguished"
    notes.append((f"boxes of the file left out, as {why}", had))
    return _laid_out(graph, file, knowledge, notes)


def _laid_out(graph: EnvironmentGraph, file: str, knowledge: Knowledge, notes: Notes) -> tuple[EnvironmentGraph, Notes]:
    """Return a graph with doors and boxes that its relations suggest, and the notes of that."""
    doors, count = completion.with_doors(completion.without_boxes(graph), max(node.id for node in graph.nodes) + 1)
    made = completion.laid_out(doors, file, knowledge)
    boxed = [node.class_name for node in made.nodes if node.box is not None]
    notes.append(("doors from the largest room to the others", ["doorjamb"] * count))
    return made, [*notes, ("boxes that fit the relations", boxed)]


def _with_own_boxes(graph: EnvironmentGraph, knowledge: Knowledge) -> tuple[EnvironmentGraph | None, Notes]:
    """Return a graph in which every thing has a box, the file's or one on or in its holder; None where one has none."""
    had = [node.class_name for node in graph.nodes if node.box is not None and node.category != ROOM_CATEGORY]
    if not had:
        return None, []
    graph, placed = completion.boxed_by_holders(graph, knowledge)
    things = [node for node in graph.nodes if node.category != ROOM_CATEGORY and node.class_name != CHARACTER_CLASS]
    bare = [node.class_name for node in things if node.box is None]
    if bare:
        return None, [(f"boxes of the file left out, as {bare[0]} and others have none", had)]
    return graph, [("boxes on or in the holder of a thing", placed)]


def _within_reach(graph: EnvironmentGraph, knowledge: Knowledge) -> list[Node]:
    """Return the nodes that are out of reach, moved towards the floor; [] where one of them is too far from it."""
    layout = measured(graph, "", knowledge)
    cells = np.asarray(layout.floor.origin) + (np.argwhere(layout.floor.main) + 0.5) * layout.floor.cell
    moved: list[Node] = []
    for fault in CHECKS["on foot"](View(graph, knowledge)):
        node = graph.node(int(fault.found))
        far = np.inf if node.box is None or not len(cells) else gaps(cells, node.box)
        if node.box is None or np.min(far) > REACH + SHIFT:
            return []
        (x, y, z), nearest = node.box.center, cells[int(np.argmin(far))]
        way = np.clip(nearest - (x, z), -SHIFT, SHIFT)
        way = way * (np.abs(way) == np.abs(way).max())
        moved.append(replace(node, box=Box((round(x + way[0], 4), y, round(z + way[1], 4)), node.box.size)))
    boxes = {node.id: node.box for node in moved if node.box is not None}
    return moved if not completion.unreachable(_with_rooms(graph, boxes), knowledge) else []


def _with_rooms(graph: EnvironmentGraph, boxes: Mapping[int, Box]) -> EnvironmentGraph:
    return replace(graph, nodes=tuple(replace(n, box=boxes[n.id]) if n.id in boxes else n for n in graph.nodes))


def _extents(graph: EnvironmentGraph, floors: Sequence[Box]) -> Iterator[Extents]:
    """Yield boxes of the rooms, the likeliest first: the file's own, those of its floors, those around their things.

    Rooms without a thing have none, and rooms that overlap are none.
    """
    rooms = [node for node in graph.nodes if node.category == ROOM_CATEGORY]
    if all(room.box is not None and min(room.box.size) > 0 for room in rooms):
        yield Extents({}, "rooms of the file")
        return
    held: dict[int, list[Box]] = {room.id: [] for room in rooms}
    boxes = {node.id: node.box for node in graph.nodes if node.box is not None}
    for edge in graph.edges:
        if edge.relation == "INSIDE" and edge.target in held and edge.source in boxes:
            held[edge.target].append(boxes[edge.source])
    if not all(held.values()):
        return
    low = min(bottom(box) for each in held.values() for box in each)
    things = {room: list(map(footprint, each)) for room, each in held.items()}
    outlines = [("rooms around their things", {r: Rect.over(each).inset(-MARGIN) for r, each in things.items()})]
    by_floors = {room: _floor_under(each, floors) for room, each in things.items()}
    known = {room: rect for room, rect in by_floors.items() if rect is not None}
    if len(known) == len(rooms):
        outlines.insert(0, ("rooms as large as the floors of the file", known))
    for how, found in outlines:
        if not any(found[one].overlap(found[other]) > 0 for one, other in _pairs(list(found))):
            yield Extents({room: box_over(rect, low, low + HEIGHT) for room, rect in found.items()}, how)


def _floor_under(things: Sequence[Rect], floors: Sequence[Box]) -> Rect | None:
    """Return the outline of the floors under a room's things; None where too many of them stand over none.

    Floors end at the walls, in which windows and mirrors are.
    """
    under = [footprint(floor) for floor in floors]
    under = [rect for rect in under if any(rect.holds(*thing.center) for thing in things)]
    if not under:
        return None
    rect = Rect.over(under)
    return rect if sum(rect.holds(*thing.center) for thing in things) >= MOST_OVER * len(things) else None


def _pairs(rooms: Sequence[int]) -> Iterator[tuple[int, int]]:
    return ((one, other) for number, one in enumerate(rooms) for other in rooms[:number])
