"""What geometry shows of what a graph says: relation by relation, with what it does not show."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from math import cos, hypot, radians, sqrt

from hearth.schemas.errors import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.graph import Box, EnvironmentGraph
from hearth.simulation.homes.geometry import DIRECTIONS, bottom, footprint, top
from hearth.simulation.homes.graph_parts import Parts
from hearth.simulation.homes.relations import CLOSE_WITHIN, VIEW
from hearth.simulation.homes.shell import Thing

PANELS = frozenset({"wall", "floor", "ceiling"})
"""What rooms are made of, however many pieces a graph counts."""
NEAR = CLOSE_WITHIN + 0.4
"""Metres within which CLOSE counts as met: other people's graphs measured otherwise."""


def unmet(
    graph: EnvironmentGraph, things: Mapping[int, Thing], parts: Parts, squeezed: Collection[int] = ()
) -> Iterator[Diagnostic]:
    """Every node without a place of its own, then every edge that the boxes do not show."""
    for node in graph.nodes:
        if (node.id not in things or node.id in squeezed) and node.class_name not in PANELS:
            where = parts.nodes[parts.room[node.id]].class_name if node.id in parts.room else "no room"
            hint = "a larger support, or fewer things there" if node.id in parts.parent else "say INSIDE which room"
            message = f"no place for {node.class_name} ({node.id}) in {where}"
            yield Diagnostic(Code.NO_PLACE, message, found=str(node.id), suggestion=hint)
    for edge in graph.edges:
        one, other = things.get(edge.source), things.get(edge.target)
        check = SHOWS.get(edge.relation)
        if check is None or one is None or other is None or edge.source == edge.target:
            continue
        if not check(one, other):
            said = f"{one.class_name} ({edge.source}) {edge.relation} {other.class_name} ({edge.target})"
            ids = f"{edge.source} {edge.target}"
            yield Diagnostic(Code.CONDITION_UNMET, f"not to be had: {said}", found=ids,
                             suggestion="drop the edge, or what stands in its way")  # fmt: skip


def gap(one: Box, other: Box) -> float:
    """Metres of free space between two boxes."""
    parts = zip(one.center, other.center, one.size, other.size, strict=True)
    return sqrt(sum(max(0.0, abs(a - b) - (s + t) / 2) ** 2 for a, b, s, t in parts))


def sees(one: Box, yaw: float | None, other: Box) -> bool:
    """Whether the front of the first points towards the second; what has no front looks anywhere."""
    dx, dz = other.center[0] - one.center[0], other.center[2] - one.center[2]
    distance = hypot(dx, dz)
    if yaw is None or distance < 0.05:
        return True
    ahead = {"north": dz, "south": -dz, "east": dx, "west": -dx}
    name = next((name for name, degrees in DIRECTIONS.items() if degrees == yaw % 360), "north")
    return bool(ahead[name] / distance >= cos(radians(VIEW)) - 1e-9)


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
SHOWS = {"ON": _on, "INSIDE": _inside, "CLOSE": _close, "FACING": _facing}
"""Whether two things' boxes show a relation."""
