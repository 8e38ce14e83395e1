"""Moving by metres: strides, turns and steps forward, what stops them, and where a character and its things are."""

import itertools
import math
import random
from dataclasses import replace

import numpy as np
import pytest
from walks import OWN, at, id_of, own_home, step, walked

from hearth.homes.plans.walkable_floor import REACH, gaps
from hearth.kb.loading.load import default
from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.legal import legal
from hearth.simulation.actions.registry import EVERY
from hearth.simulation.engine import act, tick
from hearth.simulation.env import with_agents
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.positions import placed, spot
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World


@pytest.fixture(scope="module")
def here(maple):
    return placed(World.start(maple))


@pytest.mark.parametrize("name", OWN)
def test_as_many_strides_as_the_way_is_long_rounded_up(name):
    home = own_home(name)
    world = placed(World.start(home))
    ground = ground_of(home).ground
    chooser = random.Random(name)
    cells = np.flatnonzero(ground.ways.main).tolist()
    for i in chooser.sample(list(indices(home.furniture)), 12):
        field = ground.ways.field(ground.stands(i))
        start = chooser.choice(cells)
        for stride in (1.0, 3.0):
            begun = at(world, Pose(*ground.ways.points[start].tolist()), stride=stride)
            worlds = walked(begun, home.ids[i])
            assert len(worlds) - 1 == math.ceil(field.distance[start] / stride - 1e-9)
            assert worlds[-1].agents[0].close >> i & 1 or len(worlds) == 1


def crossed(ways, one, other):
    """The cells on the straight line between two points that are a stride apart, as finely as they are."""
    count = max(1, math.ceil(math.dist(one, other) / 0.02))
    points = (tuple(a + (b - a) * k / count for a, b in zip(one, other, strict=True)) for k in range(count + 1))
    return [ways.at(*point) for point in points]


def way(ways, field, pose, stride):
    """The points of a stride, its corners included."""
    points = [pose.point]
    for _ in range(round(stride / 0.05)):
        x, z, cell = ways.stepped(field, *points[-1], 0.05)
        points.append((x, z))
        if cell < 0:
            break
    return points


@pytest.mark.parametrize("name", ["maple", "juniper", "larch"])
@pytest.mark.parametrize("stride", [1.0, 3.0])
def test_no_stride_passes_a_wall_or_a_closed_door(name, stride):
    """Juniper and larch have rooms with two ways to them, of which one may be closed."""
    home = own_home(name)
    ground = ground_of(home).ground
    doors = [i for i in indices(home.doors) if home.classes[i] == "door"]
    chooser = random.Random(3)
    passed = 0
    for _ in range(40):
        shut = chooser.sample(doors, 1)
        world = edit(placed(World.start(home)), set=[(home.ids[door], "CLOSED") for door in shut])
        without = ground.shut(sum(1 << door for door in shut))
        assert without
        x, z = ground.ways.points[chooser.choice(np.flatnonzero(ground.ways.main).tolist())].tolist()
        world = at(world, Pose(x, z), stride=stride)
        if ground.ways.at(x, z) in without:
            continue
        node = chooser.choice(list(indices(home.furniture)))
        for _ in range(20):
            after = act(world, step("Walktowards", home.ids[node]))
            if isinstance(after, Failure):
                assert after.code is Code.DOOR_CLOSED, after
                break
            one, other = world.agents[0].pose, after.agents[0].pose
            points = way(ground.ways, ground.ways.field(ground.stands(node), without), one, stride)
            for a, b in itertools.pairwise(points):
                cells = crossed(ground.ways, a, b)
                assert min(cells) >= 0 and not set(cells) & set(without)
            assert math.dist(points[-1], other.point) < 1e-6
            passed += 1
            world = after
    assert passed > 30


def test_a_closed_door_stops_who_walks_straight_on(maple):
    home = maple
    ground = ground_of(home).ground
    door = next(i for i in indices(home.doors) if home.classes[i] == "door")
    cells = ground.shut(1 << door)
    x, z = ground.ways.points[list(cells)].mean(axis=0).tolist()
    stopped = 0
    for yaw in range(0, 360, 30):
        pose = Pose(x - 0.5 * math.sin(math.radians(yaw)), z - 0.5 * math.cos(math.radians(yaw)), yaw)
        world = at(placed(World.start(home)), pose)
        if isinstance(act(world, step("Walkforward")), World):
            closed = edit(world, set=[(home.ids[door], "CLOSED")])
            assert isinstance(act(closed, step("Walkforward")), Failure)
            assert isinstance(act(closed, step("Walkforward"), DEFAULT._replace(doors=False)), World)
            open_ones = edit(world, set=[(home.ids[each], "OPEN") for each in indices(home.doors)])
            assert isinstance(act(open_ones, step("Walkforward"), DEFAULT._replace(doors=False)), World)
            stopped += 1
    assert stopped


def test_who_passes_by_is_close_to_what_is_within_reach(here, maple):
    world = here
    ground = ground_of(maple).ground
    for world in walked(here, id_of(maple, "bed"))[1:-1]:
        agent = world.agents[0]
        room = agent.inside.bit_length() - 1
        for i in indices(agent.close & ~maple.properties["BODY_PART"]):
            assert gaps(np.asarray([agent.pose.point]), maple.node(i).box)[0] <= REACH + 0.08
        for i in indices(maple.furniture):
            box = maple.node(i).box
            mine = ground._room_of[i] == room and not maple.inside[i] & ~maple.rooms
            if mine and box.center[1] < 1.5 and gaps(np.asarray([agent.pose.point]), box)[0] < REACH - 0.08:
                assert agent.close >> i & 1


def test_who_has_arrived_has_walked_there(here, maple):
    table = id_of(maple, "dining_table") if "dining_table" in maple.classes else id_of(maple, "table")
    walk = act(here, step("Walk", table))
    by_metres = walked(here, table)[-1]
    assert by_metres.agents[0].inside == walk.agents[0].inside
    assert walk.agents[0].close & ~by_metres.agents[0].close & ~maple.bears[maple.index[table]] == 0
    assert gaps(np.asarray([walk.agents[0].pose.point]), maple.node(maple.index[table]).box)[0] <= REACH


def test_turns_are_thirty_degrees_and_twelve_bring_one_round(here):
    now = here
    right = act(here, step("Turnright"))
    assert (right.agents[0].pose.yaw - here.agents[0].pose.yaw) % 360 == pytest.approx(30)
    assert act(right, step("Turnleft")).agents[0].pose == here.agents[0].pose
    for _ in range(12):
        now = act(now, step("Turnright"))
    assert now.agents[0].pose.yaw == pytest.approx(here.agents[0].pose.yaw)


def test_walkforward_is_one_metre_or_nothing(here):
    done = []
    for yaw in range(0, 360, 30):
        start = at(here, Pose(*here.agents[0].pose.point, yaw))
        after = act(start, step("Walkforward"))
        done.append(isinstance(after, World))
        if done[-1]:
            assert math.dist(after.agents[0].pose.point, start.agents[0].pose.point) == pytest.approx(1.0)
        else:
            assert after.code is Code.NO_PATH
        assert (step("Walkforward") in legal(start)) == done[-1]
    assert True in done and False in done


def test_who_sits_can_not_walk_and_gets_up_beside_the_seat(here, maple):
    couch = id_of(maple, "couch")
    seated = act(act(here, step("Walk", couch)), step("Sit", couch))
    box = maple.node(maple.index[couch]).box
    assert seated.agents[0].pose.point == (box.center[0], box.center[2])
    for action in (("Walktowards", couch), ("Walkforward",)):
        refused = act(seated, step(*action))
        assert isinstance(refused, Failure) and refused.code is Code.SITTING and refused.action == action[0]
    up = act(seated, step("StandUp"))
    ways = ground_of(maple).ground.ways
    assert ways.main[ways.at(*up.agents[0].pose.point)]
    assert isinstance(act(up, step("Walktowards", id_of(maple, "bed"))), World)


def test_a_thing_is_where_it_was_put(here, maple):
    table, milk = maple.classes.index("table"), maple.classes.index("milk")
    boxes = {i: maple.node(i).box for i in (table, milk)}
    middle = {i: (box.center[0], box.center[2]) for i, box in boxes.items()}
    assert spot(here, milk) == middle[milk] != middle[table]
    there = edit(here, place={maple.ids[milk]: ("ON", maple.ids[table])})
    assert spot(there, milk) == middle[table]
    back = edit(there, place={maple.ids[milk]: ("INSIDE", maple.ids[maple.classes.index("fridge")])})
    assert spot(back, milk) == middle[milk], "where the home has it"
    held = World(here.home, here.states, (here.agents[0]._replace(right=1 << milk),), here.moved)
    assert spot(held, milk) == here.agents[0].pose.point == spot(here, here.agents[0].index)


def test_without_geometry_nobody_has_a_place(here, maple):
    graph = maple_without_boxes(maple)
    world = World.start(Home.from_graph(graph, "", default()))
    assert placed(world) is world
    for unplaced in (world, World.start(maple)):
        refused = act(unplaced, step("Turnleft"))
        assert isinstance(refused, Failure) and refused.code is Code.NOT_SIMULATED
    assert "Turnleft" not in legal(world).masks


def maple_without_boxes(maple):
    graph = World.start(maple).graph()
    return replace(graph, nodes=tuple(replace(node, box=None) for node in graph.nodes))


@pytest.mark.parametrize("seed", range(4))
def test_legal_is_exactly_what_can_be_done_at_a_place(seed):
    chooser = random.Random(seed)
    home = own_home(OWN[seed])
    world = placed(with_agents(World.start(home), 2, seed), chooser)
    doors = [home.ids[i] for i in indices(home.doors) if home.properties["CAN_OPEN"] >> i & 1]
    world = edit(world, set=[(door, "CLOSED") for door in doors if chooser.random() < 0.3], check=False)
    for _ in range(25):
        for number in (0, 1):
            found = legal(world, number)
            things = chooser.sample(home.ids, 25) + [home.ids[i] for i in indices(world.agents[number].held)]
            tries = [step("Walktowards", thing, agent=number) for thing in things]
            tries += [step(name, agent=number) for name in ("Walkforward", "Turnleft", "Turnright")]
            for each in tries:
                assert (each in found) == isinstance(act(world, each), World), (each, act(world, each))
            options = [each for each in found if each.action in EVERY]
            chosen = chooser.choice([each for each in options if each.action in ("Walktowards", "Grab")] or options)
            world, failures = tick(world, {number: chosen})
            assert not failures
            ways = ground_of(world.home).ground.ways
            pose = world.agents[number].pose
            assert world.agents[number].on or ways.main[ways.at(*pose.point)]


def test_nobody_walks_to_a_closed_doorway_in_which_it_stands(maple):
    """A door is closed where somebody stands: the mask and the rule agree that no way leads from there to there."""
    here = ground_of(maple)
    door = next(indices(maple.doors))
    for cell in here.ground.shut(1 << door):
        assert here.ground.reached(cell, 1 << door) == 0
        assert not here.ground.joined(cell, cell, 1 << door) and here.ground.joined(cell, cell, 0)
