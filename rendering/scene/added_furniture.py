"""Places for furniture that an environment adds to a home: against a wall, where no way is blocked."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import cos, radians, sin
from typing import NamedTuple

import numpy as np

from hearth.homes.plans import grid_shapes
from hearth.rendering.scene.door_sweep import Floors
from hearth.rendering.scene.floor_cells import CELL, cells_of, eroded, is_in_the_way
from hearth.rendering.scene.free_poses import Pose
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.object_locations import BUILDING, Location, locations_of
from hearth.rendering.scene.routes import NARROW, Cells
from hearth.rendering.scene.standing_places import FreeFloor
from hearth.schemas.graph import Box, EnvironmentGraph, Node, Point, Spot
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY

GRID = 0.1
"""Metres between places that are tried."""

TRIES = 40
"""Places whose ways are looked at, the best ones first."""

DEEP = 0.2
"""Metres of depth from which on a thing at a wall is furniture, and not hung like a picture."""

NARROWER = (1.0, 0.8, 0.6)
"""Shares of a thing's width that are tried."""

FREE = 0.55
"""Metres in front of furniture that stay free, so that one can use it."""

LEGS = 0.45
"""Space in front of a seat for the legs of a sitting person, metres."""


def furnished(places: Places, graph: EnvironmentGraph, floors: Floors) -> Places:
    """Return the places of a home, with those of furniture that the graph adds to rooms.

    Args:
        places: of the home as it was built.
        graph: what is there now.
        floors: of the home.
    """
    nodes, locations = {node.id: node for node in graph.nodes}, locations_of(graph)
    for number in sorted(nodes):
        node, location = nodes[number], locations.get(number)
        if number in places.poses or location is None or not _stands(node, location, nodes, places):
            continue
        holder = location.holder
        if nodes[holder].class_name in BUILDING and holder in locations:
            holder = locations[holder].holder
        room = nodes.get(holder)
        room = room if room is not None and room.category == ROOM_CATEGORY else None
        pose = _pose(node, room, places, floors) if room is not None and room.box else None
        if pose is not None:
            poses = {**places.poses, number: pose}
            known = replace(places.graph, nodes=(*places.graph.nodes, replace(node, box=pose.box, yaw=pose.yaw)))
            places = Places(known, {**places.locations, number: location}, poses, places.knowledge, places.prepared)
    return places


def _stands(node: Node, location: Location, nodes: Mapping[int, Node], places: Places) -> bool:
    """Return whether a node is furniture in a room, portable chairs included.

    Furniture is on the room's floor, by an edge or without one, or at a wall of the room.
    """
    carried = "GRABBABLE" in node.properties and "SITTABLE" not in node.properties
    movable = carried or node.category in (CHARACTER_CATEGORY, ROOM_CATEGORY, "BodyParts")
    holder = nodes.get(location.holder)
    support = holder.class_name if location.kind == "on" and holder is not None else ""
    at_wall = support == "wall" and min(places.size_of(node)) > DEEP
    stands = location.kind == "room" or support == "floor" or at_wall
    return stands and not movable and node.box is None


class Place(NamedTuple):
    """A place for furniture: its middle, its direction, and its box's width and depth."""

    spot: Spot
    yaw: float
    size: Spot


def _pose(node: Node, room: Node, places: Places, floors: Floors) -> Pose | None:
    """Return the pose of a thing in a room, narrower where it would block a way.

    None where it does not fit or always does.
    """
    assert room.box is not None
    (width, height, depth), level = places.size_of(node), room.box.center[1] - room.box.size[1] / 2
    box = Box((room.box.center[0], level + height / 2, room.box.center[2]), (width, height, depth))
    if not is_in_the_way(replace(node, box=box), level):
        return None
    floor = floors.at(places.nodes())
    if floor.walkable is None:
        return None
    for share in NARROWER:
        place = _place((width * share, height, depth), room.box, places, floor)
        if place is not None:
            center = (place.spot[0], level + height / 2 + 0.001, place.spot[1])
            return Pose(Box(center, (place.size[0], height, place.size[1])), place.yaw)
    return None


def _place(size: Point, room: Box, places: Places, floor: FreeFloor) -> Place | None:
    """Return the best place for a thing of that size that leaves all ways, and room for legs where it can."""
    assert floor.walkable is not None
    free, origin = floor.walkable.free, floor.walkable.wide.floor.origin
    fits = [place for place in _candidates(size, room) if _fits(place, free, origin)]
    legroom = _with_legroom(free, origin, places)
    found = [place for place in fits if legroom[_cells(place.spot, place.size, origin)].all()] or fits
    found.sort(key=lambda place: _cost(place, room))
    return next((place for place in found[:TRIES] if _leaves_ways(place, free, origin, floor)), None)


def _candidates(size: Point, room: Box) -> Iterator[Place]:
    """Places all over a room, in four directions."""
    for yaw in (0.0, 90.0, 180.0, 270.0):
        across = (size[0], size[2]) if yaw % 180 == 0 else (size[2], size[0])
        spans = [(room.size[2 * k] - across[k]) / 2 - 0.04 for k in (0, 1)]
        if min(spans) < 0:
            continue
        axes = [np.linspace(-span, span, max(2, int(2 * span / GRID) + 1)) for span in spans]
        for x in axes[0].tolist():
            for z in axes[1].tolist():
                yield Place((room.center[0] + x, room.center[2] + z), yaw, across)


def _cost(place: Place, room: Box) -> float:
    """Return the distance of a place's back from the wall behind it, and of its side from the nearest corner."""
    gaps = [room.size[2 * k] / 2 - abs(place.spot[k] - room.center[2 * k]) - place.size[k] / 2 for k in (0, 1)]
    facing = (sin(radians(place.yaw)), cos(radians(place.yaw)))
    along = 0 if abs(facing[0]) > 0.5 else 1
    offset = place.spot[along] - room.center[2 * along]
    behind = gaps[along] if offset * facing[along] <= 0 else room.size[2 * along] - gaps[along] - place.size[along]
    return round(behind + 0.1 * gaps[1 - along], 4)


def _fits(place: Place, free: Cells, origin: Spot) -> bool:
    """Return whether nothing stands at a place, nor just in front of it."""
    front = (sin(radians(place.yaw)) * FREE / 2, cos(radians(place.yaw)) * FREE / 2)
    size = (place.size[0] + 2 * abs(front[0]), place.size[1] + 2 * abs(front[1]))
    part = free[_cells((place.spot[0] + front[0], place.spot[1] + front[1]), size, origin)]
    return part.size > 0 and bool(part.all())


def _with_legroom(free: Cells, origin: Spot, places: Places) -> Cells:
    """Free cells without those in front of seats."""
    left = free.copy()
    for node in places.graph.nodes:
        pose = places.poses.get(node.id)
        if "SITTABLE" not in node.properties or pose is None or pose.yaw is None:
            continue
        facing = (sin(radians(pose.yaw)), cos(radians(pose.yaw)))
        (x, _, z), (width, _, depth) = pose.box.center, pose.box.size
        ahead = [(side / 2 + LEGS / 2) * to for side, to in zip((width, depth), facing, strict=True)]
        size = (LEGS, depth) if abs(facing[0]) > 0.5 else (width, LEGS)
        left[_cells((x + ahead[0], z + ahead[1]), size, origin)] = False
    return left


def _leaves_ways(place: Place, free: Cells, origin: Spot, floor: FreeFloor) -> bool:
    """Return whether all that could be walked, and is still free, is still joined."""
    assert floor.walkable is not None
    left = free.copy()
    left[_cells(place.spot, place.size, origin)] = False
    walkable, before = eroded(left, NARROW), floor.walkable.regions
    after = grid_shapes.regions(walkable)
    pairs = np.unique(np.stack((before[walkable], after[walkable]), axis=1), axis=0)
    big = [pair for pair in pairs.tolist() if (after == pair[1]).sum() > SPECK]
    return len({pair[0] for pair in big}) == len(big)


SPECK = 6
"""Cells of a region that is too small to matter."""


def _cells(spot: Spot, size: Spot, origin: Spot) -> tuple[slice, slice]:
    """Return the cells of a rectangle, with those that it only touches."""
    return cells_of(Box((spot[0], 0.0, spot[1]), (size[0] + CELL, 1.0, size[1] + CELL)), origin)
