"""Floors of homes, ours, drawn ones and the release's: where agents can stand and walk, and where they start."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest
from walks import OWN, own_home, step

from hearth.homes import library
from hearth.homes.plans.walkable_floor import REACH, gaps
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.loading.load import default
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Box
from hearth.simulation.engine import act
from hearth.simulation.env import with_agents
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.motion.positions import around, placed
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World


def drawn_home(seed):
    return Home.from_graph(scene(generate(3 + seed % 7, seed, default()), default()), f"drawn {seed}", default())


def assert_all_furniture_is_reached(home):
    """The main region is in every room; from all its cells a way leads to each piece and ends within reach of it."""
    ground = ground_of(home).ground
    main = ground.ways.main
    assert {ground.rooms[cell] for cell in np.flatnonzero(main)} >= set(indices(home.rooms))
    appliances = home.by_class.get("fridge", 0) | home.by_class.get("dishwasher", 0)
    for i in indices((home.furniture | appliances) & ~home.properties["GRABBABLE"]):
        if home.node(i).box is None:
            continue
        stands = ground.stands(i)
        assert stands and main[list(stands)].all(), (home, home.classes[i])
        distance = np.asarray(ground.ways.field(stands).distance)
        assert np.isfinite(distance[main]).all(), (home, home.classes[i])
        if home.node(i).box.center[1] - home.node(i).box.size[1] / 2 < 0.1:
            assert gaps(ground.ways.points[list(stands)], home.node(i).box).max() <= REACH, (home, home.classes[i])


@pytest.mark.parametrize("name", OWN)
def test_all_furniture_of_our_homes_is_reached(name):
    assert_all_furniture_is_reached(own_home(name))


@pytest.mark.parametrize("seed", [*range(6), *(pytest.param(n, marks=pytest.mark.slow) for n in range(6, 50))])
def test_all_furniture_of_drawn_homes_is_reached(seed):
    assert_all_furniture_is_reached(drawn_home(seed))


@pytest.mark.parametrize("number", [1, *(pytest.param(n, marks=pytest.mark.slow) for n in range(2, 8))])
def test_no_furniture_of_the_real_homes_is_without_a_way_once_laid_out(real_data, number):
    made = library.graph_layout(real_data / f"homes/TrimmedTestScene{number}_graph.json", default())
    home = Home.from_graph(made.graph, "real", default())
    assert_all_furniture_is_reached(home)
    world = placed(World.start(home))
    for i in indices(home.furniture):
        after = act(world, step("Walktowards", home.ids[i]))
        assert not (isinstance(after, Failure) and after.code is Code.NO_PATH), after


def test_of_blocked_cells_none_is_nearest(maple):
    ways = ground_of(maple).ground.ways
    blocked = np.ones(len(ways.points), bool)
    assert ways.nearest((0.0, 0.0), blocked) == -1
    blocked[7] = False
    assert ways.nearest((0.0, 0.0), blocked) == 7 and ways.nearest(tuple(ways.points[7])) == 7


def test_a_character_stands_in_the_main_region_from_the_start():
    for home in (own_home("juniper"), own_home("willow"), drawn_home(1)):
        world = placed(with_agents(World.start(home), 4, seed=5), random.Random(2))
        ways = ground_of(home).ground.ways
        points = [agent.pose.point for agent in world.agents]
        assert all(ways.main[ways.at(*point)] for point in points)
        assert min(math.dist(a, b) for i, a in enumerate(points) for b in points[:i]) >= 2 * BODY_RADIUS


@pytest.mark.parametrize("name", OWN[:2])
def test_diagonal_ways_need_both_their_sides_free(name):
    """Of all cells that touch at a corner, those are joined that one can pass between."""
    ways = ground_of(own_home(name)).ground.ways
    joined = set(zip(*map(np.ndarray.tolist, ways.graph.nonzero()), strict=True))
    free = {(x, z): number for (x, z), number in np.ndenumerate(ways.number) if number >= 0}
    expected = set()
    for (x, z), number in free.items():
        for dx, dz in ((1, 0), (0, 1), (1, 1), (1, -1)):
            sides = [(x + dx, z), (x, z + dz), (x + dx, z + dz)]
            if all(side in free for side in sides):
                expected.add((number, free[sides[2]]))
    assert joined == expected


@pytest.mark.parametrize("name", OWN[:2])
def test_every_free_cell_is_in_a_room_and_one_walks_to_the_middle_of_rooms(name):
    home = own_home(name)
    world, here = placed(World.start(home)), ground_of(home)
    ground, ways = here.ground, here.ground.ways
    for cell in (0, 1, len(ways.points) // 2, len(ways.points) - 1):
        _, room = around(world, 0, here, Pose(*map(float, ways.points[cell]), 0.0))
        assert room == ground.rooms[cell] >= 0
    for room in indices(home.rooms):
        x, z = home.node(room).box.center[::2]
        main = np.flatnonzero(ways.main & (np.asarray(ground.rooms) == room))
        far = {cell: math.dist((x, z), ways.points[cell]) for cell in main.tolist()}
        assert [far[cell] for cell in ground.stands(room)] == [min(far.values())]


def test_who_has_a_place_in_the_graph_stands_there_and_looks_where_it_says(maple):
    graph = World.start(maple).graph()
    me = next(node for node in graph.nodes if node.class_name == "character")
    here = placed(World.start(maple)).agents[0].pose
    box = Box((here.x, 0.9, here.z), (0.5, 1.8, 0.4))
    nodes = tuple(replace(node, box=box, yaw=210.0) if node == me else node for node in graph.nodes)
    found = placed(World.start(Home.from_graph(replace(graph, nodes=nodes), "maple", default()))).agents[0].pose
    assert found == Pose(here.x, here.z, 210.0)
