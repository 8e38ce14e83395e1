"""Moving by metres over the floor of a home."""

import math
from itertools import pairwise

import pytest

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.motion.moves import Located, do, located
from hearth.simulation.motion.navigation import Pose, Ways, along, distance_to, heading, length
from hearth.simulation.world.world import World


@pytest.fixture(scope="module")
def ways():
    return Ways(library.load_layout("maple", default()).floor)


@pytest.fixture
def here(maple):
    return located(World.start(maple))


def step(action, *nodes, agent=0):
    return Step(action, tuple(ObjectRef("thing", 1, node) for node in nodes), agent)


def id_of(home, name):
    return home.ids[home.classes.index(name)]


def test_headings_turn_from_z_towards_x():
    assert [heading((0, 0), p) for p in ((0, 1), (1, 0), (0, -1), (-1, 0))] == [0, 90, 180, 270]


def test_a_path_is_free_and_no_shorter_than_the_straight_line(ways, here, maple):
    start = here.poses[0].point
    box = maple.node(maple.classes.index("bed")).box
    goal = ways.stand(box, None, seed=start)
    path = ways.path(start, goal.point)
    assert length(path) >= math.dist(start, goal.point) - 0.2
    for x, z in path:
        i, j = ways.floor.index(x, z)
        assert ways.floor.walkable[i, j]
    assert all(math.dist(a, b) < 0.15 for a, b in pairwise(path))


def test_walktowards_goes_a_stride_at_a_time_and_arrives_with_a_walk(ways, here, maple):
    bed = id_of(maple, "bed")
    before, strides = here, 0
    while not before.world.agents[0].close >> maple.index[bed] & 1:
        after = do(before, step("Walktowards", bed), ways)
        assert isinstance(after, Located), after
        moved = math.dist(before.poses[0].point, after.poses[0].point)
        assert moved <= 1.0 + 1e-6
        before, strides = after, strides + 1
        assert strides < 40
    assert strides > 2
    assert distance_to(maple.node(maple.index[bed]).box, before.poses[0].point) < 1.0


def test_a_fast_helper_needs_a_third_of_the_strides(ways, here, maple):
    bed = id_of(maple, "bed")

    def strides(metres):
        now, count = here, 0
        while not now.world.agents[0].close >> maple.index[bed] & 1:
            now, count = do(now, step("Walktowards", bed), ways, stride=metres), count + 1
        return count

    slow, fast = strides(1.0), strides(3.0)
    assert fast <= slow / 3 + 1


def test_who_is_under_way_is_close_to_nothing_and_in_the_room_it_crosses(ways, here, maple):
    bed = id_of(maple, "bed")
    near = do(here, step("Walk", id_of(maple, "couch")), ways)
    away = do(near, step("Walktowards", bed), ways)
    assert away.world.agents[0].close == 0
    assert maple.classes[away.world.agents[0].inside.bit_length() - 1] == "living_room"


def test_turns_are_thirty_degrees_and_twelve_bring_one_round(ways, here):
    right = do(here, step("Turnright"), ways)
    assert (right.poses[0].yaw - here.poses[0].yaw) % 360 == pytest.approx(30)
    assert do(right, step("Turnleft"), ways).poses == here.poses
    now = here
    for _ in range(12):
        now = do(now, step("Turnright"), ways)
    assert now.poses[0].yaw == pytest.approx(here.poses[0].yaw)


def test_walkforward_is_one_metre_or_nothing(ways, here):
    results = []
    for yaw in range(0, 360, 30):
        start = Located(here.world, (Pose(*here.poses[0].point, yaw),))
        after = do(start, step("Walkforward"), ways)
        if isinstance(after, Failure):
            assert after.code is Code.NO_PATH
        else:
            assert math.dist(after.poses[0].point, start.poses[0].point) == pytest.approx(1.0)
        results.append(isinstance(after, Failure))
    assert False in results


def test_other_characters_are_in_the_way(ways, here, maple):
    start = here.poses[0].point
    goal = ways.stand(maple.node(maple.classes.index("bed")).box, None, seed=start).point
    free = ways.path(start, goal)
    middle = free[len(free) // 2]
    around = ways.path(start, goal, others=[middle])
    assert around is None or min(math.dist(point, middle) for point in around) >= 0.45


def test_along_stops_at_the_end():
    path = [(0.0, 0.0), (0.0, 2.0), (1.0, 2.0)]
    assert along(path, 1.0) == (0.0, 1.0)
    assert along(path, 2.5) == (0.5, 2.0)
    assert along(path, 9.0) == (1.0, 2.0)


def test_who_sits_can_not_walk(ways, here, maple):
    seated = do(do(here, step("Walk", id_of(maple, "couch")), ways), step("Sit", id_of(maple, "couch")), ways)
    for action in ("Walktowards", "Walkforward"):
        refused = do(seated, step(action, id_of(maple, "bed")), ways)
        assert isinstance(refused, Failure) and refused.code is Code.SITTING and refused.action == action
