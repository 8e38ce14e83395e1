"""Doors, lids and drawers open bit by bit, about their hinges, once the hand is there."""

from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.model_recipes import RECIPES
from hearth.rendering.people.motion import OPENING, frames, spans, swinging
from hearth.rendering.scene.instances import placed
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ROOM, ME, FRIDGE, HALL, JAMB, DOOR, FLOOR = range(1, 8)
FPS = 20.0


def node(number, name, category, center, size, properties=(), yaw=0.0, states=()):
    return Node(number, name, category, properties, states, None, Box(center, size), yaw)


HOME = EnvironmentGraph(
    (
        node(ROOM, "kitchen", "Rooms", (0, 1.3, 0), (5, 2.6, 4), yaw=None),
        node(ME, "character", "Characters", (1.6, 0.85, 1.4), (0.4, 1.7, 0.4)),
        node(FRIDGE, "fridge", "Appliances", (0, 0.9, -1.6), (0.65, 1.8, 0.65), ("CAN_OPEN",), states=("CLOSED",)),
        node(FLOOR, "floor", "Floor", (0, 0, 0), (5, 0, 4), yaw=90.0),
    ),
    (Edge(ME, "INSIDE", ROOM), Edge(FRIDGE, "INSIDE", ROOM), Edge(FRIDGE, "ON", FLOOR)),
)


@pytest.fixture(scope="module")
def trajectory():
    text = "Look\nFor milk\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Close] <fridge> (1)\n"
    done = run(World.start(Home.from_graph(HOME, "", default())), parse_program(text)[0].bound({("fridge", 1): FRIDGE}))
    assert done.executable, done.failure
    return trajectory_of(done, HOME, default())


def test_a_fridge_opens_and_closes_bit_by_bit_after_the_hand_arrives(trajectory):
    reach = {2: [], 3: []}
    for frame in frames(trajectory, FPS):
        if frame.tick in reach:
            reach[frame.tick].append(float(placed(frame.scene.find(FRIDGE)).bounds()[1][2]))
    for tick, way in ((2, 1), (3, -1)):
        found = [way * far for far in reach[tick]]
        moving = [b - a for a, b in pairwise(found) if abs(b - a) > 1e-6]
        assert len(moving) >= OPENING * FPS - 2, "it takes its time"
        assert min(moving) > -0.05, "a door passes its widest point shortly before it is open"
        assert found[-1] - found[0] > 0.4
        assert found[1] == found[0], "nothing moves before the hand is there"
    assert swinging(*trajectory.keyframes[1:3]) == {FRIDGE: True}
    span = spans(trajectory)[2]
    assert span.end - span.start > OPENING


@pytest.mark.parametrize("name", sorted(name for name, recipe in RECIPES.items() if "OPEN" in recipe.states))
def test_what_is_ajar_lies_between_closed_and_open(name):
    recipe, opened = RECIPES[name], frozenset(("OPEN",))
    half = recipe.draw(Look(recipe.size, seed=3, states=opened, ajar=0.5))
    whole = recipe.draw(Look(recipe.size, seed=3, states=opened))
    assert len(half) == len(whole)
    if name not in ("book", "carton"):  # they have no hinge
        least = recipe.draw(Look(recipe.size, seed=3, states=opened, ajar=1e-3))
        some, all_ = (np.abs(mesh.corners - least.corners).max() for mesh in (half, whole))
        assert 0.1 * all_ < some < all_


def test_a_door_turns_about_its_hinge():
    leaf = node(DOOR, "door", "Doors", (2.05, 1.0, 0.45), (0.04, 2.0, 0.9), yaw=90.0, states=("OPEN",))
    jamb = node(JAMB, "doorjamb", "Doors", (2.5, 1.03, 0.0), (1.0, 2.05, 0.1))
    prepared = prepared_scene(EnvironmentGraph((HOME.nodes[0], leaf, jamb), (Edge(DOOR, "INSIDE", ROOM),)), default())
    ways = []
    for share in (0.25, 0.5, 0.75, 1.0):
        (thing,) = prepared.things(leaf, share)
        low, high = placed(thing).bounds()
        assert low[0] == pytest.approx(2.05, abs=0.09), "the hinge stays"
        assert low[2] == pytest.approx(0.0, abs=0.09)
        ways.append(high[2])
    assert ways == sorted(ways), "it swings towards where it is when it is open"
    assert high == pytest.approx((2.07, 2.0, 0.9), abs=0.09), "and ends there"


def test_nobody_stands_where_a_door_passes_over_the_floor(trajectory):
    actor = trajectory.keyframes[2].acting
    for frame in frames(trajectory, FPS):
        if frame.tick == 2:
            corners = placed(frame.scene.find(FRIDGE)).corners.reshape(-1, 3)
            gaps = np.linalg.norm(corners[corners[:, 1] < 1.7][:, (0, 2)] - actor.spot, axis=1)
            assert gaps.min() > 0.2, "of the shoulders"
    front = HOME.nodes[2].box.center[2] + HOME.nodes[2].box.size[2] / 2
    assert 0.1 < actor.spot[1] - front < 0.6, "yet before the fridge, beside the door and not beyond it"
