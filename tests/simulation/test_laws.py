"""Laws that hold in any home and after any program."""

from __future__ import annotations

from hypothesis import given, settings
from small_worlds import graphs, homes_and_steps

from hearth.kb.loading.load import default
from hearth.schemas.failures import Failure
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.graph_change import encode
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.engine import act, run
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.simulation.world.world_json import export, restore

law = settings(derandomize=True, deadline=None, max_examples=60)


def reached(graph: EnvironmentGraph, steps) -> list[World]:
    """The worlds along a program of which what can't be done is left out."""
    worlds = [World.start(Home.from_graph(graph, "", default()))]
    for step in steps:
        result = act(worlds[-1], step, DEFAULT)
        if isinstance(result, World):
            worlds.append(result)
    return worlds


def states(world: World) -> set[tuple[int, str]]:
    return {(node.id, state) for node in world.graph().nodes for state in node.states}


@law
@given(homes_and_steps(characters=2))
def test_close_is_symmetric(case):
    for world in reached(*case):
        close = {(e.source, e.target) for e in world.edges() if e.relation == "CLOSE"}
        assert close == {(b, a) for a, b in close}


@law
@given(homes_and_steps(characters=2))
def test_exclusive_states_exclude_each_other(case):
    for world in reached(*case):
        now = states(world)
        assert not any((node, OPPOSITE[state]) in now for node, state in now)


@law
@given(homes_and_steps(characters=2))
def test_a_held_thing_is_in_one_room_and_nowhere_else_and_in_the_hands_of_one(case):
    graph, steps = case
    rooms = {n.id for n in graph.nodes if n.category == "Rooms"}
    # What is poured stays in the hand, and is in the vessel too; who is in no room has nowhere to take things.
    for world in reached(graph, [s for s in steps if s.action != "Pour"]):
        held = [node for things in world.holding().values() for node in things]
        assert len(set(held)) == len(held)
        edges = world.edges()
        holder = {e.target: e.source for e in edges if e.relation.startswith("HOLDS")}
        for node in held:
            inside = {e.target for e in edges if e.source == node and e.relation == "INSIDE"}
            assert len(inside) <= 1
            assert inside <= rooms
            assert (
                inside or not {e.target for e in edges if e.source == holder[node] and e.relation == "INSIDE"} & rooms
            )
            assert not [e for e in edges if e.source == node and e.relation == "ON"]


@law
@given(homes_and_steps(characters=2))
def test_a_failed_step_changes_nothing_and_says_what_was_expected(case):
    graph, steps = case
    world = World.start(Home.from_graph(graph, "", default()))
    for step in steps:
        before, key = world.graph(), world.key()
        result = act(world, step, DEFAULT)
        assert world.graph() == before
        assert World(world.home, world.states, world.agents, world.moved).key() == key
        if isinstance(result, Failure):
            assert result.expected
            assert result.action == step.action
            assert result.agent == step.agent
        else:
            world = result


@law
@given(homes_and_steps())
def test_replaying_the_changes_rebuilds_every_state(case):
    graph, steps = case
    start = World.start(Home.from_graph(graph, "", default()))
    execution = run(start, Program(steps=tuple(steps)))
    edges, now, before = set(start.edges()), states(start), start
    for world, change in zip(execution.worlds[1:], execution.changes(), strict=True):
        assert edges >= set(change.removed)
        assert not edges & set(change.added)
        edges = edges - set(change.removed) | set(change.added)
        assert now >= set(change.cleared_states)
        assert not now & set(change.set_states)
        now = now - set(change.cleared_states) | set(change.set_states)
        assert edges == set(world.edges())
        assert now == states(world)
        assert change == encode(before.graph(), world.graph())
        before = world
        assert (change.added, change.removed) == (tuple(sorted(change.added)), tuple(sorted(change.removed)))


@law
@given(homes_and_steps(characters=2))
def test_worlds_are_equal_when_their_graphs_and_memories_are(case):
    worlds = reached(*case)
    shown = [(world.graph(), memories(world)) for world in worlds]
    for i, one in enumerate(worlds):
        for j in range(i + 1):
            assert (one == worlds[j]) == (shown[i] == shown[j])
            if one == worlds[j]:
                assert hash(one) == hash(worlds[j])


def memories(world: World) -> set:
    return {(number, entry) for number, agent in enumerate(world.agents) for entry in agent.origins}


@law
@given(homes_and_steps(characters=2))
def test_a_world_in_mid_execution_goes_on_after_export_and_import_as_if_nothing_had_been(case):
    graph, steps = case
    half = len(steps) // 2
    world = reached(graph, steps[:half])[-1]
    again = restore(export(world), default())
    assert again.graph() == world.graph()
    for step in steps[half:]:
        one, other = act(world, step, DEFAULT), act(again, step, DEFAULT)
        if isinstance(one, Failure):
            assert one == other
        else:
            assert one.graph() == other.graph()
            assert one.holding() == other.holding()
            world, again = one, other


@law
@given(graphs)
def test_a_home_shows_the_graph_it_was_made_of(graph):
    shown = World.start(Home.from_graph(graph, "", default())).graph()
    assert set(shown.edges) == set(graph.edges)
    assert [n.id for n in shown.nodes] == [n.id for n in graph.nodes]
    assert all(set(a.states) == set(b.states) for a, b in zip(shown.nodes, graph.nodes, strict=True))
