"""Starts of `household`: worlds in which nothing of a goal holds, and all of it can be brought about."""

from __future__ import annotations

from itertools import combinations
from random import Random

from hearth.challenges.household_definition import home_named, settings
from hearth.grounding.environments.default_state import Base, prepared
from hearth.grounding.environments.goal_environments import sample_for_goal
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Failure
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HANDS, HOLDS, Literal, Name
from hearth.schemas.rng import rng
from hearth.schemas.vocabulary import OPPOSITE
from hearth.simulation.goals import Progress
from hearth.simulation.literal_truth import candidates
from hearth.simulation.motion import positions
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.edit import edit
from hearth.simulation.world.world import World

MOVED = 0.5
"""The probability that a thing of a goal is brought to another place where it belongs."""


def start_for_goal(goal: Goal, home: str, seed: int, knowledge: Knowledge) -> World | None:
    """Return a world in which nothing of a goal holds; None where none was found."""
    found = sample_for_goal(Goal(goal.counts), home_named(home, knowledge), seed, "household")
    if isinstance(found, Failure):
        return None
    base = prepared(home_named(home, knowledge))
    world: World | None = found[0].world
    chooser = rng(seed, "household start", home)
    for literal, _ in goal:
        world = None if world is None else undone(world, base, literal, goal, chooser)
    return None if world is None or any(Progress.start(goal, world).counts) else settled(world, seed)


def overlaps(goal: Goal, world: World) -> bool:
    """Return whether one thing could be counted for two literals of a goal, or more is to be held than hands hold."""
    held = sum(number for literal, number in goal if literal.name == HOLDS)
    some = [(each.name, candidates(each, world.home)) for each, _ in goal]
    things = [(name, one.targets if one.by_target else one.subjects) for name, one in some]
    return held > len(HANDS) or any(
        first[1] & second[1] and first[0] == second[0] for first, second in combinations(things, 2)
    )


def settled(world: World, seed: int) -> World:
    """Return a world with its agent at a place in its room, where it walks by meters."""
    placed = positions.placed(world, rng(seed, "household pose"))
    agents = tuple(agent._replace(stride=settings()["stride"]) for agent in placed.agents[:1])
    return World(placed.home, placed.states, (*agents, *placed.agents[1:]), placed.moved)


def undone(world: World, base: Base, literal: Literal[Name], goal: Goal, chooser: Random) -> World | None:
    """Return the world in which a literal holds of nothing; None where a thing has no other place."""
    some = candidates(literal, world.home)
    if literal.target is None:
        state = literal.name if literal.negated else OPPOSITE[literal.name]
        ids = [world.home.ids[i] for i in indices(some.met(world)[0])]
        set_back = edit(world, set=[(each, state) for each in ids], check=False)
        return set_back if isinstance(set_back, World) else None
    things = some.targets if some.by_target else some.subjects
    met = 0 if some.by_target else some.met(world)[0]
    movable = world.home.properties["GRABBABLE"]
    for i in indices(things & movable):
        # An agent looks into furniture, and not into every box and basket.
        must = met >> i & 1 or edge_rows.inside(world, i) & movable
        if must or chooser.random() < MOVED:
            after = _moved(world, base, i, goal, chooser)
            if after is None and must:
                return None
            world = after or world
    return world


def _moved(world: World, base: Base, thing: int, goal: Goal, chooser: Random) -> World | None:
    """Return the world in which a thing is where it belongs, but nowhere where the goal wants it."""
    home, spots = world.home, base.spots(world.home.classes[thing])
    wrong = [candidates(each, home) for each, _ in goal if each.target is not None]
    taken = mask_of(j for each in wrong if each.subjects >> thing & 1 for j in indices(each.targets))
    never = base.seats | base.home.properties["GRABBABLE"]
    free = [
        (base.home.ids[j], relation)
        for _, j, relation in spots.choices
        if not never >> j & 1 and base.home.classes[j] not in settings()["never_at"]
    ]
    free = [
        (node, relation) for node, relation in free if not taken >> home.index.get(node, 0) & 1 and node in home.index
    ]
    if not free:
        return None
    node, relation = chooser.choice(free)
    after = edit(world, place={home.ids[thing]: (relation, node)}, check=False)
    return after if isinstance(after, World) else None
