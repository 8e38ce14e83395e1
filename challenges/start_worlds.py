"""The worlds in which tasks start: things of goals are taken away and put back elsewhere, more of them than are wanted.

Appendix B.2.3 draws where they lie in the thesis's homes; ours are brought to their default state first.
"""

from __future__ import annotations

from collections import defaultdict
from functools import lru_cache
from random import Random
from typing import NamedTuple

from hearth.challenges.challenge_definition import Challenge, challenge
from hearth.challenges.goal_grammar import instance, wanted_things
from hearth.grounding.environments.default_state import Base, prepared
from hearth.homes.library import load_graph
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge, Node
from hearth.schemas.rng import rng
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, CHARACTER_CLASS
from hearth.simulation.motion import positions
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit, extended, free_id
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

Places = tuple[tuple[tuple[str, int], ...], ...]
"""(ON or INSIDE, id of a piece of furniture), those of one relation and one class of furniture together."""


class Site(NamedTuple):
    """A home without the things that goals are about.

    Attributes:
        base: the home as it was, in its default state.
        home: without those things, and without characters.
        places: class of things -> where they may be.
        anywhere: where some of them may be.
    """

    base: Base
    home: Home
    places: dict[str, Places]
    anywhere: Places


def start(which: Challenge, goal: Goal, home: str, seed: int, knowledge: Knowledge, agents: int | None = None) -> World:
    """Return a world in which nothing of a goal is reached, all of it can be, and its agents stand in different rooms.

    Of each class there are as many things as are wanted, up to one more than any goal wants. For each thing first the
    relation and the class of its place are drawn, then the place: where such things belong, or, if in this home they
    belong only where they are wanted, where any of the challenge's things do.

    Args:
        which: the challenge whose goal it is.
        goal: of its grammar.
        home: name of one of our homes.
        seed: all the randomness there is.
        knowledge: the knowledge that the home is read with.
        agents: the first of the challenge's characters only; the world is the same but for the others.

    Raises:
        HearthError: UNKNOWN_HOME; UNKNOWN_OBJECT where the home lacks furniture of the goal; NO_PLACE where no thing
            belongs anywhere in it but where it is wanted; NO_ROOM where there are fewer rooms than agents.
    """
    site = site_of(which.name, home, which.knowledge(knowledge))
    chooser = rng(seed, "start", home)
    nodes, edges = _characters(which, site.home, chooser)
    wanted, wrong = wanted_things(goal), _wanted_at(which, goal, site.home)
    for name, most in sorted(which.grammar.most_of.items()):
        least = wanted.get(name, 0)
        places = _allowed(site.places[name], wrong[name]) or _allowed(site.anywhere, wrong[name])
        number = chooser.randint(least, max(least, most + 1))
        if number and not places:
            raise HearthError.of(Code.NO_PLACE, f"{home} has no place for {name} but where it is wanted")
        for _ in range(number):
            relation, place = chooser.choice(chooser.choice(places))
            nodes.append(_thing(site.base, name, nodes[-1].id + 1))
            edges += _placed(site.base, nodes[-1].id, relation, place)
    if agents is not None:
        absent = {node.id for node in nodes[agents : which.agents]}
        nodes = [node for node in nodes if node.id not in absent]
        edges = [edge for edge in edges if edge.source not in absent]
    world = positions.placed(World.start(extended(site.home, nodes, edges)), rng(seed, "poses", home))
    walking = (agent._replace(stride=stride) for agent, stride in zip(world.agents, which.strides, strict=False))
    return World(world.home, world.states, tuple(walking), world.moved)


@lru_cache(maxsize=32)
def site_of(name: str, home: str, knowledge: Knowledge) -> Site:
    """Return a home of ours without the things that goals of a challenge are about; made once.

    Raises:
        HearthError: UNKNOWN_HOME.
    """
    which = challenge(name)
    base = prepared(Home.from_graph(load_graph(home, knowledge), home, knowledge))
    things = {i for each in which.grammar.most_of for i in indices(base.home.instances(each))}
    gone = sorted(base.home.ids[i] for i in (*things, *base.home.agents))
    cleared = edit(World.start(base.home), remove=gone, check=False)
    assert isinstance(cleared, World)
    places = {each: _places(which, base, each) for each in which.grammar.most_of}
    groups = [group for each in places.values() for group in each]
    return Site(base, cleared.home, places, tuple(sorted(set(groups))))


def _places(which: Challenge, base: Base, name: str) -> Places:
    """Return where a thing may be at a start.

    Where the knowledge places it, but nowhere that is carried, sat or lain on.
    """
    home = base.home
    never = base.seats | home.properties["GRABBABLE"]
    found: defaultdict[tuple[str, str], set[int]] = defaultdict(set)
    for _, i, relation in base.spots(name).choices:
        if not never >> i & 1 and home.classes[i] not in which.never_at and base.room[i] >= 0:
            found[relation, home.classes[i]].add(home.ids[i])
    return tuple(tuple((relation, i) for i in sorted(ids)) for (relation, _), ids in sorted(found.items()))


def _wanted_at(which: Challenge, goal: Goal, home: Home) -> defaultdict[str, set[int]]:
    """Class of things -> ids of the furniture at which a goal wants them."""
    found: defaultdict[str, set[int]] = defaultdict(set)
    for literal, _ in goal:
        if literal.target in which.grammar.furniture:
            found[str(literal.subject)].add(instance(str(literal.target), home))
    return found


def _allowed(places: Places, wrong: set[int]) -> Places:
    rest = (tuple(place for place in group if place[1] not in wrong) for group in places)
    return tuple(group for group in rest if group)


def _characters(which: Challenge, home: Home, chooser: Random) -> tuple[list[Node], list[Edge]]:
    rooms = [home.ids[i] for i in indices(home.rooms)]
    if len(rooms) < which.agents:
        raise HearthError.of(Code.NO_ROOM, f"{home.name} has {len(rooms)} rooms for {which.agents} agents")
    first = free_id(home)
    nodes = [Node(first + n, CHARACTER_CLASS, CHARACTER_CATEGORY, ("PERSON",)) for n in range(which.agents)]
    chosen = chooser.sample(rooms, which.agents)
    return nodes, [Edge(node.id, "INSIDE", room) for node, room in zip(nodes, chosen, strict=True)]


def _thing(base: Base, name: str, number: int) -> Node:
    """Return a new node of the class that the knowledge knows by that name."""
    known = base.knowledge.object_class(name)
    called = known.name if known else name
    category, properties, states = base.kind(called)
    return Node(number, called, category, properties, states)


def _placed(base: Base, thing: int, relation: str, place: int) -> list[Edge]:
    room = base.home.ids[base.room[base.home.index[place]]]
    return [Edge(thing, relation, place), Edge(thing, "CLOSE", place), Edge(thing, "INSIDE", room)]
