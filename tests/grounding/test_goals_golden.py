"""Environments drawn for goals and for several characters stay as they are until somebody means to change them."""

import pytest
from golden_files import compare, short

from hearth.grounding.environments.goal_environments import sample_for_goal
from hearth.grounding.environments.sampling_for_several_characters import sample_together
from hearth.homes import library
from hearth.kb.action_grammar import check
from hearth.schemas.failures import Failure
from hearth.schemas.syntax import parse_program
from hearth.simulation.goal_text import read_goal
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

HOMES = ("maple", "cedar", "willow", "juniper")

GOALS = (
    "ON(plate, dining_table): 2 and ON(cup, dining_table): 2",
    "INSIDE(food_apple, fridge) and CLOSED(fridge)",
    "HOLDS(agent, book) and SITTING(agent)",
    "CLEAN(sofa) and ON(television)",
    "INSIDE(plate, dishwasher): 3 then CLOSED(dishwasher)",
    "CLOSE(agent, milk) or ON(milk, table)",
    "exists x. (ON(x, table) and CLEAN(x))",
    "not ON(plate, dining_table)",
    "ON(plate, dining_table): 99",
)

TOGETHER = (
    "Tidy\nTidy up.\n\n\n<char0> [Walk] <cup> (1)\n<char1> [Walk] <plate> (1)\n<char0> [Grab] <cup> (1)\n"
    "<char1> [Grab] <plate> (1)\n",
    "Watch\nWatch.\n\n\n<char0> [Walk] <tv> (1)\n<char1> [Walk] <sofa> (1)\n<char0> [SwitchOn] <tv> (1)\n"
    "<char1> [Sit] <sofa> (1)\n",
)


def _environment(environment) -> str:
    return short((environment.nodes, environment.placed, environment.removed, environment.states, environment.movable,
                  World.start(environment.world.home).graph().edges, environment.world.graph().edges))  # fmt: skip


def _drawn(found) -> str:
    if isinstance(found, Failure):
        return found.message()
    environment, about = found
    return f"{_environment(environment)} {getattr(about, 'failure', None) and about.failure.message()}"


@pytest.fixture(scope="module")
def homes(knowledge):
    return [Home.from_graph(library.load_graph(name, knowledge), name, knowledge) for name in HOMES]


def test_what_is_drawn_for_goals_and_for_two(homes, knowledge):
    found = {}
    for home in homes:
        for number, text in enumerate(GOALS):
            found[f"{text} in {home.name}"] = _drawn(sample_for_goal(read_goal(text, home), home, number))
        for number, text in enumerate(TOGETHER):
            program = check(parse_program(text)[0], knowledge)[0]
            found[f"{program.title} in {home.name}"] = _drawn(sample_together(program, home, 2, number))
    compare("grounding/goals.json", found)
