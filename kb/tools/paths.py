"""How two things are related: the most telling chain of facts from one to the other."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from typing import Any, NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.tools.views import edges


class Link(NamedTuple):
    """One fact of a chain, told in the direction of the chain.

    Attributes:
        source: where the chain stands.
        relation: `ON`, `goes_with`, `is_a`, ...
        target: where it goes.
        forward: whether the fact itself says source -> target; otherwise target -> source.
        evidence: who says so, where that is recorded.
    """

    source: str
    relation: str
    target: str
    forward: bool
    evidence: str

    def __str__(self) -> str:
        arrow = f"-{self.relation}->" if self.forward else f"<-{self.relation}-"
        return f"{self.source} {arrow} {self.target}"


COSTS = {
    "same_as": 0.1,
    "stands_in": 1.0,
    "goes_with": 1.0,
    "serves": 1.5,
    "ON": 1.6,
    "IN": 1.6,
    "NEARBY": 1.4,
    "is_a": 2.0,
    "found_in": 3.5,
}
"""What a step along a fact costs: little where it says much. Properties, states and affordances say too little."""


def path(knowledge: Knowledge, first: str, second: str) -> tuple[Link, ...]:
    """The cheapest chain of facts between two things, actions or kinds; empty when there is none, or they are one.

    A usual placement and a strong association cost less than a rare one.

    Raises:
        KeyError: nothing has the name; its argument is the name.
    """
    start, goal = node_of(knowledge, first), node_of(knowledge, second)
    neighbours = _neighbours(knowledge)
    best: dict[str, float] = {start: 0.0}
    came: dict[str, Link] = {}
    queue = [(0.0, start)]
    while queue:
        cost, node = heapq.heappop(queue)
        if node == goal:
            break
        if cost > best[node]:
            continue
        for step, link in neighbours.get(node, ()):
            if cost + step < best.get(link.target, float("inf")):
                best[link.target] = cost + step
                came[link.target] = link
                heapq.heappush(queue, (cost + step, link.target))
    return tuple(reversed(list(_back(came, goal)))) if goal in came else ()


def node_of(knowledge: Knowledge, name: str) -> str:
    """The graph's node for a name: a class, else an action, else a kind.

    Raises:
        KeyError: there is none.
    """
    thing, action = knowledge.object_class(name), knowledge.action(name)
    if thing is not None:
        return thing.name
    if action is not None:
        return f"action:{action.name}"
    if name in knowledge.kinds:
        return f"kind:{name}"
    raise KeyError(name)


def _back(came: dict[str, Link], node: str) -> Iterator[Link]:
    while node in came:
        yield came[node]
        node = came[node].source


def _neighbours(knowledge: Knowledge) -> dict[str, list[tuple[float, Link]]]:
    found: dict[str, list[tuple[float, Link]]] = {}
    for source, target, relation, attributes in edges(knowledge):
        if relation not in COSTS or source == target:
            continue
        cost = _cost(relation, attributes)
        evidence = str(attributes.get("evidence", ""))
        found.setdefault(source, []).append((cost, Link(source, relation, target, True, evidence)))
        found.setdefault(target, []).append((cost, Link(target, relation, source, False, evidence)))
    return found


def _cost(relation: str, attributes: dict[str, Any]) -> float:
    return COSTS[relation] + 0.15 * (5 - int(attributes.get("weight", 5)))
