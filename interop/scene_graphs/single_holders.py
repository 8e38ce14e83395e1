"""One holder for each thing: files may list several, list them in circles, or put a table on a couch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hearth.homes.geometry import bottom, top
from hearth.kb.knowledge import Knowledge
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import ROOM_CATEGORY


def with_single_holders(graph: EnvironmentGraph, knowledge: Knowledge) -> tuple[list[Edge], list[Edge]]:
    """Return the edges of a graph in which each thing is ON or INSIDE one other at most, and the edges left out.

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
    kept = set(_without_circles(chosen))
    left = [edge for edges in held.values() for edge in edges if edge not in kept]
    gone = set(left)
    return [edge for edge in graph.edges if edge not in gone], left


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


def _without_circles(chosen: Mapping[int, Edge]) -> list[Edge]:
    """Return the edges that lead to something that is held by nothing, or by something kept before."""
    kept: dict[int, Edge] = {}
    for source, edge in chosen.items():
        at, seen = edge.target, {source}
        while at in kept and at not in seen:
            seen.add(at)
            at = kept[at].target
        if at not in seen:
            kept[source] = edge
    return list(kept.values())
