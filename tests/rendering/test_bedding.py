"""Bedding makes way for who lies in the bed: a pillow under the head, a blanket over the legs, the rest aside."""

from dataclasses import replace

import numpy as np
import pytest

from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.models.blanket import EMPTY, drape
from hearth.rendering.models.paint import Paint
from hearth.rendering.people.bedding import OPENED, SPREAD, Remade, drawn, edge, turned_back
from hearth.rendering.people.body_pose import BodyPose
from hearth.rendering.people.lying_down import lying_down
from hearth.rendering.people.motion import frames
from hearth.rendering.people.motion_tracks import _got_up, track
from hearth.rendering.scene.scene_preparation import local_size
from hearth.schemas.graph import Edge, Node
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.world.edit import extended
from hearth.simulation.world.home import Home

KNOWN = default()
BEDDING = ("pillow", "blanket", "comforter", "sheets")


def rested(name, bed, more=(), last="StandUp"):
    """The keyframes of lying down in a bed and getting up, with more bedding on the bed; and the bed's id."""
    trajectory, place = filmed(name, bed, more, last)
    return trajectory.keyframes, place


def filmed(name, bed, more=(), last="StandUp", first=()):
    graph = library.load_graph(name, KNOWN)
    home = Home.from_graph(graph, name, KNOWN)
    (place, *_) = [node.id for node in graph.nodes if node.class_name == bed]
    nodes = [Node(2000 + n, each, "Props", ("GRABBABLE", "MOVABLE")) for n, each in enumerate(more)]
    home = extended(home, nodes, [Edge(node.id, "ON", place) for node in nodes])
    seat = ObjectRef(bed, 1, place)
    steps = (Step("Walk", (seat,)), *(Step(action, (seat,)) for action in first), Step("Lie", (seat,)), Step(last))
    execution = attempt(Program("Rest", steps=steps), home, 0, default_state=False, add=False).execution
    assert execution.executable
    return trajectory_of(execution, graph, KNOWN), place


def bedding_of(keyframe, place):
    places = keyframe.places
    nodes = [node for node in places.nodes() if node.class_name in BEDDING and node.box]
    return {node.id: node for node in nodes if places.locations[node.id].holder == place}


def holds(node, point, spare=0.0):
    """Return whether a point of the world is over the box of a node, and not above it."""
    (x, y, z), (w, h, d) = node.box
    return abs(point[0] - x) < w / 2 + spare and abs(point[2] - z) < d / 2 + spare and point[1] < y + h / 2 + spare


@pytest.fixture(scope="module")
def maple_bed():
    return rested("maple", "bed")


def test_a_pillow_is_under_the_head_and_a_blanket_over_the_legs(maple_bed):
    keyframes, place = maple_bed
    (actor,), bedding = keyframes[2].actors, bedding_of(keyframes[2], place)
    assert actor.body_pose.posture == "lying" and len(bedding) == 4
    at = {name: actor.world(tuple(point)) for name, point in actor.figure().joints().items()}
    blanket = next(node for node in bedding.values() if node.class_name == "blanket")
    assert all(holds(blanket, at[f"{joint}_{side}"]) for joint in ("knee", "ankle") for side in "lr")
    pillows = [node for node in bedding.values() if node.class_name == "pillow"]
    assert sum(holds(pillow, at["head"], 0.15) for pillow in pillows) == 1
    assert not any(holds(node, at[name], -0.02) for node in pillows for name in ("pelvis", "knee_l", "ankle_r"))
    assert not holds(blanket, at["head"]) and not holds(blanket, at["spine"])


def test_what_lies_in_a_bed_stays_in_it(maple_bed):
    keyframes, place = maple_bed
    bed = keyframes[2].places.poses[place].box
    for node in bedding_of(keyframes[2], place).values():
        over = np.abs(np.subtract(node.box.center, bed.center)) + np.divide(node.box.size, 2)
        assert over[0] <= bed.size[0] / 2 + 0.08 and over[2] <= bed.size[2] / 2 + 0.01, node.class_name


def test_the_bed_is_as_it_was_before_and_its_blanket_folded_back_after(maple_bed):
    keyframes, place = maple_bed
    before, lying, after = (bedding_of(keyframes[tick], place) for tick in (1, 2, 3))
    assert before == bedding_of(keyframes[0], place) and before != lying
    spread = [node for node in lying.values() if local_size(node.box.size, node.yaw)[2] >= SPREAD]
    assert [node.class_name for node in spread] == ["blanket"]
    over, back = spread[0], after[spread[0].id]
    assert local_size(back.box.size, back.yaw) == pytest.approx((local_size(over.box.size, over.yaw)[0], EMPTY, OPENED))
    assert back.box.center[1] - EMPTY / 2 == pytest.approx(over.box.center[1] - over.box.size[1] / 2)
    actor = keyframes[2].actors[0]
    ends = [actor.local(each.box.center)[2] + local_size(each.box.size, each.yaw)[2] / 2 for each in (over, back)]
    assert ends[0] == pytest.approx(ends[1]), "it stays at the foot"
    others = lying.keys() - {back.id}
    assert {number: after[number].box for number in others} == {number: lying[number].box for number in others}


def test_nothing_changes_where_nobody_lies(maple_bed):
    keyframe = maple_bed[0][1]
    assert turned_back(keyframe.places, keyframe.actors) is keyframe.places


@pytest.mark.parametrize(("name", "bed"), [("birch", "bed"), ("juniper", "bunk_bed"), ("maple", "couch")])
def test_no_two_things_of_a_full_bed_are_in_the_same_place(name, bed):
    more = ("blanket", "sheets", "pillow", "comforter")
    keyframes, place = rested(name, bed, more)
    found = list(bedding_of(keyframes[2], place).values())
    assert len(found) >= len(more)
    for number, one in enumerate(found):
        for other in found[:number]:
            apart = np.abs(np.subtract(one.box.center, other.box.center))
            assert (apart >= (np.add(one.box.size, other.box.size)) / 2 - 1e-6).any(), (one, other)


@pytest.fixture(scope="module", params=[("maple", "bed"), ("birch", "bed"), ("maple", "couch")])
def film(request):
    """Return the film of lying down and getting up, ten times a second; the bed's id; its trajectory."""
    trajectory, place = filmed(*request.param)
    return [frame for frame in frames(trajectory, 10.0) if frame.tick >= 2], place, trajectory


def test_in_a_film_bedding_is_moved_and_never_jumps(film):
    shown, place, trajectory = film
    bedding = bedding_of(trajectory.keyframes[2], place)
    ways = {number: [] for number in bedding}
    for frame in shown:
        for thing in (*frame.scene.things, *frame.scene.static.things):
            if thing.id in ways:
                ways[thing.id].append((*thing.position, *thing.model.look.size))
    for number, way in ways.items():
        assert len(way) == len(shown), "it is drawn once in each picture"
        steps = np.abs(np.diff(np.array(way), axis=0)).max(axis=1)
        assert steps.max() < 0.2, bedding[number].class_name


@pytest.mark.parametrize(
    ("name", "bed", "first"), [("birch", "bed", ()), ("larch", "bed", ()), ("birch", "couch", ("Sit",))]
)
def test_heads_and_hands_of_who_lies_down_and_gets_up_do_not_jump(name, bed, first):
    trajectory, _ = filmed(name, bed, first=first)
    shown = [frame.actors[0] for frame in frames(trajectory, 10.0) if frame.tick > len(first)]
    for joint in ("head", "palm_r", "palm_l"):
        way = np.array([actor.world(tuple(actor.figure().joints()[joint])) for actor in shown])
        assert np.linalg.norm(np.diff(way, 2, axis=0), axis=1).max() < 0.17, joint


def test_a_raised_hand_is_lowered_before_the_legs_are_swung_onto_the_bed(maple_bed):
    keyframes, place = maple_bed
    lying = keyframes[2].actors[0]
    edge_of = replace(lying, yaw=lying.yaw + 90.0, body_pose=BodyPose("sitting", 0.5, right=(0.4, 1.2, 0.3)))
    bed = Remade.between(keyframes[1].places, keyframes[2].places, place)
    shares = np.linspace(0.0, 1.0, 60)
    shown = [segment.at(share) for segment in lying_down(edge_of, lying, bed) for share in shares]
    way = np.array([actor.hand("right") for actor in shown])
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).max() < 0.08


def test_who_rises_from_the_floor_takes_the_hand_along_and_does_not_stoop_for_it(maple_bed):
    keyframes, _ = maple_bed
    actor = keyframes[1].actors[0]
    on_floor = replace(actor, place=7, body_pose=BodyPose("sitting", 0.05, right=(0.18, 0.36, 0.47)))
    bed = Remade.between(keyframes[1].places, keyframes[1].places, 7)
    segments = []
    up = _got_up(segments, on_floor, None, bed)
    shown = [segment.at(share) for segment in segments for share in np.linspace(0.0, 1.0, 60)]
    way = np.array([each.world(tuple(each.figure().joints()["head"])) for each in (*shown, up)])
    assert np.linalg.norm(np.diff(way, axis=0), axis=1).max() < 0.06


def test_hands_draw_the_blanket_over_the_legs_and_back(maple_bed):
    keyframes, _ = maple_bed
    for before, after in ((keyframes[1], keyframes[2]), (keyframes[2], keyframes[3])):
        (one,), (other,) = before.actors, after.actors
        motion = track(one, other, before, after, after.steps[0])
        laid = max((before, after), key=lambda each: each.actors[0].body_pose.posture == "lying")
        bedding = bedding_of(laid, one.place or other.place).values()
        (over,) = [each for each in bedding if each.box.size[1] > EMPTY and each.class_name == "blanket"]
        pose = laid.places.poses[over.id]
        times = np.arange(0.0, motion.seconds, 0.1)
        meanwhile = [(time, share) for time in times if 0.02 < (share := motion.done("cover", time)) < 0.98]
        assert len(meanwhile) >= 8
        for time, share in meanwhile:
            actor, at = motion.at(time), edge(drawn(pose, share))
            palms = [np.subtract(actor.hand(side), at) for side in ("right", "left")]
            assert max(np.linalg.norm(palm) for palm in palms) < 0.25, (time, share)


def test_no_leg_goes_through_the_bed(film):
    shown, place, trajectory = film
    (x, _, z), (w, _, d) = trajectory.keyframes[2].places.poses[place].box
    actor = trajectory.keyframes[2].actors[0]
    top = actor.level + actor.body_pose.seat
    for frame in shown:
        person = frame.actors[0]
        joints = person.figure().joints()
        for name in ("knee_r", "knee_l", "ankle_r", "ankle_l", "toe_r", "toe_l"):
            px, py, pz = person.world(tuple(joints[name]))
            inside = abs(px - x) < w / 2 - 0.12 and abs(pz - z) < d / 2 - 0.12
            assert not inside or py > top - 0.03, (frame.time, name)


def test_who_gets_up_stands_beside_the_bed(film):
    shown, _, trajectory = film
    up = trajectory.keyframes[3].actors[0]
    lying = trajectory.keyframes[2].actors[0]
    assert up.body_pose.posture == "standing"
    stood = [frame.actors[0] for frame in shown if frame.tick == 3 and frame.actors[0].body_pose.posture == "standing"]
    assert np.hypot(*np.subtract(stood[0].spot, up.spot)) < 0.5, "no walk around the bed"
    away = np.subtract(up.spot, lying.spot)
    assert np.cos(np.radians(up.yaw) - np.arctan2(*away)) > 0.9, "with the back to it"


@pytest.mark.parametrize(("name", "couch"), [("maple", "couch"), ("larch", "couch"), ("birch", "couch")])
def test_nobody_climbs_over_the_back_of_a_couch(name, couch):
    trajectory, place = filmed(name, couch)
    pose = trajectory.keyframes[2].places.poses[place]
    front = np.sin(np.radians(pose.yaw)), np.cos(np.radians(pose.yaw))
    for frame in (frame for frame in frames(trajectory, 10.0) if frame.tick >= 2):
        (actor,) = frame.actors
        ahead = np.dot(np.subtract(actor.spot, (pose.box.center[0], pose.box.center[2])), front)
        if actor.body_pose.posture != "standing":
            assert ahead > -0.2, frame.time
    assert ahead > 0.3, "one stands in front of it"


def test_a_blanket_over_legs_is_highest_over_the_feet_and_an_empty_one_is_even():
    over = drape(0.84, 0.32, 1.0, Paint("#808080"), Paint("#ffffff"))
    points = over.corners.reshape(-1, 3)
    low, high = over.bounds()
    assert low[1] == pytest.approx(0.0, abs=1e-6) and 0.29 < high[1] <= 0.335
    assert points[points[:, 1].argmax(), 2] > 0.25
    assert (over.normals[..., 1] > -1e-3).all()
    middle = drape(0.84, EMPTY, OPENED, Paint("#808080"), Paint("#ffffff")).corners.reshape(-1, 3)
    middle = middle[(abs(middle[:, 0]) < 0.35) & (abs(middle[:, 2] - 0.02) < 0.06)]
    assert np.ptp(middle[:, 1]) < 0.02
