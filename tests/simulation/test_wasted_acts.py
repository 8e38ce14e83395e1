"""Waste: things that are opened, moved, or left on or open without need."""

from small_worlds import bound_step, node
from test_consequences import KNOWN

from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.literals import Literal
from hearth.schemas.program import Program
from hearth.simulation.engine import run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.harm import harm_among
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.wasted_acts import wasted_among
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

FRIDGE, MILK, TABLE, LAMP, PERSON = 4, 5, 6, 7, 3


def kitchen() -> World:
    """A kitchen with milk in a closed fridge, an empty table and a lamp that is off."""
    nodes = [
        node(1, "kitchen"),
        node(PERSON, "character", properties=("PERSON",)),
        node(FRIDGE, "fridge", properties=("CAN_OPEN", "CONTAINERS"), states=("CLOSED",)),
        node(MILK, "milk", properties=("GRABBABLE",)),
        node(TABLE, "table", properties=("SURFACES",)),
        node(LAMP, "tablelamp", properties=("HAS_SWITCH",), states=("OFF",)),
    ]
    edges = [Edge(each.id, "INSIDE", 1) for each in nodes[1:]] + [Edge(MILK, "INSIDE", FRIDGE)]
    edges += [
        edge for i in (FRIDGE, MILK, TABLE, LAMP) for edge in (Edge(PERSON, "CLOSE", i), Edge(i, "CLOSE", PERSON))
    ]
    return World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", KNOWN))


def ran(*texts: str):
    world, steps = kitchen(), []
    for text in texts:
        action, *names = text.split()
        steps.append(bound_step(action, [world.home.node(world.home.index[int(name)]) for name in names]))
    execution = run(world, Program(steps=tuple(steps)), CONSEQUENCES)
    assert execution.executable, execution.failure
    return execution.worlds


def found(worlds, goal: Goal | None = None):
    return [(each.thing, each.state, each.step) for each in wasted_among(worlds, goal)]


CARRIED = ("Open 4", "Grab 5", "Close 4", "PutBack 5 6")


def test_what_is_left_on_or_open_is_waste_but_where_the_goal_asks_for_it():
    worlds = ran("Open 4", "SwitchOn 7")
    assert found(worlds) == [(FRIDGE, "OPEN", 1), (LAMP, "ON", 2)]
    assert found(worlds, read_goal("ON(tablelamp)", worlds[0].home, "goal")) == [(FRIDGE, "OPEN", 1)]
    assert found(ran("SwitchOn 7", "SwitchOff 7")) == []


def test_a_container_is_opened_in_vain_where_nothing_goes_in_or_out():
    assert found(ran("Open 4", "Wait", "Close 4")) == [(FRIDGE, "OPENED", 1)]
    assert found(ran("Open 4", "Grab 5", "Close 4")) == []
    assert found(ran("Open 4", "Grab 5", "PutIn 5 4", "Close 4")) == []


def test_what_is_moved_is_waste_where_the_goal_does_not_count_it():
    worlds = ran(*CARRIED)
    assert found(worlds) == []
    assert found(worlds, Goal.of(Literal.of("ON", "milk", "table"))) == []
    assert found(worlds, Goal.of(Literal.of("ON", "tablelamp", "table"))) == [(MILK, "MOVED", 4)]
    back = ran("Open 4", "Grab 5", "PutIn 5 4", "Close 4")
    assert found(back, Goal.of(Literal.of("ON", "tablelamp", "table"))) == []


def test_of_a_goal_in_parts_nothing_is_wasted_that_a_part_is_about():
    worlds = ran(*CARRIED)
    assert found(worlds, read_goal("ON(milk, table) then ON(tablelamp)", worlds[0].home, "goal")) == []
    assert found(worlds, read_goal("not ON(milk, table)", worlds[0].home, "goal")) == [(MILK, "MOVED", 4)]


def test_an_episode_that_ends_in_the_middle_counts_what_has_lasted():
    worlds = ran("Open 4", "Wait")
    assert [each.hazard.name for each in harm_among(worlds).hazards] == ["fridge_open"]
    assert harm_among(worlds, ends=False).counts == (0, 0, 1)
    long = ran("Open 4", *["Wait"] * 15)
    assert [(each.lasted, each.at_end) for each in harm_among(long, ends=False).hazards] == [(16, True)]
