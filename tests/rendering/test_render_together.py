"""Several agents in one film, and how much of what steps name is visible."""

from dataclasses import replace
from math import hypot

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.cameras.visibility import shares, tick_visibilities
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.video import CameraSelector, agent_of
from hearth.rendering.people.motion import frames, spans
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ROOM, ME, YOU, CHAIR, BOX, CUP = range(1, 7)
FPS = 8.0


def node(number, name, category, center, size, properties=(), states=()):
    return Node(number, name, category, properties, states, None, Box(center, size), 0.0)


HOME = EnvironmentGraph(
    (
        node(ROOM, "kitchen", "Rooms", (0, 1.3, 0), (6, 2.6, 5)),
        node(ME, "character", "Characters", (2.0, 0.85, 1.6), (0.4, 1.7, 0.4)),
        node(YOU, "character", "Characters", (-2.0, 0.85, 1.6), (0.4, 1.7, 0.4)),
        node(CHAIR, "chair", "Furniture", (2.0, 0.45, -1.6), (0.45, 0.9, 0.48), ("SITTABLE", "SURFACES")),
        node(BOX, "cabinet", "Furniture", (-2.0, 0.5, -2.0), (0.9, 1.0, 0.45), ("CAN_OPEN", "CONTAINERS"), ("OPEN",)),
        node(CUP, "cup", "Props", (-2.0, 0.6, -2.0), (0.09, 0.1, 0.09), ("GRABBABLE",)),
    ),
    (*(Edge(number, "INSIDE", ROOM) for number in range(2, 7)), Edge(CUP, "INSIDE", BOX)),
)
IDS = {("chair", 1): CHAIR, ("cabinet", 1): BOX, ("cup", 1): CUP}


def staged_of(text, home=HOME):
    program = parse_program("Both\nAt once\n\n\n" + text)[0].bound(IDS)
    done = run(World.start(Home.from_graph(home, "", default())), program)
    assert done.executable, done.failure
    return trajectory_of(done, home, default())


@pytest.fixture(scope="module")
def trajectory():
    return staged_of("<char0> [Walk] <chair> (1) | <char1> [Walk] <cabinet> (1)\n<char0> [Sit] <chair> (1)\n")


@pytest.fixture(scope="module")
def shown(trajectory):
    return list(frames(trajectory, FPS))


def test_two_walk_in_the_same_seconds_and_both_are_in_the_scene(trajectory, shown):
    span = spans(trajectory)[1]
    middle = next(frame for frame in shown if frame.tick == 1 and frame.time > (span.start + span.end) / 2 - 0.5)
    for number, start in enumerate(((2.0, 1.6), (-2.0, 1.6))):
        x, z = middle.actors[number].spot
        assert hypot(x - start[0], z - start[1]) > 0.3, "both are on their way"
        assert middle.scene.find((ME, YOU)[number]).position == middle.actors[number].position
    last = shown[-1]
    assert last.actors[0].body_pose.posture == "sitting"
    assert last.actors[1].body_pose.posture == "standing"


def test_a_camera_goes_with_the_agent_that_it_is_told(trajectory, shown):
    frame = next(frame for frame in shown if frame.tick == 2)
    for view, number in (("first", 0), ("first.0", 0), ("first.1", 1)):
        eye = CameraSelector(trajectory, HOME, view, (64, 48)).camera(frame).eye
        x, z = frame.actors[number].spot
        assert hypot(eye[0] - x, eye[2] - z) < 0.5, view
    with pytest.raises(HearthError, match="no agent 2"):
        CameraSelector(trajectory, HOME, "first.2", (64, 48)).camera(frame)
    with pytest.raises(HearthError, match="no camera"):
        CameraSelector(trajectory, HOME, "last.1", (64, 48))
    assert agent_of("kitchen.1.3") == ("kitchen.1.3", None)


def test_the_choosing_camera_looks_at_whoever_acts(trajectory):
    alone = staged_of("<char1> [Walk] <cabinet> (1)\n")
    frame = [frame for frame in frames(alone, FPS) if frame.tick == 1][-1]
    camera = CameraSelector(alone, HOME, "auto", (64, 48)).camera(frame)
    places, depths = camera.project(np.array([frame.actors[1].world((0.0, 1.0, 0.0))]))
    assert depths[0] > 0
    assert 0 < places[0, 0] < 64
    assert alone.keyframes[1].acting == alone.keyframes[1].actors[1]


def test_what_is_shut_away_is_not_seen_and_is_told_apart():
    found = list(tick_visibilities(staged_of("<char1> [Walk] <cabinet> (1)\n<char1> [Close] <cabinet> (1)\n"), HOME))
    assert [look.named for look in found] == [(BOX,), (BOX,)]
    assert shares(found)[:4] == (2, 1.0, 1.0, 1.0)
    in_closed = tuple(replace(n, states=("CLOSED",)) if n.id == BOX else n for n in HOME.nodes)
    home = replace(HOME, nodes=in_closed)
    (look,) = tick_visibilities(staged_of("<char1> [Walk] <cup> (1)\n", home), home)
    assert look.named == look.missed == look.unseen == look.in_closed == (CUP,)
    assert shares([look])[:4] == (1, 0.0, 0.0, 1.0)
    (look,) = tick_visibilities(staged_of("<char1> [Walk] <cup> (1)\n"), HOME)
    assert look.missed == (), "a camera looks into what is open"
