"""Headwear is drawn on the head, and turns and nods with it."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.headwear import WORN
from hearth.rendering.people.held_objects import held_things
from hearth.rendering.people.random_people import person
from hearth.rendering.scene.instances import placed
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene_preparation import PreparedScene
from hearth.schemas.graph import Edge, EnvironmentGraph, Node

ME = Node(1, "character", "Characters", (), (), None)
GAZES = [(0.0, 1.5, 1.0), (0.8, 1.5, 0.6), (-0.7, 1.1, 0.9), (0.2, 2.2, 0.8)]


def worn(class_name, gaze, turn=0.0):
    """The joints of somebody, and the middle of what is worn, in the body's frame."""
    thing = Node(2, class_name, "Clothes", (), (), None)
    graph = EnvironmentGraph((ME, thing), (Edge(2, "ON", 1),))
    actor = Actor(ME, person(4), (1.0, 2.0), 0.0, turn, BodyPose(gaze=gaze), 0)
    drawn = held_things(PreparedScene(graph, default()), Places(graph, {}, {}, default()), (actor,)).get(2, ())
    corners = [placed(each).corners.reshape(-1, 3) for each in drawn]
    middle = np.concatenate(corners).mean(axis=0) if corners else None
    return actor.figure().joints(), None if middle is None else np.array(actor.local(tuple(map(float, middle))))


@pytest.mark.parametrize("gaze", GAZES)
@pytest.mark.parametrize("turn", [0.0, 130.0])
def test_spectacles_are_before_the_eyes_wherever_one_looks(gaze, turn):
    joints, middle = worn("spectacles", gaze, turn)
    way = (joints["face"] - joints["head"]) / np.linalg.norm(joints["face"] - joints["head"])
    ahead = (middle - joints["head"]) @ way
    assert 0.05 < ahead < 0.12
    assert np.linalg.norm(middle - joints["head"] - ahead * way) < 0.06


@pytest.mark.parametrize("gaze", GAZES)
def test_a_hat_is_on_the_head_and_a_headset_about_it(gaze):
    joints, hat = worn("clothes_hat", gaze)
    assert 0.03 < hat[1] - joints["head"][1] < 0.2
    _, headset = worn("headset", gaze)
    assert np.linalg.norm(headset - joints["head"]) < 0.08


def test_a_shirt_is_not_a_thing():
    assert worn("clothes_shirt", GAZES[0])[1] is None


def test_worn_things_are_classes():
    assert {*WORN} <= {*default().objects}
    assert all(default().has(name, "CLOTHES") for name in WORN)
