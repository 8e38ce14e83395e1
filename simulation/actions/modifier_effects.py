"""Steps done as their modifiers say: by which hand, at which place, looking which way."""

from hearth.homes.plans.walkable_floor import REACH
from hearth.kb.modifiers import faults, numbers, value
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Box
from hearth.schemas.program import Step
from hearth.simulation.actions.common import refuse
from hearth.simulation.motion import positions
from hearth.simulation.motion.ground import distance_to, ground_of
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World

PLACED = frozenset({"at", "facing"})
"""Modifiers that need characters at places."""


def modified(before: World, after: World, step: Step, o: int, s: int) -> World | Failure:
    """Return the world after a step that was done, as its modifiers ask, or why that can't be."""
    found: World | Failure = after
    for _, message, remedy in faults(step, before.home.knowledge):
        return refuse(before, Code.NOT_SIMULATED, remedy, message)
    if hand := value(step, "hand"):
        found = _by_hand(before, after, step, o, hand)
    if isinstance(found, World) and (point := numbers(step, "at")):
        found = _lies_on(found, s, (point[0], point[1])) if s >= 0 else _stands_at(found, step, o, (point[0], point[1]))
    if isinstance(found, World) and (yaw := numbers(step, "facing")):
        pose = found.agents[step.agent].pose
        found = _unplaced(found) if pose is None else _with_pose(found, step.agent, pose._replace(yaw=yaw[0] % 360))
    return found


def _by_hand(before: World, after: World, step: Step, o: int, hand: str) -> World | Failure:
    """Return the hand holds what was taken, or gave what was held; an action on anything else needs it free."""
    old, new = before.agents[step.agent], after.agents[step.agent]
    holding = getattr(old, hand)
    taken = new.held & ~old.held
    if not taken and old.held >> o & 1:
        if holding >> o & 1:
            return after
        return refuse(before, Code.NOT_HOLDING, f"the object in the {hand} hand", "in the other hand", o)
    if holding:
        return refuse(before, Code.NO_FREE_HAND, f"a free {hand} hand", "it holds something", o)
    if not taken:
        return after
    right, left = (old.right | taken, old.left) if hand == "right" else (old.right, old.left | taken)
    return after.with_agent(step.agent, new._replace(right=right, left=left))


def _lies_on(world: World, s: int, point: tuple[float, float]) -> World | Failure:
    """Put an object at a point of something.

    Checked here, drawn by films, and not part of the world, which knows ON and no point. No action, no predicate and no
    observation asks where on a table a thing is (its place is that of its support, `positions.spot`), and worlds that
    differ in nothing else have one digest; a replay of the same steps draws it at the same point.
    """
    here = ground_of(world.home)
    box = None if here is None else here.ground.box(s)
    if here is None or box is None:
        return _unplaced(world)
    if distance_to(box, point) > 0:
        return refuse(world, Code.NO_PLACE, f"a point of it, {_bounds(box)}", _text(point), s)
    return world


def _stands_at(world: World, step: Step, o: int, point: tuple[float, float]) -> World | Failure:
    here, agent = ground_of(world.home), world.agents[step.agent]
    if here is None or agent.pose is None:
        return _unplaced(world)
    ground = here.ground
    cell = ground.ways.at(*point)
    box = ground.box(o)
    in_room = cell >= 0 and bool(ground.ways.main[cell]) and agent.inside >> ground.rooms[cell] & 1
    if not in_room or (box is not None and distance_to(box, point) > REACH):
        return refuse(world, Code.NO_PLACE, f"free floor of its room within {REACH:g} m of it", _text(point), o)
    pose = positions.facing(world, Pose(*point, agent.pose.yaw), o)
    near = agent.close | positions.near(world, step.agent, pose)
    return _with_pose(world.with_agent(step.agent, agent._replace(close=near)), step.agent, pose)


def _with_pose(world: World, number: int, pose: Pose) -> World:
    return world.with_agent(number, world.agents[number]._replace(pose=pose))


def _unplaced(world: World) -> Failure:
    return refuse(world, Code.NO_PLACE, "a home with geometry", "no place of it is known")


def _bounds(box: Box) -> str:
    (x, _, z), (width, _, depth) = box
    return f"x {x - width / 2:.2f} to {x + width / 2:.2f}, z {z - depth / 2:.2f} to {z + depth / 2:.2f}"


def _text(point: tuple[float, float]) -> str:
    return f"{point[0]:g}, {point[1]:g}"
