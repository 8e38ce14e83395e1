"""Homes: what never changes while programs run, as rows of bit sets (see `bits`), shared by every world in them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, partial
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.schemas.call_errors import explained
from hearth.schemas.graph import Edge, EdgeColumns, EnvironmentGraph, Node, read_node
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import FURTHER_STATES
from hearth.simulation.world import home_building
from hearth.simulation.world.affordance import allowed, of_kind
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home_building import Raw, Rows
from hearth.simulation.world.node_states import with_states
from hearth.simulation.world.values_by_movement import ValuesByMovement


class Memo(dict[int, int]):
    """A table filled on first use; what is never asked for costs nothing."""

    __repr__ = brief

    def __init__(self, compute: Callable[[int], int]) -> None:
        super().__init__()
        self._compute = compute

    def __missing__(self, key: int) -> int:
        value = self[key] = self._compute(key)
        return value


MOST_UNIONS = 4_096
"""Sets that a table of unions keeps: a megabyte or two a home."""


class Unions(dict[int, int]):
    """The union of the rows of a set of nodes, by the set; sets recur from tick to tick, and the last ones are kept."""

    __repr__ = brief

    def __init__(self, rows: Rows) -> None:
        super().__init__()
        self._rows = rows

    def __missing__(self, members: int) -> int:
        if len(self) >= MOST_UNIONS:
            self.clear()
        rows, found = self._rows, 0
        for i in indices(members):
            found |= rows[i]
        self[members] = found
        return found


class Home:
    """The nodes of a graph and its edges at the start.

    Nodes have indices 0..n-1 in the order of their ids. Rows hold only edges between things; a character's own edges
    stand in its `Agent`, because they change with almost every step.

    Attributes:
        name: the home's name, or "".
        ids: node ids by index.
        index: index by node id.
        classes: class names by index.
        on, bears: what i is ON; what is ON i.
        inside, contents: what i is INSIDE; what is INSIDE i.
        close: what i is CLOSE to (symmetric).
        facing, faced: what i is FACING; what is FACING i.
        between: the rooms a door is BETWEEN.
        states: the start's states, one set of nodes for each of `vocabulary.STATES`.
        agents: indices of the characters, in id order.
        agent_rows: the characters at the start, each with its own edges.
        others: edges that take no part in the simulation, kept for printing.
        nodes: as they were given; `node(i)` also knows the states that `edit.extended` gave.
        restated: nodes whose states at the start are others than the node says.
        restated_further: nodes whose further states are (action set 3).
        absent: indices of nodes that were taken away by `edit`: nothing refers to them any more.
        base: the home this one was derived from, whose nodes are the first of its own, and the nodes whose rows differ
            from it, new ones included; None of a home of its own.
    """

    def __init__(
        self,
        nodes: Iterable[Mapping[str, Any]] | Iterable[Node],
        edges: Sequence[Mapping[str, Any]] | Sequence[Edge] | Sequence[Raw] | EdgeColumns,
        name: str,
        knowledge: Knowledge,
    ) -> None:
        self.name = name
        self.knowledge = knowledge
        self.restated = self.restated_further = self.absent = 0
        self.base: tuple[Home, int] | None = None
        read = home_building.read_nodes(nodes)
        self.nodes, self.ids, self.index, self.classes = read.nodes, read.ids, read.index, read.classes
        self.by_class, self.properties, self.rooms = read.by_class, read.properties, read.rooms
        self.states, self.agents = read.states, read.agents
        rows = home_building.read_edges(edges, read)
        self.on, self.bears, self.inside, self.contents, self.close, self.facing, self.faced = rows[:7]
        self.between, self.agent_rows, self.others = rows[7:]

    @classmethod
    @explained
    def from_release(cls, data: Mapping[str, Any], name: str, knowledge: Knowledge) -> Home:
        """A home straight from the release's JSON, without an `EnvironmentGraph` between.

        Raises:
            HearthError: BAD_GRAPH (see `building`).
        """
        try:
            nodes, edges = list(data["nodes"]), data["edges"]
            edges = edges if isinstance(edges, EdgeColumns) else list(edges)
        except (KeyError, TypeError) as error:
            raise home_building.bad_graph(f"no environment graph: {type(error).__name__} {error}") from error
        return cls(nodes, edges, name, knowledge)

    @classmethod
    @explained
    def from_graph(cls, graph: EnvironmentGraph, name: str, knowledge: Knowledge) -> Home:
        """A home from a graph.

        Raises:
            HearthError: BAD_GRAPH (see `building`).

        Examples:
            >>> hearth.Home.from_graph(graph, "mine", known)
            Home('mine', 367 nodes)
        """
        return cls(graph.nodes, graph.edges, name, knowledge)

    def __len__(self) -> int:
        return len(self.ids)

    def __repr__(self) -> str:
        return f"Home({self.name!r}, {len(self.index)} nodes)"

    @explained
    def node(self, index: int) -> Node:
        """The node as it was given, in the states of the start."""
        given = self.nodes[index]
        node = given if isinstance(given, Node) else read_node(given)
        if self.restated_further >> index & 1:
            return with_states(node, index, self.states + self.further)
        return with_states(node, index, self.states) if self.restated >> index & 1 else node

    def copy(self) -> Home:
        """A home of equal content whose rows may be written to until somebody else sees it."""
        new: Home = object.__new__(Home)
        new.name, new.knowledge, new.states, new.agents = self.name, self.knowledge, self.states, self.agents
        new.rooms, new.restated, new.absent, new.base = self.rooms, self.restated, self.absent, self.base
        new.restated_further = self.restated_further
        new.others, new.nodes, new.ids, new.classes = self.others, self.nodes[:], self.ids[:], self.classes[:]
        new.index, new.by_class, new.properties = self.index.copy(), self.by_class.copy(), self.properties.copy()
        new.on, new.bears, new.inside, new.contents = self.on[:], self.bears[:], self.inside[:], self.contents[:]
        new.close, new.facing, new.faced, new.between = self.close[:], self.facing[:], self.faced[:], self.between[:]
        new.agent_rows = self.agent_rows[:]
        return new

    @property
    def rows(self) -> tuple[Rows, ...]:
        """All tables of rows between things."""
        return (
            self.on, self.bears, self.inside, self.contents, self.close, self.facing, self.faced, self.between,
        )  # fmt: skip

    @property
    def tables(self) -> dict[str, tuple[Rows, Rows]]:
        """The rows of each simulated relation between things, and of its inverse."""
        return {
            "ON": (self.on, self.bears),
            "INSIDE": (self.inside, self.contents),
            "CLOSE": (self.close, self.close),
            "FACING": (self.facing, self.faced),
        }

    @cached_property
    def further(self) -> tuple[int, ...]:
        """The rows of `vocabulary.FURTHER_STATES` at the start: only worlds of action set 3 have them."""
        found = dict.fromkeys(FURTHER_STATES, 0)
        known = len(self.base[0].ids) if self.base else 0
        for i in range(known, len(self.nodes)):
            given = self.nodes[i]
            for name in (given if isinstance(given, Node) else read_node(given)).states:
                if name in found:
                    found[name] |= 1 << i
        before = self.base[0].further if self.base else (0,) * len(found)
        here = self.everything
        return tuple((was | now) & here for was, now in zip(before, found.values(), strict=True))

    @cached_property
    def kinds(self) -> dict[int, tuple[Any, Any]]:
        """Formulas about a kind of things that somebody has asked for, with the nodes, by the formula's identity."""
        return {}

    def able(self, action: str, position: int = 0) -> int:
        """The nodes that an action's argument may be, by the knowledge's requirement for it."""  # asked by every step
        try:
            return self._able[action, position]
        except KeyError:
            pass
        needs = self.knowledge.actions[action].needs[position]
        mask = self._able[action, position] = allowed(
            needs, self.properties, self.by_class, self.rooms, self.everything
        )
        return mask

    @cached_property
    def _able(self) -> dict[tuple[str, int], int]:
        return {}

    # What the memos compute with are rows and not the home: it would be in a circle, and so in memory until the garbage
    # collector finds it.

    @cached_property
    def reach(self) -> Memo:
        """Return the nodes to which a walk to a node brings the character close, while nothing has moved."""
        return Memo(partial(_reach, self.inside, self.bears, self.rooms, self.properties))

    @cached_property
    def direct_room(self) -> Memo:
        """Index of the room that a node is, or is directly INSIDE (the first by id), or -1."""
        return Memo(partial(_direct_room, self.inside, self.rooms))

    @cached_property
    def contents_of(self) -> Unions:
        """Return the nodes INSIDE one of some nodes at the start."""
        return Unions(self.contents)

    @cached_property
    def borne_by(self) -> Unions:
        """Return the nodes ON one of some nodes at the start."""
        return Unions(self.bears)

    @cached_property
    def close_to(self) -> Unions:
        """Return the nodes CLOSE to one of some nodes at the start."""
        return Unions(self.close)

    @cached_property
    def open_rooms(self) -> dict[tuple[int, int], int]:
        """The rooms that are reached from a room, by (room, closed doors); `actions.doors` fills it."""
        return {}

    @cached_property
    def seen(self) -> ValuesByMovement[int]:
        """Return the table of the nodes that characters see; `visible_nodes` fills it."""
        return ValuesByMovement()

    @cached_property
    def walkable(self) -> ValuesByMovement[int]:
        """Return the table of the nodes that characters can walk to; `reach` fills it."""
        return ValuesByMovement()

    @cached_property
    def hidden(self) -> ValuesByMovement[int]:
        """Return the table of the nodes in closed things; `visible_nodes` fills it."""
        return ValuesByMovement()

    @cached_property
    def free_places(self) -> ValuesByMovement[int]:
        """Return the table of free seats and beds; `actions.posture` fills it."""
        return ValuesByMovement()

    @cached_property
    def worked_out(self) -> dict[str, Any]:
        """Values that other modules compute once for a home, by their names. They go with the home, in a reference
        cycle: a table of theirs by home would hold every home for ever, as its values know their homes.
        """
        return {}

    @cached_property
    def everything(self) -> int:
        """All nodes."""
        return (1 << len(self.ids)) - 1 & ~self.absent

    @cached_property
    def characters(self) -> int:
        """All characters."""
        return mask_of(self.agents)

    @cached_property
    def doors(self) -> int:
        """All nodes that are BETWEEN rooms."""
        return mask_of(i for i, row in enumerate(self.between) if row)

    @cached_property
    def furniture(self) -> int:
        """All nodes of the category Furniture."""
        home, new = self, 0
        while home.base is not None and "furniture" not in vars(home):  # thousands of homes may be derived in a row
            base = home.base[0]
            new |= mask_of(i for i in range(len(base), len(home)) if home.nodes[i].category == "Furniture")
            home = base
        if home is self:
            return mask_of(i for i in range(len(self)) if self.node(i).category == "Furniture")
        return (home.furniture | new) & ~self.absent

    @cached_property
    def around(self) -> Rows:
        """Return, for each node, the neighbors of a character CLOSE to it: its CLOSE row and the things ON it."""
        return [a | b for a, b in zip(self.close, self.bears, strict=True)]

    @cached_property
    def containing(self) -> int:
        """All nodes that something is INSIDE at the start."""
        return mask_of(i for i, row in enumerate(self.contents) if row)

    @cached_property
    def bearing(self) -> int:
        """All nodes that something is ON at the start."""
        return mask_of(i for i, row in enumerate(self.bears) if row)

    @cached_property
    def bedding(self) -> int:
        """All bedding (derived.yaml): what may lie ON a made bed."""
        return of_kind(self.knowledge.derived["bedding"][1], self.properties, self.by_class, self.everything)

    @explained
    def instances(self, name: str) -> int:
        """Return the nodes of a class name.

        Those of that class, else those of the first of its other names that the home knows; of a room that the home
        lacks, the room that serves as it.
        """
        names = (name, *self.knowledge.found_as(name))
        return next((mask for each in names if (mask := self.by_class.get(each, 0))), 0)

    @explained
    def limit(self, index: int, lying: bool = False) -> int:
        """Return how many things may be ON a seat before one may sit, or on a bed before one may lie."""
        name = self.classes[index]
        return self.knowledge.bed_limit(name) if lying else self.knowledge.seat_limit(name)


def _reach(inside: Rows, bears: Rows, rooms: int, properties: Mapping[str, int], o: int) -> int:
    mask = 1 << o | properties["BODY_PART"] | (inside[o] & ~rooms)
    return mask | bears[o] if properties["SURFACES"] >> o & 1 else mask


def _direct_room(inside: Rows, rooms: int, o: int) -> int:
    if rooms >> o & 1:
        return o
    found = inside[o] & rooms
    return (found & -found).bit_length() - 1
