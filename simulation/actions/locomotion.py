"""Walk, Run, Find, TurnTo: the character's place and the nodes that it faces."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions import doors
from hearth.simulation.actions.common import Action, Masks, need_close, refuse, some
from hearth.simulation.actions.situation import Situation
from hearth.simulation.motion import positions
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent, made
from hearth.simulation.world.bits import indices
from hearth.simulation.world.moved_edges import NOTHING, carry
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.states import LYING, SITTING
from hearth.simulation.world.world import World


def walk(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Go to o, into its room; Run is the same."""
    agent = world.agents[number]
    room = destination(world, agent, o, rules)
    if isinstance(room, Failure):
        return room
    pose = None if agent.pose is None else positions.beside(world, agent.pose, o)
    return arrived(world, number, o, room, pose, rules)


def need_legs(world: World, agent: Agent, *objects: int) -> Failure | None:
    """Refuse who sits or lies."""
    states = world.states
    if not (states[SITTING] | states[LYING]) & agent.bit:
        return None
    lying = states[LYING] & agent.bit
    return refuse(world, Code.LYING if lying else Code.SITTING, "standing", "lying" if lying else "sitting", *objects)


def destination(world: World, agent: Agent, o: int, rules: Rules) -> int | Failure:
    """Index of the room in which a walk to o ends, or why there can be none."""
    failure = need_legs(world, agent, o)
    if failure is not None:
        return failure
    room = edge_rows.room_of(world, o)
    if rules.doors and world.home.between[o]:
        room = doors.side(world, agent, o, room)
    if room < 0:
        return refuse(world, Code.NO_ROOM, "an object in some room", "INSIDE no room", o)
    if rules.doors:
        blocked = doors.blocking(world, agent, room)
        if blocked is not None:
            return blocked
    return room


def find(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Notice o; a walk to it comes first, and is all there is to it, unless it is near or the character can't walk."""
    agent = world.agents[number]
    near = (world.home.properties["BODY_PART"] | agent.worn) >> o & 1 or edge_rows.is_near(
        world, agent, o, rules.near_hands
    )
    if not near and not (world.states[SITTING] | world.states[LYING]) & agent.bit:
        return walk(world, number, o, -1, rules)
    failure = need_close(world, agent, o, near_hands=rules.near_hands)
    if failure is not None:
        return failure
    return world.with_agent(number, _attending(agent, agent.close | 1 << o, 0))


def _walkable(s: Situation) -> Masks:
    return None if s.resting else some(s.walkable)


def _findable(s: Situation) -> Masks:
    if s.resting:
        return some(s.close)
    near = s.home.properties["BODY_PART"] | s.me.worn
    return some(s.close | s.walkable & ~near)


def turn_to(world: World, number: int, o: int, _: int, rules: Rules) -> World | Failure:
    """Face o alone."""
    agent = world.agents[number]
    return world.with_agent(number, _attending(agent, agent.close, 1 << o))


def _attending(agent: Agent, close: int, facing: int) -> Agent:
    return made((agent.index, agent.bit, close, facing, *agent[4:]))


def arrived(world: World, number: int, o: int, room: int, pose: Pose | None, rules: Rules) -> World:
    """Return the world once a character has walked to o in a room, and stands there if it is placed."""
    home = world.home
    moved = world.moved
    if rules.near == "evolving_graph":
        near = _near_today(world, o)
    elif moved is NOTHING:
        near = home.reach[o]
    else:
        near = 1 << o | home.properties["BODY_PART"] | (edge_rows.inside(world, o) & ~home.rooms)
        if home.properties["SURFACES"] >> o & 1:
            near |= edge_rows.bears(world, o)
    if rules.near != "evolving_graph":
        near |= _characters_near(world, o)
    if pose is not None:
        near |= positions.near(world, number, pose)
    return gone(world, number, near, room, pose)


def _near_today(world: World, o: int) -> int:
    """Return the nodes to which a walk to o brings the character close by the rules `evolving_graph`."""
    home, bit = world.home, 1 << o
    if home.rooms & bit:
        return 0
    opens = home.properties["CAN_OPEN"] & bit
    near = bit | home.properties["BODY_PART"] | (edge_rows.inside(world, o) & ~home.rooms) | edge_rows.on(world, o)
    if opens:
        near |= edge_rows.contents(world, o)
    for other in world.agents:
        if (other.contents | other.worn) & bit or (opens and other.inside & bit):
            near |= other.bit
        if other.bit == bit:
            near |= other.inside & ~home.rooms | other.on
    return near


def gone(world: World, number: int, near: int, room: int, pose: Pose | None) -> World:
    """Return the world after a character has moved.

    It is CLOSE to some nodes and its held objects, and INSIDE a room (or -1).
    """
    moved = world.moved
    index, bit, _close, _facing, _faced, _inside, _contents, on, worn, right, left, origins, _pose, stride = (
        world.agents[number]
    )
    held = right | left
    for i in indices(held):
        moved = carry(moved, i, room)
    inside = 1 << room if room >= 0 else 0
    here = made((index, bit, near | held, 0, 0, inside, 0, on, worn, right, left, origins, pose, stride))
    if len(world.agents) == 1:
        return World(world.home, world.states, (here,), moved)
    return World(world.home, world.states, _seen_by_others(world.agents, number, here, held), moved)


def _characters_near(world: World, o: int) -> int:
    """Return the further nodes to which a walk to o brings the character close.

    Characters ON o, nodes that o is INSIDE, and its contents.
    """
    bit = 1 << o
    surface = world.home.properties["SURFACES"] & bit
    near = 0
    for other in world.agents:
        if other.contents & bit or (surface and other.on & bit):
            near |= other.bit
        if other.bit == bit:
            near |= other.inside & ~world.home.rooms
    return near


def _seen_by_others(agents: tuple[Agent, ...], number: int, arrived: Agent, held: int) -> tuple[Agent, ...]:
    """Keep the other characters' rows in step with one who has walked: the edges between two stand in both."""
    gone = arrived.bit | held
    return tuple([arrived if i == number else _left(other, arrived, gone) for i, other in enumerate(agents)])


def _left(other: Agent, arrived: Agent, gone: int) -> Agent:
    """Return another character without the edges to a character that has left, and CLOSE to one that has arrived near
    it.
    """
    index, bit, close, facing, faced, inside, contents, *rest = other
    now = close & ~gone | (arrived.bit if arrived.close & bit else 0)
    if now == close and not (facing | faced | inside | contents) & gone:
        return other
    return made((index, bit, now, facing & ~gone, faced & ~gone, inside & ~gone, contents & ~gone, *rest))


ACTIONS = (
    Action("Walk", walk, _walkable),
    Action("Run", walk, _walkable),
    Action("Find", find, _findable),
    Action("TurnTo", turn_to, lambda s: some(s.home.everything)),
)
