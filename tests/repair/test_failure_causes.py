"""The cause of a failure: the perturbation that settles it, and none where that is unclear."""

from __future__ import annotations

import pytest

from hearth.grounding.preconditions.conditions import Condition
from hearth.repair.failure_causes import MATTERS, cause
from hearth.repair.perturbation import _MATTER, Perturbation
from hearth.repair.repair_loop import Attempt
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import CHARACTER, Literal
from hearth.schemas.program import ObjectRef, Program, Step

FRIDGE, MILK, SOFA = (("fridge", 1), 10), (("milk", 1), 11), (("sofa", 1), 12)
PROGRAM = Program(steps=tuple(Step("Find", (ObjectRef(*key, node),)) for key, node in (FRIDGE, MILK, SOFA)))


def condition(name, *keys):
    return Condition(Literal(name, keys), 0)


CONTAINER = Perturbation(
    "container",
    (condition("inside", MILK[0], FRIDGE[0]),),
    (condition("in_closed_container", MILK[0], FRIDGE[0]),),
)
OPEN = Perturbation("open", (condition("open", FRIDGE[0]),), (condition("closed", FRIDGE[0]),))
SEATED = Perturbation("seated", (), (condition("sitting", CHARACTER),))
DOOR = Perturbation("door", (), (condition("doors_closed", ("kitchen", 1)),))
SEAT = Perturbation("free", (condition("free", SOFA[0]),), (condition("occupied", SOFA[0]),))
DIRTY = Perturbation("dirty", (), (condition("dirty", MILK[0]),))


def failed(code, *nodes, missed=()):
    return Attempt(0, 0, Failure(code, objects=nodes), "", (), (), missed)


@pytest.mark.parametrize(
    ("attempt", "expected"),
    [
        (failed(Code.INSIDE_CLOSED, 11, 10), CONTAINER),
        (failed(Code.IS_CLOSED, 10), OPEN),
        (failed(Code.SITTING), SEATED),
        (failed(Code.DOOR_CLOSED, 99), DOOR),
        (failed(Code.OCCUPIED, 12), SEAT),
        (failed(Code.NOT_CLOSE, 12), SEAT),  # the only one about the sofa
        (failed(Code.GOAL_LOST, missed=(Literal("CLEAN", (SOFA[0],)),)), SEAT),
        (failed(Code.NO_FREE_HAND, 99), None),
    ],
)
def test_the_one_that_settles_what_fails(attempt, expected):
    every = (CONTAINER, OPEN, SEATED, DOOR, SEAT)
    found = cause(every, attempt, PROGRAM)
    assert (found is not None and every[found]) == (expected or False)


def test_two_about_one_object_are_not_told_apart_by_it():
    assert cause((CONTAINER, DIRTY), failed(Code.NOT_FACING, 11), PROGRAM) is None


def test_the_only_one_caused_it_by_whatever_way():
    assert cause((DIRTY,), failed(Code.NO_PATH), PROGRAM) == 0


def test_matters_are_those_of_perturbations():
    assert {*MATTERS.values()} <= {*_MATTER.values(), "place"}
