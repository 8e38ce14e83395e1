"""Environments that add only what a program needs and the home has nowhere: `run --sample`."""

from __future__ import annotations

import pytest

from hearth.grounding.environments.object_placement import USUAL_PLACE
from hearth.grounding.environments.sampling import Environment
from hearth.grounding.grounded_run import LEAST, attempt
from hearth.homes import library
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

FETCH = "[Walk] <kitchen> (1)\n[Find] <{0}> (1)\n[Grab] <{0}> (1)\n"
FOODS = ("milk", "juice", "beer", "food_egg", "food_butter", "food_vegetable", "food_bread", "wine", "food_cheese")
PLANS = {
    **{name: FETCH.format(name) for name in FOODS},
    "two milks": FETCH.format("milk") + "[Grab] <milk> (2)\n",
    "three milks": FETCH.format("milk")
    + "[Drop] <milk> (1)\n[Grab] <milk> (2)\n[Drop] <milk> (2)\n[Grab] <milk> (3)\n",
    "milk in the bedroom": "[Walk] <bedroom> (1)\n[Find] <milk> (1)\n[Drink] <milk> (1)\n",
    "plate": "[Walk] <kitchen> (1)\n[Grab] <plate> (1)\n",
    "book": "[Walk] <bathroom> (1)\n[Grab] <book> (1)\n[Read] <book> (1)\n",
    "shower": "[Walk] <shower> (1)\n",
    "hands": "[Find] <hands_both> (1)\n[Wash] <hands_both> (1)\n",
}
"""Things behind closed doors, in other rooms, too few, and missing."""


def sampled(text: str, home: Home, seed: int) -> Environment | None:
    program, faults = parse_program(f"T\n\n\n{text}")
    assert not faults
    trial = attempt(program, home, seed, size=LEAST)
    return getattr(trial, "environment", None)


def spare(home: Home, name: str, environment: Environment) -> list[int]:
    """Things of a class that the home has, that can be taken, and that the program does not use yet."""
    able, used = home.able("Grab"), {ref.node for ref in environment.program.objects()}
    return [
        home.ids[i]
        for i in indices(home.instances(name) & able & home.properties["GRABBABLE"])
        if home.ids[i] not in used and not home.bears[i] | home.contents[i]
    ]


@pytest.mark.parametrize("plan", PLANS)
@pytest.mark.parametrize("place", ["maple", "cedar"])
def test_nothing_is_added_that_the_home_has_to_spare(homes, plan, place):
    home, several = homes(place), 0
    for seed in range(6):
        environment = sampled(PLANS[plan], home, seed)
        for node in environment.nodes if environment else ():
            several += 1
            assert not spare(home, node.class_name, environment), (plan, node)
    assert several if plan == "shower" and place == "maple" else True


def test_what_is_added_or_moved_stands_in_a_usual_place(homes):
    home = homes("maple")
    seen = 0
    for plan in FOODS:
        for seed in range(8):
            environment = sampled(PLANS[plan], home, seed)
            if environment is None:
                continue
            ids, world = environment.world.home.index, environment.world.home
            for edge in environment.placed:
                name, holder = (world.classes[ids[node]] for node in (edge.source, edge.target))
                if edge.relation not in ("ON", "INSIDE") or name not in FOODS or world.rooms >> ids[edge.target] & 1:
                    continue
                rows = home.knowledge.placements(name)
                called = home.knowledge.same_class(holder)
                weights = [row.weight for row in rows if row.destination in called and row.edge == edge.relation]
                seen += 1
                assert max(weights, default=0) >= USUAL_PLACE - 1, (name, edge.relation, holder)
                assert holder not in ("trashcan", "water_glass", "cup", "sauce_pan"), (name, holder)
    assert seen > 20


def test_the_character_stays_in_its_room(homes):
    home = homes("maple")
    start = World.start(home)
    drawn = [sampled(PLANS[plan], home, seed) for plan in ("shower", "milk", "wine") for seed in range(4)]
    assert {room_of(each.world) for each in drawn} == {room_of(start)}


def room_of(world: World) -> str:
    me = world.home.ids[world.agents[0].index]
    names = {node.id: node.class_name for node in world.graph().nodes}
    (room,) = (names[e.target] for e in world.graph().edges if e.source == me and e.relation == "INSIDE")
    return room


@pytest.fixture(scope="module")
def homes(knowledge):
    known = {}
    return lambda name: known.setdefault(name, Home.from_graph(library.load_graph(name, knowledge), name, knowledge))
