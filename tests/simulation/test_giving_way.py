"""Characters that stop each other: one steps aside, nobody waits for ever, and no two are in one place."""

import math

import pytest
from walks import at, id_of, step

from hearth.simulation.engine import tick
from hearth.simulation.env import with_agents
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.motion.positions import placed
from hearth.simulation.motion.stride_ahead import SLACK
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

BODIES = DEFAULT._replace(bodies=True)

DOORWAY = (Pose(1.85, 4.70, 180.0), Pose(1.95, 4.20, 0.0))
"""Places on both sides of a door of maple, face to face."""


@pytest.fixture
def facing(maple):
    """Two characters that face each other in a doorway of maple."""
    world = placed(with_agents(World.start(maple), 2))
    for number, pose in enumerate(DOORWAY):
        world = at(world, pose, number=number)
    return world


def walked_apart(world, instructions, ticks):
    """Return the world after ticks, and the least distance while both go straight from place to place."""
    least = math.inf
    for _ in range(ticks):
        after, failures = tick(world, instructions, BODIES)
        assert not failures
        for share in (0.25, 0.5, 0.75, 1.0):
            points = [
                [start + (end - start) * share for start, end in zip(one.pose.point, two.pose.point, strict=True)]
                for one, two in zip(world.agents, after.agents, strict=True)
            ]
            least = min(least, math.dist(*points))
        world = after
    return world, least


def is_there(world, number, node):
    return bool(world.agents[number].close >> world.home.index[node] & 1)


def test_two_that_face_each_other_in_a_doorway_pass(facing, maple):
    goals = [id_of(maple, "living_room"), id_of(maple, "kitchen")]
    instructions = {number: step("Walktowards", goals[number], agent=number) for number in (0, 1)}
    world, least = walked_apart(facing, instructions, 40)
    assert all(is_there(world, number, goals[number]) for number in (0, 1))
    assert least >= 2 * BODY_RADIUS - 2 * SLACK


@pytest.mark.parametrize("walker", [0, 1])
def test_a_character_that_does_nothing_steps_aside(facing, maple, walker):
    beyond = id_of(maple, ("living_room", "kitchen")[walker])
    world, least = walked_apart(facing, {walker: step("Walktowards", beyond, agent=walker)}, 40)
    assert is_there(world, walker, beyond) and least >= 2 * BODY_RADIUS - 2 * SLACK


def test_two_on_one_couch_sit_next_to_each_other(maple):
    world = placed(with_agents(World.start(maple), 2))
    couch = id_of(maple, "couch")
    for number in (0, 1):
        for _ in range(20):
            world, _ = tick(world, {number: step("Walktowards", couch, agent=number)}, BODIES)
        world, failures = tick(world, {number: step("Sit", couch, agent=number)}, BODIES)
        assert not failures
    one, other = world.agents
    assert one.on == other.on != 0
    assert math.dist(one.pose.point, other.pose.point) >= 2 * BODY_RADIUS
