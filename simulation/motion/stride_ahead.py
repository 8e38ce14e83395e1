"""A stride straight ahead, and other characters in the way of one."""

from __future__ import annotations

import math

from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.rules import Rules
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.states import CLOSED
from hearth.simulation.world.world import World


def closed_doors(world: World, rules: Rules) -> int:
    """Return the doors that stop a walk."""
    return world.home.doors & world.states[CLOSED] if rules.doors else 0


def stride_ahead(world: World, number: int, rules: Rules) -> tuple[Pose | None, float]:
    """Return the place a stride ahead, or None with the metres that are free."""
    agent = world.agents[number]
    here, pose = ground_of(world.home), agent.pose
    if here is None or pose is None:
        return None, 0.0
    angle = math.radians(pose.yaw)
    step = (math.sin(angle) * agent.stride, math.cos(angle) * agent.stride)
    free = here.ground.ways.ahead(pose.point, step, here.ground.shut(closed_doors(world, rules)))
    if free < 1.0:
        return None, free * agent.stride
    there = Pose(pose.x + step[0], pose.z + step[1], pose.yaw)
    if rules.bodies and in_the_way(world, number, (pose, there)):
        return None, 0.0
    return there, agent.stride


def others_of(world: World, number: int) -> list[Agent]:
    """Return the other characters."""
    return [other for i, other in enumerate(world.agents) if i != number]


def in_the_way(world: World, number: int, leg: tuple[Pose, Pose], room: float = 2 * BODY_RADIUS) -> bool:
    """Return whether a stride comes nearer to another character than both bodies need, and not only away from it.

    Args:
        world: where the others stand.
        number: of the character that makes the stride.
        leg: its start and end.
        room: the least distance of the two, metres.
    """
    start, end = leg
    dx, dz = end.x - start.x, end.z - start.z
    square = dx * dx + dz * dz
    for other in others_of(world, number):
        at = other.pose
        if at is None:
            continue
        share = ((at.x - start.x) * dx + (at.z - start.z) * dz) / square if square else 0.0
        if share > 0:
            share = min(1.0, share)
            if math.hypot(start.x + dx * share - at.x, start.z + dz * share - at.z) < room:
                return True
    return False


SHARES = (1.0, 0.5, 0.25, 0.125)
"""The parts of a stride that are tried around another character."""

SLACK = 0.04
"""Allowed shortfall of the distance in a stride around another character, which cuts corners, metres."""


def kept_apart(before: World, now: World, after: World, number: int) -> World:
    """Return the world after a character has moved, or before it has if it would walk into another that moves as well.

    Args:
        before: at the start of the tick.
        now: after the moves of the characters of lower numbers.
        after: after this character's move, too.
        number: of the character.
    """
    start, end = before.agents[number].pose, after.agents[number].pose
    if start is None or end is None or start.point == end.point:
        return after
    for k, other in enumerate(now.agents):
        was, at = before.agents[k].pose, other.pose
        if k == number or was is None or at is None or was.point == at.point:
            continue
        if _meet(start, end, was, at):
            return now
    return after


def is_beside(world: World, number: int, other: int) -> bool:
    """Return whether another character is so near that it may stop a stride."""
    one, two = world.agents[number], world.agents[other]
    if one.pose is None or two.pose is None:
        return False
    return math.dist(one.pose.point, two.pose.point) < 2 * BODY_RADIUS + one.stride


def _meet(start: Pose, end: Pose, was: Pose, at: Pose) -> bool:
    """Return whether two characters that go straight at the same time come nearer than both bodies need, and nearer
    than they were.
    """
    x, z = start.x - was.x, start.z - was.z
    dx, dz = end.x - at.x - x, end.z - at.z - z
    square = dx * dx + dz * dz
    share = -(x * dx + z * dz) / square if square else 0.0
    if share <= 0:
        return False
    share = min(1.0, share)
    return math.hypot(x + dx * share, z + dz * share) < 2 * BODY_RADIUS - SLACK
