"""Mirrors: what stands before one is seen in it, whole and incremental pictures are equal, other modalities stay."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.rendering.cameras.camera import look_at
from hearth.rendering.modalities import render
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.rays.incremental_pictures import incremental_frame
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import StaticThings

CAMERA = look_at("test", (0.3, 1.0, 0.0), (0.0, 1.0, 2.0), 96, 72, 50.0)
NAMES = ("depth", "instance_ids", "normals")
MIRROR = Thing(1, "mirror", Model("mirror", Look((1.2, 1.2, 0.03))), (0.0, 0.4, 2.0), 180.0)


def ball(x, color="#d02020"):
    return Thing(2, "ball", Model("toy", Look((0.6, 0.6, 0.6), kind="ball", color=color)), (x, 0.7, -1.5))


def reds(picture):
    """The columns of pixels that are more red than green by far."""
    return np.flatnonzero((picture[..., 0].astype(int) > picture[..., 1].astype(int) + 40).any(axis=0))


@pytest.mark.parametrize("quality", ["draft", "fine"])
def test_a_mirror_shows_what_is_behind_the_camera(quality):
    assert not len(reds(render(Scene((MIRROR,)), CAMERA, ["rgb"], quality=quality)["rgb"]))
    left, right = (reds(render(Scene((MIRROR, ball(x))), CAMERA, ["rgb"], quality=quality)["rgb"]) for x in (-0.9, 0.3))
    assert len(left)
    assert len(right)
    assert left.mean() < right.mean() - 8, "left and right stay where they are"


def test_only_colours_show_what_is_in_a_mirror():
    bare, full = (render(Scene(things), CAMERA, NAMES) for things in ((MIRROR,), (MIRROR, ball(0.0))))
    for name in NAMES:
        assert np.array_equal(bare[name], full[name]), name


def test_a_mirror_follows_what_moves():
    static = StaticThings((MIRROR,))
    last = None
    for x in (-0.9, 0.3):
        scene = Scene((ball(x),), static=static)
        last = incremental_frame(scene, CAMERA, last)
        assert np.array_equal(last.picture, render(scene, CAMERA, ["rgb"])["rgb"])
        assert len(reds(last.picture))
