"""Triangles that rays meet: a part that stays, shared by many moments, and a part that is built for each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.models.mesh import Mesh, join
from hearth.rendering.rays.casting import Caster, Hits
from hearth.rendering.rays.kernels import COLUMNS, nearer, triangle_rows
from hearth.rendering.scene.instances import Thing, placed

Numbers = NDArray[np.integer[Any]]

MARGIN = 0.01
"""Metres by which boxes around moving things are widened."""

NEXT_TO = 0.15
"""Metres between boxes that are taken for one."""


@dataclass(frozen=True, eq=False)
class Part:
    """The triangles of some things.

    Attributes:
        things: those that are in it.
        mesh: of everything, in world coordinates.
        owner: (T,) index of each triangle's thing.
        starts: (things,) each thing's first triangle.
    """

    things: tuple[Thing, ...]
    mesh: Mesh
    owner: NDArray[np.int32]
    starts: Numbers

    @classmethod
    def of(cls, things: tuple[Thing, ...]) -> Part:
        """Of the things, in their order."""
        meshes = [placed(thing) for thing in things]
        lengths = np.array([len(mesh) for mesh in meshes], np.int64)
        owner = np.repeat(np.arange(len(meshes), dtype=np.int32), lengths)
        return cls(things, join(meshes), owner, np.cumsum(lengths) - lengths)

    @cached_property
    def caster(self) -> Caster:
        """For rays."""
        return Caster.of(self.mesh.corners)

    @cached_property
    def shadows(self) -> Caster:
        """What keeps the light of lamps away: everything but the lamps themselves."""
        lamps = np.array([thing.lamp for thing in self.things], np.bool_)
        return Caster.of(self.mesh.corners[~lamps[self.owner]]) if lamps.any() else self.caster

    @cached_property
    def rows(self) -> Floats:
        """(T, COLUMNS) what shading looks up; `solid` is what one must not see from behind."""
        mesh = self.mesh
        solid = np.array([thing.laid for thing in self.things], np.float32)
        rows = np.empty((len(mesh), COLUMNS), np.float32)
        corners, normals, uvs, surface = (
            np.ascontiguousarray(a, np.float32) for a in (mesh.corners, mesh.normals, mesh.uvs, mesh.surface)
        )
        textures = np.ascontiguousarray(mesh.textures)
        triangle_rows(corners, normals, uvs, surface, textures, solid[self.owner] if len(mesh) else solid, rows)
        return rows

    @cached_property
    def boxes(self) -> Floats:
        """(K, 6) low and high corners of boxes that hold everything, few and small."""
        bounds = [placed(thing).bounds() for thing in self.things if len(placed(thing))]
        merged = _merged([(low - MARGIN, high + MARGIN) for low, high in bounds])
        return np.array([(*low, *high) for low, high in merged], np.float32).reshape(-1, 6)


def _merged(boxes: list[tuple[Floats, Floats]]) -> list[tuple[Floats, Floats]]:
    """Boxes around groups of boxes that are next to each other."""
    groups: list[tuple[Floats, Floats]] = []
    for low, high in boxes:
        apart = []
        for other in groups:
            if (low - NEXT_TO < other[1]).all() and (high + NEXT_TO > other[0]).all():
                low, high = np.minimum(low, other[0]), np.maximum(high, other[1])  # noqa: PLW2901 - it grows
            else:
                apart.append(other)
        groups = [*apart, (low, high)]
    return groups


class Still:
    """Things that stay: their triangles are prepared once and shared by all scenes that hold this object."""

    def __init__(self, things: tuple[Thing, ...] = ()) -> None:
        self.things = things

    @cached_property
    def whole(self) -> Part:
        """Everything."""
        return Part.of(self.things)

    @cached_property
    def opened(self) -> Part:
        """Everything but ceilings and what hangs there."""
        kept = tuple(thing for thing in self.things if not thing.above)
        return Part.of(kept) if len(kept) < len(self.things) else self.whole


NOTHING = Still()


@dataclass(frozen=True, eq=False)
class Geometry:
    """All triangles of a scene: those of the part that stays come first."""

    still: Part
    moving: Part

    @cached_property
    def things(self) -> tuple[Thing, ...]:
        """Everything that is in it."""
        return self.still.things + self.moving.things

    @cached_property
    def first(self) -> int:
        """The number of the first triangle that moves."""
        return len(self.still.mesh)

    @cached_property
    def owners(self) -> NDArray[np.int32]:
        """(T + 1,) index into `things` of each triangle; the last is -1: none."""
        return np.concatenate(
            (self.still.owner, self.moving.owner + np.int32(len(self.still.things)), np.array([-1], np.int32))
        )

    def cast(self, rays: Floats) -> Hits:
        """The first hit of each of (N, 6) rays."""
        hits = self.still.caster.cast(rays)
        everywhere = np.arange(len(rays), dtype=np.int32)
        self.overlay(everywhere, rays, hits)
        return hits

    def overlay(self, pixels: NDArray[np.int32], rays: Floats, hits: Hits) -> NDArray[np.int32]:
        """Write what moves over the hits of all pixels where it is nearer; gives the pixels where it is.

        Args:
            pixels: (M,) whose rays these are.
            rays: (M, 6).
            hits: of all pixels, on what stays.
        """
        found, numbers, uvs = self.moving.caster.raw(rays)
        won = np.empty(len(pixels), np.int32)
        distance, triangle, u, v = hits
        return won[: nearer(pixels, found, numbers, uvs, self.first, distance, triangle, u, v, won)]

    def owner(self, triangle: Numbers) -> NDArray[np.int32]:
        """(N,) index into `things` of N triangles; -1 for none."""
        return self.owners.take(triangle, mode="wrap")
