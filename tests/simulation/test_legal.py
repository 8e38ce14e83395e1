from __future__ import annotations

import random

import pytest
from small_worlds import arity, bound_step, random_graph, random_step

from hearth.kb.loading.load import default
from hearth.schemas.failures import Failure
from hearth.simulation.actions import appliances, cleaning, clothes, food, hands, locomotion, moving, posture, senses
from hearth.simulation.actions.legal import legal
from hearth.simulation.actions.registry import ACTIONS
from hearth.simulation.engine import act
from hearth.simulation.observation import reach
from hearth.simulation.rules import DEFAULT, REPLAY
from hearth.simulation.world import rows
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
    seen, near = reach.visible(world, me), reach.reachable(world, me)
    index = world.home.index
    every = set(legal(world, 0))
    for limits, mask in (({"only_visible": True}, seen), ({"only_reachable": True}, near)):
        kept = {s for s in every if all(mask >> index[ref.node] & 1 for ref in s.objects)}
        assert set(legal(world, 0, **limits)) == kept


@pytest.mark.parametrize("seed", range(40))
def test_masks_agree_with_questions_about_one_node(seed):
    rng = random.Random(seed)
    world, nodes = some_world(rng, 1 + seed % 2, DEFAULT)
    agent = world.agents[0]
    close, facing, hidden = reach.close_to(world, agent), reach.faced_by(world, agent), reach.hidden(world)
    for i in range(len(nodes)):
        assert bool(close >> i & 1) == rows.is_close(world, agent, i)
        assert bool(facing >> i & 1) == rows.is_facing(world, agent, i)
        assert bool(hidden >> i & 1) == (rows.closed_container(world, i) >= 0)
