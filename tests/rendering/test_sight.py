"""What cameras are worth: more where one sees the hands at work."""

from dataclasses import replace
from math import cos, radians, sin

import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import look_at
from hearth.rendering.cameras.sight import AT_WORK, Obstacles, person, values
from hearth.rendering.people.acting import Actor
from hearth.rendering.people.aims import with_aims
from hearth.rendering.people.body_places import at_body
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.variety import person as body_of
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.prepared import scene_of
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
