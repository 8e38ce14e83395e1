"""A literal has one value, whoever asks: the fast evaluator against the plain one, and all its users against it."""

from __future__ import annotations

import random

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from oracles.holds import Plain
from small_worlds import node, random_graph

from hearth.grounding.preconditions.condition_checks import unmet
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.failures import Failure
from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import act
from hearth.simulation.goals import Progress
from hearth.simulation.literal_truth import BINARY, UNARY, candidates, holds
from hearth.simulation.observation.containment import in_room
from hearth.simulation.observation.visible_nodes import out_of_sight
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

KNOWLEDGE = default()
STEPS = 12
ACTIONS = ("Grab", "Grab", "Open", "Close", "PutBack", "PutIn", "Sit", "Lie", "TurnTo", "SwitchOn", "SwitchOff", "Wash",
           "PutOn", "PlugOut", "Find")  # fmt: skip


def with_guest(graph: EnvironmentGraph) -> EnvironmentGraph:
    """The home with a second character, where the first is."""
    me = next(node for node in graph.nodes if node.class_name == "character")
    guest = Node(max(node.id for node in graph.nodes) + 1, "character", me.category, me.properties, me.states)
    room = next(edge.target for edge in graph.edges if edge.source == me.id and edge.relation == "INSIDE")
    return EnvironmentGraph((*graph.nodes, guest), (*graph.edges, Edge(guest.id, "INSIDE", room)))


HOMES = [
    Home.from_graph(with_guest(library.load_graph(name, KNOWLEDGE)), name, KNOWLEDGE)
    for name in ("maple", "cedar", "willow")
] + [Home.from_graph(random_graph(random.Random(seed), characters=2), "", KNOWLEDGE) for seed in range(24)]
GRAPHS = [World.start(home).graph() for home in HOMES]


def reached(home: Home, rng: random.Random) -> World:
    """The world after random actions that can be done: each with a walk before it."""
    world = World.start(home)
    for _ in range(STEPS):
        agent = rng.randrange(len(world.agents))
        name = rng.choice(ACTIONS)
        able = [[*indices(home.able(name, position))] for position in range(KNOWLEDGE.actions[name].arity)]
        if not all(able):
            continue
        things = [home.ids[rng.choice(fit)] for fit in able]
        if name.startswith("Put") and (held := world.holding()[agent]):
            things[0] = held[0]
        for action, nodes in (("Walk", things[-1:]), (name, things)):
            after = act(world, Step(action, tuple(ObjectRef("thing", 1, node) for node in nodes), agent))
            world = world if isinstance(after, Failure) else after
    return world


KEYS = (("cup", 1), ("fridge", 1), ("couch", 2), ("nothing", 1), ("character", 1), ("character", 2), ("character", 3))
OTHERS = (*KEYS, "agent", "agent:0", "agent:1", "agent:2", "agent:x", "agents", "o", 10**6)
SPELLINGS = sorted(KNOWLEDGE.object_spellings)


def drawn(seed: int) -> tuple[World, Plain, list[Literal], dict]:
    """A world, the same plainly, literals of every name, most of them about nodes that have to do with each other, and
    what keys and variables are bound to.
    """
    rng = random.Random(seed)
    number = rng.randrange(len(HOMES))
    world = reached(HOMES[number], rng)
    index, agents = world.home.index, {world.home.ids[i] for i in world.home.agents}
    edges = sorted(world.edges())
    mine = [edge for edge in edges if edge.source in agents or edge.target in agents]
    loaded = [edge[::-1] for edge in edges if edge.relation == "ON"]
    enclosed = [edge for edge in edges if edge.relation == "INSIDE" and world.has_state(edge.target, "CLOSED")]

    def term(node: int) -> object:
        """The node, its class, another name of that, or something else."""
        name = world.home.classes[index[node]]
        kinds = (node, node, name, rng.choice(KNOWLEDGE.same_class(name)), rng.choice(SPELLINGS), rng.choice(OTHERS))
        return rng.choice(kinds)

    def literal(name: str, terms: int) -> Literal:
        edge = rng.choice(rng.choice((edges, mine, loaded or edges, enclosed or edges)))
        ends = edge[::2] if rng.random() < 0.8 else edge[::-2]
        return Literal(name, tuple(map(term, ends[:terms])), rng.random() < 0.2)

    literals = [literal(name, 1) for name in (*UNARY, "GRABBED") for _ in range(5)]
    literals += [literal(name, 2) for name in (*BINARY, "UNDER") for _ in range(5)]
    bound = {key: rng.choice(world.home.ids) for key in (*KEYS[:3], "o")}
    return world, Plain.of(world.graph(), GRAPHS[number], KNOWLEDGE), literals, bound


@settings(max_examples=60, phases=[Phase.generate])
@given(st.integers(0, 1 << 32))
def test_a_literal_holds_as_it_does_read_slowly(seed):
    world, plain, literals, bound = drawn(seed)
    for literal in literals:
        assert holds(literal, world, bound) == plain.holds(literal, bound), literal


@settings(max_examples=30, phases=[Phase.generate])
@given(st.integers(0, 1 << 32))
def test_a_literal_counts_as_it_does_read_slowly(seed):
    world, plain, literals, _ = drawn(seed)
    for literal in literals:
        if not any(isinstance(term, tuple) for term in literal.terms):
            found = sum(mask.bit_count() for mask in candidates(literal, world.home).met(world))
            assert found == plain.count(literal), literal


@pytest.mark.parametrize(("literal", "found"), [
    (Literal.of("CLEAN", "sofa"), 1), (Literal.of("CLEAN", "couch"), 1), (Literal.of("DIRTY", "sofa"), 0),
    (Literal.of("INSIDE", "settee", "living_room"), 1), (Literal.of("CLEAN", "piano"), 0),
])  # fmt: skip
def test_a_name_means_the_same_to_all_who_ask(maple, literal, found):
    world = World.start(maple)
    nodes = {("sofa", 1): next(node.id for node in world.graph().nodes if node.class_name == "couch")}
    assert holds(literal, world) == bool(found)
    assert Progress.start(Goal.of(literal), world).counts == (found,)
    for home in (maple, Home.from_graph(world.graph(), "", maple.knowledge)):
        assert Progress.at(Goal.of(literal), World.start(home)).counts == (found,)
    if literal == Literal.of("CLEAN", "sofa"):
        clean = Preconditions((Condition(Literal.of("clean", ("sofa", 1))),))
        assert unmet(clean, world, nodes) == () and holds(Literal.of("CLEAN", ("sofa", 1)), world, nodes)


def small(*edges: tuple[int, str, int], closed: tuple[int, ...] = ()) -> World:
    """Kitchen, bedroom, bathroom; a door between each two; in the kitchen a character, a man, a cup, a knife."""
    names = ("kitchen", "bedroom", "bathroom", "door", "door", "character", "man", "cup", "knife", "table", "box")
    can = {"door": ("CAN_OPEN",), "box": ("CAN_OPEN",)}
    nodes = [
        node(n, name, "", can.get(name, ()), ("CLOSED",) if n in closed else ()) for n, name in enumerate(names, 1)
    ]
    between = [(4, "BETWEEN", 1), (4, "BETWEEN", 2), (5, "BETWEEN", 2), (5, "BETWEEN", 3)]
    inside = [(n, "INSIDE", 1) for n in (6, 7, 8, 9)]
    every = tuple(Edge(*edge) for edge in (*between, *inside, *edges))
    return World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), every), "", KNOWLEDGE))


@pytest.mark.parametrize(("closed", "found"), [((), False), ((4,), True), ((5,), False), ((4, 5), True)])
def test_only_a_closed_door_of_ones_own_room_closes_it(closed, found):
    assert holds(Literal.of("doors_closed", 6), small(closed=closed)) is found


def test_what_somebody_holds_is_that_and_nothing_else():
    """A man is not a character: what he holds stands in the graph only."""
    world = small((7, "HOLDS_RH", 8))
    held = [holds(Literal.of(name, 7, thing), world) for name in ("HOLDS_RH", "HOLDS_LH") for thing in (8, 9)]
    assert held == [True, False, False, False]


def test_what_is_in_a_room_counts_once_however_it_is_there():
    """A cup is on a table and in a box, both in the kitchen; a knife is on the cup; the box is closed."""
    world = small((10, "INSIDE", 1), (11, "INSIDE", 1), (8, "ON", 10), (8, "INSIDE", 11), (9, "ON", 8), closed=(11,))
    seen = [world.home.ids[i] for i in indices(in_room(world, world.home.index[1]))]
    assert seen == [1, 4, 6, 7, 8, 9, 10, 11]
    assert [world.home.ids[i] for i in indices(out_of_sight(world))] == [8, 9]
    assert [world.home.ids[i] for i in indices(in_room(world, world.home.index[2]))] == [2, 4, 5]
