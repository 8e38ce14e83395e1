"""Walktowards, Walkforward, Turnleft, Turnright: moving by metres and degrees where there is geometry (table 2.2).

They need characters at places (see `motion.positions`). The symbolic world follows. A character under way is CLOSE to
the things that it passes, in the room that it crosses. A character that has arrived has walked there.
"""

from __future__ import annotations

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import Action, Masks, refuse, some
from hearth.simulation.actions.locomotion import arrived, destination, gone, need_legs
from hearth.simulation.actions.situation import Situation
from hearth.simulation.motion import positions
from hearth.simulation.motion.giving_way import stride_aside
from hearth.simulation.motion.ground import Here, ground_of
from hearth.simulation.motion.navigation import BODY_RADIUS
from hearth.simulation.motion.stride_ahead import SHARES, SLACK, closed_doors, in_the_way, others_of, stride_ahead
from hearth.simulation.rules import Rules
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

TURN = 30.0
"""Degrees of one Turnleft or Turnright."""


def walk_towards(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Make a stride along the shortest way.

    At its end the character has walked there. A character that can't pass another one waits.
    """
    agent = world.agents[number]
    room = destination(world, agent, o, rules)
    if isinstance(room, Failure):
        return room
    here, pose = ground_of(world.home), agent.pose
    ends = positions.ends(world, here, o) if here is not None else ()
    if here is None or pose is None or not ends:
        return refuse(world, Code.NO_PATH, "something with a place", "no place of it is known", o)
    ways = here.ground.ways
    shut = here.ground.shut(closed_doors(world, rules))
    x, z, cell = ways.stepped(ways.field(ends, shut), pose.x, pose.z, agent.stride)
    if rules.bodies and cell != -2 and in_the_way(world, number, (pose, Pose(x, z))):
        taken = ways.blocked(other.pose.point for other in others_of(world, number) if other.pose is not None)
        taken[ways.around(pose.x, pose.z)] = False
        without = tuple(sorted({*shut, *taken.nonzero()[0].tolist()}))
        way = ways.detour(ends, without)
        for share in SHARES:
            x, z, cell = ways.stepped(way, pose.x, pose.z, agent.stride * share)
            if cell == -2 or not in_the_way(world, number, (pose, Pose(x, z)), 2 * BODY_RADIUS - SLACK):
                break
        else:
            cell = -2
        if cell == -2:
            return world
    if cell == -2:
        return refuse(world, Code.NO_PATH, "a free way over the floor", "none", o)
    there = Pose(x, z, pose.yaw)
    if cell == -1:
        return arrived(world, number, o, room, positions.facing(world, there, o), rules)
    there = Pose(x, z, pose.towards((x, z)).yaw)
    return _under_way(world, number, here, there)


def stepped_aside(world: World, number: int, other: int, target: int, rules: Rules) -> World:
    """Return the world after a character has made a stride out of another's way to a thing, if it can."""
    there = stride_aside(world, number, other, target, rules)
    here = ground_of(world.home)
    return world if here is None or there is None else _under_way(world, number, here, there)


def walk_forward(world: World, number: int, _: int, __: int, rules: Rules) -> World | Failure:
    """Straight on, over floor that is free all the way."""
    agent = world.agents[number]
    failure = need_legs(world, agent)
    if failure is not None:
        return failure
    here = ground_of(world.home)
    there, free = stride_ahead(world, number, rules)
    if here is None or there is None:
        return refuse(world, Code.NO_PATH, f"{agent.stride:g} m of free floor ahead", f"{free:.2f} m")
    return _under_way(world, number, here, there)


def _under_way(world: World, number: int, here: Here, pose: Pose) -> World:
    near, room = positions.around(world, number, here, pose)
    return gone(world, number, near, room, pose)


def turn(degrees: float) -> Action:
    """Return a turn about oneself; one faces nothing named then."""

    def rule(world: World, number: int, _: int, __: int, rules: Rules) -> World | Failure:
        agent = world.agents[number]
        pose = agent.pose
        if pose is None:
            return refuse(world, Code.NOT_SIMULATED, "a character at a place", "none")
        turned = Pose(pose.x, pose.z, (pose.yaw + degrees) % 360)
        return world.with_agent(number, agent._replace(facing=0, pose=turned))

    return Action("Turnleft" if degrees < 0 else "Turnright", rule, lambda s: ())


def _towards(s: Situation) -> Masks:
    if s.resting:
        return None
    return some(s.walkable & s.walked_to)


def _forward(s: Situation) -> Masks:
    if s.resting:
        return None
    return () if s.ahead else None


ACTIONS = (
    Action("Walktowards", walk_towards, _towards),
    Action("Walkforward", walk_forward, _forward),
    turn(-TURN),
    turn(TURN),
)


def followed(before: World, world: World, number: int, action: str, o: int) -> World:
    """Return the world after an action, its character turned to its target, on its seat, or next to the seat that it
    was on before and has left.
    """
    agent = world.agents[number]
    pose = agent.pose
    if pose is None:
        return world
    known = world.home.knowledge
    if action in known.group("looks") and o >= 0:
        there = positions.facing(world, pose, o)
    elif action in known.group("rests") and o >= 0:
        there = positions.resting(world, pose, o)
    elif action in known.group("rises"):
        there = positions.risen(before, number, pose)
    else:
        return world
    if there == pose:
        return world
    agents = (*world.agents[:number], agent._replace(pose=there), *world.agents[number + 1 :])
    return World(world.home, world.states, agents, world.moved)
