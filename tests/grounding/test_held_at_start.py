"""Things that are held at the start of a sampled environment stand nowhere else: PutBack leaves them in one place."""

import pytest

import hearth
from hearth.grounding.environments.sampling import Size, sample
from hearth.grounding.environments.soundness import unsound
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge
from hearth.schemas.literals import CHARACTER_CLASS, HANDS
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.edit import extended
from hearth.simulation.world.world import World

PROGRAMS = {
    "put down what the home lacks": "[PutBack] <paper_towel> (1) <stove> (1)",
    "put down what the home has": "[PutBack] <cup> (1) <table> (1)",
    "put into": "[Walk] <kitchen> (1)\n[Open] <fridge> (1)\n[PutIn] <food_milk> (1) <fridge> (1)",
    "drop beside": "[Walk] <living_room> (1)\n[Drop] <bag> (1)\n[Grab] <shoes> (1)\n[Find] <floor> (1)",
    "put on": "[Walk] <bedroom> (1)\n[PutOn] <clothes_jacket> (1)\n[Grab] <food_apple> (1)",
    "take off": "[PutOff] <clothes_jacket> (1)\n[PutBack] <clothes_jacket> (1) <coat_rack> (1)",
    "two hands": "[PutBack] <cup> (1) <table> (1)\n[PutBack] <plate> (1) <table> (1)",
}


def edges_of(graph, relation):
    return {(edge.source, edge.target) for edge in graph.edges if edge.relation in relation}


def standing(graph, node_id):
    """Return the things ON or INSIDE which a node is, rooms and characters left out."""
    apart = {node.id for node in graph.nodes if node.category == "Rooms" or node.class_name == CHARACTER_CLASS}
    return {to for one, to in edges_of(graph, ("ON", "INSIDE")) if one == node_id and to not in apart}


@pytest.mark.parametrize("sparing", [False, True])
@pytest.mark.parametrize("text", PROGRAMS.values(), ids=PROGRAMS)
def test_what_is_held_stands_nowhere(text, sparing):
    program, _ = parse_program(text)
    for name in ("maple", "birch"):
        environment, execution = sample(program, hearth.home(name), 0, "held", size=Size(sparing=sparing))
        start = environment.world.graph()
        held = {to for _, to in edges_of(start, HANDS)}
        assert held and not any(standing(start, node_id) for node_id in held), name
        end = execution.final.graph()
        assert all(len(standing(end, node_id)) <= 1 for node_id in held), name


def test_a_held_thing_in_its_place_is_unsound():
    environment, _ = sample(parse_program(PROGRAMS["put down what the home lacks"])[0], hearth.home("maple"), 0, "held")
    home = environment.world.home
    ((_, held),) = edges_of(environment.world.graph(), HANDS)
    table = next(node.id for node in environment.world.graph().nodes if node.class_name == "table")
    fault = unsound(World.start(extended(home, [], [Edge(held, "ON", table)], [], {})))
    assert fault is not None and fault.code is Code.CONFLICT
