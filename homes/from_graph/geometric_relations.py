"""The relations of a graph that its geometry shows, and those that it does not."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from math import cos, hypot, radians, sqrt

import numpy as np

from hearth.homes.from_graph.rooms_and_supports import SHELL, Parts
from hearth.homes.geometry import bottom, footprint, top
from hearth.homes.plans.home_shell import Thing
from hearth.homes.relations import CLOSE_WITHIN, VIEW, arrays, direction
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, Edge, EnvironmentGraph

NEAR = CLOSE_WITHIN + 0.4
"""Metres within which CLOSE counts as met: other people's graphs measured otherwise."""


def unmet(
    graph: EnvironmentGraph, things: Mapping[int, Thing], parts: Parts, squeezed: Collection[int] = ()
) -> Iterator[Diagnostic]:
    """Every node without a place of its own, then every edge that the boxes do not show, with what forbids it."""
    for node in graph.nodes:
        if node.id not in things or node.id in squeezed:
            where = parts.nodes[parts.room[node.id]].class_name if node.id in parts.room else "no room"
            hint = "a larger support, or fewer things there" if node.id in parts.parent else "say INSIDE which room"
            message = f"no place for {node.class_name} ({node.id}) in {where}"
            yield Diagnostic(Code.NO_PLACE, message, found=str(node.id), suggestion=hint)
    for edge in graph.edges:
        if (
            edge.relation not in SHOWS
            or edge.source == edge.target
            or not {edge.source, edge.target} <= parts.nodes.keys()
        ):
            continue
        one, other = things.get(edge.source), things.get(edge.target)
        if one is None or other is None or not SHOWS[edge.relation](one, other):
            names = [parts.nodes[n].class_name for n in (edge.source, edge.target)]
            text = f"{names[0]} ({edge.source}) {edge.relation} {names[1]} ({edge.target})"
            yield Diagnostic(Code.CONDITION_UNMET, f"not to be had: {text}: {_why(edge, things, parts)}",
                             found=f"{edge.source} {edge.target}",
                             suggestion="drop the edge, or what stands in its way")  # fmt: skip


def missed(parts: Parts, things: Mapping[int, Thing]) -> int:
    """Return the unmet relations of a graph, by weight."""
    return sum(
        WEIGHTS[relation]
        for node, given in parts.relations.items()
        for relation, other, outward in given
        if outward and not (node in things and other in things and SHOWS[relation](things[node], things[other]))
    )


def _why(edge: Edge, things: Mapping[int, Thing], parts: Parts) -> str:
    """Obstacles to a relation."""
    for node in (edge.source, edge.target):
        if node not in things:
            return f"{_called(node, parts)} has no place"
    apart = parts.room.get(edge.source) != parts.room.get(edge.target) and edge.target not in parts.rooms
    if edge.relation in ("ON", "INSIDE"):
        if edge.relation in parts.both_ways(edge.source, edge.target):
            return "the graph has it both ways round"
        if edge.source in parts.parent and parts.parent[edge.source][0] != edge.target:
            place, word = parts.parent[edge.source]
            return f"it is {word} {_called(place, parts)}, which is in another place"
        if not apart:
            return _taken(edge, things, parts)
    if apart:
        return "they are in different rooms, and walls part them"
    if edge.relation == "FACING":
        return "its front points another way"
    return f"{gap(things[edge.source].box, things[edge.target].box):.1f} m are between them"


def _taken(edge: Edge, things: Mapping[int, Thing], parts: Parts) -> str:
    """Return the obstacles at a thing's place, or else the thing that it has to be at instead."""
    there = footprint(things[edge.target].box)
    if edge.relation == "INSIDE":
        return f"{_called(edge.target, parts)} has no room for it"
    room = things[edge.target].room
    standing = ((n, t) for n, t in sorted(things.items()) if t.mount in ("floor", "item", "wall") and t.room == room)
    names = [
        _called(n, parts)
        for n, t in standing
        if n not in (edge.source, edge.target) and t.class_name not in SHELL and not t.on and not t.inside
        and footprint(t.box).inset(-0.3).overlap(there) > 0
    ]  # fmt: skip
    return f"there stand {', '.join(names[:3])}" if names else "doors, drawers or other relations leave no room"


def _called(node: int, parts: Parts) -> str:
    return f"{parts.nodes[node].class_name} ({node})"


def gap(one: Box, other: Box) -> float:
    """Metres of free space between two boxes."""
    (x, y, z), (w, h, d) = one
    (u, v, q), (i, j, k) = other
    across, up, along = abs(x - u) - (w + i) / 2, abs(y - v) - (h + j) / 2, abs(z - q) - (d + k) / 2
    return sqrt(max(across, 0.0) ** 2 + max(up, 0.0) ** 2 + max(along, 0.0) ** 2)


def seen(ones: Sequence[Box], yaws: Sequence[float], others: Sequence[Box]) -> np.ndarray:
    """Bool (ones, others): as `sees`, for all of them at once."""
    (centers, _), (aims, _) = arrays(ones), arrays(others)
    fronts = np.array([direction(yaw) for yaw in yaws], float).reshape(-1, 2)
    towards = (aims[None] - centers[:, None])[..., (0, 2)]
    distance = np.hypot(towards[..., 0], towards[..., 1])
    ahead = (towards * fronts[:, None]).sum(axis=2)
    return np.asarray((distance < 0.05) | (ahead >= (cos(radians(VIEW)) - 1e-9) * distance))


def sees(one: Box, yaw: float | None, other: Box) -> bool:
    """Return whether the front of the first points towards the second; what has no front looks anywhere."""
    dx, dz = other.center[0] - one.center[0], other.center[2] - one.center[2]
    distance = hypot(dx, dz)
    if yaw is None or distance < 0.05:
        return True
    x, z = direction(yaw)
    return (dx * x + dz * z) / distance >= cos(radians(VIEW)) - 1e-9


def _on(one: Thing, other: Thing) -> bool:
    if other.mount == "shell":
        return gap(one.box, other.box) < 0.3
    return footprint(one.box).overlap(footprint(other.box)) > 0 and bottom(one.box) >= bottom(other.box)


def _inside(one: Thing, other: Thing) -> bool:
    x, _, z = one.box.center
    return footprint(other.box).inset(-0.2).holds(x, z) and top(one.box) <= top(other.box) + 0.3


def _close(one: Thing, other: Thing) -> bool:
    return ROOM_MOUNT in (one.mount, other.mount) or gap(one.box, other.box) <= NEAR


def _facing(one: Thing, other: Thing) -> bool:
    return sees(one.box, one.yaw, other.box)


ROOM_MOUNT = "room"
WEIGHTS = {"ON": 20, "INSIDE": 20, "CLOSE": 1, "FACING": 1}
"""Worths of relations, for homes that can't show all of them."""
SHOWS = {"ON": _on, "INSIDE": _inside, "CLOSE": _close, "FACING": _facing}
"""Tests whether two things' boxes show a relation."""
