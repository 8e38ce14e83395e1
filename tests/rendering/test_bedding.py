"""Bedding makes way for who lies in the bed: a pillow under the head, a blanket over the legs, the rest aside."""

import numpy as np
import pytest

from hearth.grounding.trial import attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.film.snapshots import trajectory_of
from hearth.rendering.people.bedding import FLAT, SPREAD, turned_back
from hearth.rendering.scene.prepared import local_size
from hearth.schemas.graph import Edge, Node
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.world.edit import extended
from hearth.simulation.world.home import Home

KNOWN = default()
BEDDING = ("pillow", "blanket", "comforter", "sheets")


def rested(name, bed, more=(), last="StandUp"):
    """The keyframes of lying down in a bed and getting up, with more bedding on the bed."""
    graph = library.load_graph(name, KNOWN)
    home = Home.from_graph(graph, name, KNOWN)
    (place, *_) = [node.id for node in graph.nodes if node.class_name == bed]
    nodes = [Node(2000 + n, each, "Props", ("GRABBABLE", "MOVABLE")) for n, each in enumerate(more)]
    home = extended(home, nodes, [Edge(node.id, "ON", place) for node in nodes])
    seat = ObjectRef(bed, 1, place)
    steps = (Step("Walk", (seat,)), Step("Lie", (seat,)), Step(last))
    execution = attempt(Program("Rest", steps=steps), home, 0, default_state=False, add=False).execution
    assert execution.executable
    return trajectory_of(execution, graph, KNOWN).keyframes, place


def bedding_of(keyframe, place):
    places = keyframe.places
    nodes = [node for node in places.nodes() if node.class_name in BEDDING and node.box]
    return {node.id: node for node in nodes if places.locations[node.id].holder == place}


def holds(node, point, spare=0.0):
    """Whether a point of the world is over the box of a node, and not above it."""
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


def test_the_bed_is_as_it_was_before_and_flat_after(maple_bed):
    keyframes, place = maple_bed
    before, lying, after = (bedding_of(keyframes[tick], place) for tick in (1, 2, 3))
    assert before == bedding_of(keyframes[0], place) and before != lying
    spread = [node for node in lying.values() if local_size(node.box.size, node.yaw)[2] >= SPREAD]
    assert [node.class_name for node in spread] == ["blanket"]
    flat = after[spread[0].id]
    assert flat.box.size[1] == pytest.approx(FLAT) and flat.box.size[::2] == spread[0].box.size[::2]
    assert flat.box.center[1] - FLAT / 2 == pytest.approx(spread[0].box.center[1] - spread[0].box.size[1] / 2)
    others = lying.keys() - {flat.id}
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
