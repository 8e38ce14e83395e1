"""The values of cameras: more where one sees the hands at work, less where something near fills the picture."""

from dataclasses import replace
from math import cos, radians, sin

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import look_at
from hearth.rendering.cameras.viewpoints import best_view
from hearth.rendering.cameras.visibility_estimates import AT_WORK, Obstacles, ahead, person, values
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.own_body_targets import at_body
from hearth.rendering.people.palm_targets import with_aims
from hearth.rendering.people.random_people import person as body_of
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import scene_of
from hearth.schemas.graph import Box, EnvironmentGraph, Node

ROOM = Node(9, "bathroom", "Rooms", (), (), None, Box((0, 1.3, 0), (6, 2.6, 6)))
ME = Node(1, "character", "Characters", (), (), None)


def worth(turn, aims):
    """The worth of a camera that stands `turn` degrees beside the direction in which somebody looks."""
    actor = Actor(ME, body_of(3), (0.0, 0.0), 0.0, 0.0, with_aims(BodyPose(), aims), 9)
    empty = scene_of(EnvironmentGraph((ROOM,), ()), default())
    drawn = Thing(1, "character", actor.figure(), actor.position, actor.yaw)
    scene = replace(empty, things=(drawn,))
    at = (2.2 * sin(radians(turn)), 1.5, 2.2 * cos(radians(turn)))
    camera = look_at("near", at, (0.0, 1.0, 0.0), 160, 120, fov=60.0)
    return float(values([camera], person(actor), [], Obstacles.exact(scene)).total[0])


@pytest.mark.parametrize(("place", "share"), [("hands_both", 0.5), ("clothes_shirt", 1.0)])
def test_a_camera_before_somebody_sees_the_hands_at_work(place, share):
    """Of hands that are washed one covers the other."""
    actor = Actor(ME, body_of(3), (0.0, 0.0), 0.0, 0.0, BodyPose(), 9)
    aims = at_body(actor, place, "right", {})
    assert worth(0, aims) - worth(0, {}) == pytest.approx(AT_WORK * share, abs=0.02)
    assert worth(180, aims) - worth(180, {}) == pytest.approx(0.0, abs=0.02)


AHEAD = look_at("ahead", (0.0, 1.0, 0.0), (0.0, 1.0, 3.0), 160, 120, fov=60.0)


def leaf(at, size=(0.5, 3.0, 0.04), yaw=0.0):
    """A door's leaf."""
    x, y, z = at
    return Thing(5, "door", Model("ceiling", Look(size)), (x, y - size[1] / 2, z), yaw)


def loss(*things):
    return float(ahead([AHEAD], Obstacles.exact(Scene(things))).loss[0])


def test_what_is_near_and_fills_the_picture_counts_against_a_camera_the_more_the_nearer_and_the_larger_it_is():
    wall = leaf((0.0, 1.0, 3.0), (9.0, 9.0, 0.1))
    assert loss(wall) == 0.0
    assert loss(wall, leaf((0.5, 1.0, 1.7))) == 0.0, "it is not near"
    aside = [loss(wall, leaf((0.55 * far, 1.0, far), (0.4 * far, 3.0, 0.02))) for far in (1.4, 1.1, 0.85)]
    assert 0.02 < aside[0] < aside[1] < aside[2]
    assert loss(wall, leaf((0.6, 1.0, 1.1), (0.2, 3.0, 0.02))) < aside[1]


def test_what_a_camera_looks_at_from_close_by_is_not_in_its_way():
    close = replace(AHEAD, target=(0.0, 1.0, 1.1))
    assert ahead([close], Obstacles.exact(Scene((leaf((0.0, 1.0, 1.1), (3.0, 3.0, 0.1)),)))).loss[0] == 0.0


def test_a_door_that_hides_nobody_but_fills_a_side_of_the_best_picture_makes_another_the_best():
    actor = Actor(ME, body_of(3), (0.0, 0.0), 0.0, 0.0, BodyPose(), 9)
    empty = scene_of(EnvironmentGraph((ROOM,), ()), default())
    table = Thing(7, "table", Model("ceiling", Look((1.2, 0.9, 0.5))), (0.0, 0.0, 2.0))
    scene = replace(empty, things=(Thing(1, "character", actor.figure(), actor.position, actor.yaw), table))
    best = best_view(scene, {}, actor, (7,), ROOM.box)
    right, forward, eye = best.pose[:3, 0], best.pose[:3, 2], best.pose[:3, 3]
    depth = 0.9
    half = depth * best.width / 2 / best.intrinsics[0, 0]
    at = eye + forward * depth + right * half * 0.85
    turned = np.degrees(np.arctan2(forward[0], forward[2]))
    door = leaf((at[0], at[1], at[2]), (0.6 * half, 3.0, 0.02), float(turned))
    crowded = replace(scene, things=(*scene.things, door))
    assert ahead([best], Obstacles.exact(crowded)).free.all(), "nothing is so close that the camera is left out"
    other = best_view(crowded, {}, actor, (7,), ROOM.box)
    taken = ahead([best, other], Obstacles.exact(crowded)).loss
    assert taken[1] < taken[0] / 3
