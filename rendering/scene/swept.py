"""The floor that doors and drawers pass over while they open: people stand beside it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from hearth.rendering.arrays import Floats
from hearth.rendering.scene.instances import placed
from hearth.rendering.scene.prepared import Stage
from hearth.rendering.scene.standing_places import Ground, nothing
from hearth.schemas.graph import Node

AJAR = (0.3, 0.65, 1.0)
"""How far it is open where it is looked at."""
ALONG = np.linspace(0, 1, 7)
GRID = 0.05
OUT = 0.04
"""Metres that something sticks out of a shut thing at most: a handle."""
REACHED = 1.7
"""Metres above the floor up to which a door would hit somebody."""


def ground_of(prepared: Stage) -> Ground:
    """The floor of a home, with what its doors and drawers pass over; that is only worked out where it is asked for."""
    nodes = {node.id: node for node in prepared.graph.nodes if node.box and "CAN_OPEN" in node.properties}

    @cache
    def sweeps(number: int) -> Floats:
        return swept(prepared, nodes[number], ground.level) if number in nodes else nothing(number)

    ground = Ground.of(prepared.rooms.values(), prepared.graph.nodes, sweeps)
    return ground


def swept(prepared: Stage, node: Node, floor: float) -> Floats:
    """(n, 2) x and z of what leaves a thing's box while it opens; in steps of `GRID` metres."""
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
    """(T * 3 * steps, 3) points on the sides of (T, 3, 3) triangles."""
    ways = np.roll(corners, -1, axis=1) - corners
    return (corners[:, :, None] + ways[:, :, None] * ALONG[:, None]).reshape(-1, 3)
