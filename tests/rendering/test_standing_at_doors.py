"""Positions of people before things that open: out of the way of doors, and close to the contents of open things."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.people.action_poses import INTO
from hearth.rendering.scene.standing_places import FreeFloor
from hearth.schemas.graph import Box, Node
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.home import Home

PROGRAM = "Have dessert\nFrom the fridge\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Grab] <food_dessert> (1)\n" \
    "[Close] <fridge> (1)\n"  # fmt: skip
ROOM = Node(1, "kitchen", "Rooms", (), (), None, Box((0, 1.3, 0), (5, 2.6, 4)))
FRIDGE = Box((0, 0.9, -1.7), (0.7, 1.8, 0.6))
LEAF = np.array([(0.35, -1.4 + far) for far in np.arange(0, 0.65, 0.05)])
ARC = np.array([(x, -1.4 + far) for x in np.arange(-0.35, 0.4, 0.05) for far in np.arange(0, 0.65, 0.05)])


@pytest.fixture(scope="module")
def keyframes():
    program, faults = parse_program(PROGRAM)
    assert not faults
    graph = library.load_graph("rowan", default())
    tried = attempt(program, Home.from_graph(graph, "rowan", default()), 0)
    assert tried.execution.executable
    return trajectory_of(tried.execution, graph, default()).keyframes


def before(keyframe):
    """Metres of floor between the person and the fridge, and the fridge's id."""
    fridge = keyframe.steps[-1].objects[0].node if keyframe.steps else 0
    actor = keyframe.actors[0]
    box = keyframe.places.poses[fridge].box
    ways = [max(abs(a - b) - s / 2, 0) for a, b, s in
            zip(actor.spot, (box.center[0], box.center[2]), (box.size[0], box.size[2]), strict=True)]  # fmt: skip
    return float(np.hypot(*ways)), fridge


def test_one_steps_up_to_what_is_inside_and_back_before_the_door_closes(keyframes):
    walked, opened, taken, closed = keyframes[1:]
    assert [one.steps[0].action for one in (walked, opened, taken, closed)] == ["Walk", "Open", "Grab", "Close"]
    far, fridge = before(opened)
    box, spot = closed.places.poses[fridge].box, taken.actors[0].spot
    reached = np.hypot(
        max(abs(spot[0] - box.center[0]) - box.size[0] / 2, 0), max(abs(spot[1] - box.center[2]) - box.size[2] / 2, 0)
    )
    assert reached <= INTO < far
    for one in (opened, closed):
        assert not one.floor.in_the_way(one.actors[0].spot, fridge)


def test_doors_that_stay_as_they_are_take_up_only_the_floor_where_they_are():
    floor = FreeFloor.of([ROOM], [], lambda node: ARC, leaves=lambda node: LEAF)
    here = (0.0, 0.5)
    swinging, still = (next(floor.spots_for(FRIDGE, 0.0, ROOM.id, here, opens=2, still=each)) for each in (False, True))
    assert np.hypot(*(ARC - swinging).T).min() > 0.25 > np.hypot(*(ARC - still).T).min()
    assert np.hypot(*(LEAF - still).T).min() > 0.25
    assert abs(still[0]) < 0.35 < abs(swinging[0]), "before it, and aside"
    assert floor.in_the_way(still, 2) and not floor.in_the_way(swinging, 2)
