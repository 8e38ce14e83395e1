from __future__ import annotations

import random

import pytest
from small_worlds import arity, bound_step, node, random_graph, random_step

from hearth.kb.loading.load import default
from hearth.schemas.failures import Failure
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.simulation.actions import appliances, cleaning, clothes, food, hands, locomotion, moving, posture, senses
from hearth.simulation.actions.legal import legal
from hearth.simulation.actions.registry import ACTIONS
from hearth.simulation.engine import act
from hearth.simulation.env import Env
from hearth.simulation.observation import reach, visible_nodes
from hearth.simulation.observation.masked_world import as_seen
from hearth.simulation.rules import CONSEQUENCES, DEFAULT, REPLAY
from hearth.simulation.world import edge_rows
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


def some_world(rng: random.Random, characters: int, rules) -> tuple[World, list]:
    """A world some steps after the start of a random home, and the home's nodes."""
    graph = random_graph(rng, characters=characters)
    world = World.start(Home.from_graph(graph, "", default()))
    for _ in range(rng.randint(0, 40)):
        result = act(world, random_step(rng, graph, rng.randrange(characters)), rules)
        world = world if isinstance(result, Failure) else result
    return world, list(graph.nodes)


def all_steps(nodes, agent: int):
    for action in sorted(ACTIONS):
        if arity(action) == 0:
            yield bound_step(action, [], agent)
        for o in nodes if arity(action) else ():
            for pair in [(o,)] if arity(action) == 1 else [(o, s) for s in nodes]:
                yield bound_step(action, pair, agent)


def test_no_two_records_are_of_one_action():
    files = (appliances, cleaning, clothes, food, hands, locomotion, moving, posture, senses)
    assert sorted(action.name for file in files for action in file.ACTIONS) == sorted(ACTIONS)


@pytest.mark.parametrize("seed", range(40))
def test_legal_is_exactly_what_can_be_done(seed):
    rng = random.Random(seed)
    rules = (DEFAULT, REPLAY)[seed % 2]
    characters = 1 + seed % 3
    world, nodes = some_world(rng, characters, rules)
    agent = rng.randrange(characters)
    found = legal(world, agent, rules)
    possible = 0
    for step in all_steps(nodes, agent):
        done = not isinstance(act(world, step, rules), Failure)
        assert (step in found) == done, step
        possible += done
    assert len(found) == possible == len(list(found))
    assert all(not isinstance(act(world, step, rules), Failure) for step in found)


@pytest.mark.parametrize("seed", range(20))
def test_only_visible_and_only_reachable_keep_what_is_seen_and_reached(seed):
    rng = random.Random(seed)
    world, _ = some_world(rng, 2, DEFAULT)
    me = world.agents[0]
    seen, near = visible_nodes.visible(world, me), reach.reachable(world, me)
    index = world.home.index
    limited = (({"only_visible": True}, seen, as_seen(world, seen)), ({"only_reachable": True}, near, world))
    for limits, mask, of in limited:
        kept = {s for s in legal(of, 0) if all(mask >> index[ref.node] & 1 for ref in s.objects)}
        assert set(legal(world, 0, **limits)) == kept


def test_a_closed_door_out_of_sight_does_not_show_in_what_is_legal():
    names = ("kitchen", "bathroom", "bedroom", "character", "door", "door", "bed")
    nodes = [node(number, name) for number, name in enumerate(names, 1)]
    nodes[4:6] = [node(n, "door", properties=["CAN_OPEN"], states=["OPEN"]) for n in (5, 6)]
    edges = [Edge(4, "INSIDE", 1), Edge(7, "INSIDE", 3), *(Edge(5, "BETWEEN", room) for room in (1, 2))]
    edges += [Edge(6, "BETWEEN", room) for room in (2, 3)]
    start = World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", default()))
    far, near = (edit(start, set=[(door, "CLOSED")]) for door in (6, 5))
    assert set(legal(far, only_visible=True)) == set(legal(start, only_visible=True))
    assert 3 in legal(far, only_visible=True).objects("Walk") and 3 not in legal(far).objects("Walk")
    assert legal(near, only_visible=True).objects("Walk") == (1, 4, 5)


@pytest.mark.parametrize("names", [("Walk", "Grab"), ()])
def test_of_some_actions_legal_has_these_alone(names):
    world, _ = some_world(random.Random(3), 2, DEFAULT)
    every = legal(world, 0)
    assert set(legal(world, 0, actions=frozenset(names))) == {step for step in every if step.action in names}


@pytest.mark.parametrize("seed", range(40))
def test_masks_agree_with_questions_about_one_node(seed):
    rng = random.Random(seed)
    world, nodes = some_world(rng, 1 + seed % 2, DEFAULT)
    agent = world.agents[0]
    close, facing, hidden = reach.close_to(world, agent), reach.faced_by(world, agent), visible_nodes.hidden(world)
    for i in range(len(nodes)):
        assert bool(close >> i & 1) == edge_rows.is_close(world, agent, i)
        assert bool(facing >> i & 1) == edge_rows.is_facing(world, agent, i)
        assert bool(hidden >> i & 1) == (edge_rows.closed_container(world, i) >= 0)


def test_by_action_set_3_an_agent_that_sees_its_room_has_legal_instructions_there(knowledge):
    env = Env(CONSEQUENCES, partial=True, knowledge=knowledge.of_set(3))
    env.reset("maple", seed=1)
    env.step("[Walk] <fridge> (1)")
    whole, seen = (set(map(str, env.legal(only_visible=each))) for each in (False, True))
    assert seen and seen < whole
