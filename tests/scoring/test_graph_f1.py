import random
from collections import Counter
from dataclasses import replace
from itertools import permutations, product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hearth.schemas.failures import Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.scoring.metrics.alignment import Problem
from hearth.scoring.metrics.final_graph import Nodes, nodes_of, views_of
from hearth.scoring.metrics.graph_f1 import FAILED, MATCHES, SCOPES, f1_signature, named, score
from hearth.scoring.metrics.precision_recall import Match, Matches, Prf
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act, run
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

CLASSES = {9: "character", 1: "kitchen", 10: "table", 11: "table", 20: "cup", 21: "cup", 22: "cup", 30: "plate"}
CATEGORIES = {1: "Rooms", 9: "Characters"}
THINGS = (10, 11, 20, 21, 22, 30)


def random_graph(rng):
    states = {n: tuple(s for s in ("CLEAN", "OPEN") if rng.random() < 0.5) for n in CLASSES}
    nodes = tuple(Node(n, name, CATEGORIES.get(n, "Props"), (), states[n]) for n, name in CLASSES.items())
    edges = {
        Edge(rng.choice((9, *THINGS)), rng.choice(("ON", "CLOSE")), rng.choice((1, 9, *THINGS)))
        for _ in range(rng.randint(0, 14))
    }
    return EnvironmentGraph(nodes, tuple(sorted(edges)))


def renamed(graph, names):
    nodes = tuple(replace(node, id=names.get(node.id, node.id)) for node in graph.nodes)
    edges = tuple(Edge(names.get(e.source, e.source), e.relation, names.get(e.target, e.target)) for e in graph.edges)
    return EnvironmentGraph(nodes, edges)


def shuffled_classes(rng):
    """A permutation of ids that keeps every class."""
    names = {}
    for group in ((10, 11), (20, 21, 22)):
        names.update(zip(group, rng.sample(group, len(group)), strict=True))
    return names


cases = st.builds(
    lambda seed, ours, theirs: (random.Random(seed), ours, theirs),
    st.integers(0, 10**6),
    st.sets(st.sampled_from(THINGS), max_size=3),
    st.sets(st.sampled_from(THINGS), max_size=3),
)


def naive_best(predicted, reference, ours, theirs, scope):
    """All bijections of the named classes, tuples compared one by one; others are identified by class."""
    classes = {CLASSES[n] for n in ours | theirs}
    groups = [[n for n in THINGS if CLASSES[n] == name] for name in sorted(classes)]
    best = (-1.0, -1.0)
    for images in product(*(permutations(group) for group in groups)):
        to = dict(zip((n for group in groups for n in group), (n for chosen in images for n in chosen), strict=True))
        aligned = {to[n] for n in theirs} | ours
        ours_scored = aligned if scope == "either" else ours
        theirs_scored = aligned if scope == "either" else {to[n] for n in theirs}
        a = naive_tuples(predicted, {n: n for n in CLASSES}, aligned, ours_scored)
        b = naive_tuples(reference, {n: to.get(n, n) for n in CLASSES}, aligned, theirs_scored)
        best = max(best, Matches(*(naive_match(x, y) for x, y in zip(a, b, strict=True))).rank())
    return best


def naive_tuples(graph, to, aligned, scored):
    def label(n):
        return to[n] if to[n] in aligned or n in (1, 9) else CLASSES[n]

    about = scored | {9}
    states = Counter((label(n.id), s) for n in graph.nodes if to[n.id] in about for s in n.states)
    edges = Counter(
        (label(e.source), e.relation, label(e.target))
        for e in graph.edges
        if to[e.source] in about or to[e.target] in about
    )
    return states, edges


def naive_match(a, b):
    return Match((a & b).total(), a.total(), b.total())


def rank(found):
    return (found.both.f1, found.states.f1 + found.relations.f1)


few = settings(max_examples=30)


@few
@given(cases, st.sampled_from(SCOPES))
def test_best_is_the_naive_best(case, scope):
    rng, ours, theirs = case
    a, b = random_graph(rng), random_graph(rng)
    found = score(a, b, ours, theirs, match="best", scope=scope)
    assert found.exact
    assert rank(found) == pytest.approx(naive_best(a, b, ours, theirs, scope))


@few
@given(cases, st.sampled_from(SCOPES))
def test_best_does_not_depend_on_ids_within_a_class(case, scope):
    rng, ours, theirs = case
    a, b = random_graph(rng), random_graph(rng)
    names = shuffled_classes(rng)
    found = score(a, b, ours, theirs, match="best", scope=scope)
    again = score(renamed(a, names), b, {names.get(n, n) for n in ours}, theirs, match="best", scope=scope)
    assert rank(found) == rank(again)


@few
@given(cases, st.sampled_from(SCOPES))
def test_the_same_up_to_instances_scores_one(case, scope):
    rng, ours, _ = case
    a, names = random_graph(rng), shuffled_classes(rng)
    found = score(renamed(a, names), a, {names.get(n, n) for n in ours}, ours, match="best", scope=scope)
    assert (found.states.f1, found.relations.f1, found.both) == (1, 1, Prf(1, 1, 1))


@few
@given(cases, st.sampled_from(SCOPES))
def test_every_match_is_bounded_and_none_is_below_comparing_ids(case, scope):
    rng, ours, theirs = case
    a, b = random_graph(rng), random_graph(rng)
    found = {match: score(a, b, ours, theirs, match=match, scope=scope) for match in MATCHES}
    assert all(0 <= value <= 1 for each in found.values() for prf in (each.states, each.relations) for value in prf)
    assert rank(found["best"]) >= rank(found["none"])
    assert sum(rank(found["swap1"])) >= sum(rank(found["none"]))
    assert score(a, a, ours, ours, match="none", scope=scope).both == Prf(1, 1, 1)


@few
@given(cases)
def test_swapping_the_graphs_swaps_precision_and_recall(case):
    rng, ours, theirs = case
    a, b = random_graph(rng), random_graph(rng)
    there, back = score(a, b, ours, theirs, match="best"), score(b, a, theirs, ours, match="best")
    assert rank(there) == rank(back)


@few
@given(cases, st.sampled_from(SCOPES))
def test_a_search_finds_no_more_than_all_and_says_that_it_searched(case, scope):
    rng, ours, theirs = case
    problem = Problem(*views_of(random_graph(rng), random_graph(rng)), ours, theirs, either=scope == "either")
    every, searched = problem.best(), problem.best(limit=0)
    assert every.exact
    assert searched.matches.rank() <= every.matches.rank()
    assert searched.exact == (searched.matches.rank() == (1, 2))


def ran(world, text):
    program, faults = parse_program(text)
    assert not faults
    execution = run(world, program)
    assert execution.executable, execution.failure
    return execution.final, named(program)


CUP_TO_TABLE = """[Walk] <cup> (1.20)
[Grab] <cup> (1.20)
[Walk] <table> (1.10)
[PutBack] <cup> (1.20) <table> (1.10)"""


@pytest.mark.parametrize("scope", SCOPES)
def test_another_cup_does_as_well(world, scope):
    mine, my_names = ran(world, CUP_TO_TABLE.replace("20", "21"))
    theirs, their_names = ran(world, CUP_TO_TABLE)
    best = score(mine, theirs, my_names, their_names, match="best", scope=scope)
    assert best.both == Prf(1, 1, 1)
    assert set(best.assigned) == ({(20, 21), (21, 20)} if best.assigned[1:] else {(20, 21)})
    assert score(mine, theirs, my_names, their_names, match="none", scope=scope).both.f1 < 1


def test_counted_by_hand(world):
    """The reference opens the fridge; the prediction only walks to it. One state of two tuple sets of one each differs.

    Relations about the fridge and the character, in both: fridge INSIDE kitchen, character INSIDE kitchen, and CLOSE
    both ways between character and fridge.
    """
    mine, my_names = ran(world, "[Walk] <fridge> (1.11)")
    theirs, their_names = ran(world, "[Walk] <fridge> (1.11)\n[Open] <fridge> (1.11)")
    found = score(mine, theirs, my_names, their_names)
    assert found.states == Prf(0, 0, 0)
    assert found.relations == Prf(1, 1, 1)
    assert found.both == Prf(4 / 5, 4 / 5, 4 / 5)


def test_precision_and_recall_are_told_apart():
    reference = EnvironmentGraph((Node(20, "cup", "", (), ("CLEAN", "OPEN")),))
    predicted = EnvironmentGraph((Node(20, "cup", "", (), ("CLEAN",)),))
    assert score(predicted, reference, {20}, {20}).states == Prf(1, 1 / 2, 2 / 3)


def test_empty_sets_agree_and_one_empty_set_scores_nothing():
    bare = EnvironmentGraph((Node(20, "cup"),))
    clean = EnvironmentGraph((Node(20, "cup", "", (), ("CLEAN",)),))
    assert score(bare, bare, {20}, {20}).states == Prf(1, 1, 1)
    assert score(bare, clean, {20}, {20}).states == score(clean, bare, {20}, {20}).states == Prf(0, 0, 0)
    assert score(clean, clean, (), ()).both == Prf(1, 1, 1)
    assert FAILED.both == Prf(0, 0, 0)


def test_rooms_doors_and_unknown_nodes_are_left_out(world):
    mine, _ = ran(world, "[Walk] <fridge> (1.11)")
    theirs, _ = ran(world, "[Walk] <fridge> (1.11)")
    only = score(mine, theirs, {11}, {11})
    assert score(mine, theirs, {1, 2, 3, 9, 11, 777}, {11}) == only


def test_scope_says_whose_objects_are_looked_at(world):
    """Objects that only the prediction names are the same in both worlds: `either` finds them, `own` a tuple more."""
    mine, my_names = ran(world, "[Walk] <fridge> (1.11)")
    theirs, their_names = ran(world, "[Walk] <fridge> (1.11)")
    own = score(mine, theirs, my_names | {22}, their_names, match="none", scope="own")
    either = score(mine, theirs, my_names | {22}, their_names, match="none", scope="either")
    assert either.both == Prf(1, 1, 1)
    assert (own.both.recall, own.states.precision) == (1, 1 / 2)


def test_swap1_as_published_asks_about_another_instance():
    """The prediction names a cup that is as the reference's other cup is: asked about that one, all agrees."""
    nodes = (Node(20, "cup", "", (), ("DIRTY",)), Node(21, "cup", "", (), ("CLEAN",)))
    graph = EnvironmentGraph(nodes)
    assert score(graph, graph, {21}, {20}, match="none", scope="own").both.f1 == 0
    found = score(graph, graph, {21}, {20}, match="swap1", scope="own")
    assert (found.both.f1, found.assigned) == (1, ((20, 21),))


def test_instances_may_be_fewer_in_one_graph():
    one = EnvironmentGraph((Node(20, "cup", "", (), ("CLEAN",)),))
    two = EnvironmentGraph((Node(20, "cup", "", (), ("DIRTY",)), Node(21, "cup", "", (), ("CLEAN",))))
    assert score(one, two, {20}, {20, 21}, match="best").states == Prf(1, 1 / 2, 2 / 3)
    assert score(two, one, {20, 21}, {20}, match="best").states == Prf(1 / 2, 1, 2 / 3)


def test_too_many_instances_are_searched():
    ids = range(1, 13)
    many = EnvironmentGraph(tuple(Node(n, "cup", "", (), ("CLEAN",) if n % 3 else ("DIRTY",)) for n in ids))
    found = score(many, renamed(many, {n: 13 - n for n in ids}), set(ids), set(ids), match="best")
    assert found.both.f1 == 1
    assert found.exact  # a perfect score can't be bettered
    less = score(many, EnvironmentGraph(many.nodes[:-1]), set(ids), set(ids), match="best")
    assert 0 < less.both.f1 < 1
    assert not less.exact


def test_a_world_is_scored_as_its_graph(world):
    mine, my_names = ran(world, CUP_TO_TABLE)
    theirs, their_names = ran(world, "[Walk] <cup> (1.21)\n[Grab] <cup> (1.21)")
    for match, scope in product(MATCHES, SCOPES):
        by_world = score(mine, theirs, my_names, their_names, match=match, scope=scope)
        assert by_world == score(mine.graph(), theirs.graph(), my_names, their_names, match=match, scope=scope)
        assert 0 < by_world.both.f1 < 1


def test_a_worlds_view_is_its_graphs_view(world):
    final, _ = ran(world, CUP_TO_TABLE)
    (one, _), (other, _) = views_of(final, final), views_of(final.graph(), final.graph())
    assert one.nodes == other.nodes
    for node in (9, 10, 11, 12, 20, 21, 22):
        assert edges_of(one, node) == edges_of(other, node) == {e for e in final.edges() if node in (e[0], e[2])}
        assert (
            one.states(one.index[node])
            == other.states(other.index[node])
            == set(final.home.node(final.home.index[node]).states)
        )


def edges_of(view, node):
    read = view.rows(view.index[node]).items()
    ends = [(relation, out, view.ids[j]) for (relation, out), row in read for j in indices(row)]
    return {Edge(node, relation, j) if out else Edge(j, relation, node) for relation, out, j in ends}


def test_two_graphs_number_their_nodes_alike_whatever_nodes_they_have():
    one = EnvironmentGraph((Node(20, "cup"), Node(10, "table")), (Edge(20, "ON", 10),))
    other = EnvironmentGraph((Node(30, "plate"), Node(20, "cup"), Node(10, "table")), (Edge(20, "ON", 10),))
    a, b = views_of(one, other)
    assert (a.ids, a.index) == (b.ids, b.index)
    assert a.rows(a.index[20]) == b.rows(b.index[20]) == {("ON", True): 1 << a.index[10]}
    assert score(one, other, {20}, {20}).both == Prf(1, 1, 1)


def test_signature():
    assert f1_signature() == "f1|match:swap1|scope:own|empty:1|v1"
    assert f1_signature("best", "either") == "f1|match:best|scope:either|empty:1|v1"


@pytest.mark.parametrize("seed", range(12))
def test_worlds_scored_by_rows_score_as_their_graphs(world, seed):
    """Random legal walks from one start: what is counted on rows is what the tuples of the graphs say."""
    chance = random.Random(seed)
    ends = [wandered(world, chance) for _ in range(2)]
    ours, theirs = (set(chance.sample((10, 11, 12, 20, 21, 22), chance.randint(0, 3))) for _ in range(2))
    for match in MATCHES:
        for scope in SCOPES:
            fast = score(*ends, ours, theirs, match=match, scope=scope)
            slow = score(*(end.graph() for end in ends), ours, theirs, match=match, scope=scope)
            assert (fast.states, fast.relations, fast.both) == (slow.states, slow.relations, slow.both)


def wandered(world, chance):
    for _ in range(12):
        now = act(world, chance.choice(list(legal(world))))
        world = world if isinstance(now, Failure) else now
    return world


def test_relations_of_things_that_hold_things_have_their_direction(flat, knowledge):
    """A chair holds nothing, and a graph may say so."""
    odd = EnvironmentGraph(flat.nodes, (*flat.edges, Edge(12, "HOLDS_RH", 20)))
    world = World.start(Home.from_graph(odd, "", knowledge))
    (view, _), node = views_of(world, world), Edge(12, "HOLDS_RH", 20)
    assert node in edges_of(view, 12) and node in edges_of(view, 20)
    assert not {Edge(20, "HOLDS_RH", 12), Edge(20, "HOLDS_RH", 20)} & (edges_of(view, 12) | edges_of(view, 20))


def test_the_nodes_of_a_changed_home_are_those_that_are_there(world):
    fork = Node(50, "fork", "Props", ("GRABBABLE",))
    for gone, added in ((), ()), ((), (fork,)), ((20,), ()), ((20,), (fork,)):
        home = edit(world, remove=gone, add=added, check=False).home
        expected = Nodes.of(home.node(i) for i in indices(home.everything))
        found = nodes_of(home)
        assert found == expected
