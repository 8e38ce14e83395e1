"""The difference of two worlds, at a cost that follows what moved: `schemas.graph_change` for worlds."""

from collections.abc import Callable, Iterator, Set

from hearth.schemas.graph import Edge, Node
from hearth.schemas.graph_change import Change, Parts, State, difference
from hearth.schemas.vocabulary import EVERY_STATE
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import AGENT_IN, AGENT_OUT, Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.moved_edges import BEARS, CLOSE, CONTENTS, FACED, FACING, INSIDE, ON
from hearth.simulation.world.state import WorldState

EdgeTurn = tuple[int, str, int, bool]
"""An edge by indices, and whether it came."""


def encode(before: WorldState, after: WorldState) -> Change:
    """Return the change from `before` to `after`.

    Nodes that only one of them has are left out, but their edges and states are not. Cost follows what differs between
    worlds of one home and of homes derived from one another (see `edit`); other homes are compared whole.
    """
    ids = before.home.ids
    extra = 0
    if before.home is not after.home:
        ids, other = sorted((ids, after.home.ids), key=len, reverse=True)
        if ids[: len(other)] != other:
            return difference(_parts(before), _parts(after))
        extra = _home_differences(before.home, after.home)
    added: set[Edge] = set()
    removed: set[Edge] = set()
    for i, relation, j, came in set(_edge_changes(before, after, extra)):
        (added if came else removed).add(Edge(ids[i], relation, ids[j]))
    if before.home.others is not after.home.others:
        past, now = before.home.others, after.home.others
        added.update(Edge(*edge) for edge in now if edge not in past)
        removed.update(Edge(*edge) for edge in past if edge not in now)
    entered, left = _state_changes(before, after, ids)
    return Change(tuple(sorted(added)), tuple(sorted(removed)), tuple(sorted(entered)), tuple(sorted(left)))


def encode_whole(before: WorldState, after: WorldState, edges: Set[Edge] | None = None) -> Change:
    """Return the change from `before` to `after`, nodes included; both at their start, and their homes may be any.

    Args:
        before, after: starts.
        edges: all of those of `before`, where they are known.
    """
    past = _parts(before, edges)._replace(nodes=_nodes(before.home))
    return difference(past, _parts(after)._replace(nodes=_nodes(after.home)))


def _parts(world: WorldState, edges: Set[Edge] | None = None) -> Parts:
    ids = world.home.ids
    states = {(ids[i], name) for name, row in zip(EVERY_STATE, world.states, strict=False) for i in indices(row)}
    return Parts(edge_rows.edges(world) if edges is None else edges, states)


def _nodes(home: Home) -> dict[int, Node]:
    return {home.ids[i]: home.node(i) for i in indices(home.everything)}


def _home_differences(one: Home, other: Home) -> int:
    """Nodes whose rows at the start may differ."""
    for base, derived in ((one, other), (other, one)):
        touched = 0
        home = derived
        while home is not base and home.base is not None:
            home, more = home.base
            touched |= more
        if home is base:
            return touched
    differing = -1 << min(len(one), len(other)) & (1 << max(len(one), len(other))) - 1
    for a, b in zip(one.rows, other.rows, strict=True):
        for i, (row, now) in enumerate(zip(a, b, strict=False)):
            if row != now:
                differing |= 1 << i
    return differing


def _state_changes(before: WorldState, after: WorldState, ids: list[int]) -> tuple[list[State], list[State]]:
    came: list[State] = []
    went: list[State] = []
    for name, old, new in zip(EVERY_STATE, before.states, after.states, strict=False):
        if old != new:
            came.extend((ids[i], name) for i in indices(new & ~old))
            went.extend((ids[i], name) for i in indices(old & ~new))
    return came, went


def _edge_changes(before: WorldState, after: WorldState, extra: int) -> Iterator[EdgeTurn]:
    olds = {agent.index: agent for agent in before.agents}
    news = {agent.index: agent for agent in after.agents}
    for i in olds | news:
        old, new = olds.get(i), news.get(i)
        if old is not new:
            yield from _agent_changes(old or Agent(i, 1 << i), new or Agent(i, 1 << i))
    if extra or before.moved is not after.moved:
        keys = _touched(before, after)
        if extra:
            keys.update(8 * i + kind for i in indices(extra) for kind in range(len(KINDS)))
        for key in keys:
            yield from _row_changes(before, after, *divmod(key, 8))
    for i in indices(extra):
        yield from _door_changes(before.home, after.home, i)


def _agent_changes(old: Agent, new: Agent) -> Iterator[EdgeTurn]:
    """Yield the changes of a character's own edges, both ways."""
    me = new.index
    for fields, outwards in ((AGENT_OUT, True), (AGENT_IN, False)):
        for relation, field in fields.items():
            past, now = getattr(old, field), getattr(new, field)
            if past != now:
                yield from _came_and_went(past, now, me, relation, outwards)


KINDS: tuple[tuple[str, Callable[[WorldState, int], int], bool], ...] = (
    ("ON", edge_rows.on, True),
    ("ON", edge_rows.bears, False),
    ("INSIDE", edge_rows.inside, True),
    ("INSIDE", edge_rows.contents, False),
    ("CLOSE", edge_rows.close, True),
    ("FACING", edge_rows.facing, True),
    ("FACING", edge_rows.faced, False),
)
"""Readers of each kind of row (see `moved`), and whether its edges go out from the row's node."""

_ONE_WAY = ((ON, BEARS), (INSIDE, CONTENTS), (CLOSE,), (FACING, FACED))
"""The kinds of rows of each relation that `Moved` knows removed nodes of, in its order."""


def _touched(before: WorldState, after: WorldState) -> set[int]:
    """Keys (8 * node + kind) of rows that may differ because something moved.

    Where an edge came or went without its own row being among them, the row of its other end is.
    """
    old, new = before.moved, after.moved
    keys = {key for key, row in new.extra.items() if old.extra.get(key) != row}
    keys.update(old.extra.keys() - new.extra.keys())
    for past, now, kinds in zip(old[:4], new[:4], _ONE_WAY, strict=True):
        if past != now:
            keys.update(8 * i + kind for i in indices(past ^ now) for kind in kinds)
    return keys


def _row_changes(before: WorldState, after: WorldState, i: int, kind: int) -> Iterator[EdgeTurn]:
    relation, read, outwards = KINDS[kind]
    old = read(before, i) if i < len(before.home) else 0
    new = read(after, i) if i < len(after.home) else 0
    if old == new:
        return
    yield from _came_and_went(old, new, i, relation, outwards)
    if kind == CLOSE:
        yield from _came_and_went(old, new, i, relation, False)


def _door_changes(before: Home, after: Home, i: int) -> Iterator[EdgeTurn]:
    old = before.between[i] if i < len(before) else 0
    new = after.between[i] if i < len(after) else 0
    yield from _came_and_went(old, new, i, "BETWEEN", True)


def _came_and_went(past: int, now: int, i: int, relation: str, outwards: bool) -> Iterator[EdgeTurn]:
    """Yield the edges by which two rows of node i differ, each with whether it came."""
    for came, mask in ((True, now & ~past), (False, past & ~now)):
        for j in indices(mask):
            yield (i, relation, j, came) if outwards else (j, relation, i, came)
