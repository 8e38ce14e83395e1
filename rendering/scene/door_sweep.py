"""The floor between things; characters stand outside the area that opening doors and drawers sweep."""

from collections.abc import Hashable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.scene.floor_cells import is_in_the_way
from hearth.rendering.scene.instances import placed
from hearth.rendering.scene.room_shell import DOORS
from hearth.rendering.scene.routes import ways_of
from hearth.rendering.scene.scene_preparation import PreparedScene
from hearth.rendering.scene.standing_places import FreeFloor, nothing
from hearth.schemas.graph import Node

AJAR = (0.3, 0.65, 1.0)
"""Opening shares at which the swept area is sampled."""
ALONG = np.linspace(0, 1, 7)
GRID = 0.05
OUT = 0.04
"""Greatest length of a handle in front of a closed thing, metres."""
REACHED = 1.7
"""Metres above the floor up to which a door would hit a character."""


class Floors:
    """The free floors of a home, by the places of things and the open doors; each is computed once."""

    def __init__(self, prepared: PreparedScene) -> None:
        self.prepared = prepared
        boxes = [room.box for room in prepared.rooms.values() if room.box]
        self.level = min((box.center[1] - box.size[1] / 2 for box in boxes), default=0.0)
        self._known: dict[Hashable, FreeFloor] = {}
        self._leaves: dict[int, Floats] = {}

    def at(self, nodes: Sequence[Node]) -> FreeFloor:
        """Return the free floor between nodes with their current boxes and states."""
        standing = [node for node in nodes if node.box and is_in_the_way(node, self.level)]
        key = tuple((node.id, node.box, "OPEN" in node.states) for node in standing)
        if key not in self._known:
            self._known[key] = self._between(standing, nodes)
        return self._known[key]

    def _between(self, standing: Sequence[Node], nodes: Sequence[Node]) -> FreeFloor:
        rooms = list(self.prepared.rooms.values())
        opened = [n for n in standing if "OPEN" in n.states and n.class_name not in DOORS]
        leaves = [self._leaf(node) for node in opened if "CAN_OPEN" in node.properties]
        walkable = ways_of(rooms, nodes, np.concatenate(leaves) if leaves else None)
        sweeping = {node.id: node for node in nodes if node.box and "CAN_OPEN" in node.properties}

        @cache
        def sweeps(number: int) -> Floats:
            known = number in sweeping
            return swept(self.prepared, sweeping[number], self.level) if known else nothing(number)

        def leaves_of(number: int) -> Floats:
            is_open = number in sweeping and "OPEN" in sweeping[number].states
            return self._leaf(sweeping[number]) if is_open else nothing(number)

        return FreeFloor.of(rooms, [node for node in nodes if node.box], sweeps, walkable, leaves_of)

    def _leaf(self, node: Node) -> Floats:
        if node.id not in self._leaves:
            self._leaves[node.id] = swept(self.prepared, node, self.level, AJAR[-1:])
        return self._leaves[node.id]


def swept(prepared: PreparedScene, node: Node, floor: float, shares: Sequence[float] = AJAR) -> Floats:
    """(n, 2) x and z of the floor outside a thing's box that it sweeps while it opens, in steps of `GRID` metres."""
    assert node.box is not None
    opened = replace(node, states=("OPEN",))
    (x, _, z), (w, _, d) = node.box.center, node.box.size
    parts = []
    for ajar in shares:
        corners = [placed(thing).corners for thing in prepared.things(opened, ajar)]
        points = _edges(np.concatenate(corners)) if corners else np.zeros((0, 3))
        beside = (np.abs(points[:, 0] - x) > w / 2 + OUT) | (np.abs(points[:, 2] - z) > d / 2 + OUT)
        parts.append(points[beside & (points[:, 1] < floor + REACHED)][:, (0, 2)])
    return np.unique(np.round(np.concatenate(parts) / GRID), axis=0) * GRID


def _edges(corners: Floats) -> Floats:
    """(T * 3 * steps, 3) points on the edges of (T, 3, 3) triangles."""
    ways = np.roll(corners, -1, axis=1) - corners
    return (corners[:, :, None] + ways[:, :, None] * ALONG[:, None]).reshape(-1, 3)
