"""Things on their last way: from where they are as hands arrive to where the step leaves them."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass, replace
from math import dist, pi

from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.held_objects import held_things
from hearth.rendering.people.motion_along_routes import eased
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import PreparedScene
from hearth.schemas.graph import Point

FASTEST = 1.3
"""Metres per second at most."""

LEAST = 0.5
"""Seconds that it takes at least."""

AT_ONCE = 0.02
"""Metres up to which a thing is where it should be."""


@dataclass(frozen=True)
class Arrivals:
    """Objects that are not yet in place when the hands arrive.

    Pushed or pulled objects, objects that a hand does not quite reach, and the contents of a taken object.

    Attributes:
        ways: id -> the way that is left then, from where it will be to where it is.
    """

    ways: Mapping[int, Point]

    @property
    def seconds(self) -> float:
        """Seconds until all are in their places."""
        return max(map(_takes, self.ways.values()), default=0.0)

    def at(self, scene: Scene, past: float) -> Scene:
        """Return the scene `past` seconds after the hands arrived."""
        left = {node: 1 - eased(past / _takes(way)) for node, way in self.ways.items() if past < _takes(way)}

        def moved(thing: Thing) -> Thing:
            (x, y, z), (dx, dy, dz), share = thing.position, self.ways[thing.id], left[thing.id]
            return replace(thing, position=(x + dx * share, y + dy * share, z + dz * share))

        return replace(scene, things=tuple(moved(t) if t.id in left else t for t in scene.things)) if left else scene


def _takes(way: Point) -> float:
    """Seconds of a way, slow at both ends."""
    return max(LEAST, dist(way, (0.0, 0.0, 0.0)) * pi / 2 / FASTEST)


def arrivals(
    prepared: PreparedScene, before: Places, after: Places, actors: Sequence[Actor], without: Container[int]
) -> Arrivals:
    """Objects that still move when the hands arrive.

    Args:
        prepared: of the home.
        before, after: the step.
        actors: as they are when their hands arrive.
        without: ids of the objects that move otherwise.
    """
    changed = {
        node
        for node in before.locations.keys() & after.locations.keys()
        if before.locations[node] != after.locations[node] or before.poses.get(node) != after.poses.get(node)
    }
    one, other = (_positions(prepared, places, actors, changed) for places in (before, after))
    ways: dict[int, Point] = {}
    for node in sorted(changed & one.keys() & other.keys()):
        (x, y, z), (ox, oy, oz) = one[node], other[node]
        if node not in without and dist(one[node], other[node]) > AT_ONCE:
            ways[node] = x - ox, y - oy, z - oz
    return Arrivals(ways)


def _positions(
    prepared: PreparedScene, places: Places, actors: Sequence[Actor], wanted: Container[int]
) -> dict[int, Point]:
    """Positions of drawn things: in a hand, on a head, or where they stand."""
    drawn = {node: things for node, things in held_things(prepared, places, tuple(actors)).items() if node in wanted}
    for node in places.nodes():
        if node.id in wanted and node.id not in drawn and node.box is not None:
            drawn[node.id] = tuple(prepared.things(node))
    return {node: things[0].position for node, things in drawn.items() if things}
