"""Bodies: bones keep their lengths, feet stay on the floor, hands arrive, people differ, skin follows bones."""

import subprocess
import sys

import numpy as np
import pytest

from hearth.rendering.people.body_pose import BodyPose, Foot, Hand
from hearth.rendering.people.body_shape import Shape, body_data, proportions, target_weights
from hearth.rendering.people.clothed_body import dressed, parts_worn, tucked_in
from hearth.rendering.people.figure import Figure, figure_mesh
from hearth.rendering.people.grips import GRIPS
from hearth.rendering.people.person_appearance import BODIES
from hearth.rendering.people.proportions import standard
from hearth.rendering.people.random_people import person
from hearth.rendering.people.skeleton import joints, two_bones

pytest.importorskip("numba")

BODY_POSES = {
    "standing": BodyPose(),
    "walking": BodyPose(stride=0.8),
    "reaching": BodyPose(right=(0.2, 1.0, 0.5)),
    "low": BodyPose(left=(-0.2, 0.25, 0.45)),
    "sitting": BodyPose("sitting", 0.46),
    "typing": BodyPose("sitting", 0.46, right=(0.1, 0.76, 0.4), left=(-0.1, 0.76, 0.4), gaze=(0, 0.9, 0.8)),
    "lying": BodyPose("lying", 0.5, asleep=True),
}
PEOPLE = {"simple": BODIES["ben"], **{f"person {number}": person(number) for number in (1, 5, 9)}}


@pytest.mark.parametrize("who", PEOPLE)
def test_hands_of_who_sits_down_on_the_floor_do_not_follow_the_feet(who):
    own = PEOPLE[who].proportions
    trail = []
    for share in np.linspace(0, 1, 31):
        left = -0.2 if share < 0.6 else -0.2 + 1.3 * (share - 0.6)
        feet = (Foot(0.13, 0.5 - 0.15 * share), Foot(-0.13, left))
        pose = BodyPose("sitting", 0.5 * (1 - share), feet=feet, effort=0.4 * share)
        trail.append([joints(pose, own)[f"hand_{side}"] for side in "rl"])
    assert np.linalg.norm(np.diff(trail, axis=0), axis=2).max() < 0.08
    assert (np.array(trail)[-1, :, 2] > 0.15).all(), "before the knees"


@pytest.mark.parametrize("name", BODY_POSES)
@pytest.mark.parametrize("who", PEOPLE)
def test_bones_keep_their_lengths(who, name):
    own = PEOPLE[who].proportions
    found = joints(BODY_POSES[name], own)
    for side in "rl":
        for a, b, length in (("hip", "knee", own.thigh), ("knee", "ankle", own.shin),
                             ("shoulder", "elbow", own.upper_arm), ("elbow", "wrist", own.forearm)):  # fmt: skip
            bone = found[f"{a}_{side}"] - found[f"{b}_{side}"]
            assert np.linalg.norm(bone) == pytest.approx(length, rel=0.01)


@pytest.mark.parametrize("name", BODY_POSES)
@pytest.mark.parametrize("who", PEOPLE)
def test_nobody_sinks_into_the_floor(who, name):
    body = PEOPLE[who]
    low, high = figure_mesh(Figure(body, BODY_POSES[name])).bounds()
    assert low[1] > -0.02
    if name == "standing":
        assert high[1] == pytest.approx(body.height, abs=0.06)
    if name == "lying":
        assert low[1] > 0.4
        assert high[1] < 1.05


@pytest.mark.parametrize(("name", "side"), [("reaching", "r"), ("low", "l"), ("typing", "r"), ("typing", "l")])
@pytest.mark.parametrize("who", ["simple", "person 5", "person 9"])
def test_palms_arrive(who, name, side):
    body_pose = BODY_POSES[name]
    found = joints(body_pose, PEOPLE[who].proportions)
    assert np.linalg.norm(found[f"palm_{side}"] - np.array(body_pose.target(side))) < 0.06


def test_palms_look_where_they_are_turned():
    body = person(5)
    for way in ((-1.0, 0.0, 0.0), (0.0, -1.0, 0.2), (-0.5, 0.85, 0.0)):
        found = joints(BodyPose(right=(0.2, 1.1, 0.4), right_hand=Hand("body", way)), body.proportions)
        palm = found["palm_r"] - found["hand_r"]
        assert palm @ np.array(way) / np.linalg.norm(palm) / np.linalg.norm(way) > 0.99


def test_the_head_turns_to_what_is_looked_at():
    left = joints(BodyPose(gaze=(-3, 1.5, 1)), standard(1.7))
    assert (left["face"] - left["head"])[0] < -0.05


def test_two_bones_stretch_towards_what_is_out_of_reach():
    middle, end = two_bones(np.zeros(3), np.array((0, 0, 9.0)), 1.0, 1.0, np.array((0, 1.0, 0)))
    assert np.allclose(end, (0, 0, 2), atol=0.01)
    assert middle[1] > 0


def test_simple_bodies_differ():
    assert len(BODIES) >= 2
    meshes = [figure_mesh(Figure(body)) for body in BODIES.values()]
    assert len({mesh.surface.tobytes() for mesh in meshes}) == len(meshes)


def test_people_of_different_seeds_differ():
    people = [person(seed) for seed in range(60)]
    assert len(set(people)) == 60
    assert {body.shape.sex > 0.5 for body in people} == {True, False}
    ages = [body.shape.age for body in people]
    assert min(ages) < 22 and max(ages) > 60
    heights = [body.height for body in people]
    assert max(heights) - min(heights) > 0.3 and min(heights) > 1.2 and max(heights) < 2.0
    assert len({body.garment for body in people}) == 3 and len({body.legwear for body in people}) == 4
    assert len({body.skin for body in people}) > 8 and len({body.style for body in people}) > 5


def test_the_weights_of_targets_add_up():
    for seed in range(20):
        shape = person(seed).shape
        weights = target_weights(shape)
        people = [name for name in weights if name.startswith(("african", "asian", "caucasian"))]
        builds = [name for name in weights if name.startswith(("female", "male")) and name.count("-") == 3]
        for names in (people, builds):
            assert sum(weights[name] for name in names) == pytest.approx(1.0)


def test_skin_follows_bones():
    """The palm of the mesh is where the skeleton says; closed fingers are nearer to it than open ones."""
    body = person(5)
    target = np.array((0.2, 1.1, 0.42))
    reach = {}
    for grip in GRIPS:
        pose = BodyPose(right=tuple(target), right_hand=Hand(grip, (-1.0, 0.0, 0.0)))
        corners = figure_mesh(Figure(body, pose)).corners.reshape(-1, 3)
        far = np.linalg.norm(corners - target, axis=1)
        assert far.min() < 0.03, grip
        reach[grip] = corners[far < 0.25][:, 2].max()
    assert reach["handle"] < reach["flat"] - 0.04


def test_a_raised_heel_leaves_the_toes_where_they_are():
    own = person(1).proportions
    flat, raised = (joints(BodyPose(feet=(Foot(0.1, 0, 0, 0, pitch), Foot(-0.1, 0))), own) for pitch in (0.0, 30.0))
    assert np.allclose(flat["toe_r"], raised["toe_r"], atol=0.02)
    assert raised["ankle_r"][1] > flat["ankle_r"][1] + 0.03


def test_the_bodies_have_the_sizes_of_people():
    woman, man = proportions(Shape(), 1.65), proportions(Shape(sex=1.0), 1.78)
    for own in (woman, man):
        assert own.thigh + own.shin + own.ankle == pytest.approx(0.52 * own.height, abs=0.04)
        assert own.arm == pytest.approx(0.34 * own.height, abs=0.04)
    assert man.shoulder[0] / man.height > woman.shoulder[0] / woman.height


def test_the_file_of_bodies_is_whole():
    data = body_data()
    assert data.moves.shape == (len(data.targets), len(data.base), 3)
    assert len(data.base) == len(data.offsets) + 2 * len(data.bones) + 1
    assert data.triangles.max() < len(data.offsets) and data.weights.sum(axis=1) == pytest.approx(1.0)
    assert all(parent < number for number, parent in enumerate(data.parents))


DIGEST = """
import hashlib
from hearth.rendering.people.figure import Figure, figure_mesh
from hearth.rendering.people.random_people import person
meshes = [figure_mesh(Figure(person(seed))) for seed in range(4)]
print(hashlib.sha256(b"".join(mesh.corners.tobytes() + mesh.surface.tobytes() for mesh in meshes)).hexdigest())
"""


@pytest.mark.slow
def test_people_are_the_same_in_every_process():
    runs = [subprocess.run([sys.executable, "-c", DIGEST], capture_output=True, text=True, check=True) for _ in "ab"]
    assert len({run.stdout for run in runs}) == 1


def test_trousers_end_under_the_shirt():
    around = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    ring = np.stack([0.15 * np.sin(around), np.zeros(48), 0.12 * np.cos(around)], axis=1)
    shirt = np.concatenate([ring * 1.1 + (0.0, y, 0.0) for y in (0.85, 0.95, 1.3)] + [np.array([[0.7, 0.4, 0.0]])])
    legs = np.concatenate([np.add(ring, (0.0, y, 0.0)) for y in (0.1, 0.86, 0.95, 1.0)])
    assert tucked_in(shirt, legs).reshape(4, 48).all(axis=1).tolist() == [False, False, True, True]
    assert not tucked_in(shirt, legs).reshape(4, 48)[:2].any()


def test_what_is_under_a_shirt_is_not_drawn():
    for number in range(8):
        body = person(number)
        span = body_data().parts[body.legwear]
        whole = sum(b - a for _, _, a, b in (body_data().parts[name] for name in parts_worn(body)))
        left = whole - len(dressed(body).triangles)
        assert 0 < left < 0.5 * (span[3] - span[2])
