"""Walks of a film, and whether they lead through solid things; measured from the drawn figures, not from the routes."""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import cos, hypot, radians, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.film.execution_keyframes import Keyframe
from hearth.rendering.people.motion import Frame
from hearth.rendering.scene.floor_cells import HEADROOM, IGNORED
from hearth.rendering.scene.scene_preparation import PreparedScene
from hearth.rendering.scene.solids import Solid, solids_of
from hearth.schemas.graph import Spot

DEEP = 0.05
"""Metres inside a thing from which on a body's middle counts as walking through it."""

LOW = 0.25
"""Metres up to which things on the floor are stepped over."""

MOVED = 0.01
"""Metres between two frames from which on a character walks."""


def on_the_floor(prepared: PreparedScene, keyframe: Keyframe) -> list[Solid]:
    """Return the solid things of a keyframe that a walk can lead through."""
    floor = min(room.box.center[1] - room.box.size[1] / 2 for room in prepared.rooms.values() if room.box)
    return [
        solid
        for solid in solids_of(prepared, keyframe.places.nodes()).all
        if solid.class_name not in IGNORED and solid.low - floor < HEADROOM and solid.high - floor > LOW
    ]


def contains(solid: Solid, spot: Spot) -> bool:
    """Return whether a point of the floor is deeper than `DEEP` inside."""
    x, z = spot[0] - solid.middle[0], spot[1] - solid.middle[1]
    c, s = cos(radians(solid.yaw)), sin(radians(solid.yaw))
    # Thin things, such as walls and leaves, are entered by their middle.
    deep = [min(DEEP, half / 2) for half in solid.half]
    return abs(x * c - z * s) < solid.half[0] - deep[0] and abs(x * s + z * c) < solid.half[1] - deep[1]


class Walk(NamedTuple):
    """A walk of a character in a tick.

    Attributes:
        tick, agent: when, and who.
        spots: (n, 2) where it was, frame by frame.
        through: (node id, class) of the solid things that it led through.
    """

    tick: int
    agent: int
    spots: NDArray[np.float64]
    through: tuple[tuple[int, str], ...]


def walks(prepared: PreparedScene, keyframes: Sequence[Keyframe], frames: Iterable[Frame]) -> list[Walk]:
    """Return the walks of a film.

    Args:
        prepared, keyframes: of its trajectory.
        frames: of the film, at some ten a second.
    """
    trails: dict[tuple[int, int], list[Spot]] = {}
    for frame in frames:
        for agent, actor in enumerate(frame.actors):
            if actor.body_pose.posture == "standing":
                trails.setdefault((frame.tick, agent), []).append(actor.spot)
    found = []
    for (tick, agent), trail in trails.items():
        steps = [hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(trail)]
        if sum(step for step in steps if step > MOVED) < 0.3:
            continue
        solids = on_the_floor(prepared, keyframes[max(tick - 1, 0)])
        through = {(s.node, s.class_name) for s in solids for spot in _between(trail) if contains(s, spot)}
        found.append(Walk(tick, agent, np.array(trail), tuple(sorted(through))))
    return found


def _between(trail: Sequence[Spot]) -> list[Spot]:
    """Points of a trail every few centimetres: walls are thin."""
    found = []
    for a, b in pairwise(trail):
        shares = np.linspace(0, 1, 2 + int(hypot(b[0] - a[0], b[1] - a[1]) / FINE))
        found += [(a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share) for share in shares.tolist()]
    return found


FINE = 0.02
"""Metres between the points of a trail that are looked at."""
