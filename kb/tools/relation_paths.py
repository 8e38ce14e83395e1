"""Relations between two things: the most specific chain of facts from one to the other."""

from __future__ import annotations

from itertools import pairwise
from operator import itemgetter
from typing import TYPE_CHECKING, Any, NamedTuple

from hearth.kb.knowledge import Knowledge
from hearth.kb.tools.graph_and_tables import edges

if TYPE_CHECKING:
    import networkx


class Link(NamedTuple):
    """One fact of a chain, in the direction of the chain.

    Attributes:
        source: where the chain stands.
        relation: `ON`, `goes_with`, `is_a`, ...
        target: where it goes.
        forward: whether the fact is source -> target; otherwise it is target -> source.
        evidence: the source of the fact, where recorded.
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
"""Cost of following a fact: low for specific facts. Properties, states and affordances are not followed."""


def path(knowledge: Knowledge, first: str, second: str) -> tuple[Link, ...]:
    """Return the cheapest chain of facts between two things, actions or kinds; empty when there is none, or they are
    one.

    A usual placement and a strong association cost less than a rare one.

    Raises:
        KeyError: nothing has the name; its argument is the name.
    """
    import networkx

    start, goal = node_of(knowledge, first), node_of(knowledge, second)
    graph = _graph(knowledge)
    if start not in graph or goal not in graph or not networkx.has_path(graph, start, goal):
        return ()
    way = networkx.dijkstra_path(graph, start, goal, weight="cost")
    chosen = (min(graph[one][other].values(), key=itemgetter("cost")) for one, other in pairwise(way))
    return tuple(each["link"] for each in chosen)


def node_of(knowledge: Knowledge, name: str) -> str:
    """Return the graph's node for a name: a class, else an action, else a kind.

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


def _graph(knowledge: Knowledge) -> networkx.MultiDiGraph[str]:
    """Every fact that says something, both ways round, with its cost and link."""
    import networkx

    found: networkx.MultiDiGraph[str] = networkx.MultiDiGraph()
    for source, target, relation, attributes in edges(knowledge):
        if relation in COSTS and source != target:
            cost, evidence = _cost(relation, attributes), str(attributes.get("evidence", ""))
            found.add_edge(source, target, cost=cost, link=Link(source, relation, target, True, evidence))
            found.add_edge(target, source, cost=cost, link=Link(target, relation, source, False, evidence))
    return found


def _cost(relation: str, attributes: dict[str, Any]) -> float:
    return COSTS[relation] + 0.15 * (5 - int(attributes.get("weight", 5)))
