"""Room among solid things: arms are drawn in, people stand where they can act, doors hang in their doorways."""

from dataclasses import replace

import numpy as np
import pytest

from hearth.kb.loading.load import default
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose, Hand, drawn_in
from hearth.rendering.people.clearance import _soft, arms_on_the_way, at_rest, faults, in_world
from hearth.rendering.people.motion_along_routes import Place
from hearth.rendering.people.random_people import person
from hearth.rendering.scene.room_shell import hung_doors
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.rendering.scene.solids import Solid, Solids, solids_of
from hearth.schemas.graph import Box, EnvironmentGraph, Node

ME = Node(1, "character", "Characters", (), (), None)
ACTOR = Actor(ME, person(3), (0.0, 0.0), 0.0, 0.0, BodyPose(), 0)
WALL = Solids([Solid(9, "wall", (0.27, 0.0), (0.08, 2.0), 0.0, 0.0, 2.5)])


def inside(actor, solids, side):
    joints = actor.figure().joints()
    points = in_world(actor, [joints[f"{name}_{side}"] for name in ("elbow", "wrist", "hand")])
    return bool(solids.contain(points).any())


def test_points_are_in_turned_boxes():
    turned = Solids([Solid(1, "sofa", (1.0, 0.0), (1.0, 0.2), 90.0, 0.0, 1.0)])
    points = np.array([(1.0, 0.5, 0.9), (1.9, 0.5, 0.0), (1.0, 1.5, 0.0), (1.25, 0.5, 0.0)])
    assert turned.contain(points).tolist() == [True, False, False, False]
    assert turned.contain(points, 0.1).tolist() == [True, False, False, True]
    assert turned.near((1.0, 0.0), 0.5, without=(1,)).all == ()
    assert Solids(()).contain(points).tolist() == [False] * 4


def test_an_arm_is_drawn_in_beside_a_wall():
    assert inside(ACTOR, WALL, "r") and not inside(ACTOR, WALL, "l")
    found = at_rest(ACTOR, WALL)
    assert found.body_pose.tucked == (1.0, 0.0)
    assert not inside(found, WALL, "r")
    assert at_rest(ACTOR, Solids(())) == ACTOR


def test_what_one_hand_carries_comes_nearer_and_what_both_carry_does_not():
    pose = BodyPose(right=(0.3, 1.0, 0.4), left=(-0.3, 1.0, 0.4), left_hand=Hand("two hands"))
    found = drawn_in(pose, (1.0, 1.0))
    assert found.right[0] < 0.2 and found.right[2] < 0.3 and found.left == pose.left


def test_arms_are_drawn_in_softly_on_the_way_past_a_post():
    post = Solids([Solid(9, "doorjamb", (0.27, 2.0), (0.05, 0.05), 0.0, 0.0, 2.0)])
    found = arms_on_the_way(ACTOR, [Place(0.0, 0.1 * k, 0.0) for k in range(41)], post)
    assert found[:, 1].max() == 0.0
    assert found[20, 0] == 1.0 and found[0, 0] == found[-1, 0] == 0.0
    assert np.abs(np.diff(found[:, 0])).max() < 0.3


def test_faults_count_joints_in_things_and_hands_out_of_reach():
    assert faults(ACTOR, Solids(())) == 0
    assert faults(replace(ACTOR, body_pose=BodyPose(right=(0.0, 1.0, 3.0))), Solids(())) == 2
    assert faults(ACTOR, Solids([Solid(9, "wall", (0.0, 0.0), (1.0, 1.0), 0.0, 0.0, 2.5)])) > 10
    # A hand may be in what it reaches for.
    low = replace(ACTOR, body_pose=BodyPose(right=(0.2, 0.95, 0.45)))
    box = Solids([Solid(9, "cabinet", (0.2, 0.55), (0.2, 0.2), 0.0, 0.5, 1.5)])
    assert faults(low, box, (9,)) < faults(low, box)


def door(number, x, states=()):
    return Node(number, "door", "Doors", (), states, None, Box((x, 1.0, 0.45), (0.045, 2.0, 0.9)))


def jamb(number, x):
    return Node(number, "doorjamb", "Doors", (), (), None, Box((x, 1.0, 0.0), (0.9, 2.0, 0.12)))


def test_only_the_nearest_door_hangs_in_a_doorway():
    nodes = [jamb(1, 0.0), door(2, 0.4), door(3, 0.9), door(4, 9.0), jamb(5, 5.0)]
    assert hung_doors(nodes) == {2}


def test_doorways_have_two_posts_and_soft_things_give_way():
    room = Node(1, "hall", "Rooms", (), (), None, Box((0, 1.3, 0), (5, 2.6, 4)))
    curtain = Node(3, "curtain", "Decor", (), (), None, Box((1.0, 1.0, 1.0), (1.0, 2.0, 0.1)))
    graph = EnvironmentGraph((room, jamb(2, 0.0), curtain), ())
    found = [solid for solid in solids_of(prepared_scene(graph, default()), graph.nodes).all if solid.node != 1]
    assert [solid.class_name for solid in found] == ["doorjamb", "doorjamb"]
    assert sorted(round(solid.middle[0], 2) for solid in found) == [-0.42, 0.42]


@pytest.mark.parametrize("posture", ["lying", "sitting"])
def test_arms_of_who_rests_stay_as_they_are(posture):
    actor = replace(ACTOR, body_pose=BodyPose(posture, 0.45))
    assert at_rest(actor, WALL).body_pose.tucked == (0.0, 0.0)


def test_arms_stay_drawn_in_between_two_things_that_follow_each_other():
    inside = np.zeros((60, 2), bool)
    inside[[10, 20], 0] = inside[[5, 50], 1] = True
    found = _soft(inside)
    assert found[10:21, 0].min() == 1.0 and found[30:, 0].max() == 0.0
    # Things that are far apart let the arm swing between them.
    assert found[5, 1] == found[50, 1] == 1.0 and found[25:30, 1].max() == 0.0
