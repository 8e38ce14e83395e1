"""Characters in each other's way: by a rule one walks around them, and of two the lower number goes first."""

import math
from types import SimpleNamespace

from hypothesis import given
from hypothesis import strategies as st
from walks import at, id_of, step, walked

from hearth.homes.plans.walkable_floor import REACH
from hearth.simulation.engine import tick
from hearth.simulation.env import with_agents
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.motion.positions import placed
from hearth.simulation.motion.stride_ahead import in_the_way
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

BODIES = DEFAULT._replace(bodies=True)


def test_bodies_are_in_the_way_by_a_rule(maple):
    world = placed(with_agents(World.start(maple), 2))
    node = id_of(maple, "bed")
    alone = walked(World(maple, world.states, world.agents[:1], world.moved), node)
    middle = alone[len(alone) // 2].agents[0].pose
    standing = at(world, middle, number=1)
    through = around = standing
    nearest = {"through": math.inf, "around": math.inf}
    for _ in range(2 * len(alone)):
        through, _ = tick(through, {0: step("Walktowards", node)}, DEFAULT)
        around, _ = tick(around, {0: step("Walktowards", node)}, BODIES)
        for name, now in (("through", through), ("around", around)):
            nearest[name] = min(nearest[name], math.dist(now.agents[0].pose.point, middle.point))
    assert nearest["through"] < 2 * BODY_RADIUS <= nearest["around"] + 0.02


@given(st.tuples(*[st.integers(-30, 30)] * 6))
def test_who_is_in_the_way_of_a_stride(numbers):
    x0, z0, x1, z1, x, z = (number / 10 for number in numbers)
    other = SimpleNamespace(pose=Pose(x, z, 0.0))
    world = SimpleNamespace(agents=(SimpleNamespace(pose=Pose(x0, z0, 0.0)), other))
    leg = Pose(x0, z0, 0.0), Pose(x1, z1, 0.0)
    away = [math.dist((x0 + (x1 - x0) * n / 500, z0 + (z1 - z0) * n / 500), (x, z)) for n in range(501)]
    comes_nearer = min(away) < away[0]
    if abs(min(away) - 2 * BODY_RADIUS) > 1e-3:
        assert in_the_way(world, 0, leg) == (comes_nearer and min(away) < 2 * BODY_RADIUS)


def test_of_two_that_walk_the_lower_number_goes_first(maple):
    world = placed(with_agents(World.start(maple), 2))
    towards = {0: step("Walktowards", id_of(maple, "bed")), 1: step("Walktowards", maple.ids[maple.agents[0]], agent=1)}
    for _ in range(30):
        world, failures = tick(world, towards)
        assert not failures
    one, other = world.agents
    assert math.dist(one.pose.point, other.pose.point) < REACH and other.close & one.bit and one.close & other.bit
