"""Triangles for ray casting: a static part, shared by many scenes, and a moving part, built for each scene."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.arrays import Floats
from hearth.rendering.models.mesh import Mesh, join
from hearth.rendering.rays.kernels import COLUMNS, SHINE, nearer, triangle_rows
from hearth.rendering.rays.ray_casting import Caster, Hits
from hearth.rendering.rays.shadow_grids import LightGrids
from hearth.rendering.rays.shadow_maps import ShadowMaps
from hearth.rendering.scene.instances import Thing, placed

Numbers = NDArray[np.integer[Any]]

MARGIN = 0.01
"""Metres by which boxes around moving things are widened."""

MIRROR = 1.1
"""Shine from which on a surface is a mirror."""

NEXT_TO = 0.15
"""Distance in metres below which boxes are merged."""


@dataclass(frozen=True, eq=False)
class Part:
    """The triangles of some things.

    Attributes:
        things: the things.
        mesh: their joined meshes, in world coordinates.
        owner: (T,) index of each triangle's thing.
        starts: (things,) each thing's first triangle.
    """

    things: tuple[Thing, ...]
    mesh: Mesh
    owner: NDArray[np.int32]
    starts: Numbers

    @classmethod
    def of(cls, things: tuple[Thing, ...]) -> Part:
        """Return the part of some things, in order."""
        meshes = [placed(thing) for thing in things]
        lengths = np.array([len(mesh) for mesh in meshes], np.int64)
        owner = np.repeat(np.arange(len(meshes), dtype=np.int32), lengths)
        return cls(things, join(meshes), owner, np.cumsum(lengths) - lengths)

    @cached_property
    def caster(self) -> Caster:
        """For rays."""
        return Caster.of(self.mesh.corners)

    @cached_property
    def _lamps(self) -> NDArray[np.bool_]:
        """(things,) whether each is a lamp that is on."""
        return np.array([thing.lamp for thing in self.things], np.bool_)

    @cached_property
    def shadows(self) -> Caster:
        """A caster for shadows of lamps: all things but lamps that are on."""
        lamps = self._lamps
        return Caster.of(self.mesh.corners[~lamps[self.owner]]) if lamps.any() else self.caster

    @cached_property
    def shadow_maps(self) -> ShadowMaps:
        """The lights' view of the things."""
        return ShadowMaps(self.mesh.corners, self.owner, self._lamps)

    @cached_property
    def light_grids(self) -> LightGrids:
        """The triangles in each direction from a light."""
        return LightGrids(self.mesh.corners, self.owner, self._lamps)

    @cached_property
    def rows(self) -> Floats:
        """(T, COLUMNS) rows that shading looks up; `solid` marks triangles invisible from behind."""
        mesh = self.mesh
        solid = np.array([thing.structural for thing in self.things], np.float32)
        rows = np.empty((len(mesh), COLUMNS), np.float32)
        corners, normals, uvs, surface = (
            np.ascontiguousarray(a, np.float32) for a in (mesh.corners, mesh.normals, mesh.uvs, mesh.surface)
        )
        textures = np.ascontiguousarray(mesh.textures)
        triangle_rows(corners, normals, uvs, surface, textures, solid[self.owner] if len(mesh) else solid, rows)
        return rows

    @cached_property
    def mirrors(self) -> NDArray[np.bool_]:
        """(T,) whether each triangle is of a mirror."""
        return self.rows[:, SHINE] > MIRROR

    @cached_property
    def ends(self) -> Numbers:
        """(things,) the triangle after each thing's last."""
        return np.append(self.starts[1:], len(self.mesh)).astype(np.int64)

    @cached_property
    def extents(self) -> Floats:
        """(things, 6) low and high corners of each thing's box; of a thing without triangles, a box of no size."""
        bounds = [placed(thing).bounds() if len(placed(thing)) else NOWHERE for thing in self.things]
        return np.array([(*low, *high) for low, high in bounds], np.float64).reshape(-1, 6)

    @cached_property
    def building(self) -> Numbers:
        """Indices of the things that belong to the building, which hide others."""
        return np.flatnonzero([thing.structural for thing in self.things])

    @cached_property
    def furnishing(self) -> Numbers:
        """Indices of all other things."""
        return np.flatnonzero([not thing.structural for thing in self.things])

    @cached_property
    def boxes(self) -> Floats:
        """(K, 6) low and high corners of a few small boxes that contain all triangles."""
        bounds = [placed(thing).bounds() for thing in self.things if len(placed(thing))]
        merged = _merged([(low - MARGIN, high + MARGIN) for low, high in bounds])
        return np.array([(*low, *high) for low, high in merged], np.float32).reshape(-1, 6)


NOWHERE = (np.zeros(3, np.float32), np.zeros(3, np.float32))


def _merged(boxes: list[tuple[Floats, Floats]]) -> list[tuple[Floats, Floats]]:
    """Boxes around groups of neighbouring boxes."""
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


class StaticThings:
    """Static things; their triangles are prepared once and shared by all scenes with this object."""

    def __init__(self, things: tuple[Thing, ...] = ()) -> None:
        self.things = things

    @cached_property
    def whole(self) -> Part:
        """Everything."""
        return Part.of(self.things)

    @cached_property
    def opened(self) -> Part:
        """The part without ceilings and hanging things."""
        kept = tuple(thing for thing in self.things if not thing.above)
        return Part.of(kept) if len(kept) < len(self.things) else self.whole


NOTHING = StaticThings()


@dataclass(frozen=True, eq=False)
class Geometry:
    """All triangles of a scene, the static ones first."""

    static: Part
    moving: Part

    @cached_property
    def things(self) -> tuple[Thing, ...]:
        """Static and moving things."""
        return self.static.things + self.moving.things

    @cached_property
    def first(self) -> int:
        """Index of the first moving triangle."""
        return len(self.static.mesh)

    @cached_property
    def owners(self) -> NDArray[np.int32]:
        """(T + 1,) index into `things` of each triangle; the last entry is -1, for rays without a hit."""
        return np.concatenate(
            (self.static.owner, self.moving.owner + np.int32(len(self.static.things)), np.array([-1], np.int32))
        )

    def cast(self, rays: Floats) -> Hits:
        """Return the first hit of each of (N, 6) rays."""
        hits = self.static.caster.cast(rays)
        everywhere = np.arange(len(rays), dtype=np.int32)
        self.overlay(everywhere, rays, hits)
        return hits

    def overlay(self, pixels: NDArray[np.int32], rays: Floats, hits: Hits) -> NDArray[np.int32]:
        """Replace hits on static things by nearer hits on moving things; returns the changed pixels.

        Args:
            pixels: (M,) pixels of the rays.
            rays: (M, 6).
            hits: of all pixels, on static things.
        """
        found, numbers, uvs = self.moving.caster.raw(rays)
        won = np.empty(len(pixels), np.int32)
        distance, triangle, u, v = hits
        return won[: nearer(pixels, found, numbers, uvs, self.first, distance, triangle, u, v, won)]

    def owner(self, triangle: Numbers) -> NDArray[np.int32]:
        """(N,) index into `things` of N triangles; -1 without a triangle."""
        return self.owners.take(triangle, mode="wrap")
