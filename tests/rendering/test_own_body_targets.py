"""Hands at one's own body: garments are put on where they are worn, body parts are washed where they are."""

from dataclasses import replace

import numpy as np
import pytest

from hearth.kb.loading.load import default
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.body_pose import STILL, BodyPose
from hearth.rendering.people.gestures import gesture_of
from hearth.rendering.people.hand_gestures import TEETH, gesturing
from hearth.rendering.people.own_body_targets import CHEST, PLACE_OF, PLACES
from hearth.rendering.people.palm_targets import with_aims
from hearth.rendering.people.random_people import person
from hearth.rendering.scene.object_boxes import Places
from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Step

ME = Node(1, "character", "Characters", (), (), None)
SOAP = Node(3, "soap", "Props", ("GRABBABLE",), (), None)


def joints(action, class_name, pose=STILL, held=None, seed=3, other=SOAP):
    """The joints of somebody whose hands are where a step has them."""
    actor = Actor(ME, person(seed), (0.0, 0.0), 0.0, 0.0, pose, 0)
    graph = EnvironmentGraph((ME, other, Node(2, class_name, "Props", (), (), None)), ())
    places, step = Places(graph, {}, {}, default()), Step(action, (ObjectRef(class_name, 1, 2),))
    aims = gesturing(gesture_of(step), actor, held or {}, graph, places, step)
    return aims, replace(actor, body_pose=with_aims(pose, aims)).figure().joints()


def far(found, one, other):
    return float(np.linalg.norm(found[one] - found[other]))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("posture", "most"), [(STILL, 0.2), (BodyPose("sitting", 0.45), 0.32)])
def test_shoes_are_put_on_at_a_foot(posture, most, seed):
    _, found = joints("PutOn", "shoes", posture, seed=seed)
    assert max(far(found, f"palm_{side}", "ankle_r") for side in "rl") < most


@pytest.mark.parametrize(
    ("action", "class_name", "joint", "most"),
    [
        ("PutOn", "clothes_hat", "head", 0.2),
        ("PutOff", "spectacles", "face", 0.15),
        ("PutOn", "tie", "neck", 0.22),
        ("PutOn", "belt", "pelvis", 0.26),
        ("Wash", "face", "face", 0.15),
        ("Scrub", "hair", "head", 0.2),
        ("Wash", "legs_both", "knee_r", 0.2),
        ("Touch", "hands_left", "palm_l", 0.15),
    ],
)
def test_hands_are_where_the_body_is_dressed_or_washed(action, class_name, joint, most):
    _, found = joints(action, class_name)
    assert far(found, "palm_r", joint) < most


def test_hands_are_washed_together():
    _, found = joints("Wash", "hands_both")
    assert far(found, "palm_r", "palm_l") < 0.12


def test_teeth_are_brushed_at_the_mouth():
    aims, found = joints("Scrub", TEETH)
    assert [*aims] == ["right"]
    assert far(found, "palm_r", "face") < 0.15


def test_a_hand_that_holds_something_keeps_it():
    aims, _ = joints("Wash", "face", held={"left": 3}, other=replace(SOAP, class_name="plate"))
    assert [*aims] == ["right"]
    aims, _ = joints("Wash", "face", held={"right": 3})
    assert aims["right"].hand.grip != "flat"


@pytest.mark.parametrize(("class_name", "acting"), [("soap", "right"), ("towel", "right"), ("plate", "left")])
def test_the_hand_with_a_tool_washes(class_name, acting):
    aims, _ = joints("Wash", "face", held={"right": 3}, other=replace(SOAP, class_name=class_name))
    assert next(iter(aims)) == acting


def test_every_garment_and_part_of_the_body_has_a_place():
    """Those not listed are worn on the chest, or are no garment of their own."""
    objects = default().objects
    known = {one.name for one in objects.values() if {"CLOTHES", "BODY_PART"} & {*one.properties}}
    chest = {"clothes_dress", "clothes_jacket", "clothes_pile", "clothes_shirt", "pajamas"}
    assert known - {*PLACE_OF} == chest | {TEETH}
    assert {*PLACE_OF} <= known
    assert {*PLACE_OF.values()} | {CHEST} == {*PLACES}
