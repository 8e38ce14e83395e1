"""A character's position and direction, in homes with geometry."""

from __future__ import annotations

import math
from typing import NamedTuple

from hearth.schemas.graph import Spot

STRIDE = 1.0
"""Metres of one Walktowards or Walkforward; a fast helper's is 3 (thesis 7.3)."""


class Pose(NamedTuple):
    """A position and a direction: metres, and degrees about y from +z."""

    x: float
    z: float
    yaw: float = 0.0

    @property
    def point(self) -> Spot:
        """The position alone."""
        return (self.x, self.z)

    def towards(self, point: Spot) -> Pose:
        """Return the same place, looking at a point."""
        dx, dz = point[0] - self.x, point[1] - self.z
        if abs(dx) + abs(dz) < 1e-9:
            return self
        return Pose(self.x, self.z, math.degrees(math.atan2(dx, dz)) % 360)
