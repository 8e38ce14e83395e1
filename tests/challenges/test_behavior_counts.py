"""Counts of behavior between two agents, in a kitchen with a plate on its table."""

from __future__ import annotations

import pytest

from hearth.challenges.behavior_counts import analysed
from hearth.challenges.challenge_definition import challenge
from hearth.kb.loading.load import default
from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.env import Env
from hearth.simulation.goals import Progress
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

WAH = challenge("wah")
KITCHEN, MAIN, HELPER, TABLE, SHELF, PLATE = range(1, 7)
NAMES = {PLATE: "plate", TABLE: "table", SHELF: "shelf"}
NODES = (
    Node(KITCHEN, "kitchen", "Rooms"),
    *(Node(each, "character", "Characters") for each in (MAIN, HELPER)),
    *(Node(each, NAMES[each], "Furniture", ("SURFACES",)) for each in (TABLE, SHELF)),
    Node(PLATE, NAMES[PLATE], "Props", ("GRABBABLE", "MOVABLE")),
)
ON_TABLE = Goal.of(Literal.of("ON", "plate", "table"))
ON_SHELF = Goal.of(Literal.of("ON", "plate", "shelf"))


def counted(*ticks, goals=(ON_TABLE, ON_TABLE), on=TABLE):
    """The columns of an episode, of each tick of which it is given what the two agents do with the plate."""
    edges = [Edge(each, "INSIDE", KITCHEN) for each in range(MAIN, PLATE + 1)] + [Edge(PLATE, "ON", on)]
    edges += [Edge(*each) for one in (MAIN, HELPER) for each in ((one, "CLOSE", PLATE), (PLATE, "CLOSE", one))]
    start = World.start(Home.from_graph(EnvironmentGraph(NODES, tuple(edges)), "", default()))
    env = Env(WAH.rules, WAH.partial)
    env.restore(start)
    progress = [Progress.start(goals[0], start)]
    for tick in ticks:
        steps = {n: Step(name, (ObjectRef("plate", 0, PLATE),), n) for n, name in enumerate(tick) if name}
        done = env.step(steps)
        assert not done.failures
        progress.append(progress[-1].then(done.before, done.world))
    return analysed(WAH, start, env.ticks, goals, progress)


GRAB, WALK, TOUCH, WAIT = "Grab", "Walk", "Touch", ""


@pytest.mark.parametrize(("first", "second"), [(GRAB, WAIT), (WAIT, GRAB)])
def test_what_an_agent_takes_from_the_goal_of_the_other_is_a_conflict(first, second):
    found = counted((first, second))
    assert (found.conflicts, found.undone) == (1, 1)


@pytest.mark.parametrize("tick", [(WALK, GRAB), (GRAB, WALK), (TOUCH, GRAB)])
def test_who_only_goes_to_what_the_other_takes_has_no_part_in_the_conflict(tick):
    assert counted(tick).conflicts == 1


def test_who_goes_to_what_the_other_takes_from_its_own_goal_is_in_no_conflict():
    goals = (ON_TABLE, ON_SHELF)
    assert counted((GRAB, WAIT), goals=goals).conflicts == 0
    assert counted((GRAB, WALK), goals=goals).conflicts == 0
    assert counted((WALK, GRAB), goals=(ON_SHELF, ON_TABLE)).conflicts == 0
    assert counted((WALK, GRAB), goals=(ON_SHELF, ON_TABLE), on=SHELF).conflicts == 1
