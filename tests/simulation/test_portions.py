"""Food and drink of action set 3 that is not used up at once: four portions, and what is left of them."""

import pytest
from small_worlds import bound_step, node
from test_consequences import KNOWN, ran, states

from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.simulation.engine import act
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


def test_bread_has_four_portions_and_what_lies_on_a_plate_one():
    """A loaf is cut, eaten from and put back: only its last portion leaves nothing."""
    nodes = [
        node(1, "kitchen"), node(2, "character", properties=("PERSON",)), node(4, "plate", properties=("SURFACES",)),
        *(node(k, "food_bread", properties=("GRABBABLE", "EATABLE", "CUTTABLE")) for k in (3, 5)),
    ]  # fmt: skip
    edges = [*(Edge(n.id, "INSIDE", 1) for n in nodes[1:]), Edge(5, "ON", 4), Edge(2, "HOLDS_RH", 3)]
    edges += [edge for k in (3, 4) for edge in (Edge(2, "CLOSE", k), Edge(k, "CLOSE", 2))]
    world = World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", KNOWN))
    ids = {"bread": 3, "plate": 4, "served": 5}
    for state in ("BEGUN", "HALF_LEFT", "LAST_LEFT"):
        world = ran(world, ids, "Eat bread").final
        assert {name for thing, name in states(world) if thing == 3} == {state} and world.holding() == {0: (3,)}
    last = ran(world, ids, "Eat bread").final
    assert last.has_state(3, "GONE") and last.holding() == {0: ()}
    assert ran(world, ids, "Eat plate").final.has_state(5, "GONE")


@pytest.mark.parametrize("name", ["milk", "beer", "juice", "water"])
def test_a_drink_is_drunk_in_portions_and_its_carton_stays(name):
    """Milk and beer stay as an empty carton, juice is gone with its last portion, water with its first."""
    properties = KNOWN.object_class(name).properties
    nodes = [node(1, "kitchen"), node(2, "character", properties=("PERSON",)), node(3, name, properties=properties)]
    edges = [Edge(2, "INSIDE", 1), Edge(3, "INSIDE", 1), Edge(2, "HOLDS_RH", 3), Edge(2, "CLOSE", 3)]
    world = World.start(Home.from_graph(EnvironmentGraph(tuple(nodes), tuple(edges)), "", KNOWN))
    for state in ("BEGUN", "HALF_LEFT", "LAST_LEFT") if name != "water" else ():
        world = ran(world, {name: 3}, f"Drink {name}").final
        assert {each for thing, each in states(world) if thing == 3} == {state}
    last = ran(world, {name: 3}, f"Drink {name}").final
    stays = name in ("milk", "beer")
    left = {each for thing, each in states(last) if thing == 3} - {"LAST_LEFT"}
    assert left == {"EMPTY" if stays else "GONE"}
    again = act(last, bound_step("Drink", [world.home.node(2)]), CONSEQUENCES)
    assert isinstance(again, Failure) and again.code is (Code.WRONG_STATE if stays else Code.NOT_HOLDING), again


def test_every_drink_has_portions_by_its_class_and_not_by_its_name():
    """A drink that somebody adds is drunk in portions, too: no list names it."""
    text = str(KNOWN.derived["portions"][1])
    drinks = [each.name for each in KNOWN.objects.values() if "DRINKABLE" in each.properties]
    assert {"milk", "beer"} <= {*drinks} and not [name for name in drinks if name != "water" and f", {name})" in text]
