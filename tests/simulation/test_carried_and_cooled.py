"""Action set 3: what stands on a carried thing comes along, and fridges cool what they were found with."""

from small_worlds import ROOMS, bound_step, node
from test_consequences import KNOWN, kitchen, ran

from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.program import Program
from hearth.simulation.engine import run
from hearth.simulation.processes import widened
from hearth.simulation.world import edge_rows
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

BEDROOM = 800


def with_a_bedroom(graph: EnvironmentGraph) -> EnvironmentGraph:
    return EnvironmentGraph((*graph.nodes, node(BEDROOM, ROOMS[1])), graph.edges)


def test_what_is_on_what_one_carries_comes_along():
    world, ids = kitchen(apple="ON plate")
    world = World.start(Home.from_graph(with_a_bedroom(world.graph()), "", KNOWN))
    done = ran(world, {**ids, "bedroom": BEDROOM}, "Grab plate", "Walk bedroom").final
    apple, plate = (done.home.index[ids[name]] for name in ("apple", "plate"))
    assert edge_rows.room_of(done, apple) == edge_rows.room_of(done, plate) == done.home.index[BEDROOM]
    edges = set(done.edges())
    assert Edge(ids["apple"], "ON", ids["plate"]) in edges and Edge(ids["apple"], "INSIDE", 1) not in edges
    by_set_2 = run(world, Program(steps=(bound_step("Grab", [world.home.node(plate)]),))).final
    assert not [e for e in by_set_2.edges() if e.target == ids["plate"] and e.relation == "ON"]


def test_what_is_in_a_fridge_is_cold_when_one_comes_if_it_is_plugged_in():
    for name, is_cold in (("PLUGGED_IN", True), ("PLUGGED_OUT", False)):
        things = [node(1, "kitchen"), node(2, "character", properties=("PERSON",)), node(4, "milk")]
        things.append(
            node(3, "fridge", properties=("CAN_OPEN", "HAS_SWITCH", "HAS_PLUG"), states=("CLOSED", "OFF", name))
        )
        edges = (*(Edge(n.id, "INSIDE", 1) for n in things[1:]), Edge(4, "INSIDE", 3))
        world = widened(World.start(Home.from_graph(EnvironmentGraph(tuple(things), edges), "", KNOWN)))
        assert world.has_state(4, "COLD") is is_cold
