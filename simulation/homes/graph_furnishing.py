"""Furniture of a graph's room, the largest first, each where most of its relations are met."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from hearth.simulation.homes import raster
from hearth.simulation.homes.floor import BODY, CELL, HEAD
from hearth.simulation.homes.forms import Form, form
from hearth.simulation.homes.geometry import DIRECTIONS, Rect, along_x, bottom, box_over, facing_from, footprint, top
from hearth.simulation.homes.geometry import turned as extents
from hearth.simulation.homes.graph_parts import Parts
from hearth.simulation.homes.graph_relations import NEAR, gap, sees
from hearth.simulation.homes.packing import contents
from hearth.simulation.homes.plan import Faults, Room
from hearth.simulation.homes.shell import Shell, Thing, interior, span, strip

ALONG, ACROSS = 0.25, 0.5
"""Metres between places tried along walls, and out in the room."""
FRONT = 0.55
"""Free depth kept before what is used from its front."""
MOST_LOOKED_AT = 40
"""Of the best places so many are tried for whether they block the way."""
MARGIN = 0.5
"""Metres beyond a room's walls that are looked at: its doors' holes."""
LOOSE_WALL = 0.6
"""What a place at a wall is worth, in relations: furniture out in the room needs a reason."""

Spot = tuple[Rect, float, float]
"""Where a thing may stand: the floor under it, its yaw, its underside."""


class Crowd:
    """What has its place so far.

    Attributes:
        things: by node id; called by that id.
        squeezed: those that stand in the place of others, because there was no room.
    """

    def __init__(self, parts: Parts, built: Shell) -> None:
        self.parts = parts
        self.built = built
        self.things: dict[int, Thing] = {}
        self.squeezed: set[int] = set()


def furnish(crowd: Crowd, room_id: int, room: Room) -> bool:
    """Place a room's things, with what stands on and in them; True when something of size found no place."""
    parts = crowd.parts
    solids: list[Thing] = []
    kept = [zone for name, zone, _ in crowd.built.kept_free if name == room.name]
    short = False
    for node in parts.roots(room_id):
        shaped = form(parts.nodes[node].class_name, parts.knowledge)
        if shaped is None:
            continue
        spot = _best(crowd, room, node, shaped, solids, kept)
        if spot is None:
            short = True
            continue
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
    holder = crowd.things[node]
    for child in parts.children.get(node, ()):
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
            box = box_over(Rect(x - width / 2, z - depth / 2, x + width / 2, z + depth / 2), low, low + height)
            on, inside = (holder.name, "") if word == "on" else ("", holder.name)
            crowd.things[child] = Thing(str(child), class_name, holder.room, box, holder.yaw, "item", on=on,
                                        inside=inside, line=child)  # fmt: skip
        _squeeze_in(crowd, child)


def _front(class_name: str, shaped: Form) -> float:
    """Depth to keep free; a bed is got into from its sides."""
    return 0.0 if class_name == "bed" else min(shaped.front, FRONT)


def _best(crowd: Crowd, room: Room, node: int, shaped: Form, solids: list[Thing], kept: list[Rect]) -> Spot | None:
    """The free spot where most relations are met; of equal ones the first."""
    own = crowd.parts.family(node)
    near = [crowd.things[n] for m in sorted(own) for n in crowd.parts.near.get(m, ()) if n in crowd.things]
    faced = [crowd.things[n] for m in sorted(own) for n in crowd.parts.faces.get(m, ()) if n in crowd.things]
    facing = [t for n, t in crowd.things.items() if own & set(crowd.parts.faces.get(n, ())) and t.room == room.name]
    rugs = [crowd.things[n] for n in crowd.parts.over.get(node, ()) if n in crowd.things]
    front = _front(crowd.parts.nodes[node].class_name, shaped)
    found: list[tuple[float, int, Spot]] = []
    for number, (spot, worth) in enumerate(_spots(room, shaped)):
        if not _fits(crowd, room, spot, shaped, front=front, solids=solids, kept=kept):
            continue
        box = box_over(spot[0], spot[2], spot[2] + shaped.size[1])
        score = worth + sum(gap(box, thing.box) <= NEAR - 0.3 for thing in near)
        score += 2 * sum(sees(box, spot[1], thing.box) for thing in faced)
        score += sum(sees(thing.box, thing.yaw, box) for thing in facing)
        score += 2 * sum(spot[0].overlap(footprint(rug.box)) > 0 for rug in rugs)
        found.append((-round(score, 6), number, spot))
    found.sort()
    blocks = shaped.mount not in ("flat", "ceiling") and (shaped.mount != "wall" or shaped.up < HEAD)
    for _, _, spot in found[:MOST_LOOKED_AT]:
        if not blocks or passable(room, [footprint(t.box) for t in solids if bottom(t.box) < HEAD] + [spot[0]], kept):
            return spot
    return None


def _spots(room: Room, shaped: Form) -> Iterator[tuple[Spot, float]]:
    inner, height = interior(room), shaped.size[1]
    if shaped.mount == "ceiling":
        yield from (((*spot, 2.6 - height), 0.0) for spot in _out_in_the_room(inner, shaped, (0.0,)))
        return
    low = shaped.up if shaped.mount == "wall" else 0.0
    if shaped.mount != "flat":
        for wall in DIRECTIONS:
            for rect in _along(inner, wall, shaped):
                yield (rect, facing_from(wall), low), LOOSE_WALL
    if shaped.mount != "wall":
        yield from (((*spot, 0.0), 0.0) for spot in _out_in_the_room(inner, shaped, tuple(DIRECTIONS.values())))


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
    """Whether one gets from each of a room's doors to all others with these things standing.

    Args:
        room: the room.
        standing: what is in the way.
        doors: floor before each door, inside the room.
    """
    import numpy as np

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
    # A cell more than a body needs: the home's own grid may lie half a cell beside this one.
    regions = raster.regions(raster.eroded(free, round(BODY / CELL) + 1))
    beyond = [set(np.unique((regions * outside)[cells(door.inset(-MARGIN))]).tolist()) - {0} for door in doors]
    return not doors or bool(set.intersection(*beyond))


def _fits(
    crowd: Crowd, room: Room, spot: Spot, shaped: Form, *, front: float, solids: list[Thing], kept: list[Rect]
) -> bool:
    rect, yaw, low = spot
    high = low + shaped.size[1]
    if not interior(room).contains(rect):
        return False
    if shaped.mount == "flat":
        return True
    for thing in solids:
        if bottom(thing.box) < high and low < top(thing.box) and _meet(rect, footprint(thing.box)):
            return False
        if thing.front and low < 1.0 and _meet(rect, _before(footprint(thing.box), thing.yaw or 0.0, thing.front)):
            return False
    zone = _before(rect, yaw, front)
    if front and not interior(room).contains(zone, slack=0.05):
        return False
    if front and any(_meet(zone, footprint(t.box)) for t in solids if bottom(t.box) < 1.0):
        return False
    if low < HEAD and any(_meet(rect, zone) for zone in kept):
        return False
    return not any(_hides(room, hole, rect, (low, high), yaw, shaped.mount) for hole in crowd.built.openings)


def _hides(room: Room, hole: object, rect: Rect, heights: tuple[float, float], yaw: float, mount: str) -> bool:
    """Whether it hangs in a hole of the wall, or stands high before a window."""
    from hearth.simulation.homes.shell import Opening

    assert isinstance(hole, Opening)
    if hole.room != room.name or heights[0] >= hole.y1 or heights[1] <= hole.y0:
        return False
    deep = strip(interior(room), hole.wall, hole.start - 0.03, hole.end + 0.03, 0.25)
    high = hole.window is not None and heights[1] > hole.y0 + 0.3
    return _meet(rect, deep) and ((mount == "wall" and facing_from(hole.wall) == yaw) or high)


def _before(rect: Rect, yaw: float, depth: float) -> Rect:
    side = next(name for name, degrees in DIRECTIONS.items() if degrees == yaw % 360)
    start, end = (rect.x0, rect.x1) if along_x(side) else (rect.z0, rect.z1)
    return strip(rect, side, start, end, -depth)


def _meet(a: Rect, b: Rect) -> bool:
    return a.x0 < b.x1 - 0.005 and b.x0 < a.x1 - 0.005 and a.z0 < b.z1 - 0.005 and b.z0 < a.z1 - 0.005
