"""Walls, floors and ceilings for the rooms of graphs without them."""

from collections.abc import Iterable, Iterator, Sequence
from math import dist

from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.scene.instances import Thing
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.rng import derive

THICK = 0.06
OPENINGS = ("window", "door", "maindoor", "balcony_door", "doorjamb")

DOORS = frozenset({"door", "maindoor", "balcony_door"})
"""Classes of doors."""

HUNG = 1.2
"""Metres from the middle of a doorway within which a door hangs in it."""

Hole = tuple[float, float, float, float]


def hung_doors(nodes: Iterable[Node]) -> frozenset[int]:
    """Return the doors that hang in a doorway: the nearest to each. Others stand in the way like furniture."""
    doors: list[tuple[int, Box]] = []
    jambs: list[Box] = []
    for node in nodes:
        if node.box and node.class_name in DOORS:
            doors.append((node.id, node.box))
        elif node.box and node.class_name == "doorjamb":
            jambs.append(node.box)
    found = set()
    for jamb in jambs:
        far = [(_apart(box, jamb), number) for number, box in doors]
        found |= {number for _, number in sorted(known for known in far if known[0] < HUNG)[:1]}
    return frozenset(found)


def _apart(one: Box, other: Box) -> float:
    return dist(one.center[::2], other.center[::2])


def walls_of(graph: EnvironmentGraph, rooms: Sequence[Node]) -> list[Thing]:
    """Floor, ceiling and four walls around each room with a box; none if a wall of the graph has a box."""
    if any(node.class_name == "wall" and node.box for node in graph.nodes):
        return []
    holes = [node.box for node in graph.nodes if node.class_name in OPENINGS and node.box]
    return [thing for room in rooms if room.box for thing in _around(room, room.box, holes)]


def around_openings(wall: Box, openings: Sequence[Box]) -> list[Box]:
    """Return a wall panel minus its openings; the panel itself without any."""
    (x, y, z), (w, h, d) = wall
    axis = 2 if w > d else 0
    middle, length = (x, w) if axis == 2 else (z, d)
    whole = (middle - length / 2, middle + length / 2, y - h / 2, y + h / 2)
    left = pieces(whole, _cut(openings, wall.center[axis], axis))
    if left == [whole]:
        return [wall]
    found = []
    for a0, a1, y0, y1 in left:
        at, up = (a0 + a1) / 2, (y0 + y1) / 2
        center, size = ((at, up, z), (a1 - a0, y1 - y0, d)) if axis == 2 else ((x, up, at), (w, y1 - y0, a1 - a0))
        found.append(Box(center, size))
    return found


def _around(room: Node, box: Box, openings: Sequence[Box]) -> Iterator[Thing]:
    (x, y, z), (w, h, d) = box.center, box.size
    seed, low = derive(0, "walls", room.id), y - h / 2

    def slab(recipe: str, center: tuple[float, float, float], size: tuple[float, float, float]) -> Thing:
        model = Model(recipe, Look(size, seed=seed, kind=room.class_name))
        foot = (center[0], center[1] - size[1] / 2, center[2])
        return Thing(room.id, room.class_name, model, foot, 0.0, recipe == "ceiling", True)

    yield slab("floor", (x, low - 0.05, z), (w, 0.1, d))
    yield slab("ceiling", (x, low + h + 0.05, z), (w, 0.1, d))
    for side in (-1, 1):
        at = z + side * (d + THICK) / 2
        for a0, a1, y0, y1 in pieces((x - w / 2, x + w / 2, low, low + h), _cut(openings, at, 2)):
            yield slab("wall", ((a0 + a1) / 2, (y0 + y1) / 2, at), (a1 - a0, y1 - y0, THICK))
        at = x + side * (w + THICK) / 2
        for a0, a1, y0, y1 in pieces((z - d / 2, z + d / 2, low, low + h), _cut(openings, at, 0)):
            yield slab("wall", (at, (y0 + y1) / 2, (a0 + a1) / 2), (THICK, y1 - y0, a1 - a0))


def _cut(openings: Sequence[Box], at: float, axis: int) -> list[Hole]:
    """Return openings in the wall across `axis` at `at`, as (from, to, bottom, top)."""
    along = 2 - axis
    found = []
    for center, size in openings:
        if abs(center[axis] - at) < size[axis] / 2 + THICK and size[axis] < size[along]:
            found.append((center[along] - size[along] / 2, center[along] + size[along] / 2,
                          center[1] - size[1] / 2, center[1] + size[1] / 2))  # fmt: skip
    return found


def pieces(wall: Hole, holes: Sequence[Hole]) -> list[Hole]:
    """Return a rectangle (from, to, bottom, top) minus the holes, as rectangles."""
    left = [wall]
    for a, b, c, d in holes:
        left = [piece for rest in left for piece in _without(rest, (a, b, c, d))]
    return left


def _without(rest: Hole, hole: Hole) -> Iterator[Hole]:
    a0, a1, y0, y1 = rest
    b0, b1, c0, c1 = max(hole[0], a0), min(hole[1], a1), max(hole[2], y0), min(hole[3], y1)
    if b0 >= b1 or c0 >= c1:
        yield rest
        return
    for piece in ((a0, b0, y0, y1), (b1, a1, y0, y1), (b0, b1, y0, c0), (b0, b1, c1, y1)):
        if piece[1] - piece[0] > 1e-6 and piece[3] - piece[2] > 1e-6:
            yield piece
