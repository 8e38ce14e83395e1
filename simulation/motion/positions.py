"""Characters at places: their first place, their place for each thing, and their neighbors by distance."""

from __future__ import annotations

import math
from random import Random

import numpy as np

from hearth.homes.plans.walkable_floor import REACH
from hearth.schemas.graph import Spot
from hearth.simulation.motion.ground import Here, ground_of
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, lowest, mask_of
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World


def placed(world: World, chooser: Random | None = None) -> World:
    """Return the world with all its characters at places of the main region; those that have one keep it.

    A character with a box stands at its place, or at the nearest place in its room. A character without one, because it
    was added, stands somewhere in its room, apart from the others. A home without geometry stays as it is.

    Args:
        world: at any moment.
        chooser: decides where; without one it is near the middle of the room.
    """
    here = None if all(agent.pose is not None for agent in world.agents) else ground_of(world.home)
    if here is None or not here.ground.ways.main.any():
        return world
    agents = list(world.agents)
    for number, agent in enumerate(agents):
        if agent.pose is None:
            others = [other.pose.point for other in agents if other.pose is not None]
            agents[number] = agent._replace(pose=_first(world, agent, here, others, chooser))
    return World(world.home, world.states, tuple(agents), world.moved)


def _first(world: World, agent: Agent, here: Here, others: list[Spot], chooser: Random | None) -> Pose:
    ground = here.ground
    room = edge_rows.agent_room(world, agent)
    node = world.home.node(agent.index)
    ways = ground.ways
    in_room = ways.main & (np.asarray(ground.rooms) == room)
    free = (in_room if in_room.any() else ways.main) & ~ways.blocked(others)
    cells = np.flatnonzero(free if free.any() else ways.main)
    if node.box is not None:
        at = ways.at(node.box.center[0], node.box.center[2])
        if at >= 0 and free[at] and ground.rooms[at] == room:
            return Pose(node.box.center[0], node.box.center[2], node.yaw or 0.0)
    elif chooser is not None:
        x, z = ways.points[cells[chooser.randrange(len(cells))]].tolist()
        return Pose(x, z, 30.0 * chooser.randrange(12))
    box = node.box or (world.home.node(room).box if room >= 0 else None)
    middle = (box.center[0], box.center[2]) if box else ways.points[cells].mean(axis=0)
    x, z = ways.points[cells[np.hypot(*(ways.points[cells] - middle).T).argmin()]].tolist()
    return Pose(x, z, node.yaw or 0.0)


def spot(world: World, node: int) -> Spot | None:
    """Return the point of the floor at which a node is.

    At its holder, at its place in the home, or at its support or container; None where no place of it is known.
    """
    for agent in world.agents:
        if (agent.index == node or agent.held >> node & 1) and agent.pose is not None:
            return agent.pose.point
    here = ground_of(world.home)
    place = node if here is None else _standing(world, here, node)
    box = None if here is None or place < 0 else here.ground.box(place)
    return None if box is None else (box.center[0], box.center[2])


def _standing(world: World, here: Here, node: int) -> int:
    """Return the node that keeps its place, at which another is: itself, what it is on or in, or else its room."""
    moved = here.displaced(world)
    if not moved >> node & 1:
        return node
    known = here.standing(world)
    place = known.get(node)
    if place is None:
        place, kept = _place(world, moved, node)
        if kept:
            known[node] = place
    return place


def _place(world: World, moved: int, node: int) -> tuple[int, bool]:
    """Return the same for a moved node, and whether the answer follows from ON and INSIDE alone."""
    for _ in range(8):
        if not moved >> node & 1:
            return node, True
        around = (edge_rows.on(world, node) | edge_rows.inside(world, node)) & ~world.home.rooms & ~(1 << node)
        if not around:
            break
        node = lowest(around)
    return edge_rows.room_of(world, node), False


def ends(world: World, here: Here, node: int) -> tuple[int, ...]:
    """Return the cells at which one has arrived at a node; none where no place of it is known."""
    bit = 1 << node
    for agent in world.agents:
        if (agent.bit | agent.right | agent.left) & bit:
            break
    else:
        if not world.home.characters & bit:
            place = _standing(world, here, node)
            return here.ground.stands(place) if place >= 0 else ()
    return _ends_of_carried(world, here, node)


def _ends_of_carried(world: World, here: Here, node: int) -> tuple[int, ...]:
    if world.home.characters >> node & 1 or _held(world) >> node & 1:
        point = spot(world, node)
        if point is None:
            return ()
        cell = here.ground.ways.at(*point)
        return (cell if cell >= 0 else here.ground.ways.nearest(point, ~here.ground.ways.main),)
    place = _standing(world, here, node)
    return here.ground.stands(place) if place >= 0 else ()


def _held(world: World) -> int:
    held = 0
    for agent in world.agents:
        held |= agent.right | agent.left
    return held


def beside(world: World, pose: Pose, node: int) -> Pose:
    """Return where one who comes from a pose stands for a node, looking at it.

    The nearest of its places as the crow flies.
    """
    here = ground_of(world.home)
    cells = ends(world, here, node) if here is not None else ()
    if here is None or not cells:
        return pose
    points = here.ground.ways.points
    x, z = min((points[cell].tolist() for cell in cells), key=lambda point: math.dist(point, pose.point))
    return facing(world, Pose(x, z, pose.yaw), node)


def facing(world: World, pose: Pose, node: int) -> Pose:
    """Return the same place, looking at a node."""
    point = spot(world, node)
    return pose if point is None else pose.towards(point)


def resting(world: World, pose: Pose, seat: int) -> Pose:
    """On a seat or a bed, turned the way it faces."""
    point = spot(world, seat)
    yaw = world.home.node(seat).yaw
    return pose if point is None else Pose(*point, pose.yaw if yaw is None else yaw)


def risen(world: World, number: int, pose: Pose) -> Pose:
    """Next to the seat that the character leaves, by the world before."""
    seats = world.agents[number].on
    return beside(world, pose, lowest(seats))._replace(yaw=pose.yaw) if seats else pose


def near(world: World, number: int, pose: Pose) -> int:
    """Return the neighbors of a character at a pose by distance.

    The things within reach in its room, and its own body parts.
    """
    here = ground_of(world.home)
    return world.home.properties["BODY_PART"] if here is None else around(world, number, here, pose)[0]


def around(world: World, number: int, here: Here, pose: Pose) -> tuple[int, int]:
    """Return the same, with the index of the room that the pose is in, or -1."""
    home, ground = world.home, here.ground
    found = home.properties["BODY_PART"]
    cell = ground.ways.at(pose.x, pose.z)
    room = -1
    if cell >= 0:
        room = ground.rooms[cell]
        found |= ground.near[cell] & ~(here.displaced(world) | home.absent | _held(world))
    for i, other in enumerate(world.agents):
        at = other.pose
        if i == number or at is None or room < 0 or not other.inside >> room & 1:
            continue
        if math.hypot(at.x - pose.x, at.z - pose.z) <= REACH + BODY_RADIUS:
            found |= other.bit
    return found, room


def walked_to(world: World, number: int, doors: int) -> int:
    """Return the nodes to which a character can walk by metres while some doors are closed."""
    here = ground_of(world.home)
    pose = world.agents[number].pose
    if here is None or pose is None:
        return 0
    ground, home = here.ground, world.home
    cells = ground.ways.around(pose.x, pose.z)
    reached = 0
    for cell in cells:
        reached |= ground.reached(cell, doors)
    carried = (_held(world) | home.characters) & home.everything
    moved = here.displaced(world) & home.everything & ~carried
    found = reached & ~carried & ~moved | _at_places(world, here, moved, reached)
    for agent in world.agents:  # a character and all that it carries are at one point
        if agent.pose is not None:
            things = (agent.bit | agent.held) & carried
            carried ^= things
            (standing,) = ends(world, here, agent.index)
            if any(ground.joined(cell, standing, doors) for cell in cells):
                found |= things
    for i in indices(carried):
        there = ends(world, here, i)
        place = -1 if there else _standing(world, here, i)
        if (
            any(ground.joined(cell, there[0], doors) for cell in cells)
            if there
            else place >= 0 and reached >> place & 1
        ):
            found |= 1 << i
    return found


def _at_places(world: World, here: Here, moved: int, places: int) -> int:
    """Those of some displaced nodes that are at one of some places."""
    known, standing = here.among(world), here.standing(world)
    if (moved, places) in known:
        return known[moved, places]
    found = mask_of(i for i in indices(moved) if (place := _standing(world, here, i)) >= 0 and places >> place & 1)
    if all(i in standing for i in indices(moved)):
        known[moved, places] = found
    return found
