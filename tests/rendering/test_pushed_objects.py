"""Pushed things slide away from the person, pulled ones towards it, with what is on them, while there is room."""

from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.people.motion import frames
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ROOM, ME, CHAIR, CUP, WALL = range(1, 6)


def node(number, name, category, center, size, properties=(), yaw=0.0):
    return Node(number, name, category, properties, (), None, Box(center, size), yaw)


def filmed(action, *more):
    nodes = (
        node(ROOM, "kitchen", "Rooms", (0, 1.3, 0), (5, 2.6, 4), yaw=None),
        node(ME, "character", "Characters", (1.6, 0.85, 1.4), (0.4, 1.7, 0.4)),
        node(CHAIR, "chair", "Furniture", (0.0, 0.45, 0.0), (0.45, 0.9, 0.48), ("SITTABLE", "SURFACES", "MOVABLE")),
        node(CUP, "cup", "Props", (0.0, 0.5, 0.0), (0.1, 0.1, 0.08), ("GRABBABLE", "RECIPIENT")),
        *more,
    )
    edges = (*(Edge(each.id, "INSIDE", ROOM) for each in nodes[1:]), Edge(CUP, "ON", CHAIR))
    home = EnvironmentGraph(nodes, edges)
    program, faults = parse_program(
        f"Move it\nAway\n\n\n[Walk] <chair> (1)\n[{action}] <chair> (1)\n[Walk] <kitchen> (1)\n"
    )
    assert not faults
    bound = program.bound({("chair", 1): CHAIR, ("kitchen", 1): ROOM})
    done = run(World.start(Home.from_graph(home, "", default())), bound)
    assert done.executable, done.failure
    return trajectory_of(done, home, default())


def middle(keyframe, number):
    return np.array(keyframe.places.poses[number].box.center)


@pytest.mark.parametrize(("action", "sign"), [("Push", 1.0), ("Pull", -1.0)])
def test_a_chair_slides_and_takes_with_it_what_is_on_it(action, sign):
    found = filmed(action).keyframes
    person = np.array(found[2].actors[0].position)
    before, after = middle(found[1], CHAIR), middle(found[2], CHAIR)
    way, moved = (before - person)[[0, 2]], (after - before)[[0, 2]]
    assert 0.05 < np.linalg.norm(moved) < 0.3
    assert np.sign(way @ moved) == sign
    assert np.allclose(middle(found[2], CUP) - middle(found[1], CUP), after - before)
    # It stays there.
    assert np.allclose(middle(found[3], CHAIR), after)


def test_it_slides_softly_in_a_film():
    trajectory = filmed("Push")
    spots = [np.array(frame.scene.find(CHAIR).position) for frame in frames(trajectory, 15.0)]
    steps = [float(np.linalg.norm(b - a)) for a, b in pairwise(spots)]
    assert sum(step > 1e-4 for step in steps) >= 5
    assert max(steps) < 0.08


def test_a_wall_stops_it():
    here = np.array((0.0, 0.45, 0.0))
    free = middle(filmed("Push").keyframes[2], CHAIR) - here
    side = np.sign(free[[0, 2]]) * (0.3, 0.3) + free[[0, 2]]
    wall = node(WALL, "cabinet", "Furniture", (float(side[0]), 0.5, float(side[1])), (0.3, 1.0, 0.3))
    stopped = middle(filmed("Push", wall).keyframes[2], CHAIR) - here
    assert np.linalg.norm(stopped) < np.linalg.norm(free)
