"""The layout of a scene graph that has boxes: places are read from them."""

from collections.abc import Iterator, Mapping

from hearth.homes.geometry import OPPOSITE_WALL, Rect, along_x, bottom, footprint, top
from hearth.homes.object_shapes import form
from hearth.homes.plans.home_shell import WALL, Opening, Shell, Thing, shared_wall
from hearth.homes.plans.layout import Layout
from hearth.homes.plans.plan import Doorway, Plan, Room
from hearth.homes.plans.walkable_floor import HEAD
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, ROOM_CATEGORY

NEAR = 0.7
"""Metres from a wall within which a doorjamb belongs to a hole in it."""

WallsAndJambs = tuple[list[Rect], list[Rect]]
"""The floor under wall panels, and under doorjambs."""

PANELS = frozenset({"wall", "floor", "ceiling"})


def has_geometry(graph: EnvironmentGraph) -> bool:
    """Return whether all its rooms have boxes."""
    rooms = [node for node in graph.nodes if node.category == ROOM_CATEGORY]
    return bool(rooms) and all(room.box is not None for room in rooms)


def measured(graph: EnvironmentGraph, name: str, knowledge: Knowledge) -> Layout:
    """Return the layout that a graph's boxes describe; things are called by their ids."""
    boxes = {node.id: node.box for node in graph.nodes if node.category == ROOM_CATEGORY and node.box is not None}
    names = {node.id: f"{node.class_name} ({node.id})" for node in graph.nodes if node.id in boxes}
    inside: dict[int, str] = {}
    between: dict[int, list[int]] = {}
    for edge in graph.edges:
        if edge.relation == "INSIDE" and edge.target in names:
            inside.setdefault(edge.source, names[edge.target])
        elif edge.relation == "BETWEEN" and edge.target in boxes:
            between.setdefault(edge.source, []).append(edge.target)
    rooms = tuple(_room(node, names[node.id], boxes[node.id]) for node in graph.nodes if node.id in boxes)
    openings, doors = [], []
    walls = [footprint(n.box) for n in graph.nodes if n.class_name == "wall" and n.box and bottom(n.box) < HEAD]
    jambs = [footprint(n.box) for n in graph.nodes if n.class_name == "doorjamb" and n.box]
    for node in graph.nodes:
        found = list(_openings(node, between.get(node.id, []), names, boxes, (walls, jambs)))
        openings += found
        doors += [found[0].door] if found and found[0].door else []
    people = [inside.get(node.id, "") for node in graph.nodes if node.class_name == CHARACTER_CLASS]
    height = max(box.size[1] for box in boxes.values())
    plan = Plan(name, rooms, tuple(doors), height=height, character=people[0] if people else "", file=name)
    things = tuple(
        _thing(node, inside.get(node.id, ""), node.box, knowledge)
        for node in graph.nodes
        if node.box is not None and node.id not in boxes and node.class_name != CHARACTER_CLASS
    )
    return Layout(plan, Shell([t for t in things if t.mount == "shell"], openings), things)


def _room(node: Node, name: str, box: Box) -> Room:
    return Room(name, node.class_name, footprint(box).inset(-WALL), line=node.id)


def _thing(node: Node, room: str, box: Box, knowledge: Knowledge) -> Thing:
    shaped = form(node.class_name, knowledge)
    mount = "shell" if node.class_name in PANELS else shaped.mount if shaped else "item"
    return Thing(str(node.id), node.class_name, room, box, node.yaw, mount, line=node.id)


def _openings(
    node: Node, rooms: list[int], names: Mapping[int, str], boxes: Mapping[int, Box], about: WallsAndJambs
) -> Iterator[Opening]:
    """Return the hole of a doorway in the wall of each of its two rooms: at its jamb, or next to its open leaf."""
    if node.class_name not in ("door", "doorjamb") or node.box is None or len(rooms) != 2:
        return
    joined = (boxes[rooms[0]], boxes[rooms[1]])
    is_hole = node.class_name == "doorjamb" or _fills_hole(node.box, *joined)
    place = _hole(node.box) if is_hole else _beside_leaf(node.box, *joined, about)
    if place is None:
        return
    along, start, end, at = place
    door = Doorway((names[rooms[0]], names[rooms[1]]), width=end - start, leaf=False, line=node.id)
    for room in rooms:
        wall = _nearest(footprint(boxes[room]), at, along)
        yield Opening(names[room], wall, start, end, 0.0, top(node.box), door=door, number=node.id)


def _fills_hole(leaf: Box, one: Box, other: Box) -> bool:
    """Return whether a leaf lies along the wall of two rooms, in its hole, as that of a closed door does."""
    gap_x = max(footprint(one).x0, footprint(other).x0) - min(footprint(one).x1, footprint(other).x1)
    gap_z = max(footprint(one).z0, footprint(other).z0) - min(footprint(one).z1, footprint(other).z1)
    runs_along_x = gap_z > gap_x
    return (leaf.size[0] > leaf.size[2]) == runs_along_x


DoorHole = tuple[bool, float, float, float]
"""An outline of a wall: whether it runs along x, its two ends, and its z (or x)."""


def _hole(jamb: Box) -> DoorHole:
    along = jamb.size[0] > jamb.size[2]
    rect = footprint(jamb)
    return (True, rect.x0, rect.x1, rect.center[1]) if along else (False, rect.z0, rect.z1, rect.center[0])


def _beside_leaf(leaf: Box, one: Box, other: Box, about: WallsAndJambs) -> DoorHole | None:
    """Return an open leaf stands at right angles to its wall, at one end of the hole, which is as wide as it is long.

    The end at which less of the wall stands in the hole, or, where both ends are free of it, more of a doorjamb before
    it.
    """
    shared = shared_wall(footprint(one).inset(-WALL), footprint(other).inset(-WALL))
    if shared is None:
        return None
    wall, low, high = shared
    along, width = along_x(wall), max(leaf.size[0], leaf.size[2])
    rect, (x, z) = footprint(one), footprint(leaf).center
    middle = x if along else z
    at = {"north": rect.z1, "south": rect.z0, "east": rect.x1, "west": rect.x0}[wall]

    def filled(start: float) -> tuple[float, float]:
        walls, jambs = (sum(_across(at, start, start + width, far, along).overlap(each) for each in rects)
                        for rects, far in zip(about, (WALL, NEAR), strict=True))  # fmt: skip
        return round(walls, 3), -jambs

    start = min((start for start in (middle, middle - width) if low - WALL <= start <= high + WALL - width),
                key=filled, default=middle)  # fmt: skip
    return along, max(low, start), min(high, start + width), at


def _across(at: float, start: float, end: float, far: float, along: bool) -> Rect:
    """Return the floor within `far` of a part of a wall."""
    return Rect(start, at - far, end, at + far) if along else Rect(at - far, start, at + far, end)


def _nearest(room: Rect, at: float, along: bool) -> str:
    """Return the wall of a room that is nearest to a line along x (or z)."""
    far = {"north": room.z1, "south": room.z0, "east": room.x1, "west": room.x0}
    return min((wall for wall in OPPOSITE_WALL if along_x(wall) == along), key=lambda wall: abs(far[wall] - at))
