"""Hands that carry things: nobody stoops for what hangs from a hand."""

import pytest

from hearth.kb.loading.load import default
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.palm_targets import carrying, with_aims
from hearth.rendering.people.random_people import person
from hearth.rendering.people.skeleton import effort_of
from hearth.rendering.scene.object_boxes import Places
from hearth.schemas.graph import EnvironmentGraph, Node

ME = Node(1, "character", "Characters", (), (), None)
PEOPLE = range(24)


@pytest.mark.parametrize("name", ["bag", "purse", "suitcase", "broom", "vacuum_cleaner", "cup", "book"])
@pytest.mark.parametrize("pose", [BodyPose(), BodyPose("sitting", 0.45)], ids=["standing", "sitting"])
def test_nobody_stoops_for_what_a_hand_carries(name, pose):
    thing = Node(2, name, "Props", ("GRABBABLE",), (), None)
    graph = EnvironmentGraph((ME, thing), ())
    places = Places(graph, {}, {}, default())
    for number in PEOPLE:
        actor = Actor(ME, person(number), (0.0, 0.0), 0.0, 0.0, pose, 0)
        for side in ("right", "left"):
            aims = carrying(actor, {side: 2}, graph, places)
            assert effort_of(with_aims(pose, aims), actor.body.proportions) < 0.02, (number, side)


def test_who_carries_a_bag_has_the_hand_beside_the_hips():
    graph = EnvironmentGraph((ME, Node(2, "bag", "Props", ("GRABBABLE",), (), None)), ())
    actor = Actor(ME, person(3), (0.0, 0.0), 0.0, 0.0, BodyPose(), 0)
    x, y, z = carrying(actor, {"right": 2}, graph, Places(graph, {}, {}, default()))["right"].palm
    body = actor.body.proportions
    assert x > 0.1 and abs(z) < 0.2 and abs(y - body.pelvis) < 0.15 * body.height
