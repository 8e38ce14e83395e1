"""Agents that act see pictures of where they are."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.cameras.sensor import CameraSensor
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.env import Env
from hearth.simulation.world.home import Home

HOME = EnvironmentGraph(
    (
        Node(1, "kitchen", "Rooms", box=Box((0, 1.3, 0), (5, 2.6, 4))),
        Node(2, "character", "Characters", box=Box((1.5, 0.85, 1.2), (0.4, 1.7, 0.4)), yaw=90.0),
        Node(3, "table", "Furniture", ("SURFACES",), box=Box((-1.0, 0.37, 0.0), (1.2, 0.74, 0.8)), yaw=0.0),
        Node(4, "cup", "Props", ("GRABBABLE",), box=Box((-1.0, 0.8, 0.2), (0.1, 0.12, 0.1)), yaw=0.0),
    ),
    (*(Edge(number, "INSIDE", 1) for number in (2, 3, 4)), Edge(4, "ON", 3)),
)
CUP = ObjectRef("cup", 1, 4)


@pytest.fixture
def env():
    found = Env(partial=False)
    found.reset(Home.from_graph(HOME, "", default()))
    return found


def test_who_has_no_eyes_is_told_where_to_get_them(env):
    with pytest.raises(HearthError, match="no camera sensor"):
        env.observe(0, "rgb")


def test_pictures_follow_what_is_done(env):
    env.camera_sensor = CameraSensor(HOME, default(), size=(64, 48))
    before = env.observe(0, "rgb", "instance_ids")
    assert before["rgb"].shape == (48, 64, 3)
    assert env.observe(0).agent == 0
    env.step({0: Step("Walk", (CUP,))})
    near = env.observe(0, "instance_ids")["instance_ids"]
    assert (near == 4).sum() > (before["instance_ids"] == 4).sum()
    env.step({0: Step("Grab", (CUP,))})
    held = env.observe(0, "rgb", "depth", "instance_ids")
    assert (held["instance_ids"] == 4).any()
    again = env.observe(0, "rgb")["rgb"]
    assert np.array_equal(held["rgb"], again)


def test_another_episode_whose_start_was_not_seen_is_begun_anew(env):
    env.camera_sensor = CameraSensor(HOME, default(), size=(32, 24), view="top")
    env.observe(0, "rgb")
    env.reset(Home.from_graph(HOME, "", default()), agents=2, seed=4)
    env.step({0: Step("Walk", (CUP,))})
    assert env.observe(1, "rgb")["rgb"].shape == (24, 32, 3)
    idle = env.world.agents[1].pose
    assert [actor.spot for actor in env.camera_sensor.actors][1] == idle.point


def test_a_new_beginning_is_seen(env):
    env.camera_sensor = CameraSensor(HOME, default(), size=(32, 24), view="third")
    start, first = env.world, env.observe(0, "rgb")["rgb"]
    env.step({0: Step("Walk", (CUP,))})
    assert not np.array_equal(env.observe(0, "rgb")["rgb"], first)
    env.restore(start)
    assert np.array_equal(env.observe(0, "rgb")["rgb"], first)
