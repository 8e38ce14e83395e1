"""An agent's view: nodes and edges, the poses of the others and their last actions."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType

from hearth.schemas.agent_messages import Message
from hearth.schemas.failures import Failure
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Step
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import STATE_ID
from hearth.simulation.observation import visible_nodes
from hearth.simulation.world import edge_rows
from hearth.simulation.world import pose as world_pose
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class LastAction:
    """The last instruction of an agent, and its failure if it failed."""

    instruction: Step
    failure: Failure | None = None

    __repr__ = brief


@dataclass(frozen=True, slots=True)
class Pose:
    """A character's posture.

    Attributes:
        agent: its number.
        node: its node id.
        room: id of the room it is in; None when it is in none.
        posture: `standing`, `sitting` or `lying`.
        on: ids of its seat or bed, or of an earlier one (it stays ON a seat it has got up from, as the release has it).
        facing: ids of the faced nodes.
        holding: ids of the held objects, right hand first.
        wearing: ids of the worn objects.
        place: where it stands and looks, in metres and degrees; None without geometry.
        stride: metres that it walks in a tick.
        last: what it last tried, if anything.
    """

    agent: int
    node: int
    room: int | None
    posture: str
    on: tuple[int, ...] = ()
    facing: tuple[int, ...] = ()
    holding: tuple[int, ...] = ()
    wearing: tuple[int, ...] = ()
    place: world_pose.Pose | None = None
    stride: float = world_pose.STRIDE
    last: LastAction | None = None

    __repr__ = brief


@dataclass(frozen=True)
class View:
    """One agent's view of a world.

    Attributes:
        world: all of it; not for the agent's eyes when the view is partial.
        agent: the observing agent.
        mask: the nodes it sees, by index.
        me: its own pose.
        others: the poses of the other characters it sees, by number.
        tick: how many ticks have passed.
        messages: what others said in the last tick, by number.
    """

    world: World
    agent: int
    mask: int
    me: Pose
    others: tuple[Pose, ...]
    tick: int = 0
    messages: tuple[tuple[int, Message], ...] = ()

    __repr__ = brief

    @cached_property
    def ids(self) -> tuple[int, ...]:
        """The ids of the nodes it sees, ascending."""
        ids = self.world.home.ids
        return tuple(ids[i] for i in indices(self.mask))

    @cached_property
    def graph(self) -> EnvironmentGraph:
        """The nodes it sees and the edges among them."""
        return self.world.graph(self.mask)

    def sees(self, node_id: int) -> bool:
        """Return whether a node is seen; a node that there is not is not."""
        index = self.world.home.index.get(node_id)
        return index is not None and bool(self.mask >> index & 1)


_NOTHING: Mapping[int, LastAction] = MappingProxyType({})


def view(
    world: World,
    agent: int = 0,
    *,
    partial: bool = True,
    last_actions: Mapping[int, LastAction] = _NOTHING,
    tick: int = 0,
) -> View:
    """Return an agent's view.

    Args:
        world: now.
        agent: its number.
        partial: only the things in its room and not inside something closed, and those that it holds or wears (see
            `visible_nodes.visible`); otherwise everything.
        last_actions: what each agent last tried.
        tick: how many ticks have passed.

    Raises:
        HearthError: UNKNOWN_AGENT, if the world has no character of that number.
    """
    me = world.agent(agent)
    mask = visible_nodes.visible(world, me) if partial else world.home.everything
    others = tuple(
        pose(world, number, last_actions.get(number), mask)
        for number, other in enumerate(world.agents)
        if number != agent and mask & other.bit
    )
    return View(world, agent, mask, pose(world, agent, last_actions.get(agent), mask), others, tick)


def pose(world: World, number: int, last: LastAction | None = None, among: int = -1) -> Pose:
    """Return a character's posture, with the faced nodes and supports that are in a set."""
    agent = world.agents[number]
    ids = world.home.ids
    room = edge_rows.agent_room(world, agent)
    on, facing, worn = agent.on & among, agent.facing & among, agent.worn & among
    return Pose(
        agent=number,
        node=ids[agent.index],
        room=ids[room] if room >= 0 else None,
        posture=_posture(world, agent.bit),
        on=tuple([ids[i] for i in indices(on)]) if on else (),
        facing=tuple([ids[i] for i in indices(facing)]) if facing else (),
        holding=tuple([ids[i] for i in edge_rows.held_indices(agent)]) if agent.right or agent.left else (),
        wearing=tuple([ids[i] for i in indices(worn)]) if worn else (),
        place=agent.pose,
        stride=agent.stride,
        last=last,
    )


def _posture(world: World, bit: int) -> str:
    if world.states[STATE_ID["LYING"]] & bit:
        return "lying"
    return "sitting" if world.states[STATE_ID["SITTING"]] & bit else "standing"
