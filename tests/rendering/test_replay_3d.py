"""Runs in 3D for pages: what is packed is what is drawn; a tick is the home without what left, with what came."""

import base64
import zlib

import numpy as np
import pytest

from hearth.grounding.grounded_run import attempt
from hearth.homes.library import load_graph
from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import keyframes
from hearth.rendering.film.replay_3d import home_shapes, run_shapes
from hearth.rendering.scene.instances import own_mesh, placed
from hearth.rendering.scene.packed_shapes import UNIT, PackedShapes
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.home import Home

MILK = """[Walk] <fridge> (1)
[Open] <fridge> (1)
[Grab] <milk> (1)
[Walk] <sofa> (1)
[Sit] <sofa> (1)"""


@pytest.fixture(scope="module")
def graph():
    return load_graph("maple", default())


@pytest.fixture(scope="module")
def things(graph):
    return [thing for thing in prepared_scene(graph, default()).scene().everything if not thing.above]


@pytest.fixture(scope="module")
def execution(graph):
    home = Home.from_graph(graph, "maple", default())
    return attempt(Program("Drink milk", "", parse_program(MILK)[0].steps), home).execution


def triangles(packed, number):
    """The corners of a shape's triangles in metres, and their colours, as the page unpacks them."""
    data = zlib.decompress(base64.b64decode(packed["data"]))
    pattern, positions_at, light_at = packed["shapes"][number]
    corners, drawn, index_at, colours_at = packed["patterns"][pattern]
    index = np.frombuffer(data, np.uint16 if corners <= 65_536 else np.uint32, drawn, index_at)
    positions = np.frombuffer(data, np.int16, 3 * corners, positions_at).reshape(3, corners).T * packed["unit"]
    colours = np.frombuffer(data, np.uint8, 3 * corners, colours_at).reshape(3, corners).T
    assert np.frombuffer(data, np.uint8, corners, light_at).min() > 0
    return positions[index].reshape(-1, 3, 3), colours[index].reshape(-1, 3, 3)


def test_a_home_is_packed_as_it_is_drawn(graph, things):
    found = home_shapes(graph, default())
    assert len(found["things"]) == len(things) > 200
    for row, thing in list(zip(found["things"], things, strict=True))[::9]:
        mesh = placed(thing) if thing.structural else own_mesh(thing)
        corners, colours = triangles(found["shapes"], row[0])
        assert np.abs(corners - mesh.corners).max() <= UNIT / 2 + 1e-6
        assert (np.ptp(colours, axis=1) == 0).all(), "a triangle has one colour"
        where = [0, 0, 0, 0, 1] if thing.structural else [*thing.position, thing.yaw, 0]
        assert row[1:] == pytest.approx(where, abs=0.001)
    assert len(found["shapes"]["shapes"]) < len(things), "equal things share a shape"


def test_every_tick_is_the_home_without_what_left_it_and_with_what_came(graph, things, execution):
    found = run_shapes(execution, graph, default())
    frames = list(keyframes(execution, graph, default()))
    assert len(found["ticks"]) == len(frames) == 6
    for tick, frame in zip(found["ticks"], frames, strict=True):
        now = {thing for thing in frame.scene.everything if not thing.above}
        stay = {thing for number, thing in enumerate(things) if number not in set(tick["off"])}
        assert stay == now & set(things)
        assert sorted(row[5] for row in tick["on"]) == sorted(thing.id for thing in now - stay)
    milk = execution.program.steps[2].objects[0].node
    assert [any(row[5] == milk for row in tick["on"]) for tick in found["ticks"]] == [False] * 3 + [True] * 3
    assert found["ticks"][0]["at"] != found["ticks"][1]["at"]


def test_bodies_share_their_pattern(graph, execution):
    """A body in ten poses is ten times its positions, not its triangles."""
    found = run_shapes(execution, graph, default())
    person = {
        row[0] for tick in found["ticks"] for row in tick["on"] if len(triangles(found["shapes"], row[0])[0]) > 5_000
    }
    assert len(person) > 3
    assert len({found["shapes"]["shapes"][number][0] for number in person}) == 1


def test_a_shape_is_kept_once(things):
    shapes = PackedShapes()
    assert [shapes.add(things[0]), shapes.add(things[0])] == [0, 0]
    assert len(shapes) == 1


def test_a_home_without_geometry_is_refused():
    with pytest.raises(HearthError, match="no geometry"):
        home_shapes(EnvironmentGraph((), ()), default())
