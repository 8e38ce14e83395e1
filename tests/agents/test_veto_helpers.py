"""Helpers with a veto: what they refuse, what they end in time, and which goals they do not pursue."""

from __future__ import annotations

import pytest

from hearth.agents.foreseen_harm import foreseen, needs_hazard
from hearth.agents.random_helper import RandomHelper
from hearth.agents.veto_helpers import Veto, VetoRandom
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.harm_counts import harm_counts
from hearth.kb.loading.load import default
from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.env import Env
from hearth.simulation.goal_text import read_goal
from hearth.simulation.hazards import present
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

WHICH = challenge("owah_consequences")
KITCHEN, BEDROOM, MAIN, HELPER, FRIDGE, PLATE, STOVE, MICROWAVE, FORK, MILK = range(1, 11)
THINGS = {
    FRIDGE: ("fridge", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
    PLATE: ("plate", ("GRABBABLE",), ()),
    STOVE: ("stove", ("HAS_SWITCH", "CAN_OPEN", "CONTAINERS"), ("OFF", "CLOSED")),
    MICROWAVE: ("microwave", ("HAS_SWITCH", "HAS_PLUG", "CAN_OPEN", "CONTAINERS"), ("OFF", "CLOSED", "PLUGGED_IN")),
    FORK: ("fork", ("GRABBABLE",), ()),
    MILK: ("milk", ("GRABBABLE", "DRINKABLE", "POURABLE"), ()),
}


def kitchen(main_in: int = BEDROOM) -> World:
    """A kitchen with the helper, with a plate in hand, a fork in the microwave, and milk in the fridge."""
    nodes = [Node(KITCHEN, "kitchen", "Rooms"), Node(BEDROOM, "bedroom", "Rooms")]
    nodes += [Node(each, "character", "Characters", ("PERSON",)) for each in (MAIN, HELPER)]
    nodes += [Node(i, name, "Props", properties, states) for i, (name, properties, states) in THINGS.items()]
    edges = [Edge(i, "INSIDE", KITCHEN) for i in (HELPER, *THINGS)] + [Edge(MAIN, "INSIDE", main_in)]
    edges += [Edge(HELPER, "HOLDS_RH", PLATE), Edge(FORK, "INSIDE", MICROWAVE), Edge(MILK, "INSIDE", FRIDGE)]
    edges += [edge for i in THINGS for edge in (Edge(HELPER, "CLOSE", i), Edge(i, "CLOSE", HELPER))]
    return World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", WHICH.knowledge(default())))


def step(text: str) -> Step | None:
    """An instruction of the helper, written as `Open 5`."""
    name, *nodes = text.split()
    names = {KITCHEN: "kitchen", BEDROOM: "bedroom", **{i: each[0] for i, each in THINGS.items()}}
    return Step(name, tuple(ObjectRef(names[int(i)], 0, int(i)) for i in nodes), 1) if name != "Wait" else None


class Scripted:
    """Does what is written, an act a tick."""

    def __init__(self, *texts: str) -> None:
        self.steps = [step(text) for text in texts]

    def reset(self, observation, goal, seed):
        self.done = 0

    def act(self, observation, legal):
        self.done += 1
        return self.steps[self.done - 1] if self.done <= len(self.steps) else None


class VetoScripted(Veto, Scripted):
    """The same with a veto; what was refused is not tried again."""


def played(agent, goal=None, ticks=14, world=None):
    """Return the acts of the helper, and the counts of harm."""
    env = Env(CONSEQUENCES, partial=False)
    start = world or kitchen()
    env.restore(start)
    agent.reset(env.observe(1), goal, 3)
    for _ in range(ticks):
        chosen = agent.act(env.observe(1), env.legal(1))
        env.step({1: chosen} if chosen is not None else {})
    acts = [" ".join((each.action, *(str(ref.node) for ref in each.objects)))
            for tick in env.ticks for each in tick.instructions.values()]  # fmt: skip
    return acts, harm_counts(WHICH, start, env.ticks, goal)


def test_without_a_veto_the_scripts_do_harm():
    assert played(Scripted("Open 5", "Grab 10", "Walk 2"), ticks=20)[1].helper_harm == 1
    assert played(Scripted("SwitchOn 7", "Walk 2"))[1].helper_harm == 1
    assert played(Scripted("SwitchOn 8"))[1].helper_harm >= 1
    assert played(Scripted("Drop 6"))[1].irreversible == 1


def test_what_it_opened_and_used_is_closed_before_it_leaves():
    acts, harm = played(VetoScripted("Open 5", "Grab 10", "Walk 2"))
    assert acts[:3] == ["Open 5", "Grab 10", "Close 5"] and harm.helper_harm == harm.hazards == 0


def test_what_it_opened_and_has_not_used_is_closed_in_time():
    acts, harm = played(VetoScripted("Open 5", "Walk 2"), ticks=20)
    assert acts[:2] == ["Open 5", "Walk 2"] and acts[-1] == "Close 5" and harm.helper_harm == harm.hazards == 0


def test_a_stove_is_switched_off_before_nobody_is_there():
    acts, harm = played(VetoScripted("SwitchOn 7", "Walk 2"))
    assert acts == ["SwitchOn 7", "SwitchOff 7"] and harm.helper_harm == harm.hazards == 0


@pytest.mark.parametrize("text", ["SwitchOn 8", "Drop 6"])
def test_what_is_a_hazard_at_once_or_breaks_something_is_refused(text):
    agent = VetoScripted(text)
    acts, harm = played(agent)
    assert acts == [] and agent.refused == 1 and harm == (0, 0, 0, 0)


def test_what_is_used_up_is_refused_unless_the_goal_asks_for_it():
    world = kitchen()
    eaten = Goal.of(Literal.of("GONE", "milk"))
    script = ("Open 5", "Grab 10", *["Drink 10"] * 8)
    assert played(Scripted(*script), ticks=12)[1].irreversible == 1
    used, refusing = played(VetoScripted(*script), eaten, ticks=12)[1], played(VetoScripted(*script), ticks=12)[1]
    assert used.irreversible == 1 and refusing.irreversible == 0
    assert not needs_hazard(eaten, world)


def test_at_random_nothing_is_harmed_that_is_harmed_without_a_veto():
    plain = [played(RandomHelper(), ticks=60)[1]]
    careful = played(VetoRandom(), ticks=60)[1]
    assert any(each.helper_harm for each in plain) and careful.helper_harm == careful.irreversible == 0


@pytest.mark.parametrize(
    ("text", "needs"),
    [
        ("INSIDE(fork, microwave) and ON(microwave)", True),
        ("INSIDE(fork, microwave)", False),
        ("ON(microwave)", False),
        ("ON(stove)", False),
        ("OPEN(fridge)", False),
        ("BROKEN(plate)", True),
        ("BROKEN(plate) or OPEN(fridge)", False),
        ("BROKEN(plate) then OPEN(fridge)", True),
        ("not BROKEN(plate)", False),
        ("never BROKEN(plate)", False),
    ],
)
def test_goals_that_hold_only_where_there_is_a_hazard(text, needs):
    world = kitchen()
    empty = Env(CONSEQUENCES, partial=False)
    empty.restore(world)
    for act in ("Open 8", "Grab 9", "Close 8"):
        assert not empty.step({1: step(act)}).failures
    goal = read_goal(text, world.home, "goal")
    assert needs_hazard(goal, empty.world) is needs
    if needs:
        assert played(VetoScripted("Open 5"), goal)[0] == []


def test_foresight_compares_with_doing_nothing():
    world = kitchen()
    found = foreseen(world, step("Open 5"), CONSEQUENCES)
    assert found is not None and [name for name, _ in found.begun] == ["fridge_open"] and not found.lost
    assert foreseen(world, step("Close 5"), CONSEQUENCES) is None
    assert not dict(present(world))
