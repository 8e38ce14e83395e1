"""A layout for any scene graph: rooms joined through their doors, furniture along walls, things on and in each other.

The relations decide: what is CLOSE is put close, what FACES something is turned to it, as far as there is room. What
cannot be had is told, edge by edge.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt

from hearth.kb.knowledge import Knowledge, default
from hearth.schemas.errors import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.simulation.homes import shell
from hearth.simulation.homes.geometry import OPPOSITE_WALL, Rect, box_over
from hearth.simulation.homes.graph_furnishing import Crowd, furnish
from hearth.simulation.homes.graph_parts import Parts
from hearth.simulation.homes.graph_relations import unmet
from hearth.simulation.homes.graph_rooms import Pair, packed
from hearth.simulation.homes.layout import Layout
from hearth.simulation.homes.plan import Doorway, Faults, Plan, Room, Window
from hearth.simulation.homes.shell import Thing, interior, shared_wall, span

HEIGHT = 2.6
LEAST_SIDE = 2.6
SPACE = 2.4
"""Square metres of room for each square metre of furniture."""
ENLARGED = (1.0, 1.2, 1.45, 1.75, 2.1)
"""Factors by which a room's floor is enlarged until everything stands."""


@dataclass(frozen=True, slots=True)
class LaidOut:
    """A graph with geometry.

    Attributes:
        graph: the same nodes and edges, in the same order; those that have a place with box and yaw.
        layout: rooms, doors and things, for drawing and walking; things are called by their node ids.
        unmet: what the geometry does not show of what the graph says, each with the ids in `found`.
    """

    graph: EnvironmentGraph
    layout: Layout
    unmet: tuple[Diagnostic, ...]


def lay_out(graph: EnvironmentGraph, name: str = "", knowledge: Knowledge | None = None) -> LaidOut:
    """Give a graph plausible geometry; the same graph always gets the same.

    Raises:
        HearthError: NO_ROOM: it has no room.
    """
    knowledge = knowledge or default()
    parts = Parts(graph, knowledge)
    if not parts.rooms:
        raise HearthError.of(Code.NO_ROOM, "there is no room to lay out", file=name,
                             suggestion="a node of the category Rooms")  # fmt: skip
    best: tuple[Plan, shell.Shell, Crowd] | None = None
    factors = dict.fromkeys(parts.rooms, 0)
    for _ in range(len(ENLARGED)):
        plan, built = _plan(parts, name, {room: ENLARGED[step] for room, step in factors.items()})
        crowd = Crowd(parts, built)
        short = [room for room, found in zip(parts.rooms, plan.rooms, strict=True) if furnish(crowd, room, found)]
        best = plan, built, crowd
        if not short or all(factors[room] == len(ENLARGED) - 1 for room in short):
            break
        factors.update({room: min(factors[room] + 1, len(ENLARGED) - 1) for room in short})
    assert best is not None
    plan, built, crowd = best
    things = _shell_things(parts, plan, built) | crowd.things
    layout = Layout(plan, built, (*built.things, *crowd.things.values()))
    people = [node.id for node in graph.nodes if node.class_name == CHARACTER_CLASS]
    for person in people[:1]:
        room = _name(parts.nodes[parts.room.get(person, parts.rooms[0])])
        layout = replace(layout, plan=replace(plan, character=room))
        things[person] = layout.character
    new = EnvironmentGraph(tuple(_placed(node, things.get(node.id)) for node in graph.nodes), graph.edges, graph.extra)
    return LaidOut(new, layout, tuple(unmet(new, things, parts, crowd.squeezed)))


def _placed(node: Node, thing: Thing | None) -> Node:
    return node if thing is None else replace(node, box=thing.box, yaw=thing.yaw)


def _name(room: Node) -> str:
    return f"{room.class_name} ({room.id})"


def _plan(parts: Parts, name: str, factors: Mapping[int, float]) -> tuple[Plan, shell.Shell]:
    sizes = {}
    for room in parts.rooms:
        area = (SPACE * parts.area(room) + 4.0) * factors[room]
        width = round(max(LEAST_SIDE, sqrt(1.25 * area)), 1)
        sizes[room] = (width, round(max(LEAST_SIDE, area / width), 1))
    rects, _ = packed(sizes, list(parts.between.values()))
    x, z = min(rect.x0 for rect in rects.values()), min(rect.z0 for rect in rects.values())
    moved = {r: Rect(*(round(v, 2) for v in (q.x0 - x, q.z0 - z, q.x1 - x, q.z1 - z))) for r, q in rects.items()}
    doors = tuple(_doorways(parts, moved))
    rooms = tuple(
        Room(_name(node := parts.nodes[r]), node.class_name, moved[r], _windows(parts, r, moved), line=r)
        for r in parts.rooms
    )
    plan = Plan(name, rooms, doors, "Laid out from its relations.", HEIGHT)
    return plan, shell.build(plan, Faults(name))


def _doorways(parts: Parts, rects: Mapping[int, Rect]) -> list[Doorway]:
    """One for each pair of rooms that share a wall and a door; with a leaf where there is a door, not only its jamb."""
    pairs: dict[Pair, list[int]] = {}
    for door, pair in sorted(parts.between.items()):
        if shared_wall(rects[pair[0]], rects[pair[1]]) is not None:
            pairs.setdefault(pair, []).append(door)
    found = []
    for (one, other), doors in pairs.items():
        leaf = any(parts.nodes[door].class_name == "door" for door in doors)
        names = _name(parts.nodes[one]), _name(parts.nodes[other])
        found.append(Doorway(names, leaf=leaf, into=names[1], line=doors[0]))
    return found


def _windows(parts: Parts, room: int, rects: Mapping[int, Rect]) -> tuple[Window, ...]:
    """As many as the graph has, in the middle of outer walls and then beside the middle; curtains as it has them."""
    inner = {
        shared[0] for other in rects if other != room and (shared := shared_wall(rects[room], rects[other])) is not None
    }
    walls = [wall for wall in OPPOSITE_WALL if wall not in inner]
    count, curtains = len(parts.of_class(room, "window")), len(parts.of_class(room, "curtain"))
    found = []
    for number, wall in zip(range(count), walls, strict=False):
        low, high = span(rects[room], wall)
        width = round(min(1.4, 0.5 * (high - low)), 1)
        hung = min(2, curtains - 2 * number) if curtains > 2 * number else 0
        found.append(Window(wall, None, width, 1.2, 0.9, curtains=hung))
    return tuple(found)


def _shell_things(parts: Parts, plan: Plan, built: shell.Shell) -> dict[int, Thing]:
    """Rooms, doors, windows, curtains, floors and ceilings of the graph, as far as the rooms have them."""
    found: dict[int, Thing] = {}
    for node, room, thing in zip(parts.rooms, plan.rooms, Layout(plan, built, ()).rooms(), strict=True):
        found[node] = thing
        own = [t for t in built.things if t.room == room.name]
        for class_name in ("window", "curtain"):
            found |= _matched(parts.of_class(node, class_name), [t for t in own if t.class_name == class_name])
        for class_name, heights in (("floor", (-0.1, 0.0)), ("ceiling", (HEIGHT, HEIGHT + 0.1))):
            found |= _tiled(parts.of_class(node, class_name), class_name, room, heights)
    for door in plan.doorways:
        hung = [t for t in built.things if t.line == door.line and t.mount == "door"]
        pair = {room for room in parts.rooms if _name(parts.nodes[room]) in door.rooms}
        here = [d for d, rooms in sorted(parts.between.items()) if set(rooms) == pair]
        for class_name in ("door", "doorjamb"):
            nodes = [d for d in here if parts.nodes[d].class_name == class_name]
            found |= _matched(nodes, [t for t in hung if t.class_name == class_name])
    return found


def _tiled(nodes: Sequence[int], class_name: str, room: Room, heights: tuple[float, float]) -> dict[int, Thing]:
    """A room's floor or ceiling in as many strips as the graph has tiles of it."""
    inner, found = interior(room), {}
    for k, node in enumerate(nodes):
        x0, x1 = (inner.x0 + inner.width * i / len(nodes) for i in (k, k + 1))
        box = box_over(Rect(x0, inner.z0, x1, inner.z1), *heights)
        found[node] = Thing(str(node), class_name, room.name, box)
    return found


def _matched(nodes: Sequence[int], things: Sequence[Thing]) -> dict[int, Thing]:
    return dict(zip(nodes, things, strict=False))
