"""A stride aside, by which a character lets another pass that can't get around it."""

from __future__ import annotations

import math

import numpy as np

from hearth.schemas.graph import Spot
from hearth.simulation.motion import positions
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import BODY_RADIUS, Field, Ways
from hearth.simulation.motion.stride_ahead import SHARES, SLACK, closed_doors, in_the_way
from hearth.simulation.rules import Rules
from hearth.simulation.world.bits import lowest
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

AHEAD, POINTS = 0.2, 20
"""The part of the other's way that is left free: metres from point to point, and their number."""


def stride_aside(world: World, number: int, other: int, target: int, rules: Rules) -> Pose | None:
    """Return the end of a stride out of another character's way, or None where there is no free floor for it.

    It leads towards the nearest cell that is off the other's way, and that one can reach without passing the other.

    Args:
        world: as it is now.
        number: of the character that gives way.
        other: of the character that is to pass.
        target: the thing to which that one walks.
        rules: how actions are read.
    """
    here, pose, at = ground_of(world.home), world.agents[number].pose, world.agents[other].pose
    if here is None or pose is None or at is None:
        return None
    ways, shut = here.ground.ways, here.ground.shut(closed_doors(world, rules))
    taken = ways.blocked([each.pose.point for k, each in enumerate(world.agents) if k != number and each.pose])
    mine = ways.around(pose.x, pose.z)
    taken[mine] = False
    without = tuple(sorted({*shut, *np.flatnonzero(taken).tolist()}))
    field = ways.field(positions.ends(world, here, target), shut)
    refuge = _refuge(ways, _way(ways, field, at), mine, without, taken)
    if refuge < 0:
        return None
    back = ways.detour((refuge,), without)
    for share in SHARES:
        x, z, cell = ways.stepped(back, pose.x, pose.z, world.agents[number].stride * share)
        if cell != -2 and not in_the_way(world, number, (pose, Pose(x, z)), 2 * BODY_RADIUS - SLACK):
            return Pose(x, z, pose.towards((x, z)).yaw)
    return None


PLACES = (0.55, -0.55, 1.1, -1.1)
"""Places to the side of a seat's middle, metres."""


def seated_apart(world: World, number: int) -> World:
    """Return the world in which a character keeps apart from others on its seat, if that is wide enough."""
    agent = world.agents[number]
    pose = agent.pose
    others = [each.pose.point for k, each in enumerate(world.agents) if k != number and each.pose is not None]
    if pose is None or not agent.on or _is_free(pose.point, others):
        return world
    box = world.home.node(lowest(agent.on)).box
    angle = math.radians(pose.yaw)
    if box is None:
        return world
    for place in PLACES:
        x, z = pose.x + place * math.cos(angle), pose.z - place * math.sin(angle)
        inside = all(
            abs(now - middle) <= size / 2
            for now, middle, size in zip(
                (x, z), (box.center[0], box.center[2]), (box.size[0], box.size[2]), strict=True
            )
        )
        if inside and _is_free((x, z), others):
            beside = agent._replace(pose=Pose(x, z, pose.yaw))
            return world.with_agent(number, beside)
    return world


def _is_free(point: Spot, others: list[Spot]) -> bool:
    return all(math.dist(point, other) >= 2 * BODY_RADIUS for other in others)


def _way(ways: Ways, field: Field, at: Pose) -> list[Spot]:
    """Return points of the way ahead of a character."""
    points = [at.point]
    for _ in range(POINTS):
        x, z, cell = ways.stepped(field, *points[-1], AHEAD)
        if cell == -2:
            break
        points.append((x, z))
        if cell == -1:
            break
    return points


def _refuge(ways: Ways, way: list[Spot], mine: list[int], without: tuple[int, ...], taken: np.ndarray) -> int:
    """Return the nearest cell that is off a way, or -1."""
    if not mine:
        return -1
    distance = np.asarray(ways.detour(tuple(mine), without).distance)
    free = ~(ways.blocked(way) | taken) & np.isfinite(distance)
    return int(np.flatnonzero(free)[distance[free].argmin()]) if free.any() else -1
