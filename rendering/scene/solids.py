"""Solid things as upright boxes, as they are drawn: what bodies, arms and walks stay out of."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from math import cos, radians, sin
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.models.appearance import Size
from hearth.rendering.models.class_appearance import Model
from hearth.rendering.scene.floor_cells import IGNORED
from hearth.rendering.scene.instances import Thing
from hearth.schemas.graph import Node, Spot

if TYPE_CHECKING:
    from hearth.rendering.scene.scene_preparation import PreparedScene

FLAT = frozenset({"floor", "ceiling"})
"""Recipes below and above everything."""

SOFT = IGNORED - {"window", "doorjamb"}
"""Classes that give way."""

THIN = 0.04
"""Height in metres below which a thing stops nobody, such as paper and cloths."""

Found = NDArray[np.bool_]


class Solid(NamedTuple):
    """The box of a solid thing: its middle, half its width and depth, its direction in degrees, bottom and top."""

    node: int
    class_name: str
    middle: Spot
    half: Spot
    yaw: float
    low: float
    high: float


class Solids:
    """Solid things, asked for many points at once."""

    def __init__(self, found: Iterable[Solid]) -> None:
        self.all = tuple(found)
        self.nodes = np.array([solid.node for solid in self.all], np.int64)
        self.middles = np.array([solid.middle for solid in self.all], np.float64).reshape(-1, 2)
        self.halves = np.array([solid.half for solid in self.all], np.float64).reshape(-1, 2)
        turns = [radians(solid.yaw) for solid in self.all]
        self.cosines, self.sines = (np.array([f(turn) for turn in turns]) for f in (cos, sin))
        self.lows, self.highs = (np.array([getattr(s, end) for s in self.all]) for end in ("low", "high"))

    def near(self, spot: Spot, reach: float, without: Collection[int] = ()) -> Solids:
        """Those with a part in a square of `2 reach` metres about a spot, but for some nodes."""
        far = np.abs(self.middles - spot).max(axis=1) - np.hypot(*self.halves.T) if self.all else np.zeros(0)
        return Solids(self.all[k] for k in np.flatnonzero(far < reach) if self.all[k].node not in without)

    def contain(self, points: Floats, margin: float = 0.0) -> Found:
        """Return (n,) whether points (n, 3) are in any of them, or less than `margin` metres from it."""
        offset = points[:, None, (0, 2)] - self.middles
        x = offset[..., 0] * self.cosines - offset[..., 1] * self.sines
        z = offset[..., 0] * self.sines + offset[..., 1] * self.cosines
        high = points[:, None, 1]
        within = (np.abs(x) < self.halves[:, 0] + margin) & (np.abs(z) < self.halves[:, 1] + margin)
        found: Found = (within & (high > self.lows) & (high < self.highs)).any(axis=1)
        return found


def solids_of(prepared: PreparedScene, nodes: Iterable[Node]) -> Solids:
    """Return the solid things as they are drawn: furniture, walls around their openings, leaves of doors.

    Args:
        prepared: the home.
        nodes: with their boxes and states at present.
    """
    found = []
    for thing in prepared.scene(nodes).things:
        model = thing.model
        if not isinstance(model, Model) or model.recipe in FLAT or thing.class_name in SOFT:
            continue
        if model.look.size[1] > THIN:
            found += _boxes(thing, model.look.size)
    return Solids(found)


def _boxes(thing: Thing, size: Size) -> list[Solid]:
    """Return a thing's box; of a doorway its two posts."""
    (width, height, depth), (x, y, z) = size, thing.position
    if thing.class_name != "doorjamb":
        return [Solid(thing.id, thing.class_name, (x, z), (width / 2, depth / 2), thing.yaw, y, y + height)]
    turn, out, half = radians(thing.yaw), (width - POST) / 2, (POST / 2, depth / 2 + POST / 4)
    middles = [(x + sign * out * cos(turn), z - sign * out * sin(turn)) for sign in (-1.0, 1.0)]
    return [Solid(thing.id, thing.class_name, middle, half, thing.yaw, y, y + height) for middle in middles]


POST = 0.06
"""Width in metres of the posts of a doorway."""
