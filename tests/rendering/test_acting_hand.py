"""The hand that acts is the nearer one, unless a program asks for one, or a hand is full."""

import pytest

from hearth.kb.loading.load import default
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.gestures import gesture_of
from hearth.rendering.people.hand_gestures import gesturing
from hearth.rendering.people.random_people import person
from hearth.rendering.scene.free_poses import Pose
from hearth.rendering.scene.object_boxes import Places
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Step

ME = Node(1, "character", "Characters", (), (), None)
CUP = Node(3, "cup", "Props", ("GRABBABLE",), (), None)
ACTOR = Actor(ME, person(3), (0.0, 0.0), 0.0, 0.0, BodyPose(), 0)


@pytest.mark.parametrize(
    ("x", "held", "acting"),
    [
        (-0.4, {}, "left"),
        (0.4, {}, "right"),
        (0.0, {}, "right"),
        (-0.4, {"left": 3}, "right"),
        (0.4, {"right": 3}, "left"),
    ],
)
@pytest.mark.parametrize("action", ["SwitchOn", "Touch", "Open"])
def test_the_nearer_free_hand_acts(action, x, held, acting):
    box = Box((x, 1.1, 0.45), (0.1, 0.1, 0.1))
    thing = Node(2, "light", "Lamps", ("HAS_SWITCH", "CAN_OPEN"), ("OFF",), None, box, 180.0)
    graph = EnvironmentGraph((ME, thing, CUP), ())
    places = Places(graph, {}, {2: Pose(box, 180.0)}, default())
    step = Step(action, (ObjectRef("light", 1, 2),))
    assert [*gesturing(gesture_of(step), ACTOR, held, graph, places, step)] == [acting]
