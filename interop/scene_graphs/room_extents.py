"""Boxes of a home that was read: those of the file with rooms around them, or those of a layout."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import replace
from math import hypot
from statistics import median
from typing import NamedTuple

import numpy as np

from hearth.homes.from_graph.layout_from_boxes import measured
from hearth.homes.geometry import Rect, bottom, box_over, footprint, top
from hearth.homes.lint import CHECKS, View
from hearth.homes.plans.home_shell import WALL
from hearth.homes.plans.walkable_floor import REACH, gaps
from hearth.interop.scene_graphs import completion
from hearth.interop.scene_graphs.room_doors import DEEPEST_OVERLAP, DOORS, with_doors, with_walls_between
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

MOST_LOST = 0.5
"""Share of the things of a file that may be out of reach; with more of them, its boxes as a whole can't be."""

MOST_APART = 5.0
"""Metres between the things of two rooms over which the rooms are still next to one another."""

FAR_OFF = 5.0
"""Metres from the middle of a room's things within which a thing always counts for the room's outline."""

EMPTY_SIDE = 3.0
"""Metres along a room that the file has no thing or outline of."""


class Extents(NamedTuple):
    """Boxes of the rooms, and how they were found, in words."""

    boxes: Mapping[int, Box]
    how: str


def with_boxes(
    graph: EnvironmentGraph, floors: Sequence[Box], file: str, knowledge: Knowledge
) -> tuple[EnvironmentGraph, Notes]:
    """Return a graph with boxes, and notes: the file's, or those of a layout where a person gets to few of them.

    Things of the file that nobody can walk to stay without a box, and are named.

    Raises:
        HearthError: as `lay_out`.
    """
    had = [node.class_name for node in graph.nodes if node.box is not None and node.category != ROOM_CATEGORY]
    if not had:
        return _laid_out(graph, file, knowledge, [])
    own, placed = completion.boxed_by_holders(graph, knowledge)
    notes: Notes = [("boxes on or in the holder of a thing", placed)]
    bare = [f"{node.class_name} ({node.id})" for node in own.nodes if node.box is None and _is_thing(node)]
    if len(bare) > MOST_LOST * len(own.nodes):
        reason = f"boxes of the file left out, as {bare[0]} and {len(bare) - 1} others have none"
        return _laid_out(graph, file, knowledge, [(reason, had)])
    found = min((_furnished(own, extents, knowledge) for extents in _extents(own, floors)),
                key=lambda each: len(each.lost), default=None)  # fmt: skip
    if found is None or len(found.lost) > MOST_LOST * len(had):
        why = "its rooms cannot be distinguished" if found is None else (
            f"nobody can walk to {found.lost[0]} and {len(found.lost) - 1} others")  # fmt: skip
        return _laid_out(graph, file, knowledge, [*notes, (f"boxes of the file left out, as {why}", had)])
    notes += found.notes
    notes.append(("things without a box, as nobody can walk to their boxes", found.lost))
    notes.append(("things without a box, as the file has no place for them", bare))
    return found.graph, notes


class _Furnished(NamedTuple):
    """A graph with boxes of its own, the things that lost theirs, and notes."""

    graph: EnvironmentGraph
    lost: list[str]
    notes: Notes


def _is_thing(node: Node) -> bool:
    return node.category not in (ROOM_CATEGORY, "Doors") and node.class_name != CHARACTER_CLASS


def _furnished(graph: EnvironmentGraph, extents: Extents, knowledge: Knowledge) -> _Furnished:
    """Return a graph with rooms and doors, in which the things that nobody can walk to have no boxes."""
    named = [node.class_name for node in graph.nodes if node.id in extents.boxes]
    roomed, own_doors, doors = with_doors(_with_rooms(graph, extents.boxes), knowledge)
    notes: Notes = [(extents.how, named), ("doors of the file, by their boxes", own_doors)]
    notes.append(("doors that the file leaves out", doors))
    lost = _beyond_rooms(roomed)
    found = _bare(roomed, lost)
    moved = _within_reach(found, knowledge)
    notes.append((f"things moved by {SHIFT:g} m at most into reach", [node.class_name for node in moved]))
    found = _with_rooms(found, {node.id: node.box for node in moved if node.box is not None})
    # A thing without a box is in nobody's way, so that further things may come into reach, and none goes out of it.
    lost = lost | completion.unreachable(found, knowledge)
    found = _bare(found, lost)
    names = [f"{node.class_name} ({node.id})" for node in found.nodes if node.id in lost]
    return _Furnished(found, names, notes)


def _beyond_rooms(graph: EnvironmentGraph) -> Set[int]:
    """Return the things that are farther from every room than a person reaches."""
    rooms = [footprint(node.box) for node in graph.nodes if node.category == ROOM_CATEGORY and node.box is not None]
    return {
        node.id
        for node in graph.nodes
        if _is_thing(node) and node.box is not None
        and not any(rect.inset(-REACH).holds(*footprint(node.box).center) for rect in rooms)
    }  # fmt: skip


def _bare(graph: EnvironmentGraph, lost: Set[int]) -> EnvironmentGraph:
    """Return a graph in which some things, and the things on and in them, have no boxes."""
    held = completion.below(graph)
    gone, waiting = set(lost), list(lost)
    while waiting:
        new = [thing for thing in held.get(waiting.pop(), ()) if thing not in gone]
        gone.update(new)
        waiting += new
    return replace(graph, nodes=tuple(replace(n, box=None, yaw=None) if n.id in gone else n for n in graph.nodes))


def _laid_out(graph: EnvironmentGraph, file: str, knowledge: Knowledge, notes: Notes) -> tuple[EnvironmentGraph, Notes]:
    """Return a graph with doors and boxes that its relations suggest, and the notes of that."""
    doors, count = completion.with_doors(completion.without_boxes(graph), max(node.id for node in graph.nodes) + 1)
    made = completion.laid_out(doors, file, knowledge)
    boxed = [node.class_name for node in made.nodes if node.box is not None]
    notes.append(("doors from the largest room to the others", ["doorjamb"] * count))
    return made, [*notes, ("boxes that fit the relations", boxed)]


def _within_reach(graph: EnvironmentGraph, knowledge: Knowledge) -> list[Node]:
    """Return the nodes that are a little out of reach, moved towards the floor."""
    layout = measured(graph, "", knowledge)
    cells = np.asarray(layout.floor.origin) + (np.argwhere(layout.floor.main) + 0.5) * layout.floor.cell
    moved: list[Node] = []
    for fault in CHECKS["on foot"](View(graph, knowledge)):
        node = graph.node(int(fault.found))
        far = np.inf if node.box is None or not len(cells) else gaps(cells, node.box)
        if node.box is None or np.min(far) > REACH + SHIFT:
            continue
        (x, y, z), nearest = node.box.center, cells[int(np.argmin(far))]
        way = np.clip(nearest - (x, z), -SHIFT, SHIFT)
        way = way * (np.abs(way) == np.abs(way).max())
        moved.append(replace(node, box=Box((round(x + way[0], 4), y, round(z + way[1], 4)), node.box.size)))
    boxes = {node.id: node.box for node in moved if node.box is not None}
    still = completion.unreachable(_with_rooms(graph, boxes), knowledge) if moved else set()
    return [node for node in moved if node.id not in still]


def _with_rooms(graph: EnvironmentGraph, boxes: Mapping[int, Box]) -> EnvironmentGraph:
    return replace(graph, nodes=tuple(replace(n, box=boxes[n.id]) if n.id in boxes else n for n in graph.nodes))


def _extents(graph: EnvironmentGraph, floors: Sequence[Box]) -> Iterator[Extents]:
    """Yield boxes of the rooms, the likeliest first: the file's own, those of its floors, those around their things.

    A room without a box or a thing is put next to the others. Rooms that overlap are none.
    """
    rooms = {node.id: node.box for node in graph.nodes if node.category == ROOM_CATEGORY}
    own = {room: box for room, box in rooms.items() if box is not None and min(box.size) > 0}
    if len(own) == len(rooms):
        rects = with_walls_between({room: footprint(box) for room, box in own.items()})
        boxes = own if rects is None else {
            room: box_over(rects[room], bottom(box), top(box)) for room, box in own.items()}  # fmt: skip
        yield Extents(boxes, "rooms of the file")
        return
    held: dict[int, list[Box]] = {room: [] for room in rooms}
    # A door in a wall belongs to two rooms, and says where neither ends.
    boxes = {node.id: node.box for node in graph.nodes if node.box is not None and node.class_name not in DOORS}
    for edge in graph.edges:
        if edge.relation == "INSIDE" and edge.target in held and edge.source in boxes:
            held[edge.target].append(boxes[edge.source])
    things = {room: list(map(footprint, _together(each))) for room, each in held.items() if each or room in own}
    if not any(held.values()):
        return
    low = min(bottom(box) for each in held.values() for box in each)
    around = {room: footprint(own[room]) if room in own else Rect.over(each).inset(-MARGIN)
              for room, each in things.items()}  # fmt: skip
    outlines = [("rooms around their things", with_walls_between(around, MOST_APART, 2 * MARGIN + DEEPEST_OVERLAP))]
    by_floors = {room: _floor_under(each, floors) for room, each in things.items()}
    known = {room: rect for room, rect in by_floors.items() if rect is not None}
    if len(known) == len(rooms):
        outlines.insert(0, ("rooms as large as the floors of the file", with_walls_between(known)))
    for how, found in outlines:
        if found is not None:
            every = _with_empty_rooms(found, [room for room in rooms if room not in found])
            yield Extents({room: box_over(rect, low, low + HEIGHT) for room, rect in every.items()}, how)


def _together(boxes: Sequence[Box]) -> list[Box]:
    """Return boxes without those that lie far off all others."""
    x, z = (median(box.center[axis] for box in boxes) if boxes else 0.0 for axis in (0, 2))
    far = [hypot(box.center[0] - x, box.center[2] - z) for box in boxes]
    most = max(FAR_OFF, 4 * median(far)) if far else 0.0
    return [box for box, away in zip(boxes, far, strict=True) if away <= most]


def _with_empty_rooms(rects: Mapping[int, Rect], empty: Sequence[int]) -> dict[int, Rect]:
    """Return floors of rooms with one for each room without a thing, in a row east of the others."""
    found = dict(rects)
    for room in empty:
        beside = max(found.values(), key=lambda rect: rect.x1)
        x, z = beside.x1 + 2 * WALL, beside.center[1]
        found[room] = Rect(x, z - EMPTY_SIDE / 2, x + EMPTY_SIDE, z + EMPTY_SIDE / 2)
    return found


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
