"""Boxes for things that were moved in a home with geometry: on or in a thing, or on a floor."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from hearth.homes.from_graph.furniture_arrangement import FRONT, passable, spots
from hearth.homes.from_graph.layout_from_boxes import measured
from hearth.homes.geometry import bottom, box_over, footprint
from hearth.homes.object_shapes import form
from hearth.homes.plans.furniture import NoPlaceError
from hearth.homes.plans.home_shell import Thing, interior, strip
from hearth.homes.plans.layout import Layout
from hearth.homes.plans.object_packing import stand
from hearth.homes.plans.obstacles import Obstacles
from hearth.homes.plans.plan import Piece
from hearth.homes.plans.support_surfaces import FAR, local_of, support_of
from hearth.homes.plans.walkable_floor import HEAD
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.vocabulary import ROOM_CATEGORY

DOORWAY = 0.6
"""Metres of floor kept free before a door."""
STANDS = ("floor", "wall", "item")


def posed(graph: EnvironmentGraph, places: Mapping[int, tuple[str, int]], knowledge: Knowledge) -> EnvironmentGraph:
    """Return a graph whose nodes in `places` have boxes at their new places; the things on and in them move along.

    Args:
        graph: edited already: its edges say where things are. Things that have a place that has no box get none.
        places: node id -> (ON or INSIDE, id of the place), in the order in which they are put there.
        knowledge: for shapes.

    Raises:
        HearthError: NO_PLACE: there is no room left.
    """
    nodes = {node.id: node for node in graph.nodes}
    for node_id in places:
        nodes[node_id] = replace(nodes[node_id], box=None, yaw=None)
    before = {node.id: node for node in graph.nodes}
    for node_id, (relation, target) in places.items():
        place = nodes[target]
        if place.box is None:
            continue
        now = EnvironmentGraph(tuple(nodes.values()), graph.edges, graph.extra)
        box, yaw = _place(measured(now, "", knowledge), nodes[node_id], relation, place, graph, knowledge)
        nodes[node_id] = replace(nodes[node_id], box=box, yaw=yaw)
        for other, moved in _carried(before, graph, node_id, box):
            if other not in places:
                nodes[other] = moved
    return EnvironmentGraph(tuple(nodes[node.id] for node in graph.nodes), graph.edges, graph.extra)


def _place(
    layout: Layout, node: Node, relation: str, place: Node, graph: EnvironmentGraph, knowledge: Knowledge
) -> tuple[Box, float]:
    if form(node.class_name, knowledge) is None:
        raise _full(node, relation, place, "its shape is unknown")
    if place.category == ROOM_CATEGORY or place.class_name == "floor":
        found = _on_floor(layout, node, place, graph, knowledge)
    else:
        things = {thing.name: thing for thing in layout.things}
        here = [
            e.source for e in graph.edges if e.relation == relation and e.target == place.id and e.source != node.id
        ]
        others = [things[str(other)] for other in here if str(other) in things]
        found = room_for(node.class_name, things[str(place.id)], relation.lower(), others, knowledge)
    if found is None:
        raise _full(node, relation, place, "there is no room left")
    return found


def _on_floor(
    layout: Layout, node: Node, place: Node, graph: EnvironmentGraph, knowledge: Knowledge
) -> tuple[Box, float] | None:
    """Return the first free spot, along the walls first, that keeps the room's doors joined."""
    rooms = {e.target for e in graph.edges if e.source == place.id and e.relation == "INSIDE"} | {place.id}
    room = next(room for room in layout.plan.rooms if room.line in rooms)
    shaped = form(node.class_name, knowledge)
    assert shaped is not None
    solids = [t for t in layout.things if t.room == room.name and t.mount in STANDS and bottom(t.box) < HEAD]
    openings = [hole for hole in layout.shell.openings if hole.room == room.name]
    inner = interior(room)
    kept = [strip(inner, h.wall, h.start, h.end, DOORWAY) for h in openings if h.door is not None]
    every = [spot for spot, _ in spots(room, shaped)]
    free = Obstacles(room, solids, kept, openings).free(every, shaped, min(shaped.front, FRONT))
    standing = [footprint(thing.box) for thing in solids]
    for (rect, yaw, low), is_free in zip(every, free, strict=True):
        if is_free and (shaped.mount == "flat" or passable(room, [*standing, rect], kept)):
            return box_over(rect, low, low + shaped.size[1]), yaw
    return None


def _carried(nodes: Mapping[int, Node], graph: EnvironmentGraph, moved: int, box: Box) -> Iterator[tuple[int, Node]]:
    """Return the things on and in a moved thing, at the same distance from it as before."""
    old = nodes[moved].box
    if old is None:
        return
    shift = tuple(a - b for a, b in zip(box.center, old.center, strict=True))
    waiting, seen = [moved], {moved}
    while waiting:
        holder = waiting.pop()
        for edge in graph.edges:
            if edge.relation in ("ON", "INSIDE") and edge.target == holder and edge.source not in seen:
                seen.add(edge.source)
                waiting.append(edge.source)
                own = nodes[edge.source].box
                if own is not None:
                    center = (own.center[0] + shift[0], own.center[1] + shift[1], own.center[2] + shift[2])
                    yield edge.source, replace(nodes[edge.source], box=Box(center, own.size))


def _full(node: Node, relation: str, place: Node, why: str) -> HearthError:
    text = f"{node.class_name} ({node.id}) {relation} {place.class_name} ({place.id})"
    return HearthError.of(Code.NO_PLACE, f"{text}: {why}", suggestion="another place, or take something away")


def room_for(
    class_name: str, holder: Thing, relation: str, others: Sequence[Thing], knowledge: Knowledge
) -> tuple[Box, float] | None:
    """Return where one more thing finds room on or in another next to the things there; None where it does not.

    Args:
        class_name: of the thing to be put there.
        holder: its support or container.
        relation: `on` or `inside`.
        others: what is there.
        knowledge: for shapes.
    """
    holding = form(holder.class_name, knowledge)
    if holding is None:
        return None
    support = support_of(holder, holding, relation, knowledge, FAR if relation == "on" else 0.0)
    for other in others:
        level = min(support.levels, key=lambda level: abs(level.y - bottom(other.box)))
        local = local_of(support, footprint(other.box))
        level.taken.append((other.class_name, local))
        level.piles[local] = other.box.size[1]
    piece = Piece(class_name)
    try:
        (stood,) = stand(support, piece, [class_name], relation, knowledge)
    except NoPlaceError:
        return None
    return stood.box, stood.yaw or 0.0
