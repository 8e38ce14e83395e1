"""Processes that are asked again only where something has changed: as if every one were asked at every tick."""

import random

import pytest
from small_worlds import bound_step
from test_consequences import KNOWN, kitchen, ran, random_home

from hearth.schemas.failures import Failure
from hearth.simulation import processes
from hearth.simulation.engine import act
from hearth.simulation.processes import advanced, widened
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


@pytest.fixture
def incremental(monkeypatch):
    """Compare every answer with that of asking all processes; a list of the numbers of answers that were kept."""
    known, asked_all = processes._of_now, []

    def compared(world, counts, asked):
        found, fresh = known(world, counts, asked), known(world, counts, None)
        assert (found.rows, found.going_on, found.due) == (fresh.rows, fresh.going_on, fresh.due)
        assert {*fresh.watched} <= {*found.watched} and not fresh.beside & ~found.beside
        asked_all.append(asked is None)
        return found

    monkeypatch.setattr(processes, "_of_now", compared)
    return asked_all


@pytest.mark.parametrize(
    ("where", "steps"),
    [
        ({}, ("SwitchOn stove", "Wait 2", "Grab sauce_pan", "PutBack sauce_pan stove", "Wait 6", "Grab sauce_pan")),
        (
            {"sauce_pan": "ON stove"},
            ("SwitchOn stove", "Wait 5", "Grab apple", "PutBack apple sauce_pan", "Wait 9", "Grab apple", "Wait 2"),
        ),
        (
            {"apple": "INSIDE microwave"},
            ("SwitchOn microwave", "SwitchOn stove", "Wait 7", "Grab sauce_pan", "PutBack sauce_pan stove", "Wait 5"),
        ),
    ],
)
def test_what_is_put_on_a_device_at_work_or_taken_off_it(incremental, where, steps):
    world, ids = kitchen(**where)
    execution = ran(world, ids, *steps)
    assert incremental.count(False) >= 2
    assert any(each.has_state(ids["sauce_pan"], "HOT") for each in execution.worlds)


@pytest.mark.parametrize("seed", range(40))
def test_random_acts(incremental, seed):
    rng = random.Random(seed)
    graph = random_home(rng)
    world = widened(World.start(Home.from_graph(graph, "", KNOWN)))
    names = ("Grab", "PutBack", "PutIn", "SwitchOn", "SwitchOff", "Open", "Close", *sorted(KNOWN.actions))
    for _ in range(25):
        name = rng.choice(names)
        nodes = [rng.choice(graph.nodes) for _ in range(KNOWN.actions[name].arity)]
        after = act(world, bound_step(name, nodes), CONSEQUENCES)
        world = advanced(world, world if isinstance(after, Failure) else after)
