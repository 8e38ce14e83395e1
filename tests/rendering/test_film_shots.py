"""Shots: the best cut equals that of a plain search; films show what happens, from where nothing is in the way."""

from itertools import groupby, pairwise, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("open3d")

from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import look_at
from hearth.rendering.cameras.recognition import in_the_way, recognition, shows
from hearth.rendering.cameras.viewpoints import room_views
from hearth.rendering.cameras.visibility import seen_as
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.film_measures import film_quality
from hearth.rendering.film.shot_sequence import Acts, best_cut
from hearth.rendering.film.shots import Planner, Verified
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.rays.camera_shot import shoot
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.scene import Scene
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.home import Home

PROGRAM = """Watch TV
It.


[Walk] <sofa> (1)
[Sit] <sofa> (1)
[Watch] <television> (1)
[StandUp]
[Walk] <fridge> (1)
[Open] <fridge> (1)
"""


def value(worth, rows, cost, acts):
    cuts = sum(a != b for a, b in pairwise(rows))
    found = sum(worth[row, t] for t, row in enumerate(rows)) - cost * cuts
    for tick in set(acts.ticks.tolist()):
        seen = 0
        for t in np.flatnonzero(acts.ticks == tick):
            seen |= acts.shown[rows[t], t]
        found += sum(gain for k, gain in enumerate(acts.gains) if seen >> k & 1)
    return found


def runs(rows):
    return [len(list(run)) for _, run in groupby(rows)]


@settings(max_examples=60, deadline=None)
@given(
    st.integers(1, 3), st.integers(1, 7), st.integers(1, 3), st.integers(0, 2), st.integers(0, 2**31),
    st.sampled_from([0.0, 0.4, 2.0]),
)  # fmt: skip
def test_the_best_cut_is_that_of_a_plain_search(rows, moments, shortest, agents, seed, cost):
    numbers = np.random.default_rng(seed)
    worth = numbers.normal(size=(rows, moments))
    ticks, shown = np.cumsum(numbers.random(moments) < 0.4), numbers.integers(0, 1 << agents, (rows, moments))
    acts = Acts(ticks, shown, tuple(3 * numbers.random(agents)))
    allowed = [found for found in product(range(rows), repeat=moments) if min(runs(found)) >= min(shortest, moments)]
    if moments < 2 * shortest:
        allowed = [found for found in allowed if len(set(found)) == 1]
    found = best_cut(worth, shortest, cost, acts)
    assert tuple(found) in allowed
    best = max(value(worth, each, cost, acts) for each in allowed)
    assert value(worth, found, cost, acts) == pytest.approx(best)


def test_values_alone_decide_without_acts():
    worth = np.array([[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]])
    assert best_cut(worth, 2, 0.5) == [0, 0, 1, 1]
    assert best_cut(worth, 2, 3.0) in ([0] * 4, [1] * 4)


@pytest.fixture(scope="module")
def filmed():
    graph = library.load_graph("maple", default())
    done = attempt(parse_program(PROGRAM)[0], Home.from_graph(graph, "maple", default())).execution
    assert done.executable
    return graph, trajectory_of(done, graph, default())


def test_a_film_shows_every_step_in_shots_of_three_seconds(filmed):
    graph, trajectory = filmed
    found = film_quality(trajectory, graph)
    assert [step.shown for step in found.steps] == [True] * 6
    assert min(found.shots) >= 3
    assert found.blocked <= 0.05 * found.pictures


def test_no_door_fills_a_side_of_a_film_before_what_it_shows():
    """An open door stood before the camera in a quarter of the last picture."""
    graph = library.load_graph("maple", default())
    steps = ("[Walk] <television> (1)", "[SwitchOn] <television> (1)", *PROGRAM.splitlines()[4:7])
    program = parse_program("\n".join(("Watch TV", "It.", "", "", *steps, "")))[0]
    trajectory = trajectory_of(attempt(program, Home.from_graph(graph, "maple", default())).execution, graph, default())
    planner = Planner(trajectory, graph, room_views(graph, 160, 120), (160, 120))
    for moment, camera in zip(planner.moments, planner.shots().cameras, strict=True):
        shot = shoot(moment.frame.scene, camera)
        doors = [thing.class_name == "door" for thing in shot.geometry.things]
        near = np.array([*doors, False])[shot.owner] & (shot.distance < 1.2)
        assert near.mean() < 0.1, f"{moment.frame.tick}: {camera.name}"


def test_cuts_rely_on_pictures_where_estimates_are_mistaken(filmed):
    graph, trajectory = filmed
    views = room_views(graph, 160, 120)
    planner = Planner(trajectory, graph, views, (160, 120))
    planner.shots()
    sky = look_at("sky", (0.0, 50.0, 0.0), (0.0, 60.0, 0.1), 160, 120)
    planner.add([sky], (), [frozenset(range(len(planner.moments)))])
    cut = Verified(planner)
    # Every camera is said to show every act, and the one that shows the sky is the best.
    cut.shown[:], cut.total[:], cut.total[-1], cut.gains = 1, 0.0, 5.0, [1000.0]
    rows = cut.rows()
    for tick in range(1, len(trajectory.keyframes)):
        span = np.flatnonzero(cut.ticks == tick).tolist()
        assert any(planner.film.shows(planner.cameras[rows[number]], number, 0) for number in span), tick


def test_what_is_in_a_closed_container_is_seen_by_that(filmed):
    graph, trajectory = filmed
    names = {node.id: node.class_name for node in graph.nodes}
    closed, opened = trajectory.keyframes[0].places, trajectory.keyframes[-1].places
    inside = [n for n, place in closed.locations.items() if place.kind == "inside" and names[place.holder] == "fridge"]
    assert {names[seen_as(node, closed)] for node in inside} == {"fridge"}
    assert [seen_as(node, opened) for node in inside] == inside


CAMERA = look_at("test", (0, 1, 0), (0, 1, 1), 80, 60, 60.0)


def slab(number, center, size, name="table"):
    x, y, z = center
    return Thing(number, name, Model("ceiling", Look(size)), (x, y - size[1] / 2, z))


def test_what_is_half_hidden_or_small_is_not_recognised():
    person, cup = slab(1, (-0.6, 1, 3), (0.8, 1.6, 0.1), "character"), slab(2, (0.8, 1, 3), (0.3, 0.3, 0.1))
    free = shoot(Scene((person, cup)), CAMERA)
    assert recognition(free, 1).unhidden == 1.0
    assert recognition(free, 1).share == pytest.approx((free.owner == 0).mean())
    assert shows(free, 1, (2,))
    assert not shows(free, 1, (2, 3)), "what is not there is not shown"
    for across, seen in ((-0.3, True), (0.1, False)):
        wall = slab(9, (across - 1.3, 1, 2.5), (1.6, 3, 0.1))
        assert shows(shoot(Scene((person, cup, wall)), CAMERA), 1, (2,)) == seen
    far = slab(2, (4, 1, 30), (0.3, 0.3, 0.1))
    assert not shows(shoot(Scene((person, far)), CAMERA), 1, (2,))


def test_something_close_that_fills_the_picture_is_in_the_way():
    back = slab(1, (0, 1, 4), (9, 9, 0.1))
    assert not in_the_way(shoot(Scene((back,)), CAMERA))
    assert in_the_way(shoot(Scene((back, slab(2, (0.3, 1, 0.5), (0.4, 0.4, 0.1)))), CAMERA))
    assert not in_the_way(shoot(Scene((back, slab(2, (0.3, 1, 0.5), (0.05, 0.05, 0.02)))), CAMERA))
