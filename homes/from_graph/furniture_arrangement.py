"""Furniture of a graph's room, the largest first, each where most of its relations are met."""

from collections.abc import Iterator, Mapping
from itertools import product

import numpy as np

from hearth.homes.from_graph.geometric_relations import NEAR, gap, seen
from hearth.homes.from_graph.rooms_and_supports import Parts
from hearth.homes.geometry import DIRECTIONS, Rect, bottom, box_over, facing_from, footprint, top
from hearth.homes.geometry import turned as extents
from hearth.homes.object_shapes import Form, form
from hearth.homes.plans import grid_shapes
from hearth.homes.plans.home_shell import Shell, Thing, interior, span, strip
from hearth.homes.plans.object_packing import contents
from hearth.homes.plans.obstacles import Obstacles, Stand
from hearth.homes.plans.plan import Room
from hearth.homes.plans.walkable_floor import BODY, CELL, HEAD
from hearth.homes.relations import gaps
from hearth.schemas.graph import Box
from hearth.schemas.yaml_fields import Faults

ALONG, ACROSS = 0.25, 0.5
"""Metres between places tried along walls, and out in the room."""
FRONT = 0.55
"""Free depth kept in front of things that are used from their front."""
MOST_LOOKED_AT = 40
"""Number of the best places tried for whether they block the way."""
MARGIN = 0.5
"""Metres beyond a room's walls that are looked at: its doors' holes."""
SLACK = 0.2
"""Metres by which things are placed nearer than they need be: what is on and in them is not at their edge."""
MUST = 60.0
"""Worth of being ON a wall, a tile or a rug, in relations."""
FREE_STANDING_WALL = 5.0
"""Worth of a place at a wall, in relations: furniture out in the room needs a reason."""
BACKED_WALL = 10_000.0
"""The same for furniture with a back, such as a closet: it stands in the room only where no wall is free."""
AT_WALL = 0.1
"""Metres within which furniture stands at a wall."""
USED_FROM_FRONT = 0.4
"""Metres of free depth before a thing from which it counts as used from its front, with its back to a wall."""


class Crowd:
    """The things placed so far.

    Attributes:
        things: by node id; called by that id.
        squeezed: those that stand in the place of others, because there was no room.
    """

    def __init__(self, parts: Parts, built: Shell, before: Mapping[int, Thing]) -> None:
        self.parts = parts
        self.built = built
        self.things: dict[int, Thing] = {}
        self.squeezed: set[int] = set()
        self._before = before

    def known(self, node: int) -> Thing | None:
        """Return where a thing is, or else where it was when all were placed before."""
        return self.things.get(node) or self._before.get(node)


def furnish(crowd: Crowd, room_id: int, room: Room) -> bool:
    """Place a room's things, with the things on and in them, those first that stand at walls.

    Return True if something of size found no place, or no wall.
    """
    parts = crowd.parts
    solids: list[Thing] = []
    kept = [zone for name, zone, _ in crowd.built.kept_free if name == room.name]
    short = False
    formed = [(node, form(parts.nodes[node].class_name, parts.knowledge)) for node in parts.roots(room_id)]
    known = [(node, shaped) for node, shaped in formed if shaped is not None]
    for node, shaped in sorted(known, key=lambda each: not _has_back(each[1])):
        spot = _best(crowd, room, node, shaped, solids, kept)
        if spot is None:
            short = True
            continue
        short |= _has_back(shaped) and not _at_wall(spot[0], room)
        rect, yaw, low = spot
        box = box_over(rect, low, low + shaped.size[1])
        thing = Thing(str(node), parts.nodes[node].class_name, room.name, box, yaw, shaped.mount,
                      front=_front(parts.nodes[node].class_name, shaped), line=node)  # fmt: skip
        crowd.things[node] = thing
        if shaped.mount != "flat":
            solids.append(thing)
        for item in contents(thing, parts.piece(node), parts.knowledge, Faults("")):
            crowd.things[int(item.name.rpartition("/")[2])] = item
        _squeeze_in(crowd, node)
    return short


def _squeeze_in(crowd: Crowd, node: int) -> None:
    """Give what found no room on or in a thing a place in its middle all the same, as small as it must be."""
    parts = crowd.parts
    waiting = parts.children.get(node, [])[::-1]
    while waiting:
        child = waiting.pop()
        holder = crowd.things[parts.parent[child][0]]
        class_name = parts.nodes[child].class_name
        shaped = form(class_name, parts.knowledge)
        if shaped is None:
            continue
        if child not in crowd.things:
            word, rect = parts.parent[child][1], footprint(holder.box)
            crowd.squeezed.add(child)
            width, depth = min(shaped.size[0], 0.9 * rect.width), min(shaped.size[2], 0.9 * rect.depth)
            low, room = (top(holder.box), 1.0) if word == "on" else (bottom(holder.box) + 0.01, holder.box.size[1])
            (x, z), height = rect.center, min(shaped.size[1], 0.9 * room)
            box = box_over(Rect.around(x, z, width, depth), low, low + height)
            on, inside = (holder.name, "") if word == "on" else ("", holder.name)
            crowd.things[child] = Thing(str(child), class_name, holder.room, box, holder.yaw, "item", on=on,
                                        inside=inside, line=child)  # fmt: skip
        waiting += parts.children.get(child, [])[::-1]


def _front(class_name: str, shaped: Form) -> float:
    """Depth to keep free; a bed is got into from its sides."""
    return 0.0 if class_name == "bed" else min(shaped.front, FRONT)


def _best(crowd: Crowd, room: Room, node: int, shaped: Form, solids: list[Thing], kept: list[Rect]) -> Stand | None:
    """Return the free spot where most relations are met; of equal ones the first."""
    front = _front(crowd.parts.nodes[node].class_name, shaped)
    every = list(spots(room, shaped))
    openings = [hole for hole in crowd.built.openings if hole.room == room.name]
    free = Obstacles(room, solids, kept, openings).free([spot for spot, _ in every], shaped, front)
    good = [spot for spot, is_free in zip(every, free, strict=True) if is_free]
    if not good:
        return None
    scores = _scores(crowd, room, node, [spot for spot, _ in good], shaped.size[1])
    order = sorted(range(len(good)), key=lambda k: (-round(float(scores[k]) + good[k][1], 6), k))
    blocks = shaped.mount not in ("flat", "ceiling") and (shaped.mount != "wall" or shaped.up < HEAD)
    standing = [footprint(t.box) for t in solids if bottom(t.box) < HEAD]
    # The best must not keep a rarer spot that blocks nothing from being found: so a few of every part of the order.
    for k in dict.fromkeys((*order[:MOST_LOOKED_AT], *order[:: max(1, len(order) // MOST_LOOKED_AT)])):
        spot = good[k][0]
        if not blocks or passable(room, [*standing, spot[0]], kept):
            return spot
    return None


def _scores(crowd: Crowd, room: Room, node: int, spots: list[Stand], height: float) -> np.ndarray:
    """For each spot the weight of the relations met by a thing and all on and in it."""
    parts, own = crowd.parts, sorted(crowd.parts.family(node))
    boxes = [box_over(rect, low, low + height) for rect, _, low in spots]
    yaws = [yaw for _, yaw, _ in spots]
    near = [t for m in own for n in parts.near.get(m, ()) if (t := crowd.known(n)) is not None]
    faced = [t for m in own for n in parts.faces.get(m, ()) if (t := crowd.known(n)) is not None]
    lookers = [t for m in own for r, n, out in parts.relations.get(m, ()) if r == "FACING" and not out
               and (t := crowd.known(n)) is not None and t.yaw is not None and t.room == room.name]  # fmt: skip
    score: np.ndarray = (gaps(boxes, [t.box for t in near]) <= NEAR - SLACK).sum(axis=1).astype(float)
    score += 2 * seen(boxes, yaws, [t.box for t in faced]).sum(axis=1)
    score += seen([t.box for t in lookers], [t.yaw or 0.0 for t in lookers], boxes).sum(axis=0)
    for other in (*parts.over.get(node, ()), *parts.under.get(node, ())):
        thing = crowd.known(other)
        if thing is not None:
            score += MUST * np.array([_over(box, thing) for box in boxes])
    return score


def _over(box: Box, thing: Thing) -> bool:
    """Return whether a box is against a wall, or over (or under) a tile or rug."""
    if thing.class_name == "wall":
        return gap(box, thing.box) < 0.1
    return footprint(box).overlap(footprint(thing.box)) > 0.01


def spots(room: Room, shaped: Form) -> Iterator[tuple[Stand, float]]:
    """Yield the places of a room where a thing of that shape may stand or hang, along walls first, with their worth."""
    inner, height = interior(room), shaped.size[1]
    if shaped.mount == "ceiling":
        yield from (((*spot, 2.6 - height), 0.0) for spot in _out_in_the_room(inner, shaped, (0.0,)))
        return
    low = shaped.up if shaped.mount == "wall" else 0.0
    if shaped.mount != "flat":
        worth = BACKED_WALL if _has_back(shaped) else FREE_STANDING_WALL
        for wall in DIRECTIONS:
            for rect in _along(inner, wall, shaped):
                yield (rect, facing_from(wall), low), worth
    if shaped.mount != "wall":
        yield from (((*spot, 0.0), 0.0) for spot in _out_in_the_room(inner, shaped, tuple(DIRECTIONS.values())))


def _has_back(shaped: Form) -> bool:
    """Return whether furniture stands with its back to a wall: closets, stoves, beds, nightstands."""
    return shaped.mount == "floor" and (shaped.front >= USED_FROM_FRONT or shaped.shelves > 1)


def _at_wall(rect: Rect, room: Room) -> bool:
    """Return whether a floor rectangle touches one of a room's walls."""
    return not interior(room).inset(AT_WALL).contains(rect)


def _along(inner: Rect, wall: str, shaped: Form) -> Iterator[Rect]:
    low, high = span(inner, wall)
    along, out = shaped.size[0], shaped.size[2]
    steps = int((high - low - along - 0.04) / ALONG)
    inset = inner if shaped.mount == "wall" else inner.inset(0.03)
    for k in range(steps + 1):
        # From both ends towards the middle, as people do.
        shift = 0.02 + k // 2 * ALONG
        start = low + shift if k % 2 == 0 else high - shift - along
        yield strip(inset, wall, start, start + along, out)


def _out_in_the_room(inner: Rect, shaped: Form, yaws: tuple[float, ...]) -> Iterator[tuple[Rect, float]]:
    for yaw in yaws:
        x, z = extents(shaped.size[0], shaped.size[2], yaw)
        columns, rows = int((inner.width - x) / ACROSS), int((inner.depth - z) / ACROSS)
        if columns < 0 or rows < 0:
            continue
        middle = columns // 2, rows // 2
        cells = sorted(
            product(range(columns + 1), range(rows + 1)), key=lambda c: abs(c[0] - middle[0]) + abs(c[1] - middle[1])
        )
        for i, j in cells:
            yield Rect(inner.x0 + i * ACROSS, inner.z0 + j * ACROSS, inner.x0 + i * ACROSS + x,
                       inner.z0 + j * ACROSS + z), yaw  # fmt: skip


def passable(room: Room, standing: list[Rect], doors: list[Rect]) -> bool:
    """Return whether one gets from each of a room's doors to all others with these things standing.

    Args:
        room: the room.
        standing: what is in the way.
        doors: floor before each door, inside the room.
    """
    inner, around = interior(room), interior(room).inset(-MARGIN)
    shape = round(around.width / CELL), round(around.depth / CELL)

    def cells(rect: Rect) -> tuple[slice, slice]:
        ends = [max(0, round((v - low) / CELL)) for v, low in zip(rect, (around.x0, around.z0) * 2, strict=True)]
        return slice(ends[0], ends[2]), slice(ends[1], ends[3])

    free, outside = np.zeros(shape, bool), np.ones(shape, bool)
    outside[cells(inner)] = False
    for door in doors:
        free[cells(door.inset(-MARGIN))] = True
    free[cells(inner)] = True
    for rect in standing:
        if min(rect.width, rect.depth) > 0.1:
            free[cells(rect)] = False
    # A cell more than a body needs: the home's own grid may lie half a cell away from this one.
    regions = grid_shapes.regions(grid_shapes.eroded(free, round(BODY / CELL) + 1))
    beyond = [set(np.unique((regions * outside)[cells(door.inset(-MARGIN))]).tolist()) - {0} for door in doors]
    return not doors or bool(set.intersection(*beyond))
