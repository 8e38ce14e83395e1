"""Things come to their places within a moment; what vessels hold goes along with them, whatever the rules forget."""

from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.people.motion import frames
from hearth.rendering.people.object_arrivals import FASTEST, LEAST, Arrivals
from hearth.rendering.scene.scene import Scene
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ROOM, ME, TABLE, HOLDER, EGG, HALL = range(1, 7)
CARRIED = ("GRABBABLE", "MOVABLE")


def node(number, name, category, center, size, properties=()):
    return Node(number, name, category, properties, (), None, Box(center, size), None)


def filmed(*steps, holder=("plate", (*CARRIED, "RECIPIENT", "SURFACES")), relation="ON", far=0.2):
    """A holder with an egg on a table, and a person."""
    name, properties = holder
    nodes = (
        node(ROOM, "kitchen", "Rooms", (0, 1.3, 0), (6, 2.6, 5)),
        node(HALL, "bedroom", "Rooms", (5, 1.3, 0), (4, 2.6, 5)),
        node(ME, "character", "Characters", (2.0, 0.85, 1.6), (0.4, 1.7, 0.4)),
        node(TABLE, "table", "Furniture", (0.0, 0.37, 0.0), (1.2, 0.74, 0.9), ("SURFACES",)),
        node(HOLDER, name, "Props", (far, 0.76, 0.1), (0.24, 0.03, 0.24), properties),
        node(EGG, "food_egg", "Food", (far, 0.8, 0.1), (0.05, 0.05, 0.05), (*CARRIED, "EATABLE")),
    )
    edges = [Edge(each.id, "INSIDE", ROOM) for each in nodes[2:]]
    edges += [Edge(HOLDER, "ON", TABLE), Edge(EGG, relation, HOLDER)]
    home = EnvironmentGraph(nodes, tuple(sorted(edges)))
    program, faults = parse_program("Carry\nIt\n\n\n" + "".join(f"{step}\n" for step in steps))
    assert not faults
    known = {("table", 1): TABLE, (name, 1): HOLDER, ("food_egg", 1): EGG, ("kitchen", 1): ROOM}
    done = run(World.start(Home.from_graph(home, "", default())), program.bound(known))
    assert done.executable, done.failure
    return trajectory_of(done, home, default())


TAKES = ("[Walk] <{0}> (1)", "[Grab] <{0}> (1)", "[Walk] <kitchen> (1)", "[Walk] <table> (1)")
PUTS = "[PutBack] <{0}> (1) <table> (1)"


def spot(scene, number):
    return np.array(scene.find(number).position)


def test_an_egg_on_a_plate_goes_along_and_is_there_when_the_plate_is_put_down():
    found = filmed(*(step.format("plate") for step in (*TAKES, PUTS))).keyframes
    assert not any(edge.target == HOLDER and edge.source == EGG for edge in found[2].places.graph.edges)
    for keyframe in found[1:]:
        way = spot(keyframe.scene, EGG) - spot(keyframe.scene, HOLDER)
        assert np.hypot(way[0], way[2]) < 0.14 and -0.01 < way[1] < 0.1, keyframe.tick
    assert EGG not in found[2].places.poses and EGG in found[5].places.poses


def test_what_is_taken_from_a_carried_plate_is_in_the_hand():
    found = filmed(*(step.format("plate") for step in TAKES[:2]), "[Grab] <food_egg> (1)").keyframes
    assert found[3].places.holds[ME].keys() == {HOLDER, EGG}
    assert np.linalg.norm(spot(found[3].scene, EGG) - found[3].actors[0].hand("left")) < 0.08


@pytest.mark.parametrize("holder", [("towel", CARRIED), ("stool", (*CARRIED, "SITTABLE", "SURFACES"))])
def test_what_was_on_a_thing_that_is_no_vessel_stays_where_that_was(holder):
    found = filmed(*(step.format(holder[0]) for step in TAKES[:2]), holder=holder).keyframes
    before, after = found[1].places.poses[EGG].box, found[2].places.poses[EGG].box
    assert np.hypot(before.center[0] - after.center[0], before.center[2] - after.center[2]) < 0.1
    assert after.center[1] - after.size[1] / 2 == pytest.approx(0.74, abs=0.01)


def test_clothes_that_are_taken_off_lie_beside_who_wore_them():
    shirt = ("clothes_shirt", (*CARRIED, "CLOTHES"))
    steps = [step.format(shirt[0]) for step in (*TAKES[:2], "[PutOn] <{0}> (1)", "[PutOff] <{0}> (1)")]
    found = filmed(*steps, holder=shirt).keyframes
    (x, _, z), person = found[-1].places.poses[HOLDER].box.center, found[-1].actors[0].spot
    assert 0.1 < np.hypot(x - person[0], z - person[1]) < 1.2


@pytest.mark.parametrize("number", [HOLDER, EGG])
def test_nothing_jumps_between_poses(number):
    film = filmed(*(step.format("plate") for step in (*TAKES, PUTS)), far=-0.5)
    spots = [spot(frame.scene, number) for frame in frames(film, 10.0)]
    assert max(float(np.linalg.norm(b - a)) for a, b in pairwise(spots)) < 0.3


def test_ways_end_where_a_thing_should_be_and_are_not_too_fast():
    scene: Scene = filmed(*(step.format("plate") for step in TAKES)).keyframes[0].scene
    coming = Arrivals({EGG: (2.0, 0.0, 0.0), HOLDER: (0.0, 0.1, 0.0)})
    seconds = coming.seconds
    assert seconds > LEAST and coming.at(scene, seconds) is scene
    assert np.allclose(spot(coming.at(scene, 0.0), EGG) - spot(scene, EGG), (2.0, 0.0, 0.0))
    ways = [spot(coming.at(scene, seconds * share / 40), EGG)[0] for share in range(41)]
    assert max(a - b for a, b in pairwise(ways)) * 40 / seconds < FASTEST * 1.01
    assert np.allclose(spot(coming.at(scene, LEAST), HOLDER), spot(scene, HOLDER))
