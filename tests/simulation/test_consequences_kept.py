"""Worlds of action set 3 are edited, stored and restored with their further states and the counts of processes."""

import random

import orjson
import pytest
from small_worlds import bound_step, node
from test_consequences import KNOWN, kitchen, ran, random_home

from hearth.schemas.failures import Failure
from hearth.schemas.graph import Edge
from hearth.simulation.engine import act
from hearth.simulation.processes import advanced, widened
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.action_set_3_states import counts_of
from hearth.simulation.world.digest import digest
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.simulation.world.world_json import export, restore


def wandered(seed: int, steps: int = 12) -> World:
    rng = random.Random(seed)
    graph = random_home(rng)
    world = widened(World.start(Home.from_graph(graph, "", KNOWN)))
    for _ in range(steps):
        action = KNOWN.actions[rng.choice(sorted(KNOWN.actions))]
        after = act(
            world, bound_step(action.name, [rng.choice(graph.nodes) for _ in range(action.arity)]), CONSEQUENCES
        )
        world = advanced(world, world if isinstance(after, Failure) else after)
    return world


@pytest.mark.parametrize("seed", range(20))
def test_a_world_is_restored_with_what_goes_on_in_it(seed):
    world = wandered(seed)
    there = restore(orjson.loads(orjson.dumps(export(world))), KNOWN)
    assert counts_of(there) == counts_of(world) and digest(there) == digest(world)
    for _ in range(12):
        world, there = advanced(world, world), advanced(there, there)
        assert digest(there) == digest(world)


def test_an_edit_enters_further_states_and_goes_on():
    world, ids = kitchen(apple="INSIDE microwave")
    world = ran(world, ids, "SwitchOn microwave", "Wait").final
    hot = edit(world, set=[(ids["kettle"], "HOT")], check=False)
    assert hot.has_state(ids["kettle"], "HOT") and counts_of(hot) == counts_of(world)
    cold = edit(hot, set=[(ids["kettle"], "COLD")], check=False)
    assert cold.has_state(ids["kettle"], "COLD") and not cold.has_state(ids["kettle"], "HOT")
    more = edit(world, add=[node(900, "apple", properties=("GRABBABLE", "EATABLE"))], link=[Edge(900, "INSIDE", 1)])
    assert counts_of(more) == counts_of(world) and more.has_state(900, "GONE") is False
    fewer = edit(more, remove=[ids["apple"]])
    assert not any(row >> more.home.index[ids["apple"]] & 1 for row in counts_of(fewer))
    assert ran(more, ids, "Wait", "Wait").final.has_state(ids["apple"], "HOT")


def test_a_node_of_a_low_number_starts_the_counts_again():
    world, ids = kitchen(apple="INSIDE microwave")
    world = ran(world, ids, "SwitchOn microwave", "Wait 4").final
    moved = edit(world, add=[node(0, "cup", properties=("GRABBABLE",))])
    assert moved.has_state(ids["apple"], "HOT") and set(counts_of(moved)) == {0}
