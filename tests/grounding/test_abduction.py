"""Conditions abduced from one failure: what the program itself has brought about needs no condition on the start."""

from __future__ import annotations

import pytest

from hearth.grounding.preconditions.abduction import StartContext, conditions_for
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

FRIDGE, TABLE, CUP, PERSON = 2, 3, 4, 5


def world(knowledge, cup_on: int, fridge: str) -> World:
    nodes = (
        Node(1, "kitchen", "Rooms"),
        Node(FRIDGE, "fridge", "Appliances", ("CAN_OPEN", "CONTAINERS"), (fridge,)),
        Node(TABLE, "table", "Furniture", ("SURFACES",)),
        Node(CUP, "cup", "Props", ("GRABBABLE", "MOVABLE")),
        Node(PERSON, "character", "Characters"),
    )
    edges = [Edge(number, "INSIDE", 1) for number in (FRIDGE, TABLE, CUP, PERSON)]
    edges += [Edge(CUP, "ON", cup_on)] if cup_on else []
    return World.start(Home.from_graph(EnvironmentGraph(nodes, tuple(edges)), "", knowledge))


def ref(name: str, node: int) -> ObjectRef:
    return ObjectRef(name, 1, node)


def abduced(knowledge, code: Code, action: str, node: int, now: World, start: World) -> list[str]:
    keys = {FRIDGE: ("fridge", 1), TABLE: ("table", 1), CUP: ("cup", 1), PERSON: ("character", 1)}
    name = keys[node][0]
    steps = (Step("Find", (ref("fridge", FRIDGE),)), Step("StandUp", ()), Step(action, (ref(name, node),)))
    failure = Failure(code, 0, 0, action, (node,), (name,), "", "")
    context = StartContext(Program("", "", steps), 2, failure, now, knowledge, start, keys)
    return [str(condition) for condition in conditions_for(context)]


@pytest.mark.parametrize(
    ("code", "wanted", "opposite"), [(Code.IS_OPEN, "closed", "OPEN"), (Code.IS_CLOSED, "open", "CLOSED")]
)
def test_a_state_helps_only_where_the_program_has_not_changed_it(knowledge, code, wanted, opposite):
    same = world(knowledge, 0, opposite)
    other = world(knowledge, 0, "CLOSED" if opposite == "OPEN" else "OPEN")
    assert abduced(knowledge, code, "Open", FRIDGE, same, same) == [f"{wanted}(fridge (1))"]
    assert abduced(knowledge, code, "Open", FRIDGE, same, other) == []


def test_what_was_put_down_was_looked_for_near_its_place(knowledge):
    put, lying = world(knowledge, TABLE, "CLOSED"), world(knowledge, 0, "CLOSED")
    near = "atreach(fridge (1), table (1))"
    assert near in abduced(knowledge, Code.NOT_CLOSE, "Drink", CUP, put, lying)
    assert near not in abduced(knowledge, Code.NOT_CLOSE, "Drink", CUP, put, put)
    assert near not in abduced(knowledge, Code.NOT_CLOSE, "Drink", CUP, lying, lying)
