"""One holder for each thing: files may list several, list them in circles, or put a table on a couch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from hearth.homes.geometry import bottom, top
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import ROOM_CATEGORY


class SinglyHeld(NamedTuple):
    """The edges of a graph in which each thing is ON or INSIDE one other at most.

    Attributes:
        edges: that stay.
        second: edges to further holders, left out.
        circles: circles of holders, each with its edges in order; the last edge is left out.
    """

    edges: list[Edge]
    second: list[Edge]
    circles: list[tuple[Edge, ...]]


def with_single_holders(graph: EnvironmentGraph, knowledge: Knowledge) -> SinglyHeld:
    """Return the edges of a graph in which each thing is ON or INSIDE one other at most, and those left out.

    Of several holders the innermost stays; of those, the one whose top is nearest below the thing.
    """
    nodes = {node.id: node for node in graph.nodes}
    rooms = {node.id for node in graph.nodes if node.category == ROOM_CATEGORY}
    held: dict[int, list[Edge]] = {}
    for edge in graph.edges:
        if edge.relation in ("ON", "INSIDE") and edge.target not in rooms:
            held.setdefault(edge.source, []).append(edge)
    holders = {source: [edge.target for edge in edges] for source, edges in held.items()}
    chosen: dict[int, Edge] = {}
    for source, edges in held.items():
        able = [edge for edge in edges if not is_seat_for(nodes[source], nodes[edge.target], knowledge)]
        if able:
            chosen[source] = min(able, key=lambda edge: _rank(edge, edges, holders, nodes))
    kept, circles = _without_circles(chosen)
    closing = {circle[-1] for circle in circles}
    second = [edge for edges in held.values() for edge in edges if edge not in kept and edge not in closing]
    gone = closing.union(second)
    return SinglyHeld([edge for edge in graph.edges if edge not in gone], second, circles)


def is_seat_for(node: Node, other: Node, knowledge: Knowledge) -> bool:
    """Return whether a thing that stands on the floor is said to be on a seat: boxes overlap, no more."""
    return not knowledge.has(node.class_name, "GRABBABLE") and knowledge.has(other.class_name, "SITTABLE")


def _rank(
    edge: Edge, edges: Sequence[Edge], holders: Mapping[int, Sequence[int]], nodes: Mapping[int, Node]
) -> tuple[int, float, int]:
    """Return how well a holder fits; the lowest fits best."""
    outer = sum(edge.target in holders.get(other.target, ()) for other in edges if other is not edge)
    mine, its = nodes[edge.source].box, nodes[edge.target].box
    apart = abs(bottom(mine) - top(its)) if mine is not None and its is not None else 0.0
    return outer, round(apart, 3), edges.index(edge)


def _without_circles(chosen: Mapping[int, Edge]) -> tuple[set[Edge], list[tuple[Edge, ...]]]:
    """Return the edges without those that close a circle, and the circles. Each thing is walked through once."""
    kept: set[Edge] = set()
    circles: list[tuple[Edge, ...]] = []
    done: set[int] = set()
    for start in chosen:
        at, way = start, dict[int, Edge]()
        while at in chosen and at not in done and at not in way:
            way[at] = chosen[at]
            at = chosen[at].target
        if at in way:
            nodes = list(way)
            circle = nodes[nodes.index(at) :]
            circles.append(tuple(way[node] for node in circle))
            done.update(way)
            kept.update(edge for edge in way.values() if edge is not circles[-1][-1])
        else:
            done.update(way)
            kept.update(way.values())
    return kept, circles
