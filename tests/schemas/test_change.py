"""A change between two graphs, made again, gives the later graph; one after the other and all together."""

from dataclasses import replace
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.graph_change import Change, WorkingGraph, apply, compose, encode, in_states
from hearth.schemas.vocabulary import RELATIONS, STATES

IDS = range(1, 7)
NODES = st.builds(
    Node,
    st.just(0),
    st.sampled_from(["cup", "table", "character", "kitchen"]),
    st.sampled_from(["", "Props"]),
    st.sampled_from([(), ("GRABBABLE",)]),
    st.lists(st.sampled_from([*STATES[:4], "POLISHED", "BENT"]), unique=True).map(tuple),
    st.sampled_from([None, "mug_02"]),
    st.sampled_from([None, Box((0.0, 1.0, 0.0), (0.5, 0.5, 0.5))]),
    st.sampled_from([None, 90.0]),
)
EDGES = st.builds(Edge, st.sampled_from(IDS), st.sampled_from([*RELATIONS[:4], "BESIDE"]), st.sampled_from(IDS))


@st.composite
def graphs(draw, ids=None):
    ids = draw(st.sets(st.sampled_from(IDS))) if ids is None else ids
    nodes = tuple(replace(draw(NODES), id=node_id) for node_id in draw(st.permutations(sorted(ids))))
    there = {node.id for node in nodes}
    edges = draw(st.lists(EDGES.filter(lambda edge: {edge.source, edge.target} <= there), max_size=12))
    return EnvironmentGraph(nodes, tuple(edges))


def plain(graph):
    """Without the order of nodes, states and edges, and each edge once."""
    nodes = sorted((in_states(node, node.states) for node in graph.nodes), key=lambda node: node.id)
    return EnvironmentGraph(tuple(nodes), tuple(sorted(set(graph.edges))))


@given(graphs(), graphs())
def test_a_change_made_to_the_earlier_graph_gives_the_later_one(before, after):
    change = encode(before, after)
    assert plain(apply(before, change)) == plain(after)
    assert bool(change) == (plain(before) != plain(after))


@given(st.lists(graphs(), min_size=1, max_size=5))
def test_changes_one_after_the_other_give_the_last_graph(path):
    changes = [encode(one, other) for one, other in pairwise(path)]
    assert plain(apply(path[0], *changes)) == plain(path[-1])


@st.composite
def histories(draw):
    """Graphs of the same nodes, of which only the states and the edges differ: what ticks go through."""
    first = draw(graphs(IDS))
    found = [first]
    for _ in range(draw(st.integers(0, 4))):
        states = {node_id: draw(st.sets(st.sampled_from(STATES[:4]))) for node_id in IDS}
        nodes = tuple(in_states(n, {*states[n.id], *(set(n.states) - set(STATES))}) for n in first.nodes)
        found.append(EnvironmentGraph(nodes, tuple(draw(st.lists(EDGES, max_size=12)))))
    return found


@given(histories())
def test_what_ticks_come_to_is_one_change(history):
    changes = [encode(one, other) for one, other in pairwise(history)]
    assert all(not change.added_nodes and not change.removed_nodes for change in changes)
    assert compose(changes) == encode(history[0], history[-1])
    assert plain(apply(history[0], *changes)) == plain(history[-1])


def test_what_comes_and_goes_is_sorted_and_a_node_of_another_class_is_another():
    cup, table = Node(2, "cup", states=("DIRTY", "BENT")), Node(1, "table")
    before = EnvironmentGraph((cup, table), (Edge(2, "ON", 1), Edge(2, "CLOSE", 1), Edge(1, "CLOSE", 2)))
    clean = EnvironmentGraph((replace(cup, states=("BENT", "CLEAN")), table), (Edge(1, "CLOSE", 2),))
    assert encode(before, clean) == Change(
        removed=(Edge(2, "CLOSE", 1), Edge(2, "ON", 1)), set_states=((2, "CLEAN"),), cleared_states=((2, "DIRTY"),)
    )
    mug = replace(cup, class_name="mug")
    after = EnvironmentGraph((mug, table), (Edge(1, "CLOSE", 2),))
    assert encode(before, after) == Change(added=(Edge(1, "CLOSE", 2),), added_nodes=(mug,), removed_nodes=(2,))


def test_a_part_of_a_change():
    change = Change((Edge(1, "ON", 2), Edge(1, "CLOSE", 2)), (), ((1, "OPEN"), (3, "ON")), ((3, "OFF"),))
    assert change.where(lambda edge: edge.relation == "ON") == replace(change, added=(Edge(1, "ON", 2),))
    assert change.where(node=lambda node_id: node_id == 1) == replace(
        change, set_states=((1, "OPEN"),), cleared_states=()
    )


def test_a_copy_of_a_working_graph_changes_alone():
    graph = WorkingGraph([Node(1, "lamp", states=("OFF",))])
    lit = graph.copy().apply(Change(set_states=((1, "ON"),), cleared_states=((1, "OFF"),)))
    assert (graph.nodes[1].states, lit.nodes[1].states) == (("OFF",), ("ON",))
