"""Cameras that stay: their shots equal those that are taken anew, and static things are looked for once."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.rendering.cameras.camera import look_at
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.rays import camera_shot as shots
from hearth.rendering.rays.fixed_cameras import KEPT, StillCameras
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.triangles import StaticThings

FLOOR = Thing(1, "floor", Model("ceiling", Look((4.0, 0.1, 4.0))), (0.0, -0.1, 0.0))
STATIC = StaticThings((FLOOR,))
CAMERA = look_at("one", (1.5, 1.5, 1.8), (0.0, 0.2, 0.0), 48, 36)


def scene(at, static=STATIC):
    return Scene((Thing(2, "ball", Model("toy", Look((0.3, 0.3, 0.3), kind="ball")), (at, 0.2, 0.0)),), static=static)


def assert_same(one, other):
    for a, b in zip(one.hits, other.hits, strict=True):
        assert np.array_equal(a, b)
    assert np.array_equal(one.owner, other.owner)


def test_shots_equal_those_that_are_taken_anew_and_static_things_are_looked_for_once(monkeypatch):
    expected = [shots.shoot(scene(at), CAMERA) for at in (0.0, 0.4, 0.8)]
    looked = []
    known = shots.hits_on_static
    monkeypatch.setattr(shots, "hits_on_static", lambda *a, **k: looked.append(1) or known(*a, **k))
    cameras = StillCameras()
    for at, shot in zip((0.0, 0.4, 0.8), expected, strict=True):
        found = cameras.shoot(scene(at), replace(CAMERA, name=f"at {at}"))
        assert_same(found, shot)
        assert found.camera.name == f"at {at}"
    assert len(looked) == 1


def test_other_static_things_are_looked_for_again():
    cameras, other = StillCameras(), StaticThings((replace(FLOOR, position=(0.0, 0.0, 0.3)),))
    cameras.shoot(scene(0.0), CAMERA)
    assert_same(cameras.shoot(scene(0.0, other), CAMERA), shots.shoot(scene(0.0, other), CAMERA))


def test_only_some_cameras_are_remembered():
    cameras = StillCameras()
    for number in range(KEPT + 3):
        cameras.shoot(scene(0.0), replace(CAMERA, eye=(1.5 + 0.01 * number, 1.5, 1.8)))
    assert len(cameras.known) == KEPT
