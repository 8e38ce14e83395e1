"""Flow, boxes and joints, in scenes where one can work them out."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.rendering.annotations import camera_of, described, poses, seen, skeletons
from hearth.rendering.cameras.camera import look_at
from hearth.rendering.film import png
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.figure import Figure
from hearth.rendering.people.person_appearance import BODIES
from hearth.rendering.rays.camera_shot import shoot
from hearth.rendering.rays.optical_flow import flow, flow_of
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene

W, H = 80, 60
CAMERA = look_at("test", (0, 0, 0), (0, 0, 1), W, H)
FOCAL = CAMERA.intrinsics[0, 0]


def slab(number, center, size):
    x, y, z = center
    return Thing(number, f"class_{number}", Model("ceiling", Look(size)), (x, y - size[1] / 2, z))


BACK = slab(1, (0, 0, 6.5), (40, 40, 1))


def test_flow_of_a_moved_box_is_what_projection_says():
    before, after = slab(2, (0, 0, 4.5), (1, 1, 1)), slab(2, (0.5, -0.25, 4.5), (1, 1, 1))
    found = flow_of(Scene((BACK, after)), shoot(Scene((BACK, before)), CAMERA))
    middle = found[H // 2, W // 2]
    assert middle == pytest.approx((0.5 * FOCAL / 4.0, 0.25 * FOCAL / 4.0), abs=0.01)
    assert found[2, 2] == pytest.approx((0, 0), abs=1e-4)
    # What the box will hide is not seen afterwards; what it uncovers has a flow of its own.
    right = W // 2 + int(0.75 * FOCAL / 4)
    assert np.isnan(found[H // 2 + 2, right]).all()


def test_flow_of_a_box_that_turns_and_of_one_that_comes_nearer():
    thing = slab(2, (0, 0, 4.5), (1, 1, 1))
    nearer = replace(thing, position=(0.0, -0.5, 3.5))
    found = flow_of(Scene((BACK, nearer)), shoot(Scene((BACK, thing)), CAMERA))
    row, column = H // 2 + 3, W // 2 + 4
    away = np.array((column + 0.5 - W / 2, row + 0.5 - H / 2))
    assert found[row, column] == pytest.approx(away * (4.0 / 3.0 - 1), abs=0.02)


def test_the_sky_moves_with_the_camera_only():
    empty = Scene(())
    turned = look_at("turned", (0, 0, 0), (0.1, 0, 1), W, H)
    assert np.nanmax(np.abs(flow(shoot(empty, CAMERA), shoot(empty, CAMERA)))) < 1e-3
    found = flow(shoot(empty, CAMERA), shoot(empty, turned))
    assert found[H // 2, W // 2][0] == pytest.approx(-0.1 * FOCAL, abs=0.1)


def test_flow_survives_a_file():
    values = np.array([[[1.5, -2.25], [np.nan, np.nan]]], np.float32)
    code = png.decode(png.encode(values))
    assert (code[0, 0, :2].astype(float) - 32768) / 64 == pytest.approx((1.5, -2.25))
    assert code[..., 2].tolist() == [[1, 0]]


def test_flow_that_a_file_cannot_hold_is_unknown_in_it():
    values = np.array([[[511.9, -512.0], [512.0, 0.0], [3.0, -512.1], [np.inf, 0.0]]], np.float32)
    code = png.decode(png.encode(values))
    assert code[..., 2].tolist() == [[1, 0, 0, 0]] and not code[0, 1:].any()


def test_boxes_around_what_is_seen():
    scene = Scene((BACK, slab(2, (0, 0, 4.5), (1, 1, 1)), slab(3, (0.5, 0, 3.05), (1, 4, 0.1))))
    found = {one.node: one for one in seen(shoot(scene, CAMERA))}
    half = 0.5 * FOCAL / 4
    left, top, right, bottom = found[2].box
    assert (left, top) == pytest.approx((W / 2 - half, H / 2 - half), abs=1)
    assert bottom == pytest.approx(H / 2 + half, abs=1)
    assert right == W // 2  # the rest is behind the nearer one
    assert found[2].pixels == (right - left) * (bottom - top)
    assert found[2].center == pytest.approx((0, 0, 4.5))
    assert found[2].size == pytest.approx((1, 1, 1))
    assert np.nanmin(found[2].corners[:, 0]) == pytest.approx(W / 2 - half, abs=0.01)


def test_what_is_hidden_has_no_box():
    scene = Scene((slab(2, (0, 0, 8), (1, 1, 1)), slab(3, (0, 0, 4), (3, 3, 1))))
    assert [one.node for one in seen(shoot(scene, CAMERA))] == [3]


def test_joints_are_where_the_body_is():
    person = Thing(9, "character", Figure(BODIES["ben"], BodyPose()), (0.3, -0.9, 3.0), 180.0)
    (found,) = skeletons(shoot(Scene((BACK, person)), CAMERA))
    head, hand = found.joints["head"], found.joints["hand_r"]
    assert head == pytest.approx((0.3, 0.7, 3.0), abs=0.1)
    assert hand[0] < 0.3  # facing the camera, the right hand is on its left
    x, y, depth = found.pixels["head"]
    assert (x, y) == pytest.approx((W / 2 + FOCAL * head[0] / head[2], H / 2 - FOCAL * head[1] / head[2]), abs=0.01)
    assert depth == pytest.approx(head[2])
    assert {"head", "hand_r", "knee_l"} <= set(found.visible)


def test_joints_behind_a_wall_are_not_visible():
    person = Thing(9, "character", Figure(BODIES["ben"], BodyPose()), (0.0, -0.9, 3.0), 180.0)
    wall = slab(3, (0, -1.0, 1.5), (4, 2.0, 0.1))
    (found,) = skeletons(shoot(Scene((BACK, person, wall)), CAMERA))
    assert "ankle_l" not in found.visible
    assert "head" in found.visible


def test_a_picture_is_described_in_plain_values():
    person = Thing(9, "character", Figure(BODIES["ben"]), (0.0, -0.9, 3.0), 180.0)
    row = described(shoot(Scene((BACK, person)), CAMERA))
    assert row["camera"] == camera_of(CAMERA)
    assert np.array(row["camera"]["intrinsics"])[0, 0] == pytest.approx(FOCAL, abs=1e-3)
    assert [one["node"] for one in row["objects"]] == [1, 9]
    assert row["people"][0]["joints_3d"].keys() == row["people"][0]["joints_2d"].keys()


def test_joints_behind_the_camera_are_nowhere_in_the_picture():
    """A person that stands astride of the camera has joints on both sides of it."""
    person = Thing(9, "character", Figure(BODIES["ben"], BodyPose()), (0.0, -0.9, 0.013), 90.0)
    shot = shoot(Scene((BACK, person)), CAMERA)
    (found,), (row,) = skeletons(shot), poses(shot)
    ahead = {name for name, at in found.joints.items() if at[2] > 0}
    assert 0 < len(ahead) < len(found.joints)
    assert {name for name, at in row["joints_2d"].items() if at is not None} == ahead
    assert all(np.isnan(found.pixels[name][:2]).all() for name in found.joints.keys() - ahead)
    assert set(row["visible"]) <= ahead
