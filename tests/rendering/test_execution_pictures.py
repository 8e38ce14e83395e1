"""Executions in pictures: who stands where, and where things are that were moved."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.cameras.recognition import PERSON
from hearth.rendering.film.contact_sheet import caption, contact_sheet
from hearth.rendering.film.execution_keyframes import _put_down_at, keyframes
from hearth.rendering.film.execution_pictures import snapshots
from hearth.rendering.people.action_poses import moved
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.object_locations import locations_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

PROGRAM = """Put the cup away
On the table, then sit down


[Walk] <cup> (1)
[Grab] <cup> (1)
[Walk] <table> (1)
[PutBack] <cup> (1) <table> (1)
[Walk] <chair> (1)
[Sit] <chair> (1)
"""
CUP, TABLE, CHAIR, SHELF, ME, ROOM = 6, 3, 4, 5, 2, 1


def flat():
    properties = {
        CUP: ("GRABBABLE", "RECIPIENT"), TABLE: ("SURFACES",), CHAIR: ("SITTABLE", "SURFACES"), SHELF: ("SURFACES",)
    }  # fmt: skip
    nodes = [
        Node(ROOM, "kitchen", "Rooms", box=Box((0, 1.3, 0), (5, 2.6, 4))),
        Node(ME, "character", "Characters", box=Box((0, 0.85, 0.2), (0.4, 1.7, 0.4)), yaw=0.0),
        Node(TABLE, "table", "Furniture", box=Box((1.6, 0.37, -1.0), (1.2, 0.74, 0.8)), yaw=0.0),
        Node(CHAIR, "chair", "Furniture", box=Box((1.6, 0.45, 0.3), (0.45, 0.9, 0.48)), yaw=180.0),
        Node(SHELF, "kitchen_counter", "Furniture", box=Box((-1.8, 0.44, -1.6), (1.2, 0.88, 0.6)), yaw=0.0),
        Node(CUP, "cup", "Props", box=Box((-1.8, 0.93, -1.6), (0.1, 0.1, 0.08)), yaw=0.0),
    ]
    nodes = [Node(n.id, n.class_name, n.category, properties.get(n.id, ()), (), None, n.box, n.yaw) for n in nodes]
    inside = [Edge(n.id, "INSIDE", ROOM) for n in nodes[1:]]
    return EnvironmentGraph(tuple(nodes), (*inside, Edge(CUP, "ON", SHELF)))


def execution(graph):
    program, faults = parse_program(PROGRAM)
    assert not faults
    bound = program.bound({("cup", 1): CUP, ("table", 1): TABLE, ("chair", 1): CHAIR})
    done = run(World.start(Home.from_graph(graph, "", default())), bound)
    assert done.executable, done.failure
    return done


@pytest.fixture(scope="module")
def filmed():
    graph = flat()
    return list(keyframes(execution(graph), graph, default()))


def box_of(keyframe, node_id):
    return keyframe.places.poses[node_id].box


def test_a_moment_for_the_start_and_each_step(filmed):
    assert [keyframe.tick for keyframe in filmed] == list(range(7))


def test_what_was_not_moved_stays(filmed):
    assert box_of(filmed[0], CUP) == box_of(filmed[1], CUP)
    assert box_of(filmed[6], SHELF) == box_of(filmed[0], SHELF)


def test_one_stands_near_what_one_grabs_and_holds_it(filmed):
    actor = filmed[2].actors[0]
    assert abs(actor.spot[0] + 1.8) < 0.8
    assert -1.6 < actor.spot[1] < -0.5
    assert CUP not in filmed[2].places.poses
    cup = filmed[2].scene.find(CUP)
    hand = actor.hand("right")
    assert sum((a - b) ** 2 for a, b in zip(cup.position, hand, strict=True)) < 0.05


def test_what_is_put_down_stands_on_its_support(filmed):
    (x, y, z), (_, h, _) = box_of(filmed[4], CUP)
    (tx, ty, tz), (tw, th, td) = box_of(filmed[4], TABLE)
    assert y - h / 2 == pytest.approx(ty + th / 2, abs=0.005)
    assert abs(x - tx) < tw / 2
    assert abs(z - tz) < td / 2


def test_who_sits_sits_on_the_seat(filmed):
    actor = filmed[6].actors[0]
    assert actor.body_pose.posture == "sitting"
    assert actor.place == CHAIR
    assert abs(actor.spot[0] - 1.6) < 0.15
    assert abs(actor.spot[1] - 0.3) < 0.2
    assert 0.3 < actor.body_pose.seat < 0.6


def test_who_sits_gets_up_for_what_hands_do_not_reach(filmed):
    keyframe = filmed[6]
    (actor,), graph = keyframe.actors, keyframe.places.graph

    def doing(action, name, node):
        step = Step(action, (ObjectRef(name, 1, node),))
        return moved(actor, graph, keyframe.places, keyframe.floor, step, [])

    far = doing("Touch", "kitchen_counter", SHELF)
    assert far.body_pose.posture == "standing" and abs(far.spot[0] + 1.8) < 1.2
    assert doing("Touch", "table", TABLE).body_pose.posture == "sitting"
    assert doing("LookAt", "kitchen_counter", SHELF).body_pose.posture == "sitting"


def test_who_sits_puts_things_down_beside_itself(filmed):
    actor = filmed[6].actors[0]
    beside = _put_down_at(actor)
    assert np.hypot(beside[0] - actor.position[0], beside[2] - actor.position[2]) > 0.4
    assert _put_down_at(filmed[4].actors[0]) == filmed[4].actors[0].position


def test_people_do_not_stand_in_furniture(filmed):
    for keyframe in filmed[1:6]:
        x, z = keyframe.actors[0].spot
        for node_id in (TABLE, SHELF):
            (cx, _, cz), (w, _, d) = box_of(keyframe, node_id)
            assert abs(x - cx) > w / 2 or abs(z - cz) > d / 2


def test_new_things_find_places_in_and_on_others():
    graph = flat()
    added = (
        Node(1000, "plate", "Props", ("GRABBABLE",)),
        Node(1001, "fridge", "Appliances", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
        Node(1002, "milk", "Food", ("GRABBABLE",)),
    )
    edges = (Edge(1000, "ON", TABLE), Edge(1001, "INSIDE", ROOM), Edge(1002, "INSIDE", 1001))
    fuller = EnvironmentGraph(graph.nodes + added, graph.edges + edges)
    places = Places.start(graph, default()).settled(fuller)
    exposure, fridge, milk = (places.poses[i].box for i in (1000, 1001, 1002))
    assert exposure.center[1] - exposure.size[1] / 2 == pytest.approx(0.74, abs=0.005)
    assert all(abs(milk.center[k] - fridge.center[k]) + milk.size[k] / 2 <= fridge.size[k] / 2 + 1e-3 for k in range(3))
    assert locations_of(fuller)[1002].kind == "inside"


def test_pictures_by_two_cameras_show_person_and_cup():
    graph = flat()
    taken = list(snapshots(execution(graph), graph, default(), size=(80, 60)))
    assert len(taken) == 14
    assert {shot.camera.name for shot in taken[::2]} == {"top"}
    for shot in taken:
        assert shot.pictures["rgb"].shape == (60, 80, 3)
        assert (shot.pictures["instance_ids"] == ME).any()
    assert {shot.person for shot in taken[::2]} == {False}, "from above the person is too small to be recognised"
    for shot in taken[1::2]:
        share = (shot.pictures["instance_ids"] == ME).mean()
        assert shot.person or share < PERSON or shot.steps, "where it stands alone, its size decides"
    assert any(shot.person for shot in taken[1::2])
    grabbed = taken[5]
    assert (grabbed.pictures["instance_ids"] == CUP).any()
    assert grabbed.seen == 1.0 and taken[0].seen is None and taken[1].seen is None, "the start names nothing"
    sheet = contact_sheet([(s.pictures["rgb"], caption(s.tick, s.steps)) for s in taken[1::2]], "Put the cup away")
    assert sheet.shape[1] > 4 * 80
    assert caption(2, taken[5].steps).startswith("2. [Grab] <cup>")


def test_a_home_without_geometry_is_told():
    nodes = tuple(Node(n.id, n.class_name, n.category, n.properties) for n in flat().nodes)
    graph = EnvironmentGraph(nodes, flat().edges)
    with pytest.raises(HearthError, match="geometry"):
        next(iter(snapshots(execution(graph), graph, default())))
