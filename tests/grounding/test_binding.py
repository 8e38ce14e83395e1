"""Counters are bound so that all steps can run."""

import pytest

from hearth.grounding.binding import Binding, bind, bind_far, nearest
from hearth.grounding.grounded_run import Trial, attempt
from hearth.homes.library import load_graph
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world import edge_rows
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

OFFICE = (
    Node(1, "home_office", "Rooms"),
    Node(2, "bedroom", "Rooms"),
    Node(3, "character", "Characters"),
    Node(10, "keyboard", "Electronics", ("GRABBABLE", "HAS_PLUG")),
    Node(11, "computer", "Electronics", ("HAS_SWITCH", "LOOKABLE"), ("OFF", "CLEAN")),
    Node(12, "keyboard", "Electronics", ("GRABBABLE", "HAS_PLUG")),
    Node(13, "computer", "Electronics", ("LOOKABLE",), ("CLEAN",)),
)
EDGES = (
    Edge(3, "INSIDE", 2),
    Edge(10, "INSIDE", 2),
    Edge(13, "INSIDE", 2),
    Edge(11, "INSIDE", 1),
    Edge(12, "INSIDE", 1),
    Edge(11, "CLOSE", 12),
    Edge(12, "CLOSE", 11),
)


def world(knowledge, nodes=OFFICE, edges=EDGES):
    return World.start(Home.from_graph(EnvironmentGraph(nodes, edges), "office", knowledge))


def program(*steps):
    return parse_program("Work\n\n\n" + "\n".join(steps))[0]


def test_the_keyboard_is_the_one_next_to_the_computer_that_was_switched_on(knowledge):
    work = program("[Walk] <computer> (1)", "[SwitchOn] <computer> (1)", "[Type] <keyboard> (1)")
    found = bind(work, world(knowledge))
    assert isinstance(found, Binding)
    assert found.nodes == {("computer", 1): 11, ("keyboard", 1): 12}
    assert run(world(knowledge), found.apply(work)).executable


def test_an_earlier_choice_is_undone_when_a_later_step_needs_it(knowledge):
    work = program("[Walk] <keyboard> (1)", "[Touch] <keyboard> (1)", "[SwitchOn] <computer> (1)")
    found = bind(work, world(knowledge))
    assert isinstance(found, Binding) and found.nodes[("keyboard", 1)] == 12


def test_two_instances_are_two_things(knowledge):
    found = bind(program("[Walk] <keyboard> (1)", "[Walk] <keyboard> (2)"), world(knowledge))
    assert isinstance(found, Binding) and len(set(found.nodes.values())) == 2


def test_without_a_binding_the_step_and_its_reason_are_told(knowledge):
    found = bind(program("[Walk] <computer> (1)", "[Open] <computer> (1)"), world(knowledge))
    assert isinstance(found, Failure) and found.code is Code.UNBOUND and found.tick == 0
    found = bind(program("[Walk] <computer> (1)", "[SwitchOff] <computer> (1)"), world(knowledge))
    assert isinstance(found, Failure) and found.code is Code.IS_OFF and found.tick == 1


def test_a_room_that_the_home_lacks_has_a_stand_in(knowledge):
    found = bind(program("[Walk] <kids_bedroom> (1)"), world(knowledge))
    assert isinstance(found, Binding) and found.nodes == {("kids_bedroom", 1): 2}


ROOMS = (Node(1, "dining_room", "Rooms"), Node(2, "bedroom", "Rooms"), Node(3, "bedroom", "Rooms"))


@pytest.mark.parametrize(
    ("rooms", "nodes"),
    [
        (["kitchen (1)", "dining_room (1)"], [1, 1]),
        (["dining_room (1)", "kitchen (1)"], [1, 1]),
        (["bedroom (1)", "bedroom (2)", "kids_bedroom (1)"], [2, 3, 3]),
        (["kitchen (1)", "kitchen (2)"], None),
    ],
)
def test_a_room_may_serve_as_another_too(knowledge, rooms, nodes):
    world = World.start(Home((*ROOMS, Node(9, "character", "Characters")), [Edge(9, "INSIDE", 2)], "flat", knowledge))
    lines = "".join(f"[Walk] <{room.replace(' ', '> ')}\n" for room in rooms)
    found = bind(parse_program(f"Rooms\n\n\n\n{lines}")[0], world)
    assert (list(found.nodes.values()) if isinstance(found, Binding) else None) == nodes


def test_nodes_named_by_their_ids_alone_stay_apart(knowledge):
    """As steps of `legal` name them: without instances, two of one class have one name."""
    one, other = (ObjectRef("keyboard", 0, node) for node in (10, 12))
    steps = [Step("Walk", (one,)), Step("Touch", (one,)), Step("Walk", (other,)), Step("Grab", (other,))]
    given = Program("Work", "", tuple(steps))
    found = bind(given, world(knowledge))
    assert isinstance(found, Binding) and found.apply(given) == given
    free = Step("Walk", (ObjectRef("keyboard", 1),))
    taken = bind(given.with_steps([*steps, free]), world(knowledge))
    assert isinstance(taken, Failure) and taken.code is Code.UNBOUND and taken.tick == 4


def test_where_some_objects_have_nodes_the_failure_is_that_of_the_search(knowledge):
    """A run of what is bound only in part would end at the first step, for want of a node."""
    home = Home.from_graph(EnvironmentGraph(OFFICE, EDGES), "office", knowledge)
    free, fixed = ObjectRef("keyboard", 1), ObjectRef("computer", 1, 11)
    steps = (Step("Walk", (free,)), Step("Walk", (fixed,)), Step("SwitchOff", (fixed,)))
    found = attempt(Program("Work", "", steps), home)
    assert isinstance(found, Failure) and (found.code, found.tick) == (Code.IS_OFF, 2)
    whole = attempt(Program("Work", "", steps[1:]), home)
    assert isinstance(whole, Trial) and whole.execution.failure.code is Code.IS_OFF


def test_without_characters_nobody_acts(knowledge):
    nobody = world(knowledge, [node for node in OFFICE if node.id != 3], [e for e in EDGES if e.source != 3])
    work = program("[Walk] <computer> (1)")
    found = bind(work, nobody)
    assert isinstance(found, Failure) and (found.code, found.tick) == (Code.UNKNOWN_AGENT, 0)
    assert nearest(work, nobody).nodes == {("computer", 1): 11}


def test_more_objects_than_an_action_takes_are_a_failure_of_their_step(knowledge):
    computer, keyboard = ObjectRef("computer", 1), ObjectRef("keyboard", 1)
    work = Program("Work", "", (Step("Walk", (computer,)), Step("Walk", (computer, keyboard))))
    found = bind(work, world(knowledge))
    assert isinstance(found, Failure) and (found.code, found.tick) == (Code.WRONG_ARITY, 1)
    assert nearest(work, world(knowledge)).nodes.keys() == {("computer", 1), ("keyboard", 1)}


def test_where_a_step_fails_all_the_same_the_best_candidates_are_told(knowledge):
    """The sink of the kitchen that one has walked to, and not the last one that was tried."""
    home = Home.from_graph(load_graph("maple", knowledge), "maple", knowledge)
    steps = program("[Walk] <kitchen> (1)", "[Walk] <sink> (1)", "[Wash] <hands_both> (1)")
    found, failure = bind_far(steps, World.start(home))
    assert failure is not None and failure.code is Code.UNBOUND
    room = home.index[found.nodes["kitchen", 1]]
    assert edge_rows.room_of(World.start(home), home.index[found.nodes["sink", 1]]) == room
