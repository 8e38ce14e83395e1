from __future__ import annotations

import pytest

from hearth.schemas.errors import HearthError
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.simulation.edit import added_nodes, extended
from hearth.simulation.home import Home
from hearth.simulation.world import World


def node(node_id: int, name: str, category: str = "Props", properties=(), states=()) -> Node:
    return Node(node_id, name, category, tuple(properties), tuple(states))


def kitchen() -> Home:
    nodes = (
        node(1, "kitchen", "Rooms"),
        node(2, "bedroom", "Rooms"),
        node(3, "character", "Characters"),
        node(4, "table", "Furniture", ["SURFACES"], ["CLEAN"]),
        node(5, "cup", properties=["GRABBABLE", "RECIPIENT"], states=["CLEAN"]),
        node(6, "lamp", properties=["HAS_SWITCH"], states=["OFF", "FREE"]),
        node(7, "door", "Doors", ["CAN_OPEN"], ["OPEN"]),
    )
    edges = (
        Edge(3, "INSIDE", 1), Edge(4, "INSIDE", 1), Edge(5, "ON", 4), Edge(5, "INSIDE", 1), Edge(5, "CLOSE", 4),
        Edge(4, "CLOSE", 5), Edge(3, "CLOSE", 4), Edge(4, "CLOSE", 3), Edge(4, "FACING", 6), Edge(6, "INSIDE", 2),
        Edge(7, "BETWEEN", 1), Edge(7, "BETWEEN", 2), Edge(5, "MADE_BY", 6),
    )  # fmt: skip
    return Home.from_graph(EnvironmentGraph(nodes, edges), "kitchen")


ADDED = (
    node(1000, "plate", properties=["GRABBABLE"], states=["DIRTY"]),
    node(2000, "character", "Characters", ["PERSON"], ["SITTING"]),
)
EDGES = (
    Edge(1000, "ON", 4), Edge(1000, "INSIDE", 1), Edge(1000, "CLOSE", 4), Edge(3, "CLOSE", 1000),
    Edge(2000, "INSIDE", 2), Edge(2000, "CLOSE", 3), Edge(2000, "HOLDS_RH", 1000), Edge(1000, "FACING", 2000),
    Edge(6, "MADE_BY", 5),
)  # fmt: skip
REMOVED = (
    Edge(5, "ON", 4), Edge(4, "CLOSE", 5), Edge(3, "INSIDE", 1), Edge(7, "BETWEEN", 2), Edge(5, "MADE_BY", 6),
    Edge(4, "FACING", 6),
)  # fmt: skip
STATES = {4: ["DIRTY"], 6: ["ON"], 3: ["LYING"]}


def by_hand(home: Home) -> EnvironmentGraph:
    """The same done to the graph, edge by edge."""
    graph = World.start(home).graph()
    gone = {(e.source, e.relation, e.target) for e in REMOVED} | {(5, "CLOSE", 4)}
    new = {*EDGES, Edge(4, "CLOSE", 1000), Edge(1000, "CLOSE", 3), Edge(3, "CLOSE", 2000)}
    edges = {e for e in graph.edges if tuple(e) not in gone} | new
    changed = {4: ("DIRTY",), 6: ("FREE", "ON"), 3: ("LYING",)}
    nodes = [
        Node(n.id, n.class_name, n.category, n.properties, changed.get(n.id, n.states)) for n in (*graph.nodes, *ADDED)
    ]
    return EnvironmentGraph(tuple(nodes), tuple(sorted(edges)))


def test_an_extended_home_is_the_home_of_the_extended_graph():
    home = kitchen()
    before = World.start(home).graph()
    new = extended(home, ADDED, EDGES, REMOVED, STATES)
    assert World.start(new).graph() == by_hand(home)
    fresh = Home.from_graph(by_hand(home))
    for name in ("ids", "classes", "by_class", "properties", "rooms", "states", "agents", "agent_rows", "index"):
        assert getattr(new, name) == getattr(fresh, name), name
    assert new.rows == fresh.rows
    assert new.near == fresh.near
    assert [new.able(a) for a in ("Grab", "Open", "Walk")] == [fresh.able(a) for a in ("Grab", "Open", "Walk")]
    assert World.start(home).graph() == before
    assert added_nodes(home, new) == ADDED
    assert new.node(5).states == ("FREE", "ON")


def test_changes_between_a_home_and_one_derived_from_it_rebuild_the_graph():
    home = kitchen()
    start = World.start(home)
    after = World.start(extended(home, ADDED, EDGES, REMOVED, STATES))
    again = World.start(Home.from_graph(by_hand(home)))
    change = after.changes(start)
    assert change == again.changes(start)
    edges = (set(start.edges()) | set(change.added)) - set(change.removed)
    assert edges == set(after.edges())
    states = {(n.id, s) for n in start.graph().nodes for s in n.states}
    states = (states | set(change.set_states)) - set(change.cleared_states)
    assert states == {(n.id, s) for n in after.graph().nodes for s in n.states}
    back = start.changes(after)
    assert (back.added, back.removed) == (change.removed, change.added)


def test_ids_below_the_homes_own_are_put_in_order():
    home = extended(kitchen(), [node(2000, "bowl")])
    new = extended(home, ADDED[:1], EDGES[:4], [Edge(5, "ON", 4)], {5: ["DIRTY"]})
    fresh = Home.from_graph(World.start(new).graph())
    assert new.ids == [1, 2, 3, 4, 5, 6, 7, 1000, 2000]
    assert new.rows == fresh.rows
    assert new.states == fresh.states


@pytest.mark.parametrize(
    "arguments",
    [
        ([node(5, "cup")],),
        ([node(9, "cup"), node(9, "cup")],),
        ((), [Edge(5, "ON", 99)]),
        ((), (), [Edge(99, "ON", 5)]),
        ((), (), (), {99: ["ON"]}),
    ],
)
def test_what_is_not_there_or_there_twice_is_refused(arguments):
    with pytest.raises(HearthError, match="BAD_GRAPH"):
        extended(kitchen(), *arguments)
