"""Inference, places of states and repairs know the checks, tools and states of action set 3."""

import pytest

from hearth.grounding.environments.soundness import unsound
from hearth.grounding.preconditions.postconditions import achieved
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.repair.repair_trimming import _undo
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph_change import Change, encode
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_program
from hearth.simulation.actions.consequences import tools_of
from hearth.simulation.engine import act, run
from hearth.simulation.processes import widened
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.derived_homes import changed
from hearth.simulation.world.home import Home
from hearth.simulation.world.placement_fit import impossible
from hearth.simulation.world.world import World

KNOWN = default().of_set(3)


@pytest.fixture(scope="module")
def maple() -> Home:
    return Home.from_graph(library.load_graph("maple", KNOWN), "maple", KNOWN)


def program(*steps: str) -> Program:
    found, faults = parse_program("Acts\n\n" + "\n".join(steps) + "\n", "")
    assert not faults
    return found


def one(home: Home, name: str) -> int:
    return home.ids[next(i for i, each in enumerate(home.classes) if each == name)]


def bound(home: Home, action: str, *names: str) -> Step:
    return Step(action, tuple(ObjectRef(name, 1, one(home, name)) for name in names))


def test_a_tool_that_is_missing_is_named_and_a_start_with_it_in_hand_is_found():
    steps = ("[Walk] <desk> (1)", "[Find] <paper> (1)", "[Touch] <pen> (1)", "[Write] <paper> (1)")
    found = infer(program(*steps), KNOWN, CONSEQUENCES)
    assert not isinstance(found, Failure) and found.has("holds", ("pen", 1), ("character", 1))


@pytest.mark.parametrize("steps", [("[Call]",), ("[Vacuum] <floor> (1)",), ("[Shave] <face> (1)",)])
def test_without_a_tool_no_start_helps_and_nothing_breaks(steps):
    found = infer(program(*steps), KNOWN, CONSEQUENCES)
    assert isinstance(found, Failure) and found.code is not Code.INTERNAL_ERROR


def test_a_failure_names_the_tool_and_not_the_thing_that_is_worked_on(maple):
    world = widened(World.start(maple))
    walked = act(world, bound(maple, "Walk", "paper"), CONSEQUENCES)
    found = act(walked, bound(maple, "Write", "paper"), CONSEQUENCES)
    assert isinstance(found, Failure) and found.code is Code.NOT_HOLDING and found.names == ("pen",)
    names, tools = tools_of(KNOWN.action("Write").preconditions[-1].formula, world)
    assert names[0] == "pen" and found.objects[0] in {maple.ids[i] for i in tools}


def test_washing_twice_contradicts_nothing_and_opening_twice_does():
    assert KNOWN.group("operates") == default().group("operates")


def test_acts_that_undo_each_other_are_trimmed_by_set_3():
    paper = (ObjectRef("paper", 1, 7),)
    assert _undo(Step("Fold", paper), Step("Unfold", paper), False, KNOWN)
    assert not _undo(Step("Cut", paper), Step("Unfold", paper), False, KNOWN)


def test_further_states_of_a_start_are_stored_and_read_again(maple):
    bowl = one(maple, "bowl")
    home = changed(maple, Change(set_states=((bowl, "COLD"), (bowl, "DIRTY")), cleared_states=((bowl, "CLEAN"),)))
    world = widened(World.start(home))
    assert world.has_state(bowl, "COLD") and world.has_state(bowl, "DIRTY") and not world.has_state(bowl, "CLEAN")
    assert "COLD" in home.node(home.index[bowl]).states and "COLD" not in maple.node(maple.index[bowl]).states
    warm = changed(home, Change(cleared_states=((bowl, "COLD"),)))
    assert not widened(World.start(warm)).has_state(bowl, "COLD") and widened(World.start(home)).has_state(bowl, "COLD")


def test_graphs_of_set_3_differ_by_states_and_not_by_nodes(maple):
    world = widened(World.start(maple))
    after = run(world, Program(steps=(bound(maple, "Walk", "bowl"),)), CONSEQUENCES).final
    bowl = maple.index[one(maple, "bowl")]
    states = [*after.states]
    states[10] |= 1 << bowl
    cold = World(maple, tuple(states), after.agents, after.moved)
    assert encode(after.graph(), cold.graph()) == cold.changes(after) == Change(set_states=((maple.ids[bowl], "COLD"),))


def test_two_states_that_exclude_each_other_are_unsound(maple):
    world = widened(World.start(maple))
    states = [*world.states]
    assert unsound(world) is None
    states[10] |= 1 << 20
    states[11] |= 1 << 20
    found = unsound(World(maple, tuple(states), world.agents, world.moved))
    assert found is not None and found.code is Code.CONTRADICTION and found.expected == "COLD or HOT"


def test_an_edit_may_say_by_set_3_that_something_is_cold(maple):
    milk = maple.index[one(maple, "milk")]
    usual = Home.from_graph(library.load_graph("maple", default()), "maple", default())
    assert impossible(maple, milk, "COLD") is None
    assert impossible(usual, milk, "COLD") is not None


def test_states_that_end_by_themselves_are_no_goal(maple):
    acts = (bound(maple, "Walk", "kettle"), bound(maple, "SwitchOn", "kettle"), *[bound(maple, "Wait")] * 4)
    execution = run(widened(World.start(maple)), Program(steps=acts), CONSEQUENCES)
    assert execution.executable and execution.final.has_state(one(maple, "kettle"), "HOT")
    assert "HOT" not in {fact.name for fact in achieved(execution)}


def test_a_state_that_an_act_brings_about_only_at_times_has_no_achiever():
    assert KNOWN.achiever("CUT") == "Cut" and KNOWN.achiever("FOLDED") == "Fold"
    assert KNOWN.achiever("EMPTY") == KNOWN.achiever("FULL") == ""  # Drink empties a cup, and nobody drinks a sink
