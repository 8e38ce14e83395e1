"""An agent's beliefs about things that are gone from the place where it saw them."""

from __future__ import annotations

import pytest
from small_tasks import standing, start, target

from hearth.agents.belief import Belief
from hearth.schemas.rng import rng
from hearth.simulation.env import Env
from hearth.simulation.world.edit import edit
from hearth.simulation.world.world import World


def seen_by_who_stands_in_the_kitchen(world, place, states=()):
    """Return the views of an agent in the kitchen: the apple at a place, and then the apple in another room."""
    apple, bed = target(world, "apple"), target(world, "bed")
    views = []
    for there in (place, ("ON", bed)):
        now = edit(world, place={apple: there}, set=list(states), check=False)
        assert isinstance(now, World)
        env = Env()
        env.restore(standing(now, 0, "kitchen"))
        views.append(env.observe(0))
    return views


@pytest.mark.parametrize(
    ("relation", "furniture", "state"),
    [("INSIDE", "sink", ""), ("INSIDE", "fridge", "OPEN"), ("ON", "kitchen_counter", ""), ("INSIDE", "kitchen", "")],
)
def test_a_thing_that_is_not_seen_where_one_would_see_it_is_looked_for_elsewhere(maple, relation, furniture, state):
    world = start(maple, {"apple": 1})
    there = target(world, furniture)
    before, after = seen_by_who_stands_in_the_kitchen(world, (relation, there), [(there, state)] if state else ())
    apple = before.world.home.index[target(world, "apple")]
    belief = Belief(before.world.home, 1 << apple, rng(0, "belief"))
    belief.observe(before)
    assert belief.known >> apple & 1
    assert belief.where[apple].node == world.home.index[there]
    belief.observe(after)
    assert belief.where[apple].node != world.home.index[there]


def test_a_thing_in_what_was_closed_since_is_believed_to_be_there_still(maple):
    world = start(maple, {"apple": 1})
    fridge = target(world, "fridge")
    before, _ = seen_by_who_stands_in_the_kitchen(world, ("INSIDE", fridge), [(fridge, "OPEN")])
    closed, _ = seen_by_who_stands_in_the_kitchen(world, ("INSIDE", fridge), [(fridge, "CLOSED")])
    apple = before.world.home.index[target(world, "apple")]
    belief = Belief(before.world.home, 1 << apple, rng(0, "belief"))
    belief.observe(before)
    belief.observe(closed)
    assert belief.known >> apple & 1
    assert belief.where[apple].node == world.home.index[fridge]
