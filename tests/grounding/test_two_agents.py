"""Programs of several agents are bound tick by tick, and get the characters that they need."""

from hearth.grounding.binding import bind
from hearth.grounding.grounded_run import Trial, attempt
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

NODES = (
    Node(1, "kitchen", "Rooms"),
    Node(2, "bedroom", "Rooms"),
    Node(3, "character", "Characters"),
    Node(10, "table", "Furniture", ("SURFACES",)),
    Node(11, "cup", "Props", ("GRABBABLE",)),
    Node(12, "fridge", "Appliances", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
)
EDGES = (*(Edge(node, "INSIDE", 1) for node in (3, 10, 11, 12)), Edge(11, "ON", 10), Edge(11, "CLOSE", 10))


def home(knowledge):
    return Home.from_graph(EnvironmentGraph(NODES, EDGES), "flat", knowledge)


def program(*lines):
    return parse_program("Together\n\n\n" + "\n".join(lines))[0]


def test_both_act_in_one_tick(knowledge):
    lines = (
        "<char0> [Walk] <cup> (1) | <char1> [Walk] <fridge> (1)",
        "<char0> [Grab] <cup> (1) | <char1> [Open] <fridge> (1)",
    )
    trial = attempt(program(*lines), home(knowledge))
    assert isinstance(trial, Trial)
    assert len(trial.execution.worlds) == 3
    changed = trial.execution.changes()[1]
    assert {edge.relation for edge in changed.added} >= {"HOLDS_RH"}
    assert (12, "OPEN") in changed.set_states


def test_two_who_grab_one_cup_are_a_conflict_of_that_tick(knowledge):
    lines = (
        "<char0> [Walk] <cup> (1) | <char1> [Walk] <cup> (1)",
        "<char0> [Grab] <cup> (1) | <char1> [Grab] <cup> (1)",
    )
    failure = attempt(program(*lines), home(knowledge))
    assert isinstance(failure, Failure)
    assert (failure.code, failure.tick, failure.agent) == (Code.CONFLICT, 1, 1)


def test_a_character_that_is_named_is_another_than_who_acts(knowledge):
    lines = ("[Walk] <cup> (1)", "[Grab] <cup> (1)", "[Walk] <character> (1)", "[PutBack] <cup> (1) <character> (1)")
    trial = attempt(program(*lines), home(knowledge))
    assert isinstance(trial, Trial)
    end = trial.execution.final
    holder = {edge.source for edge in end.edges() if edge.relation.startswith("HOLDS")}
    assert holder and 3 not in holder


def test_nobody_is_bound_to_itself(knowledge):
    failure = bind(program("[Walk] <character> (1)"), World.start(home(knowledge)))
    assert isinstance(failure, Failure)
    assert failure.code is Code.UNBOUND
