"""A camera that stays: drawing only what changed gives what drawing everything gives."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import look_at, top_view
from hearth.rendering.modalities import render
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.figure import Figure
from hearth.rendering.people.person_appearance import BODIES
from hearth.rendering.rays.incremental_pictures import incremental_frame, pictures_of
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene_preparation import scene_of
from hearth.rendering.scene.triangles import StaticThings
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node

ROOM = Node(1, "kitchen", "Rooms", box=Box((0, 1.3, 0), (4.0, 2.6, 4.0)))
LAMP = Node(4, "floor_lamp", "Lamps", states=("ON",), box=Box((1.2, 0.8, -1.2), (0.4, 1.6, 0.4)), yaw=0.0)
TABLE = Node(5, "table", "Furniture", box=Box((0, 0.37, -0.6), (1.2, 0.74, 0.7)), yaw=0.0)
WINDOW = Node(6, "window", "Windows", box=Box((0, 1.5, 2.0), (1.2, 1.2, 0.1)), yaw=180.0)
NODES = (ROOM, LAMP, TABLE, WINDOW)
CAMERAS = {
    "inside": look_at("inside", (1.7, 1.9, 1.7), (-0.5, 0.5, -0.8), 96, 72, 70.0),
    "above": top_view(ROOM.box, width=96, height=72),
}


STILL = {}


@pytest.fixture(scope="module")
def static():
    graph = EnvironmentGraph(NODES, tuple(Edge(node.id, "INSIDE", 1) for node in NODES[1:]))
    return scene_of(graph, default(), hour=11.0)


def keyframe(static, *moving, lights=None):
    lights = static.lights if lights is None else lights
    return replace(
        static, things=moving, static=STILL.setdefault(id(static), StaticThings(static.things)), lights=lights
    )


def person(x, z, **body_pose):
    return Thing(2, "character", Figure(BODIES["ana"], BodyPose(**body_pose)), (x, 0.0, z), 30.0)


def ball(x, y=0.74):
    return Thing(3, "ball", Model("toy", Look((0.2, 0.2, 0.2), kind="ball")), (x, y, -0.6))


def film(static):
    yield keyframe(static, person(-1, 0.3), ball(0))
    yield keyframe(static, person(-0.8, 0.2, stride=0.7), ball(0))
    yield keyframe(static, person(-0.8, 0.2), ball(0.3))
    yield keyframe(static, person(-0.8, 0.2), ball(0.3), lights=tuple(x for x in static.lights if x.facing))
    yield keyframe(static, person(-0.8, 0.2, right=(0.2, 1.0, 0.4)))
    yield keyframe(static, person(0.2, 0.9), ball(-0.2, 0.9))


def difference(one, other):
    return np.abs(one["rgb"].astype(int) - other["rgb"].astype(int)).max(axis=2)


@pytest.mark.parametrize("name", CAMERAS)
def test_only_what_changed_is_drawn_and_nothing_else_differs(static, name):
    last = None
    for number, scene in enumerate(film(static)):
        last = incremental_frame(scene, CAMERAS[name], last)
        seen = pictures_of(last, ("rgb", "instance_ids"))
        whole = render(scene, CAMERAS[name], ("rgb", "instance_ids"))
        assert (seen["instance_ids"] == whole["instance_ids"]).all(), number
        assert difference(seen, whole).max() <= 1, number
        # All triangles in one part: where two walls meet, the other may win.
        alone = replace(scene, things=scene.everything, static=StaticThings())
        whole = render(alone, CAMERAS[name], ("rgb", "instance_ids"))
        assert (seen["instance_ids"] == whole["instance_ids"]).all(), number
        assert (difference(seen, whole) > 1).sum() <= 5, number
        if number and scene.lights == static.lights:
            assert 0 < last.drawn < 96 * 72 / 2, number


def test_the_same_scene_again_draws_nothing(static):
    first = incremental_frame(keyframe(static, ball(0)), CAMERAS["inside"])
    assert incremental_frame(keyframe(static, ball(0)), CAMERAS["inside"], first).drawn == 0


def test_another_camera_or_hour_draws_all(static):
    scene = keyframe(static, ball(0))
    first = incremental_frame(scene, CAMERAS["inside"])
    assert incremental_frame(scene, CAMERAS["above"], first).drawn == 96 * 72
    later = replace(scene, day=replace(scene.day, ambient=0.1))
    assert incremental_frame(later, CAMERAS["inside"], first).drawn == 96 * 72
