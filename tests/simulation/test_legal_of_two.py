"""What several characters may do with one thing: masks that random worlds hardly ever reach."""

from __future__ import annotations

import pytest
from small_worlds import bound_step

from hearth.kb.loading.load import default
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.rules import DEFAULT
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
