"""Making a home, or a world in the middle of an execution, into another one in O(what is different).

`extended` is for many environments of one home, `edit` for worlds; what `edit` changes is checked as sampling does.
"""

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, Node
from hearth.schemas.graph_change import Change
from hearth.schemas.vocabulary import EVERY_STATE_ID, FIRST_ADDED_ID, OPPOSITE, STATE_ID
from hearth.simulation.world import edge_rows, placement_fit, single_edge_changes
from hearth.simulation.world import moved_edges as kinds
from hearth.simulation.world.action_set_3_states import counts_of, is_wide, rows_at_start, wide_start, without_node
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.derived_homes import Movable, added_nodes, extended, without
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import Moved
from hearth.simulation.world.world import World

__all__ = ["Movable", "added_nodes", "apply", "edit", "extended", "free_id"]

_NO_PLACES: Mapping[int, tuple[str, int]] = MappingProxyType({})


def edit(
    world: World,
    *,
    add: Sequence[Node] = (),
    remove: Iterable[int] = (),
    place: Mapping[int, tuple[str, int]] = _NO_PLACES,
    link: Iterable[Edge] = (),
    unlink: Iterable[Edge] = (),
    set: Iterable[tuple[int, str]] = (),
    clear: Iterable[tuple[int, str]] = (),
    check: bool = True,
) -> World | Failure:
    """Another world, in which these things are different; done in the order of the arguments.

    Args:
        world: to start from, at any moment of an execution.
        add: new nodes, each with its states; see `free_id`. They are nowhere until placed.
        remove: ids of nodes that vanish, with all their edges, out of all hands and memories.
        place: node id -> (`ON` or `INSIDE`, id of the place): it leaves hands and all it was ON, INSIDE and CLOSE to,
            both ways, and is in the place's room, ON or INSIDE the place, and CLOSE to it. What a character holds
            comes along, as when it walks.
        link: edges that come; of BETWEEN only those of new nodes.
        unlink: edges to remove; missing ones are ignored.
        set: (node id, state): it enters the state and leaves the opposite.
        clear: (node id, state): it leaves the state.
        check: whether `place`, `link` and `set` must fit the knowledge: placements, seat limits, possible states.

    Returns:
        The world, or NO_PLACE, OCCUPIED or NOT_AFFORDED for the first thing that does not fit.

    Raises:
        HearthError: BAD_GRAPH, when an id is used twice or names a node that there is not.

    Examples:
        >>> opened = hearth.edit(world, set=[(fridge, "OPEN")])
        >>> world.has_state(fridge, "OPEN"), opened.has_state(fridge, "OPEN")
        (False, True)
        >>> str(hearth.edit(world, set=[(fridge, "SITTING")]).code)
        'NOT_AFFORDED'
    """
    try:
        if add:
            world = _with_nodes(world, add)
        for node_id in remove:
            world = _without_node(world, world.home.index[node_id])
        for node_id, (relation, target) in place.items():
            i, j = world.home.index[node_id], world.home.index[target]
            failure = placement_fit.unfit(world, i, relation, j) if check else None
            if failure is not None:
                return failure
            world = _placed(world, i, relation, j)
        linked = _linked(world, link, check)
        if isinstance(linked, Failure):
            return linked
        world = single_edge_changes.unlinked(linked, _numbered(linked.home, unlink))
        return _with_states(world, set, clear, check)
    except KeyError as error:
        raise _no_node(error) from None


def apply(world: World, change: Change) -> World:
    """Return the world after a change: what was there is taken away, what came is added.

    Raises:
        HearthError: BAD_GRAPH, when it names a node that there is not.
    """
    try:
        world = single_edge_changes.unlinked(world, _numbered(world.home, change.removed))
    except KeyError as error:
        raise _no_node(error) from None
    after = edit(world, link=change.added, clear=change.cleared_states, set=change.set_states, check=False)
    assert isinstance(after, World)
    return after


def free_id(home: Home, first: int = FIRST_ADDED_ID) -> int:
    """Return the next id for a new node: `first` or more, and above all the home has, which is fast."""
    return max(first, home.ids[-1] + 1) if home.ids else first


def _with_nodes(world: World, nodes: Sequence[Node]) -> World:
    home = extended(world.home, nodes)
    if home.base is None or home.base[0] is not world.home:
        return _moved_over(world, home)
    rest = world.home.everything
    starts = rows_at_start(World(home, world.states, (), world.moved))
    known, ticks = world.states[: len(starts)], world.states[len(starts) :]
    states = (*(now | new & ~rest for now, new in zip(known, starts, strict=True)), *ticks)
    agents = (*world.agents, *(agent for agent in home.agent_rows if not rest & agent.bit))
    return World(home, states, agents, world.moved)


def _moved_over(world: World, home: Home) -> World:
    """Return the world in a home with other indices: edges and states anew, memories by id.

    In a world of action set 3 processes count from 0 again.
    """
    start, before = World.start(home), World.start(world.home)
    if is_wide(world):
        start, before = wide_start(start, len(counts_of(world))), wide_start(before, len(counts_of(world)))
    there = apply(start, world.changes(before))
    old, new = world.home.ids, home.index
    agents = list(there.agents)
    numbers = {agent.index: number for number, agent in enumerate(agents)}  # new ones may stand before the others
    for agent in world.agents:
        number = numbers[new[old[agent.index]]]
        origins = tuple((new[old[o]], new[old[p]], kind) for o, p, kind in agent.origins)
        agents[number] = agents[number]._replace(origins=origins, pose=agent.pose, stride=agent.stride)
    return World(home, there.states, tuple(agents), there.moved)


def _without_node(world: World, i: int) -> World:
    home = without(world.home, i)
    bit = 1 << i
    extra = dict(world.moved.extra)
    kinds.unlink_all(extra, i, tuple(range(7)))
    agents = []
    for agent in world.agents:
        if agent.index != i:
            memory = tuple(entry for entry in agent.origins if i not in entry[:2])
            agents.append(agent.without(bit)._replace(origins=memory))
    states = without_node(world, bit)
    return World(home, states, tuple(agents), world.moved._replace(extra=extra))


def _placed(world: World, i: int, relation: str, j: int) -> World:
    """Take i out of where it is and put it there, without asking whether it fits."""
    bit = 1 << i
    room = edge_rows.room_of(world, j)
    moved = world.moved
    agents = list(world.agents)
    for number, agent in enumerate(agents):
        if agent.index == i:
            agents[number] = agent._replace(close=0, inside=0, on=0, pose=None)
        else:
            agents[number] = agent.parted(bit)
    edges = [(i, relation, j)]
    if j != room:
        edges.append((i, "CLOSE", j))
    if room >= 0 and j != room:
        edges.append((i, "INSIDE", room))
    if world.home.characters & bit:
        moved = _come_along(agents, i, moved, room)
    else:
        moved = kinds.lift(moved, i, -1)
    return single_edge_changes.linked(World(world.home, world.states, tuple(agents), moved), edges)


def _come_along(agents: list[Agent], i: int, moved: Moved, room: int) -> Moved:
    """Bring what a character holds into a room with it, CLOSE to it alone; the characters' rows change, too."""
    held = next(agent.held for agent in agents if agent.index == i)
    for number, agent in enumerate(agents):
        parted = agent._replace(**{name: getattr(agent, name) & ~held for name in _LEFT_BEHIND})
        agents[number] = parted._replace(close=parted.close | held) if agent.index == i else parted
    for each in indices(held):
        moved = kinds.carry(moved, each, room)
    return moved


_LEFT_BEHIND = ("close", "facing", "faced", "inside", "contents")
"""The rows of characters that lose what is carried away."""


def _linked(world: World, edges: Iterable[Edge], check: bool) -> World | Failure:
    for i, relation, j in _numbered(world.home, edges):
        failure = placement_fit.unfit(world, i, relation, j) if check and relation in ("ON", "INSIDE") else None
        if failure is not None:
            return failure
        world = single_edge_changes.linked(world, [(i, relation, j)])
    return world


def _with_states(
    world: World, entered: Iterable[tuple[int, str]], left: Iterable[tuple[int, str]], check: bool
) -> World | Failure:
    states = list(world.states)
    index, numbers = world.home.index, EVERY_STATE_ID if is_wide(world) else STATE_ID
    for node_id, name in left:
        states[numbers[name]] &= ~(1 << index[node_id])
    for node_id, name in entered:
        failure = placement_fit.impossible(world.home, index[node_id], name) if check else None
        if failure is not None:
            return failure
        bit = 1 << index[node_id]
        states[numbers[name]] |= bit
        opposite = OPPOSITE.get(name, "")
        for other in (opposite,) if opposite else world.home.knowledge.excludes(name):
            if other in numbers:
                states[numbers[other]] &= ~bit
    return World(world.home, tuple(states), world.agents, world.moved)


def _numbered(home: Home, edges: Iterable[Edge]) -> list[tuple[int, str, int]]:
    index = home.index
    return [(index[source], relation, index[target]) for source, relation, target in edges]


def _no_node(error: KeyError) -> HearthError:
    return HearthError.of(Code.BAD_GRAPH, f"there is no node or state {error.args[0]}")
