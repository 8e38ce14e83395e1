"""Ticks of walks, as an agent reckons them from the distance fields of a home."""

from __future__ import annotations

import math

from hearth.homes.plans.walkable_floor import REACH
from hearth.simulation.motion.ground import Here, ground_of
from hearth.simulation.motion.navigation import Field
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose

Leg = tuple[float, int]
"""Metres of a walk, and the cell at which it ends."""


class Distances:
    """The ways in a home for one agent. In a home without geometry every walk takes one tick.

    Attributes:
        stride: metres that the agent walks in a tick.
    """

    def __init__(self, home: Home, stride: float) -> None:
        self.stride = stride
        self._here: Here | None = ground_of(home)
        self._legs: dict[tuple[int, int], Leg] = {}

    def cell(self, pose: Pose | None) -> int:
        """Return the cell in which an agent stands, or the nearest; -1 without geometry."""
        if self._here is None or pose is None:
            return -1
        ways = self._here.ground.ways
        at = ways.at(pose.x, pose.z)
        return at if at >= 0 else ways.nearest(pose.point, ~ways.main)

    def leg(self, start: int, node: int) -> Leg:
        """Return the walk from a cell to something that stays where it is; doors count as open."""
        try:
            return self._legs[start, node]
        except KeyError:
            found = self._legs[start, node] = self._leg(start, node)
            return found

    def _leg(self, start: int, node: int) -> Leg:
        if self._here is None or start < 0:
            return self.stride, start
        ground = self._here.ground
        stands = ground.stands(node) if node < len(ground.home) else ()
        if not stands:
            return self.stride, start
        field = ground.ways.field(stands)
        return field.distance[start], _end(field, start)

    def after(self, start: int, node: int, metres: float) -> int:
        """Return the cell that an agent reaches after some meters of the walk to a node."""
        if self._here is None or start < 0:
            return start
        field = self._here.ground.ways.field(self._here.ground.stands(node))
        left, cell = field.distance[start] - metres, start
        while (after := field.following[cell]) >= 0 and field.distance[cell] > left:
            cell = after
        return cell

    def end(self, node: int) -> int:
        """Return a cell at which one stands for something that stays where it is; -1 without geometry."""
        if self._here is None or node >= len(self._here.ground.home):
            return -1
        return next(iter(self._here.ground.stands(node)), -1)

    def ticks(self, metres: float) -> int:
        """Return the ticks until an agent is within reach of a thing at some distance."""
        return max(0, math.ceil((metres - REACH / 2) / self.stride)) if math.isfinite(metres) else 1_000


def _end(field: Field, cell: int) -> int:
    """Return where a field's way from a cell ends."""
    following = field.following
    while (after := following[cell]) >= 0:
        cell = after
    return cell
