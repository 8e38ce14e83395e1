"""Moving by metres and degrees where there is geometry: Walktowards, Walkforward, Turnleft, Turnright (table 2.2).

The symbolic world follows: who has left a thing is no longer CLOSE to it, and who has arrived has walked there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Box, Spot
from hearth.schemas.program import Step
from hearth.simulation.actions.common import refuse
from hearth.simulation.engine import act
from hearth.simulation.motion.navigation import Pose, Ways, along, distance_to
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world import rows
from hearth.simulation.world.bits import indices, lowest
from hearth.simulation.world.moved import carry
from hearth.simulation.world.states import LYING, SITTING
from hearth.simulation.world.world import World

STRIDE = 1.0
"""Metres of one Walktowards or Walkforward; a fast helper's is 3 (thesis 7.3)."""

TURN = 30.0
"""Degrees of one Turnleft or Turnright."""


@dataclass(frozen=True, slots=True)
class Located:
    """A world and where its characters stand, by agent number. A value, like the world."""

    world: World
    poses: tuple[Pose, ...]

    def others(self, number: int) -> tuple[Spot, ...]:
        """Where the other characters stand."""
        return tuple(pose.point for i, pose in enumerate(self.poses) if i != number)


def located(world: World) -> Located:
    """The characters where their boxes have them; who has none, because it was added, in the middle of its room.

    Raises:
        KeyError: neither a character nor its room has a box; only homes with geometry can be moved in by metres.
    """
    poses = []
    for agent in world.agents:
        node = world.home.node(agent.index)
        room = rows.agent_room(world, agent)
        box = node.box or (world.home.node(room).box if room >= 0 else None)
        if box is None:
            raise KeyError(f"character {node.id} has no box")
        poses.append(Pose(box.center[0], box.center[2], node.yaw or 0.0))
    return Located(world, tuple(poses))


def do(
    here: Located, instruction: Step, ways: Ways, stride: float = STRIDE, rules: Rules = DEFAULT
) -> Located | Failure:
    """One instruction of one character, by metres where it is one of the four moves, else as the engine does it.

    What the engine does moves the character too: to where it stands for what it has walked to, or turned to what it
    faces.
    """
    move = MOVES.get(instruction.action)
    if move is not None:
        result = move(here, instruction, ways, stride, rules)
        if isinstance(result, Failure):
            return replace(result, agent=instruction.agent, action=instruction.action)
        return result
    world = act(here.world, instruction, rules)
    if isinstance(world, Failure):
        return world
    return Located(world, _follow(here, world, instruction, ways))


def spot(here: Located, node: int) -> Box | None:
    """The box of a node as things stand: with whom holds it, on or in what it was put, else where the home has it.

    What was added to a home has no box of its own: it is where it stands on or in.
    """
    world = here.world
    for number, agent in enumerate(world.agents):
        if agent.index == node or agent.held >> node & 1:
            x, z = here.poses[number].point
            return Box((x, 0.9, z), (0.1, 0.1, 0.1))
    box = world.home.node(node).box
    if box is None or (world.moved.on | world.moved.inside) >> node & 1:
        place = lowest((rows.on(world, node) | rows.inside(world, node)) & ~world.home.rooms)
        if place >= 0 and place != node:
            return spot(here, place)
    return box


def _walk_towards(here: Located, step: Step, ways: Ways, stride: float, rules: Rules) -> Located | Failure:
    """A stride along the shortest free path; the last one is a Walk."""
    number = step.agent
    target = here.world.home.index.get(step.objects[0].node or -1, -1) if step.objects else -1
    box = spot(here, target) if target >= 0 else None
    failure = _need_legs(here.world, number)
    if failure is not None:
        return failure
    if box is None:
        return refuse(here.world, Code.NO_ROOM, "something with a place", "no box, or nothing", target)
    pose = here.poses[number]
    others = here.others(number)
    node = here.world.home.node(target)
    goal = ways.stand(box, node.yaw, others, pose.point)
    path = ways.path(pose.point, goal.point if goal else (box.center[0], box.center[2]), others)
    if path is None:
        return refuse(here.world, Code.NO_PATH, "a free path over the floor", "none", target)
    end = along(path, stride)
    moved = Pose(*end).towards((box.center[0], box.center[2]))
    if math.dist(end, path[-1]) < 1e-9 and distance_to(box, end) <= _near(here.world, target):
        arrived = act(here.world, Step("Walk", step.objects, number), rules)
        return arrived if isinstance(arrived, Failure) else _at(here, number, moved, arrived)
    return _at(here, number, moved, _departed(here.world, number, moved.point))


def _walk_forward(here: Located, step: Step, ways: Ways, stride: float, rules: Rules) -> Located | Failure:
    """Straight on, over floor that is free all the way."""
    number = step.agent
    failure = _need_legs(here.world, number)
    if failure is not None:
        return failure
    pose = here.poses[number]
    taken = ways.blocked(here.others(number))
    angle = math.radians(pose.yaw)
    for metres in _steps(stride, ways.floor.cell / 2):
        point = (pose.x + math.sin(angle) * metres, pose.z + math.cos(angle) * metres)
        i, j = ways.floor.index(*point)
        inside = 0 <= i < ways.floor.walkable.shape[0] and 0 <= j < ways.floor.walkable.shape[1]
        if not inside or ways.number[i, j] < 0 or taken[ways.number[i, j]]:
            return refuse(here.world, Code.NO_PATH, f"{stride:g} m of free floor ahead", f"{metres:.2f} m")
    return _at(here, number, Pose(point[0], point[1], pose.yaw), _departed(here.world, number, point))


def _turn(degrees: float) -> Move:
    def turn(here: Located, step: Step, ways: Ways, stride: float, rules: Rules) -> Located | Failure:
        pose = here.poses[step.agent]
        agent = here.world.agents[step.agent]
        world = here.world.with_agent(step.agent, agent._replace(facing=0))
        return _at(here, step.agent, Pose(pose.x, pose.z, (pose.yaw + degrees) % 360), world)

    return turn


Move = Callable[[Located, Step, Ways, float, Rules], Located | Failure]

MOVES: dict[str, Move] = {
    "Turnleft": _turn(-TURN),
    "Turnright": _turn(TURN),
    "Walkforward": _walk_forward,
    "Walktowards": _walk_towards,
}


def _at(here: Located, number: int, pose: Pose, world: World) -> Located:
    return Located(world, (*here.poses[:number], pose, *here.poses[number + 1 :]))


def _steps(stride: float, step: float) -> list[float]:
    count = max(1, math.ceil(stride / step))
    return [stride * (i + 1) / count for i in range(count)]


def _need_legs(world: World, number: int) -> Failure | None:
    resting = (world.states[SITTING] | world.states[LYING]) & world.agents[number].bit
    return refuse(world, Code.SITTING, "standing", "sitting or lying") if resting else None


def _near(world: World, target: int) -> float:
    """Metres within which one has arrived: a room's floor itself, anything else at arm's length."""
    return 0.0 if world.home.rooms >> target & 1 else math.inf


def _departed(world: World, number: int, point: Spot) -> World:
    """The world once a character is under way: CLOSE to nothing but what it holds, in the room that the point is in."""
    agent = world.agents[number]
    room = _room_at(world, point)
    if room < 0:
        room = rows.agent_room(world, agent)
    moved = world.moved
    for i in indices(agent.held):
        moved = carry(moved, i, room)
    inside = 1 << room if room >= 0 else 0
    going = agent._replace(close=agent.held, facing=0, faced=0, inside=inside, contents=0)
    after = world.with_agent(number, going)
    return World(world.home, world.states, after.agents, moved)


def _room_at(world: World, point: Spot) -> int:
    for i in indices(world.home.rooms):
        box = world.home.node(i).box
        if box is not None and distance_to(box, point) == 0.0:
            return i
    return -1


def _follow(here: Located, world: World, step: Step, ways: Ways) -> tuple[Pose, ...]:
    """Where the characters stand after an action of the engine."""
    number = step.agent
    knowledge = world.home.knowledge
    pose = here.poses[number]
    target = world.home.index.get(step.objects[0].node or -1, -1) if step.objects else -1
    box = spot(here, target) if target >= 0 else None
    resting = (world.states[SITTING] | world.states[LYING]) & world.agents[number].bit
    if box is None or (resting and step.action in knowledge.group("goes")):
        return here.poses
    if step.action in knowledge.group("looks"):
        moved: Pose | None = pose.towards((box.center[0], box.center[2]))
    elif world.agents[number].inside != here.world.agents[number].inside or step.action in knowledge.group("goes"):
        moved = ways.stand(box, world.home.node(target).yaw, here.others(number), pose.point)
    elif step.action in knowledge.group("rests"):
        moved = Pose(box.center[0], box.center[2], world.home.node(target).yaw or pose.yaw)
    else:
        moved = None
    return here.poses if moved is None else (*here.poses[:number], moved, *here.poses[number + 1 :])
