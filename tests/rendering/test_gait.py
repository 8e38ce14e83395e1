"""Speeds of turns on the way, and lengths of the steps of people that run."""

from __future__ import annotations

from itertools import pairwise
from math import hypot

import pytest

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.gait import CORNERING, LONGEST, Gait, Movement, movements, slowed, walking
from hearth.rendering.people.motion_along_routes import Place
from hearth.rendering.people.motion_tracks import RUNNING, WALKING
from hearth.rendering.people.random_people import person
from hearth.schemas.graph import Node

BACK_AGAIN = [(0.0, 0.0), (0.0, 2.0), (0.3, 2.0), (0.3, 0.0)]
STRAIGHT = [(0.0, 0.0), (0.0, 4.0)]


def fastest(move):
    """Degrees a second."""
    times = [move.seconds * k / 1000 for k in range(1001)]
    yaws = [move.at(time).yaw for time in times]
    return max(abs(other - one) for one, other in pairwise(yaws)) / (move.seconds / 1000)


def test_sharp_corners_are_walked_slowly():
    move = walking(Place(0.0, 0.0, 0.0), BACK_AGAIN, WALKING, 180.0)
    assert CORNERING * 0.9 < fastest(move) < CORNERING * 1.25
    end = move.at(move.seconds)
    assert (end.x, end.z) == pytest.approx((0.3, 0.0), abs=1e-6)


def test_who_turns_slowly_is_not_slowed():
    move = walking(Place(0.0, 0.0, 0.0), STRAIGHT, WALKING, 0.0)
    assert slowed(move) is move
    quick = Movement(0.5, lambda time: Place(0.0, time, 400 * time))
    assert slowed(quick).seconds == pytest.approx(200 / CORNERING)
    assert slowed(quick).at(100 / CORNERING) == pytest.approx(quick.at(0.25))


@pytest.mark.parametrize("speed", [WALKING, RUNNING])
def test_no_step_is_longer_than_legs_reach(speed):
    actor = Actor(Node(1, "character", "Characters", (), (), None), person(3), (0.0, 0.0), 0.0, 0.0, BodyPose(), 0)
    gait = Gait(actor, movements(Place(0.0, 0.0, 0.0), STRAIGHT, speed, 0.0), speed=speed)
    for prints in gait.prints:
        places = [each.place for each in prints]
        steps = [hypot(b.x - a.x, b.z - a.z) for a, b in pairwise(places)]
        assert max(steps) < 2 * LONGEST * 1.05


@pytest.mark.parametrize("speed", [WALKING, RUNNING])
def test_hips_neither_drop_nor_rise_at_once(speed):
    actor = Actor(Node(1, "character", "Characters", (), (), None), person(3), (0.0, 0.0), 0.0, 0.0, BodyPose(), 0)
    gait = Gait(actor, movements(Place(0.0, 0.0, 0.0), STRAIGHT, speed, 0.0), speed=speed)
    count = int(gait.seconds * 10)
    heights = [float(gait.at(k / 10).figure().joints()["pelvis"][1]) for k in range(count + 1)]
    assert max(abs(a - 2 * b + c) for a, b, c in zip(heights, heights[1:], heights[2:], strict=False)) < 0.06
    standing = actor.body.proportions.pelvis
    assert heights[0] == pytest.approx(standing, abs=1e-3) and min(heights) > standing - 0.16
