"""Homes made out of others: with more nodes, edges and states, or without a node, in O(what is different).

Rows are shared by copying lists of references, so that what is not touched costs a few nanoseconds a node.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from operator import attrgetter, or_
from types import MappingProxyType
from typing import NamedTuple

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge, Node
from hearth.schemas.graph_change import Change, State, restated
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import CHARACTER_CLASS, FURTHER_STATES, ROOM_CATEGORY, STATE_ID
from hearth.simulation.world.agent import Agent, change_characters
from hearth.simulation.world.bits import cleared, indices
from hearth.simulation.world.home import Home
from hearth.simulation.world.home_building import CHARACTER_PROPERTIES
from hearth.simulation.world.node_states import states_of


class Movable(NamedTuple):
    """A new thing with its place: the short form in which many things are added.

    Attributes:
        node: the thing.
        relation: ON or INSIDE the place.
        place, room: indices of where it is; a room of -1 is none.
        near: the nodes it is CLOSE to.
    """

    node: Node
    relation: str
    place: int
    room: int
    near: int

    def __repr__(self) -> str:
        return brief(self)

    def edges(self, ids: Sequence[int]) -> Iterator[Edge]:
        """Yield the same as edges, CLOSE one way round."""
        me = self.node.id
        if self.room >= 0:
            yield Edge(me, "INSIDE", ids[self.room])
        yield Edge(me, self.relation, ids[self.place])
        for j in indices(self.near):
            yield Edge(me, "CLOSE", ids[j])


_NO_STATES: Mapping[int, Iterable[str]] = MappingProxyType({})


def extended(
    home: Home,
    nodes: Sequence[Node] = (),
    edges: Sequence[Edge] = (),
    removed_edges: Sequence[Edge] = (),
    states: Mapping[int, Iterable[str]] = _NO_STATES,
    movable: Sequence[Movable] = (),
) -> Home:
    """Return a home with more nodes, more and fewer edges, and other states; the given home stays as it is.

    Nothing is checked against the knowledge.

    Args:
        home: to start from. Many homes may be derived from one.
        nodes: new ones, characters included. Fast when their ids are above all that the home has.
        edges: new ones; either end may be a new node. CLOSE is symmetric: one direction is enough.
        removed_edges: taken away before `edges` are added; missing ones are ignored.
        states: node id -> the simulated states it is in, instead of those it had; new nodes bring their own.
        movable: more new nodes, their ids above all others; fast where there are many.

    Raises:
        HearthError: BAD_GRAPH, when an id is used twice or an edge or state names a node that there is not.
    """
    if nodes:
        if len(nodes) > 1:
            nodes = sorted(nodes, key=attrgetter("id"))
        if home.ids and nodes[0].id <= home.ids[-1]:
            more = [edge for one in movable for edge in one.edges(home.ids)]
            whole = _rebuilt(home, nodes, edges, removed_edges, states)
            return extended(whole, [one.node for one in movable], more) if movable else whole
    new = home.copy()
    try:
        _append(new, [*nodes, *[one.node for one in movable]] if movable else nodes)
        touched = -1 << len(home)
        touched |= _each(new, removed_edges, put=False) | _each(new, edges, put=True)
        if movable:
            touched |= _lay(new, len(home) + len(nodes), movable)
        if states:
            _restate(new, states)
    except KeyError as error:
        raise HearthError.of(Code.BAD_GRAPH, f"no node has the id {error.args[0]}") from None
    new.base = (home, touched & new.everything)
    return new


def changed(home: Home, change: Change) -> Home:
    """Return a home after a change by which no nodes go, or none that it has.

    Raises:
        HearthError: BAD_GRAPH, when an id is used twice or an edge names a node that there is not.
    """
    simulated = replace(
        change, set_states=_simulated(change.set_states), cleared_states=_simulated(change.cleared_states)
    )
    states = restated(simulated, lambda node_id: states_of(home.index[node_id], home.states))
    ordered = {node_id: sorted(names) for node_id, names in states.items()}
    new = extended(home, change.added_nodes, change.added, change.removed, ordered)
    if simulated != change:
        restate_further(new, change.cleared_states, change.set_states)
    return new


def _simulated(states: tuple[State, ...]) -> tuple[State, ...]:
    """Return the states that worlds of every action set know; nearly always all of them."""
    further = any(name not in STATE_ID for _, name in states)
    return tuple(each for each in states if each[1] in STATE_ID) if further else states


def restate_further(home: Home, left: Iterable[State], entered: Iterable[State]) -> None:
    """Change the further states of a new home's start (action set 3)."""
    found = dict(zip(FURTHER_STATES, home.further, strict=True))
    for states, change in ((left, cleared), (entered, or_)):
        for node_id, name in states:
            if name in found:
                bit = 1 << home.index[node_id]
                found[name] = change(found[name], bit)
                home.restated_further |= bit
    home.__dict__["further"] = tuple(found.values())


def added_nodes(base: Home, home: Home) -> tuple[Node, ...]:
    """Return the nodes that `home` has and `base` has not, in id order."""
    known = base.index
    return tuple(home.node(i) for i in indices(home.everything) if home.ids[i] not in known)


def without(home: Home, i: int) -> Home:
    """Return a home without the node of that index; the other nodes keep theirs."""
    new = home.copy()
    bit = 1 << i
    touched = bit
    for forward, backward in new.tables.values():
        for table, inverse in ((forward, backward), (backward, forward)):
            for j in indices(table[i]):
                inverse[j] &= ~bit
                touched |= 1 << j
            table[i] = 0
    for door in indices(home.doors):
        new.between[door] &= ~bit
    new.between[i] = 0
    del new.index[home.ids[i]]
    new.absent |= bit
    new.rooms &= ~bit
    new.by_class[home.classes[i]] &= ~bit
    new.properties = {name: mask & ~bit for name, mask in home.properties.items()}
    new.states = tuple(row & ~bit for row in home.states)
    new.agents = tuple(a for a in home.agents if a != i)
    new.agent_rows = [row.without(bit) for row in home.agent_rows if row.index != i]
    new.others = [edge for edge in home.others if home.ids[i] not in (edge[0], edge[2])]
    new.base = (home, touched | home.doors)
    return new


def _rebuilt(
    home: Home,
    nodes: Sequence[Node],
    edges: Sequence[Edge],
    removed_edges: Sequence[Edge],
    states: Mapping[int, Iterable[str]],
) -> Home:
    """Return the slow way, for ids that belong between the home's: everything anew, in id order."""
    every = sorted([*map(home.node, indices(home.everything)), *nodes], key=attrgetter("id"))
    for one, other in pairwise(every):
        if one.id == other.id:
            raise _twice(one.id)
    from hearth.simulation.world.world import World

    whole = Home(every, World.start(home).edges(), home.name, home.knowledge)
    return extended(whole, (), edges, removed_edges, states)


def _twice(node_id: int) -> HearthError:
    return HearthError.of(Code.BAD_GRAPH, f"two nodes have the id {node_id}")


def _append(home: Home, nodes: Sequence[Node]) -> None:
    """Append nodes that belong after all others; what is alike in several of them is entered once for all."""
    first = len(home.ids)
    before = len(home.index)
    home.ids += [node.id for node in nodes]
    home.index.update(zip(home.ids[first:], range(first, len(home.ids)), strict=True))
    if len(home.index) < before + len(nodes):
        raise _twice(_repeated(home, first))
    home.nodes += nodes
    home.classes += [node.class_name for node in nodes]
    for rows in home.rows:
        rows.extend([0] * len(nodes))
    kinds: dict[tuple[str, str, int, tuple[str, ...]], tuple[Node, int]] = {}
    bit = 1 << first
    for node in nodes:
        # Properties of one kind are one tuple nearly always; where they are not, the kind is entered twice.
        kind = (node.class_name, node.category, id(node.properties), node.states)
        known = kinds.get(kind)
        kinds[kind] = (node, bit) if known is None else (node, known[1] | bit)
        bit <<= 1
    states = list(home.states)
    for node, mask in kinds.values():
        name = node.class_name
        home.by_class[name] = home.by_class.get(name, 0) | mask
        if name == CHARACTER_CLASS:
            home.agents = (*home.agents, *indices(mask))
            home.agent_rows += [Agent(i, 1 << i) for i in indices(mask)]
        elif node.category == ROOM_CATEGORY:
            home.rooms |= mask
        for prop in node.properties:
            if name != CHARACTER_CLASS or prop in CHARACTER_PROPERTIES:
                home.properties[prop] = home.properties.get(prop, 0) | mask
        _enter(states, mask, node.states)
    home.states = tuple(states)


def _repeated(home: Home, first: int) -> int:
    """Return the first id from index `first` on that a node before it, which is not absent, has too."""
    seen = {node_id for i, node_id in enumerate(home.ids[:first]) if not home.absent >> i & 1}
    for node_id in home.ids[first:]:
        if node_id in seen:
            return node_id
        seen.add(node_id)
    raise LookupError(first)


def _enter(states: list[int], bit: int, names: Iterable[str]) -> None:
    """Of two states that exclude each other the first holds."""
    for name in names:
        number = STATE_ID.get(name)
        if number is not None and not states[number ^ 1] & bit:
            states[number] |= bit


def _lay(home: Home, first: int, movable: Sequence[Movable]) -> int:
    """Enter the rows of things that are appended from index `first`; the nodes whose rows changed."""
    close, on, bears, inside, contents = home.close, home.on, home.bears, home.inside, home.contents
    touched = 0
    bit = 1 << first
    for i, (_, relation, place, room, near) in enumerate(movable, first):
        if relation == "ON":
            on[i] = 1 << place
            bears[place] |= bit
        else:
            inside[i] = 1 << place
            contents[place] |= bit
        if room >= 0:
            inside[i] |= 1 << room
            contents[room] |= bit
            touched |= 1 << room
        close[i] = near
        touched |= near
        rest = near
        while rest:
            lowest = rest & -rest
            close[lowest.bit_length() - 1] |= bit
            rest ^= lowest
        bit <<= 1
    return touched


def _restate(home: Home, states: Mapping[int, Iterable[str]]) -> None:
    found = list(home.states)
    restated = 0
    for node_id, names in states.items():
        bit = 1 << home.index[node_id]
        restated |= bit
        for number, row in enumerate(found):
            if row & bit:
                found[number] = row ^ bit
        _enter(found, bit, names)
    home.restated |= restated
    home.states = tuple(found)


def _each(home: Home, edges: Iterable[Edge], put: bool) -> int:
    """Put or clear both rows of every edge; the nodes whose rows changed."""
    index = home.index
    characters = home.characters
    tables = home.tables
    touched = 0
    for source, relation, target in edges:
        i, j = index[source], index[target]
        a, b = 1 << i, 1 << j
        touched |= a | b
        if relation not in tables or (a | b) & characters:
            _each_agent(home, (i, relation, j), or_ if put else cleared)
            continue
        forward, backward = tables[relation]
        if put:
            forward[i] |= b
            backward[j] |= a
        else:
            forward[i] &= ~b
            backward[j] &= ~a
    return touched


def _each_agent(home: Home, edge: tuple[int, str, int], change: Callable[[int, int], int]) -> None:
    """The same for an edge that a character has, or that takes no part in the simulation."""
    i, relation, j = edge
    if change_characters(home.agent_rows, edge, change):
        return
    if relation == "BETWEEN":
        home.between[i] = change(home.between[i], 1 << j)
    else:
        raw = (home.ids[i], relation, home.ids[j])
        home.others = [other for other in home.others if other != raw]
        if change(0, 1):
            home.others.append(raw)
