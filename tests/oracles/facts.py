"""A world as a plain set of facts: what the literals are read and applied in when speed does not matter."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.vocabulary import ROOM_CATEGORY
from oracles.formulas import Changes, Memory

T = TypeVar("T")

Chooser = Callable[[Sequence[int]], int]
"""A choice of the place that is remembered, of several; given ascending ids, never none."""


@dataclass(frozen=True, eq=False)
class Facts:
    """A world: nodes, edges both ways round, states, and what is remembered. Answers `evaluate.View`.

    Attributes:
        by_id: the nodes.
        forward: (relation, source) -> targets.
        backward: (relation, target) -> sources.
        states: node -> its states.
        memories: thing -> where it was grabbed from.
        choose: which of several places a grab remembers.
    """

    by_id: Mapping[int, Node]
    forward: Mapping[tuple[str, int], frozenset[int]]
    backward: Mapping[tuple[str, int], frozenset[int]]
    states: Mapping[int, frozenset[str]]
    memories: Mapping[int, Memory]
    choose: Chooser = min

    @classmethod
    def of(cls, graph: EnvironmentGraph, choose: Chooser = min) -> Facts:
        """The facts of a scene graph."""
        forward: dict[tuple[str, int], set[int]] = {}
        backward: dict[tuple[str, int], set[int]] = {}
        for source, relation, target in graph.edges:
            forward.setdefault((relation, source), set()).add(target)
            backward.setdefault((relation, target), set()).add(source)
        return cls(
            {node.id: node for node in graph.nodes},
            {key: frozenset(nodes) for key, nodes in forward.items()},
            {key: frozenset(nodes) for key, nodes in backward.items()},
            {node.id: frozenset(node.states) for node in graph.nodes},
            {},
            choose,
        )

    def nodes(self) -> Iterable[int]:
        """Every node, in the order of the graph."""
        return self.by_id.keys()

    def targets(self, relation: str, source: int) -> frozenset[int]:
        """The nodes to which `source` stands in the relation."""
        return self.forward.get((relation, source), frozenset())

    def sources(self, relation: str, target: int) -> frozenset[int]:
        """The nodes that stand in the relation to `target`."""
        return self.backward.get((relation, target), frozenset())

    def has_state(self, node: int, state: str) -> bool:
        """Return whether the node is in the state."""
        return state in self.states[node]

    def properties(self, node: int) -> frozenset[str]:
        """The node's own properties."""
        return frozenset(self.by_id[node].properties)

    def class_name(self, node: int) -> str:
        """The node's class."""
        return self.by_id[node].class_name

    def is_room(self, node: int) -> bool:
        """Return whether the node is a room."""
        return self.by_id[node].category == ROOM_CATEGORY

    def room(self, node: int) -> int | None:
        """The room itself, or the lowest room reached along INSIDE, nearest first."""
        level, seen = [node], {node}
        while level:
            rooms = [place for place in level if self.is_room(place)]
            if rooms:
                return min(rooms)
            level = sorted({place for thing in level for place in self.targets("INSIDE", thing)} - seen)
            seen.update(level)
        return None

    def origin(self, node: int) -> Memory | None:
        """Return the place from which the thing was grabbed."""
        return self.memories.get(node)

    def place(self, node: int) -> Memory | None:
        """Return the node that the thing is ON, else INSIDE, else CLOSE to, rooms left out."""
        for relation in ("ON", "INSIDE", "CLOSE"):
            places = sorted(place for place in self.targets(relation, node) if not self.is_room(place))
            if places:
                return relation, self.choose(places)
        return None

    def after(self, changes: Changes) -> Facts:
        """The world with the changes made."""
        forward, backward = dict(self.forward), dict(self.backward)
        states = dict(self.states)
        for kept, facts in ((False, changes.removed), (True, changes.added)):
            for name, first, second in facts:
                if name == "state":
                    states[first] = _with(states[first], str(second), kept)
                else:
                    other = int(second)
                    forward[name, first] = _with(forward.get((name, first), frozenset()), other, kept)
                    backward[name, other] = _with(backward.get((name, other), frozenset()), first, kept)
        for node in changes.gone:
            _nowhere(forward, backward, node)
            states[node] = states[node] | {"GONE"}
        memories = {**self.memories, **changes.remembered, **dict.fromkeys(changes.gone)}
        return replace(
            self,
            forward=forward,
            backward=backward,
            states=states,
            memories={thing: memory for thing, memory in memories.items() if memory is not None},
        )

    def edges(self) -> frozenset[tuple[int, str, int]]:
        """Every edge as (source, relation, target)."""
        return frozenset(
            (source, relation, target) for (relation, source), targets in self.forward.items() for target in targets
        )


def _nowhere(forward: dict, backward: dict, node: int) -> None:
    """Take away every edge of a node."""
    for out, into in ((forward, backward), (backward, forward)):
        for relation, one in list(out):
            if one == node:
                for other in out.pop((relation, node)):
                    into[relation, other] = _with(into[relation, other], node, False)


def _with(members: frozenset[T], member: T, kept: bool) -> frozenset[T]:
    return members | {member} if kept else members - {member}
