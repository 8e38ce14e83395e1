"""Scenes whose pictures are known beforehand."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import look_at, top_view
from hearth.rendering.film import png
from hearth.rendering.modalities import render
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import scene_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node

W, H = 80, 60


def slab(number, center, size, recipe="ceiling"):
    x, y, z = center
    return Thing(number, f"class_{number}", Model(recipe, Look(size)), (x, y - size[1] / 2, z))


def plain(eye, target, width=W, height=H, fov=60.0):
    return look_at("test", eye, target, width, height, fov)


def test_depth_of_a_plane_is_the_distance_along_the_axis_everywhere():
    scene = Scene((slab(7, (0, 0, 5.0), (40, 40, 2.0)),))
    depth = render(scene, plain((0, 0, 0), (0, 0, 1)), ("depth",))["depth"]
    assert depth.dtype == np.uint16
    assert depth.shape == (H, W)
    assert np.abs(depth.astype(int) - 4000).max() <= 1


def test_the_nearer_of_two_boxes_hides_the_other():
    scene = Scene((slab(3, (0, 0, 4), (2, 2, 1)), slab(9, (0.75, 0, 2.5), (1.5, 6, 1))))
    ids = render(scene, plain((0, 0, 0), (0, 0, 1)), ("instance_ids",))["instance_ids"]
    assert ids[H // 2, W // 2 + 3] == 9  # x grows to the right
    assert ids[H // 2, W // 2 - 3] == 3
    assert ids[H // 2, 1] == 0
    assert set(np.unique(ids)) == {0, 3, 9}


def test_classes_are_numbered_as_told():
    scene = Scene((slab(3, (0, 0, 4), (2, 2, 1)),))
    camera = plain((0, 0, 0), (0, 0, 1))
    assert render(scene, camera, ("class_ids",), class_ids={"class_3": 77})["class_ids"].max() == 77
    assert render(scene, camera, ("class_ids",))["class_ids"].max() == 1


def test_normals_of_a_ball_point_away_from_its_middle():
    ball = Thing(1, "toy", Model("toy", Look((2, 2, 2), kind="ball")), (0, -1, 5))
    camera = plain((0, 0, 0), (0, 0, 1), fov=40)
    seen = render(Scene((ball,)), camera, ("normals", "depth"))
    row, column = H // 2, W // 2 + 8
    ray = camera.rays().reshape(H, W, 6)[row, column, 3:]
    point = ray * seen["depth"][row, column] / 1000
    expected = (point - (0, 0, 5)) / np.linalg.norm(point - (0, 0, 5))
    assert seen["normals"][row, column] @ expected > 0.98
    assert (seen["normals"][1, 1] == 0).all()


def test_projection_and_rays_agree():
    camera = plain((1, 2, 3), (4, 1, 8))
    rays = camera.rays().reshape(H, W, 6)
    pixels, depths = camera.project(rays[[10, 50], [70, 5], :3] + 2.5 * rays[[10, 50], [70, 5], 3:])
    assert np.allclose(pixels, [(70.5, 10.5), (5.5, 50.5)], atol=1e-3)
    assert np.allclose(depths, 2.5, atol=1e-4)
    assert np.isclose(np.linalg.det(camera.pose[:3, :3]), 1.0)


def room(*nodes, edges=(), size=(4.0, 2.6, 4.0)):
    inside = [Edge(node.id, "INSIDE", 1) for node in nodes]
    floor = Node(1, "kitchen", "Rooms", box=Box((0, size[1] / 2, 0), size))
    return EnvironmentGraph((floor, *nodes), (*inside, *edges))


def fridge(state):
    return Node(2, "fridge", "Appliances", states=(state,), box=Box((0, 0.9, -1.6), (0.65, 1.8, 0.65)), yaw=0.0)


MILK = Node(3, "milk", "Food", box=Box((0.0, 1.3, -1.6), (0.09, 0.24, 0.09)), yaw=0.0)


def test_what_is_in_a_closed_fridge_is_seen_once_it_is_open():
    camera = plain((0.5, 1.5, 0.8), (0, 1.2, -1.6))
    closed = render(scene_of(room(fridge("CLOSED"), MILK), default()), camera, ("instance_ids",))["instance_ids"]
    opened = render(scene_of(room(fridge("OPEN"), MILK), default()), camera, ("instance_ids",))["instance_ids"]
    assert (closed == 2).sum() > 50
    assert (closed == 3).sum() == 0
    assert (opened == 3).sum() > 3


def test_a_lamp_that_is_switched_on_brightens_its_room():
    def brightness(*states):
        lamp = Node(4, "ceilinglamp", "Lamps", states=states, box=Box((0, 2.5, 0), (0.4, 0.2, 0.4)), yaw=0.0)
        picture = render(scene_of(room(lamp), default(), hour=23.0), plain((1.5, 1.5, 1.5), (-1, 0.3, -1)), ("rgb",))[
            "rgb"
        ]
        return picture.mean()

    assert brightness("ON") > brightness("OFF") * 1.3


def test_a_view_from_above_looks_into_rooms_with_ceilings():
    table = Node(5, "table", "Furniture", box=Box((0, 0.37, 0), (1.4, 0.74, 0.8)), yaw=0.0)
    graph = room(table)
    camera = top_view(graph.node(1).box, width=W, height=H)
    seen = render(scene_of(graph, default()), camera, ("instance_ids", "depth"))
    assert seen["instance_ids"][H // 2, W // 2] == 5
    eye = camera.eye[1]
    assert abs(int(seen["depth"][H // 2, W // 2]) - (eye - 0.74) * 1000) < 15


@pytest.mark.parametrize("quality", ["draft", "fine"])
def test_the_same_scene_gives_the_same_bytes(quality):
    camera = plain((1.5, 1.5, 1.5), (-1, 0.3, -1), 48, 36)
    first, second = (
        render(scene_of(room(fridge("OPEN"), MILK), default()), camera, quality=quality)["rgb"] for _ in range(2)
    )
    assert png.encode(first) == png.encode(second)
    assert 20 < first.mean() < 240
    assert (first == 255).mean() < 0.02


def test_png_keeps_sixteen_bits_and_the_order_of_colours():
    rgb = np.zeros((2, 3, 3), np.uint8)
    rgb[..., 0] = 200
    depth = np.array([[0, 1000], [65535, 7]], np.uint16)
    assert (png.decode(png.encode(rgb)) == rgb).all()
    assert (png.decode(png.encode(depth)) == depth).all()


def test_ids_that_no_png_can_hold_are_refused():
    scene = Scene((slab(70_000, (0, 0, 4), (2, 2, 1)),))
    ids = render(scene, plain((0, 0, 0), (0, 0, 1)), ("instance_ids",))["instance_ids"]
    assert ids.max() == 70_000
    with pytest.raises(HearthError, match="int32") as refused:
        png.encode(ids)
    assert "65535" in str(refused.value.diagnostics[0].suggestion)


def test_unknown_modalities_are_told():
    with pytest.raises(HearthError, match="infrared"):
        render(Scene(()), plain((0, 0, 0), (0, 0, 1)), ("rgb", "infrared"))


def test_flow_boxes_and_camera_come_from_the_same_cast():
    camera = plain((0, 0, 0), (0, 0, 1))
    before, after = (Scene((slab(3, (x, 0, 4), (2, 2, 1)),)) for x in (0.0, 0.2))
    row = render(before, camera, ("flow", "boxes", "poses", "camera"), after=after)
    focal = camera.intrinsics[0, 0]
    assert row["flow"][H // 2, W // 2] == pytest.approx((0.2 * focal / 3.5, 0), abs=0.01)
    (box,) = row["boxes"]
    assert (box["node"], box["box_3d"]["size"]) == (3, [2, 2, 1])
    assert box["box_2d"][0] == pytest.approx(W / 2 - focal / 3.5, abs=1)
    assert row["poses"] == []
    assert row["camera"]["intrinsics"][0][0] == pytest.approx(focal, abs=1e-3)


def test_an_empty_scene_is_sky():
    seen = render(Scene(()), plain((0, 1, 0), (0, 1.2, 1)), ("rgb", "depth", "instance_ids"))
    assert seen["depth"].max() == 0
    assert seen["instance_ids"].max() == 0
    assert seen["rgb"].mean() > 60


def test_without_open3d_it_is_said_what_to_install(monkeypatch):
    import sys

    from hearth.rendering.rays import ray_casting

    def broken(name):
        raise OSError("libusb")

    ray_casting.engine.cache_clear()
    monkeypatch.setitem(sys.modules, "open3d", None)
    with pytest.raises(HearthError, match=r"pip install '\.\[pictures\]'"):
        ray_casting.engine()
    monkeypatch.setattr(ray_casting, "library", broken)
    with pytest.raises(HearthError, match=r"libusb-1\.0-0"):
        ray_casting.engine()
    monkeypatch.undo()
    ray_casting.engine.cache_clear()
