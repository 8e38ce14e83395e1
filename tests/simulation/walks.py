"""Walks over the floors of homes: homes, places in them, and all worlds of a walk to a node."""

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.engine import act
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

OWN = library.names()


def own_home(name):
    """One of our homes."""
    return Home.from_graph(library.load_graph(name, default()), name, default())


def step(action, *nodes, agent=0):
    """An instruction about nodes."""
    return Step(action, tuple(ObjectRef("thing", 1, node) for node in nodes), agent)


def id_of(home, name):
    """Id of the first thing of a class."""
    return home.ids[home.classes.index(name)]


def at(world, pose, number=0, stride=1.0):
    """The world with a character at a place, in whose room it is then."""
    ground = ground_of(world.home).ground
    room = 1 << ground.rooms[ground.ways.at(*pose.point)]
    agent = world.agents[number]._replace(pose=pose, stride=stride, inside=room)
    return World(world.home, world.states, (*world.agents[:number], agent, *world.agents[number + 1 :]), world.moved)


def walked(world, node, limit=200):
    """The worlds of walking to a node, until there is nothing left of the way."""
    worlds = [world]
    target = step("Walktowards", node)
    ground = ground_of(world.home).ground
    field = ground.ways.field(ground.stands(world.home.index[node]))
    while ground.ways.left(field, *worlds[-1].agents[0].pose.point)[0] > 1e-9:
        after = act(worlds[-1], target)
        assert isinstance(after, World), after
        worlds.append(after)
        assert len(worlds) < limit
    return worlds
