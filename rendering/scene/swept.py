"""The floor area that opening doors and drawers sweep; characters stand outside it."""

from dataclasses import replace
from functools import cache

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.scene.instances import placed
from hearth.rendering.scene.prepared import PreparedScene
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


def free_floor(prepared: PreparedScene) -> FreeFloor:
    """The free floor of a home, with the areas that doors and drawers sweep, computed at first use."""
    nodes = {node.id: node for node in prepared.graph.nodes if node.box and "CAN_OPEN" in node.properties}

    @cache
    def sweeps(number: int) -> Floats:
        return swept(prepared, nodes[number], floor.level) if number in nodes else nothing(number)

    floor = FreeFloor.of(prepared.rooms.values(), prepared.graph.nodes, sweeps)
    return floor


def swept(prepared: PreparedScene, node: Node, floor: float) -> Floats:
    """(n, 2) x and z of the floor outside a thing's box that it sweeps while it opens, in steps of `GRID` metres."""
    assert node.box is not None
    opened = replace(node, states=("OPEN",))
    (x, _, z), (w, _, d) = node.box.center, node.box.size
    parts = []
    for ajar in AJAR:
        corners = [placed(thing).corners for thing in prepared.things(opened, ajar)]
        points = _edges(np.concatenate(corners)) if corners else np.zeros((0, 3))
        beside = (np.abs(points[:, 0] - x) > w / 2 + OUT) | (np.abs(points[:, 2] - z) > d / 2 + OUT)
        parts.append(points[beside & (points[:, 1] < floor + REACHED)][:, (0, 2)])
    return np.unique(np.round(np.concatenate(parts) / GRID), axis=0) * GRID


def _edges(corners: Floats) -> Floats:
    """(T * 3 * steps, 3) points on the edges of (T, 3, 3) triangles."""
    ways = np.roll(corners, -1, axis=1) - corners
    return (corners[:, :, None] + ways[:, :, None] * ALONG[:, None]).reshape(-1, 3)
