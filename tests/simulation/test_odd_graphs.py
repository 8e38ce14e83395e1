"""Graphs that are odd: each oddity has a rule (`building`), or is refused as BAD_GRAPH."""

from __future__ import annotations

import random

import pytest
from small_worlds import bound_step, node, random_graph

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, to_release
from hearth.simulation.actions.legal import legal
from hearth.simulation.actions.registry import ACTIONS
from hearth.simulation.engine import act
from hearth.simulation.observation.views import view
from hearth.simulation.rules import DEFAULT, REPLAY
from hearth.simulation.world import home_building
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

BASE = (node(1, "kitchen"), node(2, "bedroom"), node(3, "character"), node(4, "cup"), node(5, "fridge"))


def world(*edges: tuple[int, str, int], nodes=BASE, way: str = "graph") -> World:
    graph = EnvironmentGraph(tuple(nodes), tuple(Edge(*e) for e in edges))
    home = (
        Home.from_graph(graph, "", default()) if way == "graph" else Home.from_release(to_release(graph), "", default())
    )
    return World.start(home)


def do(world: World, action: str, *ids: int) -> World | Failure:
    return act(world, bound_step(action, [world.home.node(world.home.index[i]) for i in ids]))


def edges(world: World) -> set[tuple[int, str, int]]:
    return {tuple(e) for e in world.edges()}


@pytest.mark.parametrize("way", ["graph", "release"])
def test_of_several_rooms_the_lowest_id_counts(way):
    w = world((4, "INSIDE", 2), (4, "INSIDE", 1), (3, "INSIDE", 2), way=way)
    assert (3, "INSIDE", 1) in edges(do(w, "Walk", 4))


def test_of_several_containers_any_closed_one_hides():
    nodes = (*BASE[:4], node(5, "fridge", states=["OPEN"]), node(6, "box", properties=["CAN_OPEN"], states=["CLOSED"]))
    w = world((4, "INSIDE", 5), (4, "INSIDE", 6), (4, "INSIDE", 1), (3, "CLOSE", 4), nodes=nodes)
    failure = do(w, "Grab", 4)
    assert (failure.code, failure.objects) == (Code.INSIDE_CLOSED, (4, 6))


@pytest.mark.parametrize("circle", [[(4, 5), (5, 4)], [(4, 4)], [(4, 5), (5, 6), (6, 4)]])
def test_a_circle_of_inside_is_in_no_room_unless_one_is_on_the_way(circle):
    nodes = (*BASE, node(6, "plate"))
    loops = [(a, "INSIDE", b) for a, b in circle]
    assert do(world(*loops, nodes=nodes), "Walk", 4).code is Code.NO_ROOM
    out = do(world(*loops, (circle[-1][0], "INSIDE", 2), nodes=nodes), "Walk", 4)
    assert (3, "INSIDE", 2) in edges(out)
    assert len(legal(out)) == len(list(legal(out)))


def test_the_character_may_be_in_a_circle_too():
    w = world((3, "INSIDE", 4), (4, "INSIDE", 3))
    assert do(w, "Walk", 4).code is Code.NO_ROOM
    assert (3, "INSIDE", 1) in edges(do(w, "Walk", 1))


def test_without_states_nothing_is_open_or_closed_on_or_off():
    w = world((3, "CLOSE", 5))
    assert do(w, "Open", 5).code is Code.NOT_OPENABLE_STATE
    assert do(w, "Close", 5).code is Code.NOT_OPENABLE_STATE
    assert do(w, "SwitchOn", 5).code is Code.IS_ON
    assert do(w, "SwitchOn", 5).actual == "neither OFF nor ON"


def test_missing_and_unknown_categories_properties_and_states_do_no_harm():
    data = {
        "nodes": [
            {"id": 1, "class_name": "kitchen", "category": "Rooms"},
            {"id": 2, "class_name": "gadget", "category": "Nonsense", "properties": ["SHINY"], "states": ["FREE"]},
            {"id": 3, "class_name": "character", "properties": None, "states": None, "category": None},
        ],
        "edges": [{"from_id": 2, "relation_type": "INSIDE", "to_id": 1}],
    }
    w = World.start(Home.from_release(data, "", default()))
    shown = w.graph().node(2)
    assert (shown.category, shown.properties, shown.states) == ("Nonsense", ("SHINY",), ("FREE",))
    assert isinstance(do(w, "Walk", 2), World)
    assert w.graph().node(3).states == ()


def test_of_states_that_exclude_each_other_the_first_holds():
    w = world(nodes=(*BASE[:4], node(5, "fridge", states=["OPEN", "CLOSED", "OFF", "ON"])))
    assert w.graph().node(5).states == ("OPEN", "OFF")


def test_an_edge_said_twice_stands_once_and_close_both_ways():
    w = world((4, "ON", 5), (4, "ON", 5), (4, "CLOSE", 5), (3, "CLOSE", 4))
    assert sorted(edges(w)) == [(3, "CLOSE", 4), (4, "CLOSE", 3), (4, "CLOSE", 5), (4, "ON", 5), (5, "CLOSE", 4)]


def test_edges_to_missing_nodes_are_left_out():
    w = world((4, "ON", 99), (99, "CLOSE", 3), (98, "INSIDE", 99), (4, "WEARS", 99))
    assert edges(w) == set()


def test_relations_that_are_none_are_kept_for_printing():
    w = world((4, "WEARS", 5), (3, "SITTING", 5), (4, "HOLDS_RH", 5))
    assert edges(w) == {(4, "WEARS", 5), (3, "SITTING", 5), (4, "HOLDS_RH", 5)}
    assert w.holding() == {0: ()}


def test_a_door_between_one_room_leads_nowhere():
    door = node(6, "door", properties=["CAN_OPEN"], states=["CLOSED"])
    w = world((3, "INSIDE", 1), (6, "BETWEEN", 1), nodes=(*BASE, door))
    assert (3, "INSIDE", 2) in edges(do(w, "Walk", 2))
    assert (3, "INSIDE", 1) in edges(do(w, "Walk", 6))


def test_a_thing_held_by_two_is_held_by_the_lower_id():
    nodes = (*BASE, node(6, "character"))
    w = world((6, "HOLDS_RH", 4), (3, "HOLDS_LH", 4), (6, "HOLDS_LH", 5), nodes=nodes)
    assert w.holding() == {0: (4,), 1: (5,)}
    assert edges(w) == {(3, "HOLDS_LH", 4), (6, "HOLDS_LH", 5)}


def test_one_hand_may_hold_several_things():
    w = world((3, "HOLDS_RH", 4), (3, "HOLDS_RH", 5), (3, "INSIDE", 1))
    assert w.holding() == {0: (4, 5)}
    assert do(w, "Drop", 4).holding() == {0: (5,)}


def test_characters_cannot_be_grabbed_worn_sat_on_or_filled_whatever_they_are_said_to_be():
    able = ["GRABBABLE", "CLOTHES", "SITTABLE", "LIEABLE", "RECIPIENT", "PERSON"]
    nodes = (*BASE[:3], node(4, "character", properties=able))
    w = world((3, "CLOSE", 4), nodes=nodes)
    for action in ("Grab", "Sit", "Lie"):
        assert do(w, action, 4).code is Code.NOT_AFFORDED
    assert isinstance(do(w, "Greet", 4), World)
    assert w.graph().node(4).properties == tuple(able)


def test_without_characters_there_is_nobody_to_act():
    w = world(nodes=BASE[:2])
    assert do(w, "Walk", 1).code is Code.UNKNOWN_AGENT


def test_without_rooms_nobody_can_walk():
    nodes = (node(3, "character"), node(4, "cup"))
    w = world((3, "CLOSE", 4), nodes=nodes)
    assert do(w, "Walk", 4).code is Code.NO_ROOM
    held = do(w, "Grab", 4)
    assert edges(held) == {(3, "CLOSE", 4), (4, "CLOSE", 3), (3, "HOLDS_RH", 4)}
    assert edges(do(held, "Drop", 4)) == {(3, "CLOSE", 4), (4, "CLOSE", 3)}


def test_a_home_of_nothing_is_a_home():
    assert World.start(Home.from_graph(EnvironmentGraph(), "", default())).graph() == EnvironmentGraph()


NODE = {"id": 1, "class_name": "kitchen", "category": "Rooms", "properties": [], "states": []}
BAD = {
    "nothing": None,
    "a list": [],
    "no nodes": {"edges": []},
    "no edges": {"nodes": []},
    "nodes that are none": {"nodes": [1, 2], "edges": []},
    "no id": {"nodes": [{"class_name": "kitchen"}], "edges": []},
    "no class": {"nodes": [{"id": 1}], "edges": []},
    "an id of text": {"nodes": [{**NODE, "id": "1"}], "edges": []},
    "an id that is true": {"nodes": [{**NODE, "id": True}], "edges": []},
    "ids of two kinds": {"nodes": [NODE, {**NODE, "id": "2"}], "edges": []},
    "an id of nothing": {"nodes": [{**NODE, "id": None}], "edges": []},
    "a class that is a number": {"nodes": [{**NODE, "class_name": 7}], "edges": []},
    "one id twice": {"nodes": [NODE, NODE], "edges": []},
    "properties that are a number": {"nodes": [{**NODE, "properties": 7}], "edges": []},
    "states that are lists": {"nodes": [{**NODE, "states": [["ON"]]}], "edges": []},
    "an edge without relation": {"nodes": [NODE], "edges": [{"from_id": 1, "to_id": 1}]},
    "edges that are none": {"nodes": [NODE], "edges": [3]},
    "a relation that is a list": {"nodes": [NODE], "edges": [{"from_id": 1, "to_id": 1, "relation_type": []}]},
    "an end that is a list": {"nodes": [NODE], "edges": [{"from_id": [], "to_id": 1, "relation_type": "ON"}]},
}


@pytest.mark.parametrize("data", BAD.values(), ids=BAD)
def test_what_is_no_graph_is_refused_as_such(data):
    with pytest.raises(HearthError, match="BAD_GRAPH"):
        Home.from_release(data, "", default())


@pytest.mark.parametrize("end", ["1", 1.5, None, -7, 10**30])
def test_an_edge_with_an_end_that_is_no_node_is_left_out(end):
    edge = {"from_id": end, "relation_type": "ON", "to_id": 1}
    assert World.start(Home.from_release({"nodes": [NODE], "edges": [edge]}, "", default())).edges() == []


@pytest.mark.parametrize("seed", range(30))
def test_large_and_small_homes_are_read_alike(seed, monkeypatch):
    graph = random_graph(random.Random(seed), characters=1 + seed % 3)
    spread = {n.id: n.id * (1 if seed % 2 else 100_000) - seed for n in graph.nodes}
    nodes = tuple(node(spread[n.id], n.class_name, n.category, n.properties, n.states) for n in graph.nodes)
    extra = (Edge(1, "HOLDS_LH", 1), Edge(1, "LIKES", spread[1]), Edge(spread[1], "LIKES", spread[1]))
    moved = tuple(Edge(spread[a], r, spread[b]) for a, r, b in graph.edges) + extra
    small = Home.from_graph(EnvironmentGraph(nodes, moved), "", default())
    monkeypatch.setattr(home_building, "LARGEST_MATRIX", 0)
    large = Home.from_graph(EnvironmentGraph(nodes, moved), "", default())
    assert small.rows == large.rows
    assert (small.agent_rows, small.others, small.states) == (large.agent_rows, large.others, large.states)


@pytest.mark.parametrize("seed", range(60))
def test_nothing_odd_gets_through_to_the_actions(seed):
    """Any action of any node of a home full of oddities gives a world or a failure."""
    rng = random.Random(seed)
    graph = random_graph(rng, things=6, characters=rng.randint(0, 3))
    ids = [n.id for n in graph.nodes]
    odd = [
        Edge(rng.choice(ids), rng.choice(["ON", "INSIDE", "BETWEEN", "HOLDS_RH", "FACING", "CLOSE"]), rng.choice(ids))
        for _ in range(25)
    ]
    w = World.start(Home.from_graph(EnvironmentGraph(graph.nodes, graph.edges + tuple(odd)), "", default()))
    for _ in range(150):
        action = rng.choice(sorted(ACTIONS))
        arity = len(w.home.knowledge.actions[action].needs)
        step = bound_step(action, [rng.choice(graph.nodes) for _ in range(arity)], rng.randint(0, 2))
        result = act(w, step, rng.choice((DEFAULT, REPLAY)))
        w = result if isinstance(result, World) else w
    assert w.changes(World.start(w.home)) is not None
    assert w.graph() == World.start(Home.from_graph(w.graph(), "", default())).graph()
    assert all(len(legal(w, number)) >= 0 for number in range(len(w.agents)))


@pytest.mark.parametrize("number", [0, 7, -1])
@pytest.mark.parametrize(
    "ask", [legal, lambda w, n: legal(w, n, only_visible=True), view, lambda w, n: view(w, n, partial=False)]
)
def test_who_is_not_in_the_world_is_refused_with_a_code(ask, number):
    w = world(nodes=BASE[:2]) if number == 0 else world()
    with pytest.raises(HearthError, match=rf"no agent {number}; there are \d, from 0") as caught:
        ask(w, number)
    assert caught.value.diagnostics[0].code is Code.UNKNOWN_AGENT and caught.value.diagnostics[0].suggestion
