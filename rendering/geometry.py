"""Triangles that rays meet: a part that stays, shared by many moments, and a part that is built for each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from hearth.rendering.meshes.mesh import Floats, Mesh, join
from hearth.rendering.meshes.shapes import face_normals
from hearth.rendering.rays import Caster, Hits, put
from hearth.rendering.things import Thing, placed

Ids = NDArray[np.int64]
Mask = NDArray[np.bool_]

# Rows of `Part.rows`: what shading looks up of a triangle. Differences are to the first corner.
NORMAL, NORMAL_U, NORMAL_V = slice(0, 3), slice(3, 6), slice(6, 9)
UV, UV_U, UV_V = slice(9, 11), slice(11, 13), slice(13, 15)
FLAT, DENSITY, COLOR, GLOW, SHINE, TEXTURE, SOLID = slice(15, 18), 18, slice(19, 22), 22, 23, 24, 25
ROWS = 26


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
    starts: Ids

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
        """(ROWS, T) what shading looks up, a column a triangle; `solid` is what one must not see from behind."""
        mesh = self.mesh
        rows = np.empty((ROWS, len(mesh)), np.float32)
        normals, uvs = mesh.normals.transpose(1, 2, 0), mesh.uvs.transpose(1, 2, 0)
        rows[NORMAL], rows[NORMAL_U], rows[NORMAL_V] = normals[0], normals[1] - normals[0], normals[2] - normals[0]
        rows[UV], rows[UV_U], rows[UV_V] = uvs[0], uvs[1] - uvs[0], uvs[2] - uvs[0]
        rows[FLAT] = face_normals(mesh.corners).T
        rows[DENSITY] = _density(mesh)
        rows[COLOR], rows[GLOW], rows[SHINE] = mesh.surface[:, :3].T, mesh.surface[:, 3], mesh.surface[:, 4]
        rows[TEXTURE] = mesh.textures
        rows[SOLID] = np.array([thing.laid for thing in self.things], np.float32)[self.owner] if len(mesh) else 0
        return rows


def _density(mesh: Mesh) -> Floats:
    """(T,) tiles of its texture a metre of each triangle."""
    spans, tiles = (
        np.sqrt(((values[:, 1:] - values[:, :1]) ** 2).sum(axis=2).max(axis=1)) for values in (mesh.corners, mesh.uvs)
    )
    density: Floats = (tiles / np.maximum(spans, 1e-6)).astype(np.float32)
    return density


@lru_cache(maxsize=4)
def still_part(things: tuple[Thing, ...]) -> Part:
    """The part of things that stay; kept, since all moments and often several programs share it."""
    return Part.of(things)


EMPTY: tuple[Thing, ...] = ()


@dataclass(frozen=True, eq=False)
class Geometry:
    """All triangles of a scene: those of the part that stays come first."""

    still: Part
    moving: Part

    @classmethod
    def of(cls, still: tuple[Thing, ...], moving: tuple[Thing, ...]) -> Geometry:
        """Of things that stay and things that do not."""
        return cls(still_part(still), Part.of(moving))

    @cached_property
    def things(self) -> tuple[Thing, ...]:
        """Everything that is in it."""
        return self.still.things + self.moving.things

    @cached_property
    def first(self) -> int:
        """The number of the first triangle that moves."""
        return len(self.still.mesh)

    def cast(self, rays: Floats) -> Hits:
        """The first hit of each of (6, N) rays."""
        return nearer(self.still.caster.cast(rays), self.moving.caster.cast(rays), self.first)

    def occluded(self, origins: Floats, directions: Floats, far: float = 0.999, shadows: bool = False) -> Mask:
        """(N,) whether anything (but a lamp, for `shadows`) lies between origins and origin + far * direction."""
        still, moving = (part.shadows if shadows else part.caster for part in (self.still, self.moving))
        found = moving.occluded(origins, directions, far)
        rest = np.flatnonzero(~found)
        found[rest] = still.occluded(origins[:, rest], directions[:, rest], far)
        return found

    def rows(self, triangle: Ids, which: slice = slice(None)) -> Floats:
        """(ROWS, N) what is known of N triangles, or only those rows."""
        first, moving = self.first, self.moving.rows[which]
        if not first:
            return moving.take(triangle, axis=1)
        found: Floats = self.still.rows[which].take(triangle, axis=1, mode="clip")
        moved = np.flatnonzero(triangle >= first)
        if len(moved):
            found[:, moved] = moving.take(triangle[moved] - first, axis=1)
        return found

    def owner(self, triangle: Ids) -> Ids:
        """(N,) index into `things` of N triangles; -1 for none."""
        owners = np.empty(self.first + len(self.moving.mesh) + 1, np.int64)
        owners[: self.first] = self.still.owner
        owners[self.first : -1] = self.moving.owner + len(self.still.things)
        owners[-1] = -1
        return owners.take(triangle, mode="wrap")


def nearer(one: Hits, other: Hits, first: int) -> Hits:
    """The nearer of two hits of the same rays, in `one`; the other's triangles are counted from `first`."""
    won = np.flatnonzero(other.distance < one.distance)
    if len(won):
        found = other.part(won)
        put(one, won, found._replace(triangle=found.triangle + first))
    return one
