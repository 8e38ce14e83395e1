"""Homes: what never changes while programs run, as rows of bit sets (see `bits`), shared by every world in them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any

from hearth.kb.knowledge import Knowledge, default
from hearth.schemas.graph import Box, EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CLASS, PROPERTIES, ROOM_CATEGORY, STATE_ID, STATES
from hearth.simulation.affordance import allowed
from hearth.simulation.bits import indices
from hearth.simulation.nodes import with_states

Rows = list[int]
Raw = tuple[int, str, int]
AgentRow = tuple[int, int, int, int, int, int, int, int, int]

AGENT_OUT = {"CLOSE": 0, "FACING": 1, "INSIDE": 3, "ON": 5, "HOLDS_RH": 7, "HOLDS_LH": 8}
"""Where an edge from a character stands in its row of `Home.agent_rows`, which is that of `Agent` without its node."""

AGENT_IN = {"CLOSE": 0, "FACING": 2, "INSIDE": 4, "ON": 6}
"""Where an edge to a character stands in its row of `Home.agent_rows`."""


class Memo(dict[int, int]):
    """A table filled on first use; what is never asked for costs nothing."""

    def __init__(self, compute: Callable[[int], int]) -> None:
        super().__init__()
        self._compute = compute

    def __missing__(self, key: int) -> int:
        value = self[key] = self._compute(key)
        return value


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
        agent_rows: each character's own edges, in the order of `Agent`'s fields.
        others: edges that take no part in the simulation, kept for printing.
        nodes: as they were given; `node(i)` also knows the states that `edit.extended` gave.
        restated: nodes whose states at the start are others than the node says.
        base: the home this one was derived from, and the nodes whose rows differ from it; None of a home of its own.
    """

    def __init__(
        self,
        nodes: Sequence[Mapping[str, Any]] | Sequence[Node],
        edges: Iterable[Raw],
        name: str = "",
        knowledge: Knowledge | None = None,
    ) -> None:
        self.name = name
        self.nodes: list[Any] = list(nodes)
        self.restated = 0
        self.base: tuple[Home, int] | None = None
        self.knowledge = knowledge or default()
        self.others: list[Raw] = []
        self._add_nodes()
        self._add_edges(edges)
        self.reach = Memo(self._reach)
        self.direct_room = Memo(self._direct_room)

    @classmethod
    def from_release(cls, data: Mapping[str, Any], name: str = "", knowledge: Knowledge | None = None) -> Home:
        """A home straight from the release's JSON, without an `EnvironmentGraph` between."""
        nodes = sorted(data["nodes"], key=lambda node: node["id"])
        edges = ((e["from_id"], e["relation_type"], e["to_id"]) for e in data["edges"])
        return cls(nodes, edges, name, knowledge)

    @classmethod
    def from_graph(cls, graph: EnvironmentGraph, name: str = "", knowledge: Knowledge | None = None) -> Home:
        """A home from a graph; edges to missing nodes are left out (the linter reports them)."""
        return cls(sorted(graph.nodes, key=lambda node: node.id), graph.edges, name, knowledge)

    def __len__(self) -> int:
        return len(self.ids)

    def __repr__(self) -> str:
        return f"Home({self.name!r}, {len(self)} nodes)"

    def _add_nodes(self) -> None:
        self.ids: list[int] = []
        self.classes: list[str] = []
        self.by_class: dict[str, int] = {}
        self.properties: dict[str, int] = dict.fromkeys(PROPERTIES, 0)
        self.rooms = 0
        states = [0] * len(STATES)
        agents: list[int] = []
        bit = 1
        for node in self.nodes:
            node_id, class_name, category, properties, node_states = _fields(node)
            if class_name == CHARACTER_CLASS:
                agents.append(len(self.ids))
            elif category == ROOM_CATEGORY:
                self.rooms |= bit
            self.ids.append(node_id)
            self.classes.append(class_name)
            self.by_class[class_name] = self.by_class.get(class_name, 0) | bit
            for name in properties:
                self.properties[name] = self.properties.get(name, 0) | bit
            for name in node_states:
                number = STATE_ID.get(name)
                # Of two states that exclude each other the one said first holds.
                if number is not None and not states[number ^ 1] & bit:
                    states[number] |= bit
            bit <<= 1
        self.index = {node_id: index for index, node_id in enumerate(self.ids)}
        self.states = tuple(states)
        self.agents = tuple(agents)

    def _add_edges(self, edges: Iterable[Raw]) -> None:
        n = len(self.ids)
        bits = [1 << i for i in range(n)]
        index = self.index
        out: dict[str, Rows] = {name: [0] * n for name in ("ON", "INSIDE", "CLOSE", "FACING", "BETWEEN")}
        held: dict[str, Rows] = {"HOLDS_RH": [0] * n, "HOLDS_LH": [0] * n}
        rows = out | held
        for source, relation, target in edges:
            try:
                rows[relation][index[source]] |= bits[index[target]]
            except KeyError:
                self.others.append((source, relation, target))
        self.on, self.inside, self.facing, self.between = out["ON"], out["INSIDE"], out["FACING"], out["BETWEEN"]
        self.bears, self.contents, self.faced = (_transposed(r) for r in (self.on, self.inside, self.facing))
        self.close = [a | b for a, b in zip(out["CLOSE"], _transposed(out["CLOSE"]), strict=True)]
        self.holding = held
        self._part_agents(bits)

    def _part_agents(self, bits: Rows) -> None:
        """Move the characters' edges out of the things' rows into `agent_rows`."""
        tables = (self.close, self.facing, self.faced, self.inside, self.contents, self.on, self.bears)
        hands = (self.holding["HOLDS_RH"], self.holding["HOLDS_LH"])
        self.agent_rows: list[AgentRow] = [agent_row([table[i] for table in tables + hands]) for i in self.agents]
        inverse = (self.close, self.faced, self.facing, self.contents, self.inside, self.bears, self.on)
        for i in self.agents:
            for table, opposite in zip(tables, inverse, strict=True):
                for j in indices(table[i]):
                    opposite[j] &= ~bits[i]
                table[i] = 0

    def node(self, index: int) -> Node:
        """The node as it was given, in the states of the start."""
        given = self.nodes[index]
        node = given if isinstance(given, Node) else _node(given)
        return with_states(node, index, self.states) if self.restated >> index & 1 else node

    def copy(self) -> Home:
        """A home of equal content whose rows may be written to until somebody else sees it."""
        new: Home = object.__new__(Home)
        new.name, new.knowledge, new.states, new.agents = self.name, self.knowledge, self.states, self.agents
        new.rooms, new.restated, new.base = self.rooms, self.restated, self.base
        new.others, new.nodes, new.ids, new.classes = self.others, self.nodes[:], self.ids[:], self.classes[:]
        new.index, new.by_class, new.properties = self.index.copy(), self.by_class.copy(), self.properties.copy()
        new.on, new.bears, new.inside, new.contents = self.on[:], self.bears[:], self.inside[:], self.contents[:]
        new.close, new.facing, new.faced, new.between = self.close[:], self.facing[:], self.faced[:], self.between[:]
        new.agent_rows = self.agent_rows[:]
        new.reach = Memo(new._reach)
        new.direct_room = Memo(new._direct_room)
        return new

    def derive(self, base: Home, touched: int) -> None:
        """Note where this home comes from, so that what is known of `base` need not be found out again.

        Args:
            base: its nodes are the first of this home's.
            touched: the nodes whose rows differ from the base's, new ones included.
        """
        self.base = (base, touched)

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

    def able(self, action: str, position: int = 0) -> int:
        """The nodes that an action's argument may be, by the knowledge's requirement for it."""
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

    @cached_property
    def everything(self) -> int:
        """All nodes."""
        return (1 << len(self.ids)) - 1

    @cached_property
    def characters(self) -> int:
        """All characters."""
        return sum(1 << i for i in self.agents)

    @cached_property
    def doors(self) -> int:
        """All nodes that are BETWEEN rooms."""
        return sum(1 << i for i, row in enumerate(self.between) if row)

    @cached_property
    def furniture(self) -> int:
        """All nodes of the category Furniture."""
        return sum(1 << i for i in range(len(self)) if self.node(i).category == "Furniture")

    @cached_property
    def near(self) -> Rows:
        """For each node, what makes who is CLOSE to it close to the node too: its CLOSE row and what it is ON."""
        return [a | b for a, b in zip(self.close, self.on, strict=True)]

    @cached_property
    def edges(self) -> list[Raw]:
        """Every edge between things at the start, the characters' own left out."""
        found: list[Raw] = []
        for relation, rows in zip(
            ("ON", "INSIDE", "CLOSE", "FACING", "BETWEEN"),
            (self.on, self.inside, self.close, self.facing, self.between),
            strict=True,
        ):
            for i, row in enumerate(rows):
                found.extend((self.ids[i], relation, self.ids[j]) for j in indices(row))
        return found

    def limit(self, index: int, lying: bool = False) -> int:
        """How many things may be ON a seat before one may sit, or on a bed before one may lie."""
        name = self.classes[index]
        return self.knowledge.bed_limit(name) if lying else self.knowledge.seat_limit(name)

    def _reach(self, o: int) -> int:
        """What a walk to o brings the character close to, while nothing has moved."""
        mask = 1 << o | self.properties["BODY_PART"] | (self.inside[o] & ~self.rooms)
        return mask | self.bears[o] if self.properties["SURFACES"] >> o & 1 else mask

    def _direct_room(self, o: int) -> int:
        """Index of the room that o is, or is directly INSIDE (the first by id), or -1."""
        if self.rooms >> o & 1:
            return o
        rooms = self.inside[o] & self.rooms
        return (rooms & -rooms).bit_length() - 1


def agent_row(row: Iterable[int]) -> AgentRow:
    """The nine rows of a character, from any iterable."""
    close, facing, faced, inside, contents, on, worn, right, left = row
    return close, facing, faced, inside, contents, on, worn, right, left


def _fields(node: Mapping[str, Any] | Node) -> tuple[int, str, str, Iterable[str], Iterable[str]]:
    if isinstance(node, Node):
        return node.id, node.class_name, node.category, node.properties, node.states
    return node["id"], node["class_name"], node["category"], node["properties"], node["states"]


def _node(data: Mapping[str, Any]) -> Node:
    box = data.get("bounding_box")
    return Node(
        data["id"],
        data["class_name"],
        data["category"],
        tuple(data["properties"]),
        tuple(data["states"]),
        data.get("prefab_name"),
        Box(tuple(box["center"]), tuple(box["size"])) if box else None,
        data.get("yaw"),
    )


def _transposed(rows: Rows) -> Rows:
    columns = [0] * len(rows)
    for i, row in enumerate(rows):
        bit = 1 << i
        for j in indices(row):
            columns[j] |= bit
    return columns
