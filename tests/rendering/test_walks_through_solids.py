"""Walks through solid things are found by what is drawn, independently of how routes are made."""

import pytest

pytest.importorskip("open3d")

from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.walks_through_solids import contains, on_the_floor, walks
from hearth.rendering.people import motion_tracks
from hearth.rendering.people.motion import frames
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.home import Home

THERE = "Fetch\nIt.\n\n\n[Walk] <bed> (1)\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[StandUp]\n[Walk] <fridge> (1)\n"


@pytest.fixture(scope="module")
def trajectory():
    graph = library.load_graph("maple", default())
    program, _ = parse_program(THERE)
    done = attempt(program, Home.from_graph(graph, "maple", default()))
    return trajectory_of(done.execution, graph, default())


def test_a_film_has_no_walk_through_solids(trajectory):
    found = walks(trajectory.prepared, trajectory.keyframes, frames(trajectory, 10.0))
    assert [walk.tick for walk in found] == [1, 2, 5]
    assert not any(walk.through for walk in found)


def test_straight_lines_are_found_out(trajectory, monkeypatch):
    monkeypatch.setattr(motion_tracks, "path", lambda floor, start, goal: (start, goal))
    found = walks(trajectory.prepared, trajectory.keyframes, frames(trajectory, 10.0))
    assert any(name == "wall" for walk in found for _, name in walk.through)


def test_walls_are_solid_beside_their_doorways_only(trajectory):
    solids = on_the_floor(trajectory.prepared, trajectory.keyframes[0])
    doorway = next(node for node in trajectory.prepared.graph.nodes if node.class_name == "doorjamb").box.center
    assert not any(contains(solid, (doorway[0], doorway[2])) for solid in solids)
    wall = next(solid for solid in solids if solid.class_name == "wall")
    assert contains(wall, wall.middle)
