"""Another world that one agent can't tell from a given one: only what it does not see is different."""

from __future__ import annotations

import random

from hearth.homes.object_shapes import form
from hearth.schemas.graph import Node
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.observation import containment, visible_nodes
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit, free_id
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.states import CLOSED
from hearth.simulation.world.world import World

PAIRS = (("OPEN", "CLOSED"), ("ON", "OFF"), ("CLEAN", "DIRTY"), ("PLUGGED_IN", "PLUGGED_OUT"))


def scrambled(world: World, number: int, chooser: random.Random) -> World:
    """Things, states and characters out of an agent's sight moved, changed, added and taken away.

    Rooms, doors, and what stands on the floor stay: they belong to what never changes in a home.
    """
    mask = visible_nodes.visible(world, world.agents[number])
    world = _states(world, mask, chooser)
    world = _removed(world, mask, chooser)
    world = _moved(world, mask, chooser)
    world = _added(world, mask, chooser)
    return _others_elsewhere(world, mask, chooser)


def _states(world, mask, chooser):
    home = world.home
    changes = []
    for i in indices(home.everything & ~mask & ~home.characters):
        for one, other in PAIRS:
            if chooser.random() < 0.3 and (world.has_state(home.ids[i], one) or world.has_state(home.ids[i], other)):
                changes.append((home.ids[i], chooser.choice((one, other))))
    return edit(world, set=changes, check=False)


def _movable(world, mask):
    """Unseen things that stand neither on the floor nor in anybody's sight, and bear or hold nothing."""
    home = world.home
    for i in indices(home.everything & ~mask & ~home.rooms & ~home.characters & ~home.doors):
        shape = form(home.classes[i], home.knowledge)
        bare = not (edge_rows.bearing(world, i) | edge_rows.contents(world, i))
        if bare and (shape is None or shape.mount != "floor") and home.properties["GRABBABLE"] >> i & 1:
            yield i


def hiding_places(world, mask):
    """(relation, id) of places out of sight: in what is closed here, in and on what is in other rooms."""
    home = world.home
    for i in indices(mask & world.states[CLOSED] & home.properties["CAN_OPEN"] & ~home.doors & ~home.rooms):
        yield "INSIDE", home.ids[i]
    for i in indices(home.everything & ~mask & ~home.rooms & ~home.characters & home.furniture):
        yield "INSIDE", home.ids[i]
        yield "ON", home.ids[i]


def _removed(world, mask, chooser):
    gone = [world.home.ids[i] for i in _movable(world, mask) if chooser.random() < 0.15]
    return edit(world, remove=gone)


def _moved(world, mask, chooser):
    places = list(hiding_places(world, mask))
    moves = [world.home.ids[i] for i in _movable(world, mask) if places and chooser.random() < 0.4]
    for node in moves:
        place = chooser.choice(places)
        if place[1] != node:
            world = edit(world, place={node: place}, check=False)
    return world


def _added(world, mask, chooser):
    places = list(hiding_places(world, mask))
    for name in chooser.sample(["apple", "plate", "milk", "book", "cup"], 3 if places else 0):
        node = Node(free_id(world.home), name, "Food", ("GRABBABLE",), ("CLEAN",))
        world = edit(world, add=[node], place={node.id: chooser.choice(places)}, check=False)
    return world


def _others_elsewhere(world, mask, chooser):
    """Characters out of sight stand somewhere else out of sight, with other things in their hands' memory."""
    here = ground_of(world.home)
    rooms = [
        i for i in indices(world.home.rooms) if not containment.contained(world, 1 << i) & mask & ~world.home.rooms
    ]
    agents = list(world.agents)
    for n, agent in enumerate(agents):
        if agent.bit & mask or not rooms or agent.held or chooser.random() < 0.3:
            continue
        room = chooser.choice(rooms)
        pose = agent.pose
        if here is not None and pose is not None:
            cells = [c for c, r in enumerate(here.ground.rooms) if r == room]
            pose = Pose(*here.ground.ways.points[chooser.choice(cells)].tolist(), 30.0 * chooser.randrange(12))
        agents[n] = agent._replace(inside=1 << room, close=0, facing=0, on=0, pose=pose)
    return World(world.home, world.states, tuple(agents), world.moved)
