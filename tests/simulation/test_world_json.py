"""A world can be put down and taken up again in the middle of an execution."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import act
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.simulation.world.world_json import export, restore

GRAPH = EnvironmentGraph(
    (
        Node(1, "kitchen", "Rooms"),
        Node(2, "character", "Characters"),
        Node(3, "cup", "Props", ("GRABBABLE",), ("DIRTY",)),
        Node(4, "book", "Props", ("GRABBABLE", "READABLE")),
        Node(5, "table", "Furniture", ("SURFACES",)),
        Node(6, "chair", "Furniture", ("SITTABLE",)),
        Node(7, "cabinet", "Furniture", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
    ),
    (
        Edge(2, "INSIDE", 1),
        *(Edge(i, "INSIDE", 1) for i in range(3, 8)),
        Edge(3, "INSIDE", 7),
        Edge(4, "ON", 5),
        Edge(6, "FACING", 5),
    ),
)
ACTIONS = ["Walk", "Find", "Grab", "PutBack", "PutIn", "PutObjBack", "Open", "Close", "Wash", "Drop", "Sit", "StandUp"]
PLAN = st.lists(st.tuples(st.sampled_from(ACTIONS), st.integers(3, 7), st.integers(3, 7)), max_size=25)


def instruction(action, first, second):
    nodes = {"PutBack": (first, second), "PutIn": (first, second), "StandUp": ()}.get(action, (first,))
    return Step(action, tuple(ObjectRef("thing", 1, node) for node in nodes))


@given(PLAN, PLAN)
def test_an_execution_goes_on_after_a_snapshot_as_if_there_had_been_none(before, after):
    world = World.start(Home.from_graph(GRAPH, "kitchen", default()))
    for entry in before:
        result = act(world, instruction(*entry))
        world = world if isinstance(result, Failure) else result
    copy = restore(json.loads(json.dumps(export(world))), default())
    assert not world.changes(copy)
    for entry in after:
        one, other = act(world, instruction(*entry)), act(copy, instruction(*entry))
        if isinstance(one, Failure) or isinstance(other, Failure):
            assert one == other
            continue
        world, copy = one, other
        assert not world.changes(copy)


def test_where_a_thing_came_from_is_kept():
    world = World.start(Home.from_graph(GRAPH, "kitchen", default()))
    for action in ("Walk", "Grab"):
        world = act(world, instruction(action, 4, 0))
    assert export(world)["memories"] == [{"agent": 2, "thing": 4, "place": 5, "relation": "ON"}]
    back = act(restore(export(world), default()), instruction("PutObjBack", 4, 0))
    assert Edge(4, "ON", 5) in back.edges()


@pytest.mark.parametrize("data", [{}, {"graph": 3}, {"graph": {"nodes": [], "edges": []}, "memories": [{"agent": 9}]}])
def test_what_is_no_world_is_refused(data):
    with pytest.raises(HearthError) as caught:
        restore(data, default())
    assert caught.value.diagnostics[0].code is Code.BAD_GRAPH
