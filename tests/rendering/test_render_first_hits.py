"""Rasterised first hits equal those of rays, their plain twin, but where two triangles are equally near."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("open3d")

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import NEAREST, look_at, top_view
from hearth.rendering.cameras.viewpoints import home_box
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.rays.camera_shot import shoot
from hearth.rendering.rays.optical_flow import flow_of
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import scene_of
from hearth.rendering.scene.triangles import StaticThings

SIZE = (96, 72)
FLOW = 1e-3
"""Pixels by which the flow of both may differ."""


@pytest.fixture(scope="module")
def home():
    graph = library.load_graph("birch", default())
    whole = scene_of(graph, default())
    moving = tuple(thing for thing in whole.things if thing.id % 9 == 0 and not thing.structural)
    scene = replace(whole, things=moving, static=StaticThings(tuple(t for t in whole.things if t not in moving)))
    return graph, scene


def depths(shot):
    return shot.image(np.where(shot.hits.triangle >= 0, shot.hits.distance, np.float32(1e4)))


def assert_equal_but_for_edges(scene, camera):
    """Both shots; their depths differ by a millimetre at most, but where an edge passes through a pixel's middle."""
    one, other = shoot(scene, camera), shoot(scene, camera, by_rays=True)
    found, expected = depths(one), depths(other)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(expected, 1, mode="edge"), (3, 3))
    far = (found < around.min(axis=(2, 3)) - 1e-3) | (found > around.max(axis=(2, 3)) + 1e-3)
    assert far.mean() <= 1e-3
    assert (np.abs(found - expected) > 1e-3).mean() < 0.01
    return one, other


@settings(max_examples=25, deadline=None)
@given(
    st.tuples(st.floats(0.05, 0.95), st.floats(0.05, 0.95), st.floats(0.05, 0.95)),
    st.floats(-180, 180),
    st.floats(-80, 80),
    st.floats(20, 110),
)
def test_from_anywhere_in_a_home_the_same_is_seen(home, share, turn, tilt, fov):
    graph, scene = home
    box = home_box(graph)
    eye = tuple(c + (s - 0.5) * w for c, s, w in zip(box.center, share, box.size, strict=True))
    way = np.array((np.sin(np.radians(turn)), np.tan(np.radians(tilt)), np.cos(np.radians(turn))))
    camera = look_at("test", eye, tuple(float(v) for v in np.array(eye) + way), *SIZE, fov)
    if depths(shoot(scene, camera, by_rays=True)).min() > 2 * NEAREST:
        assert_equal_but_for_edges(scene, camera)


def test_ids_from_the_cameras_of_rooms_are_equal(home):
    from hearth.rendering.cameras.viewpoints import room_views

    graph, scene = home
    same = []
    for cameras in room_views(graph, *SIZE).values():
        one, other = assert_equal_but_for_edges(scene, cameras[2])
        same.append((one.owner == other.owner).mean())
    assert np.mean(same) > 0.999


def test_a_view_from_above_begins_at_its_cut(home):
    graph, scene = home
    assert_equal_but_for_edges(scene, top_view(home_box(graph), "top", *SIZE))


def test_what_is_partly_behind_the_camera_is_cut_off_there():
    floor = Thing(5, "floor", Model("ceiling", Look((9, 1, 9))), (0, -1, 0))
    camera = look_at("test", (0, 1, 0), (0.3, 0.6, 1), *SIZE, 75)
    one, other = assert_equal_but_for_edges(Scene((floor,)), camera)
    assert (one.hits.triangle >= 0).sum() > SIZE[0] * SIZE[1] / 3
    assert ((one.hits.triangle >= 0) == (other.hits.triangle >= 0)).all()


def test_nothing_is_hit_in_an_empty_scene():
    assert (shoot(Scene(()), look_at("test", (0, 0, 0), (0, 0, 1), *SIZE)).hits.triangle == -1).all()


def test_flow_is_the_same(home):
    _, scene = home
    camera = look_at("test", (3.0, 1.6, 3.0), (1.0, 0.8, 1.0), *SIZE, 75)
    after = replace(scene, things=tuple(replace(t, yaw=t.yaw + 5) for t in scene.things))
    one, other = (flow_of(after, shoot(scene, camera, after=after, by_rays=rays)) for rays in (False, True))
    close = np.isclose(one, other, atol=FLOW, equal_nan=True).all(axis=2)
    assert close.mean() > 0.995


@pytest.mark.parametrize("name", ["birch", "maple"])
def test_of_equally_near_things_the_same_one_wins_whatever_the_number_of_threads(home, monkeypatch, name):
    from hearth.rendering.rays import first_hits

    scene = scene_of(library.load_graph(name, default()), default())
    camera = look_at("test", (3.0, 1.6, 3.0), (1.0, 0.8, 1.0), *SIZE, 75)
    one = shoot(scene, camera).hits.triangle
    monkeypatch.setattr(first_hits, "count", lambda: 5)
    assert (shoot(scene, camera).hits.triangle == one).all()
