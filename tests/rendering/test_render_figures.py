"""Bodies: bones keep their lengths, feet stay on the floor, hands arrive."""

import numpy as np
import pytest

from hearth.rendering.people.figure import BODIES, Figure, figure_mesh
from hearth.rendering.people.skeleton import FOREARM, SHIN, THIGH, UPPER_ARM, BodyPose, joints, two_bones

HEIGHT = 1.7
BODY_POSES = {
    "standing": BodyPose(),
    "walking": BodyPose(stride=0.8),
    "reaching": BodyPose(right=(0.2, 1.0, 0.5)),
    "low": BodyPose(left=(-0.2, 0.25, 0.45)),
    "sitting": BodyPose("sitting", 0.46),
    "typing": BodyPose("sitting", 0.46, right=(0.1, 0.76, 0.4), left=(-0.1, 0.76, 0.4), gaze=(0, 0.9, 0.8)),
    "lying": BodyPose("lying", 0.5, asleep=True),
}


@pytest.mark.parametrize("name", BODY_POSES)
def test_bones_keep_their_lengths(name):
    found = joints(BODY_POSES[name], HEIGHT)
    for side in "rl":
        for a, b, length in (("hip", "knee", THIGH), ("knee", "ankle", SHIN), ("shoulder", "elbow", UPPER_ARM),
                             ("elbow", "wrist", FOREARM)):  # fmt: skip
            bone = found[f"{a}_{side}"] - found[f"{b}_{side}"]
            assert np.linalg.norm(bone) == pytest.approx(length * HEIGHT, rel=0.01)


@pytest.mark.parametrize("name", BODY_POSES)
def test_nobody_sinks_into_the_floor(name):
    low, high = figure_mesh(Figure(BODIES["ben"], BODY_POSES[name])).bounds()
    assert low[1] > -0.02
    if name == "standing":
        assert high[1] == pytest.approx(BODIES["ben"].height, abs=0.06)
    if name == "lying":
        assert low[1] > 0.4
        assert high[1] < 1.0


@pytest.mark.parametrize(("name", "side"), [("reaching", "r"), ("low", "l"), ("typing", "r"), ("typing", "l")])
def test_hands_arrive(name, side):
    body_pose = BODY_POSES[name]
    goal = body_pose.right if side == "r" else body_pose.left
    assert np.linalg.norm(joints(body_pose, HEIGHT)[f"hand_{side}"] - np.array(goal)) < 0.06


def test_the_head_turns_to_what_is_looked_at():
    left = joints(BodyPose(gaze=(-3, 1.5, 1)), HEIGHT)
    assert (left["face"] - left["head"])[0] < -0.05


def test_two_bones_stretch_towards_what_is_out_of_reach():
    middle, end = two_bones(np.zeros(3), np.array((0, 0, 9.0)), 1.0, 1.0, np.array((0, 1.0, 0)))
    assert np.allclose(end, (0, 0, 2), atol=0.01)
    assert middle[1] > 0


def test_bodies_differ():
    assert len(BODIES) >= 2
    meshes = [figure_mesh(Figure(body)) for body in BODIES.values()]
    assert len({mesh.surface.tobytes() for mesh in meshes}) == len(meshes)
