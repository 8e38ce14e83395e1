"""Locations of things by the relations of a graph: in hands, worn, on, inside, or in a room."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from hearth.schemas.graph import EnvironmentGraph, Node
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, ROOM_CATEGORY

HANDS = {"HOLDS_RH": "right", "HOLDS_LH": "left"}
BUILDING = frozenset({"floor", "wall", "ceiling", "doorjamb", "window"})


class Location(NamedTuple):
    """A thing's location in the graph.

    Attributes:
        kind: `held`, `worn`, `on`, `inside`, or `room` if no nearer holder is known.
        holder: id of the character, support, container or room.
    """

    kind: str
    holder: int


def locations_of(graph: EnvironmentGraph) -> dict[int, Location]:
    """Return the most specific location of every thing: hand, wearer, support, container or room."""
    nodes = {node.id: node for node in graph.nodes}
    ranks = {"held": 0, "worn": 1, "on": 2, "inside": 3, "on building": 4, "room": 5}
    best: dict[int, tuple[int, int, Location]] = {}
    for edge in graph.edges:
        kind, thing, holder = _read(edge.relation, edge.source, edge.target, nodes)
        if not kind:
            continue
        rank = (ranks[kind], holder, Location(kind.removesuffix(" building"), holder))
        if thing not in best or rank < best[thing]:
            best[thing] = rank
    return {thing: found[2] for thing, found in sorted(best.items())}


def _read(relation: str, source: int, target: int, nodes: Mapping[int, Node]) -> tuple[str, int, int]:
    """(kind, thing, holder) of the location that an edge gives; kind is empty if it gives none."""
    if source not in nodes or target not in nodes:
        return "", source, target
    if relation in HANDS:
        return "held", target, source
    if nodes[source].category == CHARACTER_CATEGORY:
        return "", source, target
    if relation == "ON":
        if nodes[target].category == CHARACTER_CATEGORY:
            return "worn", source, target
        return "on building" if nodes[target].class_name in BUILDING else "on", source, target
    if relation == "INSIDE":
        return "room" if nodes[target].category == ROOM_CATEGORY else "inside", source, target
    return "", source, target


def parents_first(nodes: Mapping[int, Node], locations: Mapping[int, Location]) -> list[int]:
    """Ids, each after its support or container."""
    done: dict[int, None] = {}

    def visit(node_id: int, trail: tuple[int, ...]) -> None:
        location = locations.get(node_id)
        if location and location.holder in nodes and location.holder not in done and location.holder not in trail:
            visit(location.holder, (*trail, node_id))
        done.setdefault(node_id)

    # Things that stay come first: low ids are the home's own.
    for node_id in sorted(nodes):
        visit(node_id, ())
    return list(done)
