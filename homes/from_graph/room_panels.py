"""Parts of rooms, as a graph counts them: places for its floors, ceilings, walls, windows, curtains and jambs.

Things of one class in one room are alike until something is CLOSE to one of them or ON it: which of them is where is
chosen so that most of that is met.
"""

from collections.abc import Iterator, Mapping
from math import hypot, sqrt

import numpy as np

from hearth.homes.from_graph.geometric_relations import SHOWS, WEIGHTS
from hearth.homes.from_graph.rooms_and_supports import Parts
from hearth.homes.geometry import DIRECTIONS, Rect, box_over, facing_from, footprint, front_of, top
from hearth.homes.plans.home_shell import WALL, Shell, Thing, interior, span, strip
from hearth.homes.plans.layout import Layout
from hearth.homes.plans.plan import OUTSIDE, Plan, Room

THICK = 0.1
"""Metres of floor and ceiling."""
HUNG = 0.05, 0.4, 2.0
"""Depth, width and height of a curtain beyond those that the windows have."""
SWEEPS = 2
"""Passes over all classes: the places of one decide about the others."""

Slots = dict[tuple[int, str], list[Thing]]
"""Places by room and class."""


def slots(parts: Parts, plan: Plan, built: Shell) -> Slots:
    """Return a place at least for each of a room's panels, windows, curtains and jambs."""
    found: Slots = {}
    for node, room in zip(parts.rooms, plan.rooms, strict=True):
        own = [t for t in built.things if t.room == room.name]
        count = {name: len(parts.of_class(node, name)) for name in ("floor", "ceiling", "wall", "curtain", "window")}
        found[node, "floor"] = list(_tiles(room, "floor", count["floor"], -THICK))
        found[node, "ceiling"] = list(_tiles(room, "ceiling", count["ceiling"], plan.height))
        found[node, "wall"] = list(_walls(room, count["wall"], plan.height))
        found[node, "window"] = [t for t in own if t.class_name == "window"]
        curtains = [t for t in own if t.class_name == "curtain"]
        found[node, "curtain"] = [*curtains, *_curtains(room, count["curtain"] - len(curtains), built)]
        jambs = list(_jambs(room, built))
        # A graph may count more jambs than ways out: then some share a hole.
        found[node, "doorjamb"] = jambs * max(1, len(parts.of_class(node, "doorjamb")))
    return found


def rooms_and_doors(parts: Parts, plan: Plan, built: Shell) -> dict[int, Thing]:
    """Return the rooms, and the doors and jambs that the graph puts BETWEEN two of them."""
    found = dict(zip(parts.rooms, Layout(plan, built, ()).rooms(), strict=True))
    names = {room.name: node for node, room in zip(parts.rooms, plan.rooms, strict=True)}
    for door in plan.doorways:
        hung = [t for t in built.things if t.line == door.line and t.mount == "door"]
        if OUTSIDE in door.rooms:
            found[door.line] = next(thing for thing in hung if thing.class_name == "maindoor")
            continue
        pair = {names[name] for name in door.rooms}
        here = [d for d, rooms in sorted(parts.between.items()) if set(rooms) == pair]
        for class_name in ("door", "doorjamb"):
            nodes = [d for d in here if parts.nodes[d].class_name == class_name]
            found |= dict(zip(nodes, (t for t in hung if t.class_name == class_name), strict=False))
    return found


def assigned(parts: Parts, places: Slots, things: Mapping[int, Thing], anew: bool = False) -> dict[int, Thing]:
    """Each of the panels with the place where most of its relations are met.

    Args:
        parts: the graph.
        places: as of `slots`.
        things: what has its place already, by node id.
        anew: the panels among them are but guesses: each gets the place nearest to its own.
    """
    from scipy.optimize import linear_sum_assignment

    groups = {key: [n for n in parts.of_class(*key) if anew or n not in things] for key in places}
    found: dict[int, Thing] = {}
    for _ in range(1 if anew else SWEEPS):
        for key, nodes in groups.items():
            here = [*places[key], *(slot for node in nodes for slot in _drawn_before(parts, node, things))]
            if not nodes or not here:
                continue
            for node in nodes:
                found.pop(node, None)
            known = {**things, **found}
            worth = [
                [_nearness(things[n], p) if anew and n in things else _worth(parts, n, p, known) for p in here]
                for n in nodes
            ]
            for row, column in zip(*linear_sum_assignment(np.array(worth), maximize=True), strict=True):
                found[nodes[row]] = here[column]
    return found


def _drawn_before(parts: Parts, node: int, things: Mapping[int, Thing]) -> Iterator[Thing]:
    """Return a curtain's place in front of its holder, such as a shower."""
    for relation, other, outward in parts.relations.get(node, ()):
        thing = things.get(other)
        if relation == "INSIDE" and outward and thing is not None and thing.class_name != "curtain":
            rect, side = footprint(thing.box), front_of(thing.yaw or 0.0)
            box = box_over(strip(rect, side, *span(rect, side), HUNG[0]), 0.1, max(0.2, top(thing.box)))
            yield Thing(f"{thing.name}/curtain", "curtain", thing.room, box, thing.yaw, "window")


def _nearness(guess: Thing, place: Thing) -> float:
    (x, _, z), (u, _, v) = guess.box.center, place.box.center
    return -hypot(x - u, z - v)


def _worth(parts: Parts, node: int, place: Thing, things: Mapping[int, Thing]) -> int:
    """Return the weight of the relations of a node that would be met there."""
    total = 0
    for relation, other, outward in parts.relations.get(node, ()):
        thing = things.get(other)
        if thing is not None:
            total += WEIGHTS[relation] * SHOWS[relation](*((place, thing) if outward else (thing, place)))
    return total


def _tiles(room: Room, class_name: str, count: int, low: float) -> Iterator[Thing]:
    """Yield a floor or ceiling in `count` tiles, in rows as square as can be."""
    inner = interior(room)
    rows = max(1, round(sqrt(count * inner.depth / inner.width))) if count else 0
    for row in range(rows):
        first, last = count * row // rows, count * (row + 1) // rows
        z0, z1 = (inner.z0 + inner.depth * k / rows for k in (row, row + 1))
        for k in range(last - first):
            x0, x1 = (inner.x0 + inner.width * i / (last - first) for i in (k, k + 1))
            yield Thing(f"{room.name}/{class_name}.{first + k + 1}", class_name, room.name,
                        box_over(Rect(x0, z0, x1, z1), low, low + THICK))  # fmt: skip


def _walls(room: Room, count: int, height: float) -> Iterator[Thing]:
    """`count` panels, on each of the four sides in proportion to its length."""
    inner = interior(room)
    lengths = {wall: span(inner, wall)[1] - span(inner, wall)[0] for wall in DIRECTIONS}
    shares = dict.fromkeys(DIRECTIONS, 0)
    for _ in range(count):
        shares[max(lengths, key=lambda wall: lengths[wall] / (shares[wall] + 1))] += 1
    for wall, share in shares.items():
        low, high = span(inner, wall)
        for k in range(share):
            start, end = (low + (high - low) * i / share for i in (k, k + 1))
            yield Thing(f"{room.name}/wall.{wall}.{k + 1}", "wall", room.name,
                        box_over(strip(inner, wall, start, end, -WALL), 0.0, height), facing_from(wall))  # fmt: skip


def _curtains(room: Room, count: int, built: Shell) -> Iterator[Thing]:
    """Return the curtains that exceed those of the windows: along walls, next to the openings."""
    inner, (depth, width, height) = interior(room), HUNG
    holes = [o for o in built.openings if o.room == room.name]
    left = count
    for wall in DIRECTIONS:
        low, high = span(inner, wall)
        start = low + 0.05
        while left > 0 and start + width <= high:
            if not any(o.wall == wall and o.start < start + width and start < o.end for o in holes):
                box = box_over(strip(inner, wall, start, start + width, depth), 0.3, 0.3 + height)
                yield Thing(
                    f"{room.name}/curtain.{wall}.{left}", "curtain", room.name, box, facing_from(wall), "window"
                )
                left -= 1
            start += 2 * width


def _jambs(room: Room, built: Shell) -> Iterator[Thing]:
    """Of each doorway the half of the jamb that is on the room's side, as the graph may count one in either room."""
    inner = interior(room)
    for opening in built.openings:
        if opening.room == room.name and opening.door is not None:
            hole = strip(inner, opening.wall, opening.start, opening.end, -WALL)
            yield Thing(f"{room.name}/doorjamb.{opening.number}", "doorjamb", room.name,
                        box_over(hole, 0.0, opening.y1), facing_from(opening.wall), "door")  # fmt: skip
