"""A layout for any scene graph: rooms joined through their doors, furniture along walls, things on and in each other.

The relations decide: things that are CLOSE are put close, things that FACE something are turned to it, as far as there
is room. Relations that cannot be met are reported, edge by edge.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import sqrt

from hearth.homes.from_graph import room_panels
from hearth.homes.from_graph.furniture_arrangement import Crowd, furnish
from hearth.homes.from_graph.geometric_relations import missed, unmet
from hearth.homes.from_graph.room_embedding import guessed
from hearth.homes.from_graph.room_rectangles import RoomPair, packed
from hearth.homes.from_graph.rooms_and_supports import Parts
from hearth.homes.geometry import Rect
from hearth.homes.plans import home_shell
from hearth.homes.plans.home_shell import Thing, outer_walls, shared_wall, span
from hearth.homes.plans.layout import Layout
from hearth.homes.plans.plan import OUTSIDE, Doorway, Plan, Room, Window
from hearth.homes.plans.plan_entries import MOST_ROOMS
from hearth.homes.plans.walkable_floor import REACH
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.schemas.yaml_fields import Faults

HEIGHT = 2.6
LEAST_SIDE = 2.6
SPACE = 2.4
"""Square metres of room for each square metre of furniture."""
MOST_STANDING = 500
"""Things that are in a room, and not on or in another thing: each is placed among all others. Published homes
have fewer than 100."""
GOES = 2
"""Number of times that a home is furnished in a series; each time uses the result of the one before."""
ENLARGED = (1.0, 1.2, 1.45, 1.75, 2.1)
"""Factors by which a room's floor is enlarged until everything stands."""


@dataclass(frozen=True, slots=True)
class GraphLayout:
    """A graph with geometry.

    Attributes:
        graph: the same nodes and edges, in the same order; those that have a place with box and yaw.
        layout: rooms, doors and things, for drawing and walking; things are called by their node ids.
        unmet: the edges that the geometry does not show, each with the ids in `found`.
    """

    graph: EnvironmentGraph
    layout: Layout
    unmet: tuple[Diagnostic, ...]


def lay_out(graph: EnvironmentGraph, name: str, knowledge: Knowledge) -> GraphLayout:
    """Give a graph plausible geometry; the same graph always gets the same.

    Raises:
        HearthError: NO_ROOM: it has no room; FILE_TOO_LARGE: it has more to place than any home.
    """
    parts = Parts(graph, knowledge)
    if not parts.rooms:
        raise HearthError.of(Code.NO_ROOM, "there is no room to lay out", file=name,
                             suggestion="a node of the category Rooms")  # fmt: skip
    _check_number(parts, name)
    plan, built = _large_enough(parts, name)
    crowd, things = _arranged(parts, plan, built)
    layout = Layout(plan, built, (*built.things, *crowd.things.values()))
    people = [node.id for node in graph.nodes if node.class_name == CHARACTER_CLASS]
    for person in people[:1]:
        room = _name(parts.nodes[parts.room.get(person, parts.rooms[0])])
        layout = replace(layout, plan=replace(plan, character=room))
        things[person] = layout.character
    new = EnvironmentGraph(tuple(_placed(node, things.get(node.id)) for node in graph.nodes), graph.edges, graph.extra)
    return GraphLayout(new, layout, tuple(unmet(new, things, parts, crowd.squeezed)))


def _check_number(parts: Parts, name: str) -> None:
    """Refuse a graph with more rooms, or things on the floor, than are placed in a minute."""
    standing = sum(len(parts.roots(room)) for room in parts.rooms)
    if len(parts.rooms) > MOST_ROOMS or standing > MOST_STANDING:
        message = f"a graph without boxes of {len(parts.rooms):,} rooms and {standing:,} things that stand in them"
        remedy = (
            f"at most {MOST_ROOMS} rooms and {MOST_STANDING} such things; or give each room and thing a bounding_box"
        )
        raise HearthError.of(Code.FILE_TOO_LARGE, message, file=name, suggestion=remedy)


def _large_enough(parts: Parts, name: str) -> tuple[Plan, home_shell.Shell]:
    """Rooms in which all furniture stands, or that are as large as they may be."""
    factors = dict.fromkeys(parts.rooms, 0)
    for _ in ENLARGED:
        plan, built = _plan(parts, name, {room: ENLARGED[step] for room, step in factors.items()})
        crowd = Crowd(parts, built, {})
        short = _short(crowd, plan)
        short += [room for room in _cut_off(crowd, plan, built) if room not in short]
        if all(factors[room] == len(ENLARGED) - 1 for room in short):
            break
        factors.update({room: min(factors[room] + 1, len(ENLARGED) - 1) for room in short})
    return plan, built


def _short(crowd: Crowd, plan: Plan) -> list[int]:
    """Furnish all rooms; those where something of size found no place."""
    return [room for room, found in zip(crowd.parts.rooms, plan.rooms, strict=True) if furnish(crowd, room, found)]


def _cut_off(crowd: Crowd, plan: Plan, built: home_shell.Shell) -> list[int]:
    """Return the room of each piece of furniture that nobody gets near."""
    numbers = {room.name: number for number, room in enumerate(plan.rooms)}
    floor = Layout(plan, built, (*built.things, *crowd.things.values())).floor
    standing = (thing for thing in crowd.things.values() if thing.mount == "floor")
    rooms = ((numbers[each.room], each.box) for each in standing)
    return [plan.rooms[number].line for number, box in rooms if floor.distance(box, number) > REACH]


def _arranged(parts: Parts, plan: Plan, built: home_shell.Shell) -> tuple[Crowd, dict[int, Thing]]:
    """Everything in its place, the best of several goes: each knows where the one before has put things.

    The furniture decides which tile is where, and then the tiles where the furniture is. One series of goes begins with
    nothing known, the other with a guess.
    """
    fixed, places = room_panels.rooms_and_doors(parts, plan, built), room_panels.slots(parts, plan, built)
    guess = guessed(parts, plan, fixed)
    found: list[tuple[int, Crowd, dict[int, Thing]]] = []
    for start in ({}, guess | room_panels.assigned(parts, places, guess | fixed, anew=True)):
        before: dict[int, Thing] = start
        for _ in range(GOES):
            crowd = Crowd(parts, built, before | fixed)
            lost = 1000 * len(_short(crowd, plan)) + 200 * len(_cut_off(crowd, plan, built))
            before = fixed | crowd.things
            before |= room_panels.assigned(parts, places, before)
            found.append((lost + missed(parts, before), crowd, before))
    _, crowd, things = min(found, key=lambda go: go[0])
    return crowd, dict(things)


def _placed(node: Node, thing: Thing | None) -> Node:
    return node if thing is None else replace(node, box=thing.box, yaw=thing.yaw)


def _name(room: Node) -> str:
    return f"{room.class_name} ({room.id})"


def _plan(parts: Parts, name: str, factors: Mapping[int, float]) -> tuple[Plan, home_shell.Shell]:
    sizes = {}
    for room in parts.rooms:
        area = (SPACE * parts.area(room) + 4.0) * factors[room]
        width = round(max(LEAST_SIDE, sqrt(1.25 * area)), 1)
        sizes[room] = (width, round(max(LEAST_SIDE, area / width), 1))
    rects, _ = packed(sizes, list(parts.between.values()))
    x, z = min(rect.x0 for rect in rects.values()), min(rect.z0 for rect in rects.values())
    moved = {r: Rect(*(round(v, 2) for v in (q.x0 - x, q.z0 - z, q.x1 - x, q.z1 - z))) for r, q in rects.items()}
    doors = (*_doorways(parts, moved), *_ways_out(parts, moved))
    rooms = tuple(
        Room(_name(node := parts.nodes[r]), node.class_name, moved[r], _windows(parts, r, moved), line=r)
        for r in parts.rooms
    )
    plan = Plan(name, rooms, doors, "Laid out from its relations.", HEIGHT)
    return plan, home_shell.build(plan, Faults(name))


def _doorways(parts: Parts, rects: Mapping[int, Rect]) -> list[Doorway]:
    """One for each pair of rooms that share a wall and a door; with a leaf where there is a door, not only its jamb."""
    pairs: dict[RoomPair, list[int]] = {}
    for door, pair in sorted(parts.between.items()):
        if shared_wall(rects[pair[0]], rects[pair[1]]) is not None:
            pairs.setdefault(pair, []).append(door)
    found = []
    for (one, other), doors in pairs.items():
        names = _name(parts.nodes[one]), _name(parts.nodes[other])
        leaves = [door for door in doors if parts.nodes[door].class_name == "door"]
        into = next(
            (_name(parts.nodes[r]) for door in leaves if (r := parts.room.get(door, -1)) in (one, other)), names[1]
        )
        found.append(Doorway(names, leaf=bool(leaves), into=into, line=doors[0]))
    return found


def _ways_out(parts: Parts, rects: Mapping[int, Rect]) -> Iterator[Doorway]:
    """Yield a room's main door, in the last of its outer walls; the others are for windows."""
    for room in parts.rooms:
        walls = outer_walls(rects[room], [rect for other, rect in rects.items() if other != room])
        for door in parts.of_class(room, "maindoor")[: len(walls[:1])]:
            yield Doorway((_name(parts.nodes[room]), OUTSIDE), wall=walls[-1], line=door)


def _windows(parts: Parts, room: int, rects: Mapping[int, Rect]) -> tuple[Window, ...]:
    """Return as many windows as the graph has, in the middle of outer walls and then next to the middle.

    Curtains as it has them.
    """
    walls = outer_walls(rects[room], [rect for other, rect in rects.items() if other != room])
    if parts.of_class(room, "maindoor"):
        walls = walls[:-1]
    count, curtains = len(parts.of_class(room, "window")), len(parts.of_class(room, "curtain"))
    found = []
    for number, wall in zip(range(count), walls, strict=False):
        low, high = span(rects[room], wall)
        width = round(min(1.4, 0.5 * (high - low)), 1)
        hung = min(2, curtains - 2 * number) if curtains > 2 * number else 0
        found.append(Window(wall, None, width, 1.2, 0.9, curtains=hung))
    return tuple(found)
