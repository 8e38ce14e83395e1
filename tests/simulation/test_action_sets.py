"""Action sets 1 and 2 stay as they were published, to the byte, whatever set 3 adds."""

import random
from hashlib import sha256

import pytest
from small_worlds import bound_step, random_graph

from hearth.kb.loading.load import default
from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.rules import RULES
from hearth.simulation.world.digest import digest
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ACTIONS = (
    "Close", "Cut", "Drink", "Drop", "Eat", "Find", "Grab", "Greet", "Lie", "LookAt", "Move", "Open",
    "PlugIn", "PlugOut", "PointAt", "Pour", "Pull", "Push", "PutBack", "PutIn", "PutObjBack", "PutOff",
    "PutOn", "Read", "Release", "Rinse", "Run", "Scrub", "Sit", "Sleep", "Squeeze", "StandUp", "SwitchOff",
    "SwitchOn", "Touch", "TurnTo", "Type", "WakeUp", "Walk", "Wash", "Watch", "Wipe", "Break", "Fold",
    "Wait", "Dance", "Wrap",
)  # fmt: skip
"""Those of set 2, oftener those that lead somewhere, and five that it does not execute."""

USUAL = ("Walk", "Walk", "Find", "Grab", "Grab", "Open", "PutBack", "PutIn", "Sit", "StandUp", "SwitchOn", "Wash")

STORED = {
    "near_hands": "c632573b1e6e535067cfc12e92a427e5",
    "replay": "337fafc87f76c66940fe690010419feb",
    "evolving_graph": "dbfbd48bbde8cf56966508cdcadfa585",
    "default": "fcf071bf45c081354b009f5c0a77784d",
}
"""Digests of 2,500 random programs by each of four rules, made by version 0.2 before set 3 was written."""


def programs_digest(rules_name: str, count: int = 2_500) -> tuple[str, int]:
    """Return a digest of the effects and messages of random programs, and the number of their steps that were done."""
    found, done = sha256(), 0
    for seed in range(count):
        rng = random.Random(f"{rules_name} {seed}")
        graph = random_graph(rng)
        world = World.start(Home.from_graph(graph, "", default()))
        for _ in range(12):
            name = rng.choice(USUAL if rng.random() < 0.6 else ACTIONS)
            things = [rng.choice(graph.nodes) for _ in range(default().actions[name].arity)]
            result = act(world, bound_step(name, things), RULES[rules_name])
            if isinstance(result, Failure):
                found.update(result.message().encode())
            else:
                world, done = result, done + 1
                found.update(digest(world).encode())
        found.update(repr(sorted((e.source, e.relation, e.target) for e in world.edges())).encode())
        found.update(repr([(n.id, n.states) for n in world.graph().nodes]).encode())
        masks = legal(world, 0, RULES[rules_name]).masks
        found.update(repr(sorted((name, masks[name]) for name in masks.keys())).encode())  # noqa: SIM118
    return found.hexdigest()[:32], done


@pytest.mark.parametrize("rules", STORED)
def test_ten_thousand_random_programs_of_set_2_do_and_say_what_they_did(rules):
    found, done = programs_digest(rules)
    assert done > 5_000
    assert found == STORED[rules]


@pytest.mark.parametrize("action", ["Break", "Fold", "Wait", "Dance", "Wrap"])
def test_sets_1_and_2_do_not_execute_what_only_set_3_does(action):
    graph = random_graph(random.Random(1))
    world = World.start(Home.from_graph(graph, "", default()))
    things = [graph.nodes[-1], graph.nodes[-2]][: default().actions[action].arity]
    for name in STORED:
        assert act(world, bound_step(action, things), RULES[name]).code is Code.NOT_SIMULATED
        assert action not in legal(world, 0, RULES[name]).masks
