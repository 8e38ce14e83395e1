"""Motions are slow enough for heads, hands and held things all along the way."""

from itertools import pairwise

import numpy as np
import pytest

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose, Hand, Held
from hearth.rendering.people.gait import SWUNG, turning, walking
from hearth.rendering.people.held_objects import Hold
from hearth.rendering.people.motion_along_routes import Place
from hearth.rendering.people.motion_timing import FASTEST, THINGS, paced
from hearth.rendering.people.pose_blends import Segment, blended
from hearth.rendering.people.random_people import person
from hearth.schemas.graph import Node

BROOM = Hold("handle", (0.0, 1.2, 0.0), 0.0, (-1.0, 0.0, 0.1), (0.1, 0.6, 0.2), True)
"""Held 1.2 m above its foot."""


def actor(right, **held):
    node = Node(1, "character", "Characters", (), (), None)
    pose = BodyPose(right=right, right_hand=Hand("handle", held=Held(**held)))
    return Actor(node, person(3), (0.0, 0.0), 0.0, 0.0, pose, 0)


def test_a_slow_motion_stays_as_it_is():
    segment = blended(actor((0.1, 1.0, 0.4)), actor((0.15, 1.0, 0.4)), 1.0)
    assert paced(segment, {}) == segment


def test_a_long_thing_that_turns_takes_longer():
    one, other = actor((0.1, 1.0, 0.4)), actor((0.1, 1.0, 0.4), pitch=80.0)
    segment = blended(one, other, 0.3)
    slow = paced(segment, {"r": BROOM})
    foot = 1.2 * np.radians(80.0)
    assert paced(segment, {}) == segment
    assert slow.seconds == pytest.approx(foot * np.pi / 2 / THINGS, rel=0.05), (
        "an eased motion is fastest in its middle"
    )


def test_who_moves_on_a_detour_takes_as_long_as_the_detour():
    still = actor((0.1, 1.0, 0.4))
    there_and_back = Segment(0.3, lambda share: actor((0.1 + 0.5 * np.sin(np.pi * share) ** 2, 1.0, 0.4)))
    slow = paced(there_and_back, {})
    assert slow.at(1.0).body_pose.right == pytest.approx(still.body_pose.right)
    hands = [slow.at(k / 200).figure().joints()["hand_r"] for k in range(201)]
    speeds = [np.linalg.norm(b - a) * 200 / slow.seconds for a, b in pairwise(hands)]
    assert slow.seconds > 0.3
    assert max(speeds) < FASTEST * 1.05


@pytest.mark.parametrize("reach", [0.3, 0.6, 0.9])
def test_who_carries_something_wide_turns_slowly(reach):
    found = turning(Place(0.0, 0.0, 0.0), 150.0, reach)
    fastest = max(
        abs(found.at(b).yaw - found.at(a).yaw) / (b - a) for a, b in pairwise(np.linspace(0, found.seconds, 300))
    )
    assert np.radians(fastest) * reach < SWUNG * 1.01
    assert found.seconds >= turning(Place(0.0, 0.0, 0.0), 150.0).seconds


def test_who_turns_on_a_single_step_does_not_whirl():
    found = walking(Place(0.0, 0.0, 0.0), [(0.0, 0.0), (0.1, 0.0)], 1.1, -38.0)
    times = np.arange(0.0, found.seconds + 0.2, 0.1)
    yaws = [found.at(time).yaw for time in times]
    assert max(abs(a - 2 * b + c) for a, b, c in zip(yaws, yaws[1:], yaws[2:], strict=False)) < 14
    assert yaws[-1] == pytest.approx(-38.0)
