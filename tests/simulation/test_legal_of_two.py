"""Actions of several characters with one thing: masks that random worlds hardly ever reach."""

from __future__ import annotations

from dataclasses import replace

import pytest
from small_worlds import bound_step

from hearth.kb.loading.load import default
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KITCHEN = Node(1, "kitchen", "Rooms")
ME, OTHER = Node(2, "character", "Characters"), Node(3, "character", "Characters")
CUPS = [Node(number, "cup", "Props", ("GRABBABLE", "MOVABLE")) for number in (4, 5, 6)]
NEAR = [Edge(a, "CLOSE", b) for one in (2, 3) for cup in (4, 5, 6) for a, b in ((one, cup), (cup, one))]


def world(*held: Edge) -> World:
    inside = [Edge(number, "INSIDE", 1) for number in range(2, 7)]
    people = [Edge(2, "CLOSE", 3), Edge(3, "CLOSE", 2)]
    graph = EnvironmentGraph((KITCHEN, ME, OTHER, *CUPS), (*inside, *people, *NEAR, *held))
    return World.start(Home.from_graph(graph, "", default()))


def code(start: World, step) -> Code | None:
    found = act(start, step, DEFAULT)
    return found.code if isinstance(found, Failure) else None


@pytest.mark.parametrize("hand", ["HOLDS_RH", "HOLDS_LH"])
def test_what_another_holds_is_not_offered(hand):
    mine, theirs = bound_step("Grab", [CUPS[0]], 0), bound_step("Grab", [CUPS[1]], 0)
    start = world(Edge(3, hand, 5))
    assert (code(start, mine), code(start, theirs)) == (None, Code.HELD_BY_OTHER)
    found = legal(start, 0, DEFAULT)
    assert mine in found and theirs not in found
    assert code(world(), theirs) is None and theirs in legal(world(), 0, DEFAULT)


def test_nothing_is_handed_to_who_has_both_hands_full():
    hand = bound_step("PutBack", [CUPS[0], OTHER], 0)
    one, both = (Edge(2, "HOLDS_RH", 4), Edge(3, "HOLDS_RH", 5)), Edge(3, "HOLDS_LH", 6)
    assert code(world(*one), hand) is None and hand in legal(world(*one), 0, DEFAULT)
    assert code(world(*one, both), hand) is not None
    assert hand not in legal(world(*one, both), 0, DEFAULT)


@pytest.mark.parametrize("action", ["PutBack", "PutIn", "Pour"])
def test_nothing_is_put_on_in_or_into_itself(action):
    """One may put either of two held things on the other, but neither on itself."""
    known = default()
    mug = Node(4, "mug", "Props", ("GRABBABLE", "MOVABLE", "POURABLE", "DRINKABLE", "RECIPIENT"))
    edges = [Edge(n, "INSIDE", 1) for n in (2, 4, 5)] + [Edge(2, "CLOSE", n) for n in (4, 5)]
    edges += [Edge(2, "HOLDS_RH", 4), Edge(2, "HOLDS_LH", 5)]
    graph = EnvironmentGraph((KITCHEN, ME, mug, replace(mug, id=5)), tuple(edges))
    start = World.start(Home.from_graph(graph, "", known))
    itself, other = bound_step(action, [mug, mug], 0), bound_step(action, [mug, replace(mug, id=5)], 0)
    found = legal(start, 0, DEFAULT)
    listed = [tuple(ref.node for ref in each.objects) for each in found if each.action == action]
    assert code(start, itself) is Code.NOT_AFFORDED and itself not in found
    assert code(start, other) is None and other in found
    assert (4, 5) in listed and (4, 4) not in listed and found.count(action) == len(listed)
    assert len(found) == len(list(found))


def test_what_one_holds_is_grabbed_again_only_by_the_releases_rule():
    again, start = bound_step("Grab", [CUPS[0]], 0), world(Edge(2, "HOLDS_RH", 4))
    after = act(start, again, DEFAULT)
    assert isinstance(after, World) and after.agents[0].right == after.agents[0].left  # as the release has it
    rules = DEFAULT._replace(one_grip=True)
    refused = act(start, again, rules)
    assert isinstance(refused, Failure) and refused.code is Code.HELD_ALREADY
    assert again in legal(start, 0, DEFAULT) and again not in legal(start, 0, rules)
    assert not isinstance(act(start, bound_step("Grab", [CUPS[1]], 0), rules), Failure)
    assert not isinstance(act(world(Edge(2, "HOLDS_RH", 6)), again, rules), Failure)  # after it in the home


@pytest.mark.parametrize(("near", "returned"), [(5, True), (6, False)])
def test_a_thing_goes_back_to_where_one_took_it_only_if_that_is_near(near, returned):
    tables = [Node(number, "table", "Furniture", ("SURFACES",)) for number in (5, 6)]
    edges = [Edge(n, "INSIDE", 1) for n in (2, 4, 5, 6)] + [Edge(4, "ON", 5), Edge(2, "CLOSE", 4), Edge(2, "CLOSE", 5)]
    graph = EnvironmentGraph((KITCHEN, ME, CUPS[0], *tables), tuple(edges))
    taken = act(World.start(Home.from_graph(graph, "", default())), bound_step("Grab", [CUPS[0]], 0))
    apart = edit(taken, unlink=[Edge(2, "CLOSE", 5), Edge(5, "CLOSE", 2)])
    start = edit(apart, link=[Edge(2, "CLOSE", near)])
    back = bound_step("PutObjBack", [CUPS[0]], 0)
    assert (code(start, back) is None) is returned is (back in legal(start, 0, DEFAULT))
