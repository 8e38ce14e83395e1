"""Starting places of things in tasks: the distributions of the thesis's figures B-4 and B-5."""

from collections import Counter
from typing import NamedTuple

from hearth.analysis.object_distribution import Counts
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.goal_grammar import wanted_things
from hearth.challenges.task_files import Suite
from hearth.kb.knowledge import Knowledge
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.world import World


class Starts(NamedTuple):
    """Counts of places by class.

    Attributes:
        everything: of all things of a challenge's goals (figure B-4).
        wanted: of the classes that a task's goal wants (figure B-5).
        numbers: class -> how many there are of it, over tasks.
        agents: how many agents start in each kind of room.
    """

    everything: Counts
    wanted: Counts
    numbers: dict[str, Counter[int]]
    agents: Counter[str]


def starts(suite: Suite, knowledge: Knowledge) -> Starts:
    """Count where things and agents are at the starts of tasks."""
    names = tuple(challenge(suite.challenge).grammar.most_of)
    found = Starts(
        {name: Counter() for name in names},
        {name: Counter() for name in names},
        {n: Counter() for n in names},
        Counter(),
    )
    for task in suite.tasks:
        world = task.start(knowledge)
        goal = wanted_things(task.goal)
        for name in names:
            here = world.home.instances(name) & world.home.everything
            found.numbers[name][here.bit_count()] += 1
            for i in indices(here):
                place = place_of(world, i)
                found.everything[name][place] += 1
                found.wanted[name][place] += name in goal
        found.agents.update(world.home.classes[edge_rows.agent_room(world, agent)] for agent in world.agents)
    return found


def place_of(world: World, i: int) -> str:
    """Return the place of a thing, as `ON table` or `INSIDE fridge`."""
    for relation, places in (("ON", edge_rows.on(world, i)), ("INSIDE", edge_rows.inside(world, i))):
        furniture = places & ~world.home.rooms
        if furniture:
            return f"{relation} {world.home.classes[lowest(furniture)]}"
    return "floor"
